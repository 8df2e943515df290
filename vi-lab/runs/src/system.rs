//! A system of any number of degrees of freedom, its type erased.
//!
//! In: a system of a known type. Out: a [`System`], by which runs, maps and comparisons use it. Below this trait stands all
//! code of the command that is generic over systems: its integrators, its accurate motion and the rival are compiled
//! once for each system, however many charts use them.

use crate::exponents::{self, Exponents};
use crate::kind::Kind;
use crate::plan::{ENERGY_STAGES, PhasePoint, Plan};
use crate::rival::{self, Ended};
use crate::simulation::{self, Simulation, vector};
use core::cell::Cell;
use core::marker::PhantomData;
use vi_core::check::Motion;
use vi_core::collocation::Collocation;
use vi_core::gauss::step_density;
use vi_core::lagrangian::Parameters;
use vi_core::stepping::Convertible;
use vi_core::{Called, SVector, State, StepError};

/// A system with its parameters.
pub trait System: Send + Sync {
    /// Name of the type.
    fn name(&self) -> &'static str;
    /// Names of the coordinates.
    fn coordinates(&self) -> Vec<&'static str>;
    /// Names and values of the parameters.
    fn parameters(&self) -> Vec<(&'static str, f64)>;
    /// Sets a parameter; false where there is none of this name.
    fn set(&mut self, name: &str, value: f64) -> bool;
    /// A system of the same type with the same parameters.
    fn copy(&self) -> Box<dyn System>;
    /// Whether the system has a rule, and with it fixed and energy-preserving steps of order 2.
    fn has_rule(&self) -> bool;
    /// Whether the energy of a motion is constant: L and f are free of the time, and there is no force.
    fn conserves_energy(&self) -> bool;
    /// Step density D at t = 0; none where it has no value, or the system no rule.
    fn step_density(&self, q: &[f64], v: &[f64]) -> Option<f64>;
    /// Step densities of 1, 2 and 3 stages at a node, its time, coordinates and momenta given; none where one has no value.
    fn step_densities(&self, t: f64, q: &[f64], p: &[f64]) -> [Option<f64>; ENERGY_STAGES.len()];
    /// g of the time scale at a point; none of a system without a time scale.
    fn time_scale(&self, at: &PhasePoint) -> Option<f64>;
    /// H at a point.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] where the point has another number of coordinates, here and below.
    fn energy(&self, at: &PhasePoint) -> Result<f64, StepError>;
    /// Momenta ∂L/∂v at a point.
    ///
    /// # Errors
    /// As [`System::energy`].
    fn momentum(&self, at: &PhasePoint) -> Result<Vec<f64>, StepError>;
    /// The point of the same motion at the time `end`, by [`Motion::at`].
    ///
    /// # Errors
    /// Where the motion cannot be followed.
    fn follow(&self, from: &PhasePoint, end: f64) -> Result<PhasePoint, StepError>;
    /// Starts a run; `evaluations` grows by the evaluations of the equations.
    ///
    /// # Errors
    /// What the integrators say of the initial state.
    fn begin<'a>(&self, plan: &Plan, evaluations: &'a Cell<u64>) -> Result<Box<dyn Simulation + 'a>, StepError>;
    /// Lyapunov exponents, as many as wanted, along the run of Gauss steps from the start of a plan.
    ///
    /// # Errors
    /// As [`System::begin`].
    fn lyapunov(&self, plan: &Plan, count: usize) -> Result<Box<dyn Exponents>, StepError>;
    /// The point of the same motion at the time `end`, by the rival with a tolerance. `evaluations` grows by the number of
    /// accelerations, also where the run ends early; `watch`, if any, is given time and H at the start and after every step.
    ///
    /// # Errors
    /// Why the run did not reach its end.
    fn rival(
        &self,
        from: &PhasePoint,
        end: f64,
        tolerance: f64,
        evaluations: &Cell<u64>,
        watch: Option<&mut dyn FnMut(f64, f64)>,
    ) -> Result<PhasePoint, Ended>;
}

/// A system of a known type, of the kind K.
struct Typed<S, K, const N: usize>(S, PhantomData<K>);

/// The system `S` with its default parameters.
#[must_use]
pub fn erased<S, K: Kind<S, N>, const N: usize>() -> Box<dyn System>
where
    S: Collocation<N> + Convertible<N> + Parameters + Default + Send + Sync + 'static,
{
    Box::new(Typed::<S, K, N>(S::default(), PhantomData))
}

impl<S, K: Kind<S, N>, const N: usize> System for Typed<S, K, N>
where
    S: Collocation<N> + Convertible<N> + Parameters + Send + Sync + 'static,
{
    fn name(&self) -> &'static str {
        S::NAME
    }

    fn coordinates(&self) -> Vec<&'static str> {
        S::COORDINATES.to_vec()
    }

    fn parameters(&self) -> Vec<(&'static str, f64)> {
        let mut system = self.0;
        S::PARAMETERS.iter().filter_map(|name| Some((*name, *system.parameter_mut(name)?))).collect()
    }

    fn set(&mut self, name: &str, value: f64) -> bool {
        self.0.parameter_mut(name).map(|parameter| *parameter = value).is_some()
    }

    fn copy(&self) -> Box<dyn System> {
        Box::new(Self(self.0, PhantomData))
    }

    fn has_rule(&self) -> bool {
        K::HAS_RULE
    }

    fn conserves_energy(&self) -> bool {
        S::AUTONOMOUS && !S::FORCED
    }

    fn step_density(&self, q: &[f64], v: &[f64]) -> Option<f64> {
        let sized = q.len() == N && v.len() == N;
        let density = || K::step_density(&self.0, &SVector::from_column_slice(q), &SVector::from_column_slice(v));
        sized.then(density).flatten()
    }

    fn step_densities(&self, t: f64, q: &[f64], p: &[f64]) -> [Option<f64>; ENERGY_STAGES.len()] {
        let state =
            vector(q, "number of coordinates").and_then(|q| Ok(State { t, q, p: vector(p, "number of momenta")? }));
        let Ok(state) = state else { return [None; ENERGY_STAGES.len()] };
        let system = Called(self.0);
        [
            step_density::<_, N, { ENERGY_STAGES[0] }>(&system, &state).ok(),
            step_density::<_, N, { ENERGY_STAGES[1] }>(&system, &state).ok(),
            step_density::<_, N, { ENERGY_STAGES[2] }>(&system, &state).ok(),
        ]
    }

    fn time_scale(&self, at: &PhasePoint) -> Option<f64> {
        let Motion { t, q, v } = sized(at).ok()?;
        S::SCALES_TIME.then(|| self.0.scaled_point(t, &q, &v).g)
    }

    fn energy(&self, at: &PhasePoint) -> Result<f64, StepError> {
        let Motion { t, q, v } = sized(at)?;
        Ok(self.0.energy(t, &q, &v))
    }

    fn momentum(&self, at: &PhasePoint) -> Result<Vec<f64>, StepError> {
        let Motion { t, q, v } = sized(at)?;
        Ok(self.0.momentum(t, &q, &v).as_slice().to_vec())
    }

    fn follow(&self, from: &PhasePoint, end: f64) -> Result<PhasePoint, StepError> {
        sized(from)?.at(&self.0, end).map(erased_point)
    }

    fn begin<'a>(&self, plan: &Plan, evaluations: &'a Cell<u64>) -> Result<Box<dyn Simulation + 'a>, StepError> {
        simulation::begin::<S, K, N>(self.0, plan, evaluations)
    }

    fn lyapunov(&self, plan: &Plan, count: usize) -> Result<Box<dyn Exponents>, StepError> {
        exponents::begin(self.0, plan, count)
    }

    fn rival(
        &self,
        from: &PhasePoint,
        end: f64,
        tolerance: f64,
        evaluations: &Cell<u64>,
        mut watch: Option<&mut dyn FnMut(f64, f64)>,
    ) -> Result<PhasePoint, Ended> {
        let mut show = |motion: &Motion<N>| {
            if let Some(watch) = &mut watch {
                watch(motion.t, self.0.energy(motion.t, &motion.q, &motion.v));
            }
        };
        rival::motion(self.0, &sized(from)?, end, tolerance, evaluations, &mut show).map(erased_point)
    }
}

/// A point with the system's number of coordinates.
fn sized<const N: usize>(point: &PhasePoint) -> Result<Motion<N>, StepError> {
    let q = vector(&point.q, "number of coordinates")?;
    let v = vector(&point.v, "number of velocities")?;
    Ok(Motion { t: point.t, q, v })
}

/// A point of any number of coordinates.
fn erased_point<const N: usize>(motion: Motion<N>) -> PhasePoint {
    PhasePoint { t: motion.t, q: motion.q.as_slice().to_vec(), v: motion.v.as_slice().to_vec() }
}
