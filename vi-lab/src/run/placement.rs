//! Initial states on the constraints of a system.
//!
//! In: whether the initial state is the default, and whether it moves onto the constraints. Out: the coordinates and
//! velocities of a plan, for the parameters that a system has.

use vi_core::StepError;
use vi_erased::System;
use vi_erased::plan::{PhasePoint, Plan};
use vi_report::catalogue::kebab;
use vi_report::failure::Failure;

/// What determines an initial state on the constraints.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Placement {
    /// Whether it is the default of the system, which may follow from the parameters.
    follows: bool,
    /// Whether it moves to the nearest state on the constraints.
    projects: bool,
}

impl Placement {
    /// The placement for a default or a given initial state.
    ///
    /// # Errors
    /// [`Failure::Input`] for a projection of a system without constraints.
    pub(super) fn of(system: &dyn System, is_default: bool, projects: bool) -> Result<Self, Failure> {
        if projects && !system.has_constraints() {
            let name = kebab(system.name());
            return Err(Failure::Input(format!("{name} has no constraints to --project onto; remove it")));
        }
        Ok(Self { follows: is_default, projects })
    }

    /// Sets the default initial state of the parameters of a system.
    pub(crate) fn follow(self, system: &dyn System, plan: &mut Plan) {
        if let Some([q, v]) = system.start().filter(|_| self.follows) {
            (plan.q, plan.v) = (q, v);
        }
    }

    /// Checks that a system has a default initial state for its parameters.
    ///
    /// # Errors
    /// [`Failure::Input`] if it has none.
    pub(super) fn check(self, system: &dyn System, plan: &Plan) -> Result<(), Failure> {
        let is_finite = plan.q.iter().chain(&plan.v).all(|value| value.is_finite());
        if !self.follows || is_finite || system.start().is_none() {
            return Ok(());
        }
        Err(Failure::Input(format!(
            "{} has no initial state for these parameters: its constraints cannot be satisfied together; set other \
             lengths with --set, or give a start with --q and --v",
            kebab(system.name())
        )))
    }

    /// Moves the initial state onto the constraints. Returns how far the coordinates and the velocities moved.
    ///
    /// # Errors
    /// As [`vi_erased::System::project`].
    pub(crate) fn project(self, system: &dyn System, plan: &mut Plan) -> Result<Option<[f64; 2]>, StepError> {
        if !self.projects {
            return Ok(None);
        }
        let found = system.project(&PhasePoint { t: plan.t, q: plan.q.clone(), v: plan.v.clone() })?;
        (plan.q, plan.v) = (found.point.q, found.point.v);
        let most = |of: &[f64]| of.iter().fold(0.0_f64, |most, change| most.max(change.abs()));
        Ok(Some([most(&found.moved_q), most(&found.moved_v)]))
    }
}
