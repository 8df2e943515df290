//! A system with a place to start from: what a list of systems is made of.
//!
//! In: the type of a system, and its start. Out: an [`Entry`], the type erased: there the compiler meets all that is generic over systems.

use vi_core::kind::Free;
use vi_core::lagrangian::Described;
use vi_core::method::Controlled;
use vi_core::stepping::EnergyStepping;
use vi_core::{Composition, EnergyPreserving, FixedStep};
use vi_erased::erasable::{Erasable, Runnable};
use vi_erased::integrator::{self, Integrator};
use vi_erased::plan::{DEFAULT_BOUND_ENERGY_STAGES, DEFAULT_BOUND_STAGES, ENERGY_STAGES, STAGES};
use vi_erased::system::StartOf;
use vi_erased::{System, Typed};

/// A system with a place to start from.
pub struct Entry {
    /// The system, with the default parameters.
    pub system: Box<dyn System>,
    /// Its description.
    pub about: &'static str,
    /// Default initial coordinates.
    pub q: Vec<f64>,
    /// Default initial velocities.
    pub v: Vec<f64>,
    /// Default step.
    pub h: f64,
    /// The text of a system that is not compiled, with the texts of its files.
    pub text: Option<String>,
}

impl Entry {
    /// A system with a place to start from: what it is, its initial coordinates and velocities, a step.
    #[must_use]
    pub fn new<S: Ruled<N>, const N: usize>(about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Self {
        let integrators = integrator::all([S::with_rule(), without_rule()]);
        Self::of(Typed::<S, N>::new(integrators), about, (q, v), h)
    }

    /// The same of a system without a rule, which has Gauss steps alone.
    #[must_use]
    pub fn with_gauss_only<S, const N: usize>(about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Self
    where
        S: Runnable<N, Kind = Free> + Described + Default,
    {
        Self::of(Typed::<S, N>::new(without_rule()), about, (q, v), h)
    }

    /// The same of a system with constraints.
    #[must_use]
    pub fn with_constraints<S, const N: usize>(about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Self
    where
        S: Runnable<N> + Described + Default,
    {
        Self::of(Typed::<S, N>::new(with_constraints()), about, (q, v), h)
    }

    /// The same of a system with constraints whose initial state follows from its parameters, by `start`.
    #[must_use]
    pub fn placed<S, const N: usize>(about: &'static str, start: StartOf<S, N>, h: f64) -> Self
    where
        S: Runnable<N> + Described + Default,
    {
        Self::of(Typed::<S, N>::new(with_constraints()).with_start(start), about, start(&S::default()), h)
    }

    fn of<S, const N: usize>(system: Typed<S, N>, about: &'static str, (q, v): ([f64; N], [f64; N]), h: f64) -> Self
    where
        S: Runnable<N> + Described,
    {
        Self { system: Box::new(system), about, q: q.to_vec(), v: v.to_vec(), h, text: None }
    }
}

/// A system with a rule that has fixed and energy-preserving steps: every generated one with `discretize midpoint`.
pub trait Ruled<const N: usize>: EnergyStepping<N> + Runnable<N, Kind = Free> + Described + Default {
    /// The integrators that need the rule.
    fn with_rule() -> Vec<Integrator<Self, N>>;
}

impl<S, const N: usize> Ruled<N> for S
where
    S: EnergyStepping<N> + Runnable<N, Kind = Free> + Described + Default,
    FixedStep: Erasable<S, N>,
    Composition: Erasable<S, N>,
    EnergyPreserving: Erasable<S, N, Memory: Controlled<f64>>,
{
    fn with_rule() -> Vec<Integrator<S, N>> {
        integrator::all([integrator::by_rule(), vec![integrator::energy()]])
    }
}

/// Every integrator that needs no rule.
fn without_rule<S: Runnable<N, Kind = Free>, const N: usize>() -> Vec<Integrator<S, N>> {
    let gauss = vec![
        integrator::gauss::<S, N, { STAGES[0] }>(),
        integrator::gauss::<S, N, { STAGES[1] }>(),
        integrator::adaptive::<S, N, { STAGES[0] }>(),
        integrator::adaptive::<S, N, { STAGES[1] }>(),
        integrator::transformed::<S, N, { STAGES[0] }>(),
        integrator::transformed::<S, N, { STAGES[1] }>(),
        integrator::energy_gauss::<S, N, { ENERGY_STAGES[0] }>(),
        integrator::energy_gauss::<S, N, { ENERGY_STAGES[1] }>(),
        integrator::energy_gauss::<S, N, { ENERGY_STAGES[2] }>(),
    ];
    integrator::all([integrator::splitting(), gauss])
}

/// Every integrator that keeps constraints.
fn with_constraints<S: Runnable<N>, const N: usize>() -> Vec<Integrator<S, N>> {
    vec![
        integrator::gauss::<S, N, 1>(),
        integrator::gauss::<S, N, 2>(),
        integrator::gauss::<S, N, DEFAULT_BOUND_STAGES>(),
        integrator::adaptive::<S, N, DEFAULT_BOUND_STAGES>(),
        integrator::energy_gauss::<S, N, DEFAULT_BOUND_ENERGY_STAGES>(),
    ]
}
