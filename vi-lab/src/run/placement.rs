//! Initial states on the constraints of a system.
//!
//! In: the default initial state as a function of the parameters, and whether it moves onto the constraints. Out: the
//! coordinates and velocities of a plan, for the parameters of a system.

use vi_core::StepError;
use vi_erased::System;
use vi_erased::plan::{PhasePoint, Plan};
use vi_report::catalogue::kebab;
use vi_report::entry::Start;
use vi_report::failure::Failure;

/// The rule for an initial state on the constraints.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Placement {
    /// The default of the system, if it follows from the parameters and no other is given.
    start: Option<Start>,
    /// Whether it moves to the nearest state on the constraints.
    projects: bool,
}

impl Placement {
    /// The placement for a default initial state, or without `start` for a given one.
    ///
    /// # Errors
    /// [`Failure::Input`] for a projection of a system without constraints.
    pub(super) fn of(system: &dyn System, start: Option<Start>, projects: bool) -> Result<Self, Failure> {
        if projects && !system.has_constraints() {
            let name = kebab(system.name());
            return Err(Failure::Input(format!("{name} has no constraints to --project onto; remove it")));
        }
        Ok(Self { start, projects })
    }

    /// Sets the default initial state of the parameters of a system.
    pub(crate) fn follow(self, system: &dyn System, plan: &mut Plan) {
        if let Some(start) = self.start {
            [plan.q, plan.v] = start(&system.parameters());
        }
    }

    /// Checks that a system has a default initial state for its parameters.
    ///
    /// # Errors
    /// [`Failure::Input`] if it has none.
    pub(super) fn check(self, system: &dyn System, plan: &Plan) -> Result<(), Failure> {
        let is_finite = plan.q.iter().chain(&plan.v).all(|value| value.is_finite());
        if self.start.is_none() || is_finite {
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
