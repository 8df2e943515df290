//! Markers of quadrature rules, and systems by a rule other than their own.
//!
//! The traits of a discrete system ([`DiscreteLagrangian`](crate::discrete::DiscreteLagrangian),
//! [`FixedStepping`](crate::stepping::FixedStepping), [`EnergyStepping`](crate::stepping::EnergyStepping)) are
//! implemented once per declared rule, with the marker R. The integrators step by [`Own`], the first rule. A direct
//! call of a trait function on a system with several rules names the marker: `FixedStepping::<1, f64,
//! Own>::discrete_energy(&system, …)`.

use core::fmt::Debug;
use core::ops::{Deref, DerefMut};

/// A marker of a rule.
pub trait Rule: Copy + Debug + PartialEq + Send + Sync + 'static {
    /// Name of the rule in the language; `None` for the system's own rule, which can be any.
    const NAME: Option<&'static str>;
}

/// The declared rule of a system; the first if there are several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Own;
/// The midpoint rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Midpoint;
/// The trapezoidal rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trapezoidal;

impl Rule for Own {
    const NAME: Option<&'static str> = None;
}
impl Rule for Midpoint {
    const NAME: Option<&'static str> = Some("midpoint");
}
impl Rule for Trapezoidal {
    const NAME: Option<&'static str> = Some("trapezoidal");
}

/// A rule that evaluates L at points of a step, all with its mean velocity:
///
/// ```text
/// L_d = h Σ w L(t0 + c h, q0 + c h v, v)        v = (q1 − q0)/h
/// ```
pub trait Quadrature: Rule {
    /// `[c, w]` of each point. The weights have the sum 1.
    const POINTS: &'static [[f64; 2]];
}

impl Quadrature for Midpoint {
    const POINTS: &'static [[f64; 2]] = &[[0.5, 1.0]];
}
impl Quadrature for Trapezoidal {
    const POINTS: &'static [[f64; 2]] = &[[0.0, 0.5], [1.0, 0.5]];
}

/// A system by one of its further rules, R. It replaces the system everywhere:
///
/// ```
/// use vi_core::rules::{By, Trapezoidal};
/// use vi_core::prelude::*;
///
/// lagrangian! {
///     struct Pendulum {
///         coord θ;
///         L = dot(θ)^2 / 2 + cos(θ);
///         discretize midpoint, trapezoidal;
///     }
/// }
///
/// let pendulum = Pendulum::default();
/// let start = pendulum.at(0.0, [0.5], [0.0]);
/// let by_midpoint = start.integrate(FixedStep, 0.1)?.step()?;
/// let by_trapezoidal = By::new(&pendulum, Trapezoidal).at_state(start.state).integrate(FixedStep, 0.1)?.step()?;
/// assert_ne!(by_midpoint, by_trapezoidal);
/// # Ok::<(), vi_core::StepError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct By<S, R> {
    system: S,
    rule: R,
}

impl<S, R: Rule> By<S, R> {
    /// The system by this rule.
    pub fn new(system: S, rule: R) -> Self {
        Self { system, rule }
    }

    /// The system, by its own rule.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// The rule.
    pub fn rule(&self) -> R {
        self.rule
    }
}

impl<S, R> Deref for By<S, R> {
    type Target = S;

    fn deref(&self) -> &S {
        &self.system
    }
}

impl<S, R> DerefMut for By<S, R> {
    fn deref_mut(&mut self) -> &mut S {
        &mut self.system
    }
}
