//! Entries for the systems listed in `vi_lab::main!`, with or without a rule, or with constraints.
//!
//! In: a type. Out: its [`Entry`]. The call `(&&&Declared::<S>::new()).entry(…)` resolves to [`WithRule`] if the system
//! has a rule with a step density, to [`WithConstraints`], one reference deeper, if it has constraints, otherwise to
//! [`WithoutRule`]. The macro knows the type at its expansion.

use crate::Entry;
use core::marker::PhantomData;
use vi_core::kind::{Bound, Form, Free};
use vi_core::lagrangian::Described;
use vi_erased::erasable::Runnable;
use vi_report::entry::Ruled;

/// A system declared by a program.
#[derive(Debug)]
pub struct Declared<S>(PhantomData<S>);

impl<S> Declared<S> {
    /// This system.
    #[must_use]
    #[allow(clippy::new_without_default, reason = "the macro alone calls it")]
    pub const fn new() -> Self {
        Self(PhantomData)
    }
}

/// A system with a rule.
pub trait WithRule<const N: usize> {
    /// Builds the entry from a description, initial coordinates and velocities, and a step.
    fn entry(&self, about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Entry;
}

/// A system with constraints.
pub trait WithConstraints<const N: usize> {
    /// Builds the entry from a description, initial coordinates and velocities, and a step.
    fn entry(&self, about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Entry;
}

/// A system without a rule.
pub trait WithoutRule<const N: usize> {
    /// Builds the entry from a description, initial coordinates and velocities, and a step.
    fn entry(&self, about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Entry;
}

impl<S, const N: usize> WithRule<N> for &&Declared<S>
where
    S: Ruled<N>,
{
    fn entry(&self, about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Entry {
        Entry::new::<S, N>(about, q, v, h)
    }
}

impl<S, const N: usize, const K: usize, F: Form> WithConstraints<N> for &Declared<S>
where
    S: Runnable<N, Kind = Bound<K, F>> + Described + Default,
{
    fn entry(&self, about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Entry {
        Entry::with_constraints::<S, N>(about, q, v, h)
    }
}

impl<S, const N: usize> WithoutRule<N> for Declared<S>
where
    S: Runnable<N, Kind = Free> + Described + Default,
{
    fn entry(&self, about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Entry {
        Entry::with_gauss_only::<S, N>(about, q, v, h)
    }
}

#[cfg(test)]
#[allow(clippy::needless_borrow, reason = "the calls are those of the macro")]
mod tests {
    use super::{Declared, WithConstraints as _, WithRule as _, WithoutRule as _};
    use vi_core::{StepError, lagrangian};
    use vi_erased::plan::{Method, PhasePoint, Plan};

    lagrangian! {
        struct Alone {
            coord x, y;
            L = (dot(x)^2 + dot(y)^2) / 2 - x^4 * y^2 - y^4;
        }
    }

    lagrangian! {
        struct Ruled {
            coord x;
            L = dot(x)^2 / 2 - x^4 / 4;
            discretize midpoint;
        }
    }

    lagrangian! {
        struct Rod {
            param l = 1.0;
            coord x, y;
            L = (dot(x)^2 + dot(y)^2) / 2 - y;
            constraint rod = x^2 + y^2 - l^2;
        }
    }

    #[test]
    fn a_system_with_constraints_runs_by_steps_that_keep_them() {
        let entry = (&&&Declared::<Rod>::new()).entry("a rod", [0.6, -0.8], [0.0, 0.0], 0.01);
        assert!(entry.system.has_constraints() && !entry.system.has_rule());
        let start = PhasePoint { t: 0.0, q: entry.q, v: entry.v };
        let mut run = entry.system.begin(&Plan::new(Method::Gauss, entry.h, start.clone())).expect("a start");
        run.advance_by(10).expect("steps");
        assert!(run.t() > 0.05 && run.q()[0] < 0.6, "{}", run.t());
        for method in [Method::Fixed, Method::Splitting6, Method::Energy] {
            let error = entry.system.begin(&Plan::new(method, entry.h, start.clone())).err();
            assert_eq!(error, Some(StepError::HasConstraints { system: "Rod" }));
        }
    }

    #[test]
    fn a_system_without_a_rule_runs_by_gauss_steps() {
        let entry = (&&&Declared::<Alone>::new()).entry("two springs", [1.0, 0.2], [0.0, 0.0], 0.01);
        let start = PhasePoint { t: 0.0, q: entry.q, v: entry.v };
        assert!(!entry.system.has_rule() && entry.system.studies().step_density(&start).is_none());
        let by = |method, stages| Plan { stages, ..Plan::new(method, entry.h, start.clone()) };
        for (method, stages) in [(Method::Gauss, Some(4)), (Method::Energy, Some(2))] {
            let mut run = entry.system.begin(&by(method, stages)).expect("a start");
            run.advance_by(10).expect("steps");
            assert!(run.t() > 0.05 && run.q()[0] < 1.0, "{}", run.t());
        }
        for method in [Method::Fixed, Method::KahanLi8, Method::Energy] {
            let error = entry.system.begin(&by(method, None)).err();
            assert_eq!(error, Some(StepError::NoRule { system: "Alone" }));
        }
        let message = StepError::NoRule { system: "Alone" }.to_string();
        assert!(
            message.contains("`Alone` declares no quadrature rule") && message.contains("add `discretize midpoint;`"),
            "{message}"
        );
    }

    #[test]
    fn a_system_with_a_rule_keeps_it() {
        let entry = (&&&Declared::<Ruled>::new()).entry("a spring", [1.0], [0.0], 0.01);
        let start = PhasePoint { t: 0.0, q: entry.q, v: entry.v };
        assert!(entry.system.has_rule() && entry.system.studies().step_density(&start).is_some());
        let mut run = entry.system.begin(&Plan::new(Method::Fixed, entry.h, start)).expect("a start");
        run.advance_by(10).expect("steps");
        assert!(run.evaluations() > 10);
    }
}
