//! A type-erased system for runs, maps and comparisons.
//!
//! In: a system of a known type. Out: a [`System`], which derefs to that of [`vi_erased`]: its functions and runs. This
//! trait adds what is generic over systems and only the command needs: densities, accurate motion, exponents and the
//! rival are compiled once per system, for any number of charts.

use crate::exponents::{self, Exponents};
use crate::rival::{self, Ended};
use core::cell::Cell;
use core::ops::{Deref, DerefMut};
use vi_core::check::Trajectory;
use vi_core::constrained::Extended;
use vi_core::gauss::step_density;
use vi_core::kind::{Free, Kind};
use vi_core::lagrangian::Described;
use vi_core::stepping::EnergyStepping;
use vi_core::{Called, Lagrangian, SVector, State, StepError};
use vi_erased::erasable::Runnable;
use vi_erased::integrator::{self, Integrator};
use vi_erased::plan::{BOUND_ENERGY_STAGES, BOUND_STAGES, ENERGY_STAGES, STAGES};
use vi_erased::simulation::vector;
use vi_erased::{Method, PhasePoint, Plan, Typed};

/// A system with its parameters.
pub trait System: Send + Sync {
    /// Its functions and runs.
    fn erased(&self) -> &(dyn vi_erased::System + 'static);
    /// The same, mutably.
    fn erased_mut(&mut self) -> &mut (dyn vi_erased::System + 'static);
    /// Whether it is compiled. A system of a text has runs, and nothing of what follows.
    fn is_compiled(&self) -> bool {
        true
    }
    /// A system of the same type with the same parameters.
    fn copy(&self) -> Box<dyn System>;
    /// The default initial coordinates and velocities, if they follow from the parameters.
    fn start(&self) -> Option<[Vec<f64>; 2]>;
    /// Step density D at t = 0; `None` without a value or without a rule.
    fn step_density(&self, q: &[f64], v: &[f64]) -> Option<f64>;
    /// Step densities of 1, 2 and 3 stages at a node with its time, coordinates and momenta; `None` without a value.
    fn step_densities(&self, t: f64, q: &[f64], p: &[f64]) -> [Option<f64>; ENERGY_STAGES.len()];
    /// The point of the same motion at the time `end`, by [`Trajectory::at`].
    ///
    /// # Errors
    /// The motion cannot be computed; [`StepError::InvalidInput`] for a point with another number of coordinates.
    fn follow(&self, from: &PhasePoint, end: f64) -> Result<PhasePoint, StepError>;
    /// `count` Lyapunov exponents along the run of Gauss steps of a plan.
    ///
    /// # Errors
    /// As [`vi_erased::System::begin`].
    fn lyapunov(&self, plan: &Plan, count: usize) -> Result<Box<dyn Exponents>, StepError>;
    /// The point of the same motion at the time `end`, by the rival with a tolerance. `evaluations` grows by the number
    /// of accelerations, even if the run ends early; `watch`, if any, gets time and H at the start and after every
    /// step.
    ///
    /// # Errors
    /// The reason why the run did not reach its end.
    fn rival(
        &self,
        from: &PhasePoint,
        end: f64,
        tolerance: f64,
        evaluations: &Cell<u64>,
        watch: Option<&mut dyn FnMut(f64, f64)>,
    ) -> Result<PhasePoint, Ended>;
}

impl Deref for dyn System + '_ {
    type Target = dyn vi_erased::System;

    fn deref(&self) -> &Self::Target {
        self.erased()
    }
}

impl DerefMut for dyn System + '_ {
    fn deref_mut(&mut self) -> &mut Self::Target {
        self.erased_mut()
    }
}

impl dyn System + '_ {
    /// Whether the system has constraints.
    #[must_use]
    pub fn has_constraints(&self) -> bool {
        !self.constraints().is_empty()
    }

    /// The default method of the system.
    #[must_use]
    pub fn usual_method(&self) -> Method {
        match (self.has_constraints(), self.has_rule()) {
            (false, true) => Method::Fixed,
            _ => Method::Gauss,
        }
    }

    /// Whether the system has a rule, and with it fixed and energy-preserving steps of order 2.
    #[must_use]
    pub fn has_rule(&self) -> bool {
        self.has(Method::Fixed)
    }
}

/// The step density of a rule at t = 0.
type Density<S, const N: usize> = fn(&S, &SVector<f64, N>, &SVector<f64, N>) -> Option<f64>;

/// Initial coordinates and velocities of a system with its parameters.
pub type StartOf<S, const N: usize> = fn(&S) -> ([f64; N], [f64; N]);

/// A system of a known type; without a rule it has no density.
struct Studied<S, const N: usize> {
    typed: Typed<S, N>,
    density: Option<Density<S, N>>,
    start: Option<StartOf<S, N>>,
}

/// The system `S` with its default parameters, and every integrator.
#[must_use]
pub fn by_rule<S, const N: usize>() -> Box<dyn System>
where
    S: EnergyStepping<N> + Runnable<N, Kind = Free> + Described + Default,
{
    let density = |system: &S, q: &SVector<f64, N>, v: &SVector<f64, N>| {
        system.step_density(0.0, q, v).ok().filter(|density| density.is_finite())
    };
    let with_rule = [integrator::by_rule(), vec![integrator::energy()], without_rule()];
    Box::new(Studied { typed: Typed::new(integrator::all(with_rule)), density: Some(density), start: None })
}

/// The same of a system without a rule.
#[must_use]
pub fn gauss_only<S: Runnable<N, Kind = Free> + Described + Default, const N: usize>() -> Box<dyn System> {
    Box::new(Studied { typed: Typed::<S, N>::new(without_rule()), density: None, start: None })
}

/// The system `S` with its default parameters and its constraints, and every integrator that keeps them; its initial
/// state, if it follows from the parameters.
#[must_use]
pub fn with_constraints<S, const N: usize>(start: Option<StartOf<S, N>>) -> Box<dyn System>
where
    S: Runnable<N> + Described + Default,
{
    let integrators = vec![
        integrator::gauss::<S, N, { BOUND_STAGES[0] }>(),
        integrator::gauss::<S, N, { BOUND_STAGES[1] }>(),
        integrator::gauss::<S, N, { BOUND_STAGES[2] }>(),
        integrator::energy_gauss::<S, N, BOUND_ENERGY_STAGES>(),
    ];
    Box::new(Studied { typed: Typed::new(integrators), density: None, start })
}

/// Every integrator that needs no rule.
fn without_rule<S: Runnable<N, Kind = Free>, const N: usize>() -> Vec<Integrator<S, N>> {
    let gauss = vec![
        integrator::gauss::<S, N, { STAGES[0] }>(),
        integrator::gauss::<S, N, { STAGES[1] }>(),
        integrator::transformed::<S, N, { STAGES[0] }>(),
        integrator::transformed::<S, N, { STAGES[1] }>(),
        integrator::energy_gauss::<S, N, { ENERGY_STAGES[0] }>(),
        integrator::energy_gauss::<S, N, { ENERGY_STAGES[1] }>(),
        integrator::energy_gauss::<S, N, { ENERGY_STAGES[2] }>(),
    ];
    integrator::all([integrator::splitting(), gauss])
}

impl<S: Runnable<N> + Described, const N: usize> System for Studied<S, N> {
    fn erased(&self) -> &(dyn vi_erased::System + 'static) {
        &self.typed
    }

    fn erased_mut(&mut self) -> &mut (dyn vi_erased::System + 'static) {
        &mut self.typed
    }

    fn copy(&self) -> Box<dyn System> {
        Box::new(Self { typed: self.typed.clone(), ..*self })
    }

    fn start(&self) -> Option<[Vec<f64>; 2]> {
        self.start.map(|start| {
            let (q, v) = start(&self.typed.system);
            [q.to_vec(), v.to_vec()]
        })
    }

    fn step_density(&self, q: &[f64], v: &[f64]) -> Option<f64> {
        let sized = q.len() == N && v.len() == N;
        let density =
            |of: Density<S, N>| of(&self.typed.system, &SVector::from_column_slice(q), &SVector::from_column_slice(v));
        self.density.filter(|_| sized).and_then(density)
    }

    fn step_densities(&self, t: f64, q: &[f64], p: &[f64]) -> [Option<f64>; ENERGY_STAGES.len()] {
        if const { S::Kind::COUNT > 0 } {
            return [None; ENERGY_STAGES.len()];
        }
        let state =
            vector(q, "number of coordinates").and_then(|q| Ok(State { t, q, p: vector(p, "number of momenta")? }));
        let Ok(state) = state else { return [None; ENERGY_STAGES.len()] };
        let system = Called(self.typed.system);
        [
            step_density::<_, N, { ENERGY_STAGES[0] }>(&system, &state).ok(),
            step_density::<_, N, { ENERGY_STAGES[1] }>(&system, &state).ok(),
            step_density::<_, N, { ENERGY_STAGES[2] }>(&system, &state).ok(),
        ]
    }

    fn follow(&self, from: &PhasePoint, end: f64) -> Result<PhasePoint, StepError> {
        sized(from)?.at(&Extended(self.typed.system), end).map(erased_point)
    }

    fn lyapunov(&self, plan: &Plan, count: usize) -> Result<Box<dyn Exponents>, StepError> {
        if const { S::Kind::COUNT > 0 } {
            let because = "exponents of motions with constraints are not supported";
            return Err(StepError::NoDerivative { t: plan.t, because });
        }
        exponents::begin(self.typed.system, plan, count)
    }

    fn rival(
        &self,
        from: &PhasePoint,
        end: f64,
        tolerance: f64,
        evaluations: &Cell<u64>,
        watch: Option<&mut dyn FnMut(f64, f64)>,
    ) -> Result<PhasePoint, Ended> {
        by_rival(Extended(self.typed.system), (from, end), tolerance, evaluations, watch)
    }
}

/// [`System::rival`].
fn by_rival<S: Lagrangian<N> + Copy, const N: usize>(
    system: S,
    (from, end): (&PhasePoint, f64),
    tolerance: f64,
    evaluations: &Cell<u64>,
    mut watch: Option<&mut dyn FnMut(f64, f64)>,
) -> Result<PhasePoint, Ended> {
    let mut show = |motion: &Trajectory<N>| {
        if let Some(watch) = &mut watch {
            watch(motion.t, system.energy(motion.t, &motion.q, &motion.v));
        }
    };
    rival::motion(system, &sized(from)?, end, tolerance, evaluations, &mut show).map(erased_point)
}

/// A point with the system's number of coordinates.
fn sized<const N: usize>(point: &PhasePoint) -> Result<Trajectory<N>, StepError> {
    let q = vector(&point.q, "number of coordinates")?;
    let v = vector(&point.v, "number of velocities")?;
    Ok(Trajectory { t: point.t, q, v })
}

/// A type-erased point.
fn erased_point<const N: usize>(motion: Trajectory<N>) -> PhasePoint {
    PhasePoint { t: motion.t, q: motion.q.as_slice().to_vec(), v: motion.v.as_slice().to_vec() }
}
