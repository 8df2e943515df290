//! A type-erased system for runs, maps and comparisons.
//!
//! In: a system of a known type. Out: a [`System`], which derefs to that of [`vi_erased`]: its functions and runs. This
//! trait adds what is generic over systems and only the command needs: densities, accurate motion, exponents and the
//! rival are compiled once per system, for any number of charts.

use crate::exponents::{self, Exponents};
use crate::rival::{self, Ended};
use core::cell::Cell;
use core::ops::{Deref, DerefMut};
use vi_core::check::Motion;
use vi_core::constrained::Extended;
use vi_core::gauss::step_density;
use vi_core::lagrangian::Described;
use vi_core::method::Controlled;
use vi_core::stepping::EnergyStepping;
use vi_core::{Called, EnergyPreservingGaussLobatto, GaussLobatto, Lagrangian, SVector, State, StepError};
use vi_erased::integrator::{self, Integrator};
use vi_erased::mechanics::WithConstraints;
use vi_erased::plan::{ENERGY_LOBATTO_STAGES, ENERGY_STAGES, LOBATTO_STAGES, STAGES};
use vi_erased::simulation::{Erasable, Runnable, RunnableWithConstraints, vector};
use vi_erased::{Method, PhasePoint, Plan, Typed};

/// A system with its parameters.
pub trait System: Send + Sync {
    /// Its functions and runs.
    fn erased(&self) -> &(dyn vi_erased::System + 'static);
    /// The same, mutably.
    fn erased_mut(&mut self) -> &mut (dyn vi_erased::System + 'static);
    /// A system of the same type with the same parameters.
    fn copy(&self) -> Box<dyn System>;
    /// The default initial coordinates and velocities, if they follow from the parameters.
    fn start(&self) -> Option<[Vec<f64>; 2]>;
    /// Step density D at t = 0; `None` without a value or without a rule.
    fn step_density(&self, q: &[f64], v: &[f64]) -> Option<f64>;
    /// Step densities of 1, 2 and 3 stages at a node with its time, coordinates and momenta; `None` without a value.
    fn step_densities(&self, t: f64, q: &[f64], p: &[f64]) -> [Option<f64>; ENERGY_STAGES.len()];
    /// g of the time scale at a point; `None` for a system without a time scale.
    fn time_scale(&self, at: &PhasePoint) -> Option<f64>;
    /// The point of the same motion at the time `end`, by [`Motion::at`].
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
            (true, _) => Method::GaussLobatto,
            (false, true) => Method::Fixed,
            (false, false) => Method::Gauss,
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

/// A system of a known type; without a rule it has no density.
struct Studied<S, const N: usize> {
    typed: Typed<S, N>,
    density: Option<Density<S, N>>,
}

/// The system `S` with its default parameters, and every integrator.
#[must_use]
pub fn by_rule<S, const N: usize>() -> Box<dyn System>
where
    S: EnergyStepping<N> + Runnable<N> + Described + Default,
{
    let density = |system: &S, q: &SVector<f64, N>, v: &SVector<f64, N>| {
        system.step_density(0.0, q, v).ok().filter(|density| density.is_finite())
    };
    let with_rule = [integrator::by_rule(), vec![integrator::energy()], without_rule()];
    Box::new(Studied { typed: Typed::new(integrator::all(with_rule)), density: Some(density) })
}

/// The same of a system without a rule.
#[must_use]
pub fn gauss_only<S: Runnable<N> + Described + Default, const N: usize>() -> Box<dyn System> {
    Box::new(Studied { typed: Typed::<S, N>::new(without_rule()), density: None })
}

/// Every integrator that needs no rule.
fn without_rule<S: Runnable<N>, const N: usize>() -> Vec<Integrator<S, N>> {
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
        Box::new(Self { typed: self.typed.clone(), density: self.density })
    }

    fn start(&self) -> Option<[Vec<f64>; 2]> {
        None
    }

    fn step_density(&self, q: &[f64], v: &[f64]) -> Option<f64> {
        let sized = q.len() == N && v.len() == N;
        let density =
            |of: Density<S, N>| of(&self.typed.system, &SVector::from_column_slice(q), &SVector::from_column_slice(v));
        self.density.filter(|_| sized).and_then(density)
    }

    fn step_densities(&self, t: f64, q: &[f64], p: &[f64]) -> [Option<f64>; ENERGY_STAGES.len()] {
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

    fn time_scale(&self, at: &PhasePoint) -> Option<f64> {
        let Motion { t, q, v } = sized(at).ok()?;
        S::SCALES_TIME.then(|| self.typed.system.scaled_point(t, &q, &v).g)
    }

    fn follow(&self, from: &PhasePoint, end: f64) -> Result<PhasePoint, StepError> {
        sized(from)?.at(&self.typed.system, end).map(erased_point)
    }

    fn lyapunov(&self, plan: &Plan, count: usize) -> Result<Box<dyn Exponents>, StepError> {
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
        by_rival(self.typed.system, (from, end), tolerance, evaluations, watch)
    }
}

/// Initial coordinates and velocities of a system with its parameters.
pub type StartOf<S, const N: usize> = fn(&S) -> ([f64; N], [f64; N]);

/// A system of a known type with constraints.
struct StudiedWithConstraints<S, const N: usize> {
    typed: Typed<S, N, WithConstraints>,
    start: Option<StartOf<S, N>>,
}

/// The system `S` with its default parameters and its constraints, and every integrator that keeps them; its initial
/// state, if it follows from the parameters.
#[must_use]
pub fn with_constraints<S, const N: usize>(start: Option<StartOf<S, N>>) -> Box<dyn System>
where
    S: RunnableWithConstraints<N> + Described + Default,
    GaussLobatto<{ LOBATTO_STAGES[0] }>: Erasable<S, N>,
    GaussLobatto<{ LOBATTO_STAGES[1] }>: Erasable<S, N>,
    GaussLobatto<{ LOBATTO_STAGES[2] }>: Erasable<S, N>,
    EnergyPreservingGaussLobatto<ENERGY_LOBATTO_STAGES>: Erasable<S, N, Memory: Controlled<f64>>,
{
    let integrators = vec![
        integrator::gauss_lobatto::<S, N, { LOBATTO_STAGES[0] }>(),
        integrator::gauss_lobatto::<S, N, { LOBATTO_STAGES[1] }>(),
        integrator::gauss_lobatto::<S, N, { LOBATTO_STAGES[2] }>(),
        integrator::energy_lobatto::<S, N, ENERGY_LOBATTO_STAGES>(),
    ];
    Box::new(StudiedWithConstraints { typed: Typed::new(integrators), start })
}

impl<S: RunnableWithConstraints<N> + Described, const N: usize> System for StudiedWithConstraints<S, N> {
    fn erased(&self) -> &(dyn vi_erased::System + 'static) {
        &self.typed
    }

    fn erased_mut(&mut self) -> &mut (dyn vi_erased::System + 'static) {
        &mut self.typed
    }

    fn copy(&self) -> Box<dyn System> {
        Box::new(Self { typed: self.typed.clone(), start: self.start })
    }

    fn start(&self) -> Option<[Vec<f64>; 2]> {
        self.start.map(|start| {
            let (q, v) = start(&self.typed.system);
            [q.to_vec(), v.to_vec()]
        })
    }

    fn step_density(&self, _q: &[f64], _v: &[f64]) -> Option<f64> {
        None
    }

    fn step_densities(&self, _t: f64, _q: &[f64], _p: &[f64]) -> [Option<f64>; ENERGY_STAGES.len()] {
        [None; ENERGY_STAGES.len()]
    }

    fn time_scale(&self, _at: &PhasePoint) -> Option<f64> {
        None
    }

    fn follow(&self, from: &PhasePoint, end: f64) -> Result<PhasePoint, StepError> {
        sized(from)?.at(&Extended(self.typed.system), end).map(erased_point)
    }

    fn lyapunov(&self, plan: &Plan, _count: usize) -> Result<Box<dyn Exponents>, StepError> {
        Err(StepError::NoDerivative { t: plan.t, because: "exponents of motions with constraints are not supported" })
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
    let mut show = |motion: &Motion<N>| {
        if let Some(watch) = &mut watch {
            watch(motion.t, system.energy(motion.t, &motion.q, &motion.v));
        }
    };
    rival::motion(system, &sized(from)?, end, tolerance, evaluations, &mut show).map(erased_point)
}

/// A point with the system's number of coordinates.
fn sized<const N: usize>(point: &PhasePoint) -> Result<Motion<N>, StepError> {
    let q = vector(&point.q, "number of coordinates")?;
    let v = vector(&point.v, "number of velocities")?;
    Ok(Motion { t: point.t, q, v })
}

/// A type-erased point.
fn erased_point<const N: usize>(motion: Motion<N>) -> PhasePoint {
    PhasePoint { t: motion.t, q: motion.q.as_slice().to_vec(), v: motion.v.as_slice().to_vec() }
}
