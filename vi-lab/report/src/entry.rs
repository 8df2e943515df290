//! A system with a place to start from: an entry of a list of systems.
//!
//! In: the type of a system, and its start. Out: an [`Entry`]. A list shows its data; the type-erased system is built
//! when it is first used. All code that is generic over systems is instantiated here.

use std::sync::LazyLock;
use vi_core::kind::Free;
use vi_core::lagrangian::{Described, Parameters};
use vi_core::method::Controlled;
use vi_core::stepping::EnergyStepping;
use vi_core::{Composition, EnergyPreserving, FixedStep, Lagrangian};
use vi_erased::erasable::{Erasable, Runnable};
use vi_erased::integrator::{self, Integrator};
use vi_erased::plan::{DEFAULT_BOUND_ENERGY_STAGES, DEFAULT_BOUND_STAGES, ENERGY_STAGES, STAGES};
use vi_erased::{System, Typed};

/// A system with a place to start from.
pub struct Entry {
    /// Name of the type.
    pub name: &'static str,
    /// Its description.
    pub about: &'static str,
    /// Names of the coordinates.
    pub coordinates: Vec<&'static str>,
    /// Names and default values of the parameters.
    pub parameters: Vec<(&'static str, f64)>,
    /// Default initial coordinates.
    pub q: Vec<f64>,
    /// Default initial velocities.
    pub v: Vec<f64>,
    /// Default step.
    pub h: f64,
    /// The default initial state for other parameters, if it follows from them.
    pub start: Option<Start>,
    /// The text of a system of a file, with the texts of its files of tables.
    pub text: Option<String>,
    /// The system, with the default parameters.
    pub system: OnDemand,
}

/// A system that is built when it is first used.
pub type OnDemand = LazyLock<Box<dyn System>, Box<dyn FnOnce() -> Box<dyn System> + Send>>;

/// Initial coordinates and velocities of parameters, which are given by name.
pub type Start = fn(&[(&'static str, f64)]) -> [Vec<f64>; 2];

impl Entry {
    /// A system with a description, initial coordinates and velocities, and a step.
    #[must_use]
    pub fn new<S: Ruled<N>, const N: usize>(about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Self {
        Self::listed::<S, N>(about, (q, v), h, || {
            Box::new(Typed::<S, N>::new(integrator::all([S::with_rule(), without_rule()])))
        })
    }

    /// The entry of a system without a rule, which has Gauss steps only.
    #[must_use]
    pub fn with_gauss_only<S, const N: usize>(about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Self
    where
        S: Runnable<N, Kind = Free> + Described + Default,
    {
        Self::listed::<S, N>(about, (q, v), h, || Box::new(Typed::<S, N>::new(without_rule())))
    }

    /// The entry of a system with constraints.
    #[must_use]
    pub fn with_constraints<S, const N: usize>(about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Self
    where
        S: Runnable<N> + Described + Default,
    {
        Self::listed::<S, N>(about, (q, v), h, || Box::new(Typed::<S, N>::new(with_constraints())))
    }

    /// The entry of a system that `build` returns, with the name, the coordinates and the parameters of this type.
    #[must_use]
    pub fn listed<S, const N: usize>(
        about: &'static str,
        (q, v): ([f64; N], [f64; N]),
        h: f64,
        build: fn() -> Box<dyn System>,
    ) -> Self
    where
        S: Lagrangian<N> + Default,
    {
        let system = S::default();
        let parameters =
            S::PARAMETERS.iter().enumerate().map(|(index, name)| (*name, system.parameter(index))).collect();
        Self {
            name: S::NAME,
            about,
            coordinates: S::COORDINATES.to_vec(),
            parameters,
            q: q.to_vec(),
            v: v.to_vec(),
            h,
            start: None,
            text: None,
            system: LazyLock::new(Box::new(build)),
        }
    }

    /// The entry of a system that is built already, with its text.
    #[must_use]
    pub fn of(system: Box<dyn System>, [q, v]: [Vec<f64>; 2], h: f64, text: String) -> Self {
        Self {
            name: system.name(),
            about: system.about(),
            coordinates: system.coordinates(),
            parameters: system.parameters(),
            q,
            v,
            h,
            start: None,
            text: Some(text),
            system: LazyLock::new(Box::new(|| system)),
        }
    }

    /// This entry with an initial state that follows from the parameters.
    #[must_use]
    pub fn placed(self, start: Start) -> Self {
        Self { start: Some(start), ..self }
    }
}

/// Initial coordinates and velocities of a system with these parameters: for a [`Start`].
pub fn start<S: Parameters + Default, const N: usize>(
    parameters: &[(&'static str, f64)],
    start: fn(&S) -> ([f64; N], [f64; N]),
) -> [Vec<f64>; 2] {
    let mut system = S::default();
    for (name, value) in parameters {
        system.parameter_mut(name).into_iter().for_each(|parameter| *parameter = *value);
    }
    let (q, v) = start(&system);
    [q.to_vec(), v.to_vec()]
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
        integrator::energy_gauss::<S, N, { ENERGY_STAGES[0] }>(),
        integrator::energy_gauss::<S, N, { ENERGY_STAGES[1] }>(),
        integrator::energy_gauss::<S, N, { ENERGY_STAGES[2] }>(),
    ];
    // Compiled for systems with a time scale only.
    let transformed = if const { S::SCALES_TIME } {
        vec![integrator::transformed::<S, N, { STAGES[0] }>(), integrator::transformed::<S, N, { STAGES[1] }>()]
    } else {
        Vec::new()
    };
    integrator::all([integrator::splitting(), gauss, transformed])
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
