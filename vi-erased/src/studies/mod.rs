//! What studies compare the runs of a system with.
//!
//! | module | product |
//! |---|---|
//! | [`exponents`] | Lyapunov exponents along a run |
//! | [`rival`] | the motion by DOP853 |

pub mod exponents;
pub mod rival;

use crate::erasable::Runnable;
use crate::plan::{ENERGY_STAGES, Method, PhasePoint, Plan};
use crate::simulation::vector;
use crate::system::Typed;
use core::cell::Cell;
use exponents::Exponents;
use rival::Ended;
use vi_core::check::Trajectory;
use vi_core::constrained::Extended;
use vi_core::gauss::step_density;
use vi_core::kind::Kind;
use vi_core::lagrangian::Described;
use vi_core::{Called, Lagrangian as _, SVector, State, StepError};

/// What studies compare runs with.
pub trait Studies {
    /// Step density D of a rule at a point; `None` without a value, without a rule, or for another number of coordinates.
    fn step_density(&self, at: &PhasePoint) -> Option<f64>;
    /// Step densities of 1, 2 and 3 stages at a node with its time, coordinates and momenta; `None` without a value.
    fn step_densities(&self, t: f64, q: &[f64], p: &[f64]) -> [Option<f64>; ENERGY_STAGES.len()];
    /// The point of the same motion at the time `end`, by [`Trajectory::at`].
    ///
    /// # Errors
    /// The motion cannot be computed; [`StepError::InvalidInput`] for a point with another number of coordinates.
    fn follow(&self, from: &PhasePoint, end: f64) -> Result<PhasePoint, StepError>;
    /// `count` Lyapunov exponents along the run of Gauss steps of a plan: those of the first `coordinates`, if the others
    /// are at rest.
    ///
    /// # Errors
    /// As [`System::begin`](crate::System::begin); [`StepError::InvalidInput`] for more exponents than there are.
    fn lyapunov(&self, plan: &Plan, count: usize, coordinates: usize) -> Result<Box<dyn Exponents>, StepError>;
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

impl<S: Runnable<N> + Described, const N: usize> Studies for Typed<S, N> {
    fn step_density(&self, at: &PhasePoint) -> Option<f64> {
        let Trajectory { t, q, v } = sized(at).ok()?;
        let energy = self.integrators.iter().find(|of| of.built == (Method::Energy, None, false))?;
        energy.density.and_then(|density| density(&self.system, t, &q, &v)).filter(|density| density.is_finite())
    }

    fn step_densities(&self, t: f64, q: &[f64], p: &[f64]) -> [Option<f64>; ENERGY_STAGES.len()] {
        let none = [None; ENERGY_STAGES.len()];
        if const { S::Kind::COUNT > 0 } {
            return none;
        }
        let state =
            vector(q, "number of coordinates").and_then(|q| Ok(State { t, q, p: vector(p, "number of momenta")? }));
        let Ok(state) = state else { return none };
        let system = Called(self.system);
        [
            step_density::<_, N, { ENERGY_STAGES[0] }>(&system, &state).ok(),
            step_density::<_, N, { ENERGY_STAGES[1] }>(&system, &state).ok(),
            step_density::<_, N, { ENERGY_STAGES[2] }>(&system, &state).ok(),
        ]
    }

    fn follow(&self, from: &PhasePoint, end: f64) -> Result<PhasePoint, StepError> {
        sized(from)?.at(&Extended(self.system), end).map(erased_point)
    }

    fn lyapunov(&self, plan: &Plan, count: usize, coordinates: usize) -> Result<Box<dyn Exponents>, StepError> {
        exponents::begin(self.system, plan, (count, coordinates))
    }

    fn rival(
        &self,
        from: &PhasePoint,
        end: f64,
        tolerance: f64,
        evaluations: &Cell<u64>,
        mut watch: Option<&mut dyn FnMut(f64, f64)>,
    ) -> Result<PhasePoint, Ended> {
        let system = Extended(self.system);
        let mut show = |motion: &Trajectory<N>| {
            if let Some(watch) = &mut watch {
                watch(motion.t, system.energy(motion.t, &motion.q, &motion.v));
            }
        };
        rival::motion(system, &sized(from)?, end, tolerance, evaluations, &mut show).map(erased_point)
    }
}

/// A point with the system's number of coordinates.
fn sized<const N: usize>(point: &PhasePoint) -> Result<Trajectory<N>, StepError> {
    let q: SVector<f64, N> = vector(&point.q, "number of coordinates")?;
    let v = vector(&point.v, "number of velocities")?;
    Ok(Trajectory { t: point.t, q, v })
}

/// A type-erased point.
fn erased_point<const N: usize>(motion: Trajectory<N>) -> PhasePoint {
    PhasePoint { t: motion.t, q: motion.q.as_slice().to_vec(), v: motion.v.as_slice().to_vec() }
}
