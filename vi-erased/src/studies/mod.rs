//! Reference quantities with which studies compare the runs of a system.
//!
//! | module | product |
//! |---|---|
//! | [`exponents`] | Lyapunov exponents along a run |
//! | [`rival`] | the motion by DOP853 |

pub mod exponents;
pub mod rival;

use crate::plan::{ENERGY_STAGES, PhasePoint, Plan};
use core::cell::Cell;
use exponents::Exponents;
use rival::Ended;
use vi_core::StepError;

/// Reference quantities with which studies compare runs.
pub trait Studies {
    /// Step density D of a rule at a point; `None` without a value, without a rule, or for another number of coordinates.
    fn step_density(&self, at: &PhasePoint) -> Option<f64>;
    /// Step densities of 1, 2 and 3 stages at a node with its time, coordinates and momenta; `None` without a value.
    fn step_densities(&self, t: f64, q: &[f64], p: &[f64]) -> [Option<f64>; ENERGY_STAGES.len()];
    /// The point of the same motion at the time `end`, by [`Trajectory::at`](vi_core::check::Trajectory::at).
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
