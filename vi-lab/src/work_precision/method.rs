//! The compared methods, and one run of each.
//!
//! In: a system, an initial point, the end time, a [`Method`] and its setting: a step, or a tolerance. Out: the final
//! state, or the reason why it was not reached. The energy-preserving integrator stops at the first node at or after
//! the end; the others take the nearest number of steps.

use core::cell::Cell;
use vi_erased::System;
use vi_erased::plan::Named as _;
use vi_erased::plan::{self, PhasePoint, Plan};
use vi_erased::simulation::Simulation;
use vi_erased::studies::rival::Ended;
use vi_report::chart::Look;

/// A method of the comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Method {
    /// An integrator of this project.
    Own(plan::Method),
    /// Gauss steps with this number of stages.
    Gauss(usize),
    /// The Runge–Kutta method of order 8 with adaptive steps.
    Rival,
}

impl Method {
    /// Fixed steps of order 2.
    pub(super) const FIXED: Self = Self::Own(plan::Method::Fixed);
    /// Fixed steps composed to order 8.
    pub(super) const KAHAN_LI_8: Self = Self::Own(plan::Method::KahanLi8);
    /// The integrator that solves for its own step.
    pub(super) const ENERGY: Self = Self::Own(plan::Method::Energy);

    /// All methods, in the order of the legends.
    pub(super) const ALL: [Self; 9] = [
        Self::FIXED,
        Self::Own(plan::Method::Suzuki4),
        Self::Own(plan::Method::KahanLi6),
        Self::KAHAN_LI_8,
        Self::Own(plan::Method::Splitting6),
        Self::Gauss(plan::STAGES[0]),
        Self::Gauss(plan::STAGES[1]),
        Self::ENERGY,
        Self::Rival,
    ];

    /// Its name in legends and tables.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Own(plan::Method::Fixed) => "fixed step",
            Self::Own(plan::Method::Energy) => "energy-preserving",
            Self::Own(plan::Method::Splitting6) => "splitting, order 6",
            Self::Own(composed) => composed.scheme().map_or(composed.name(), |scheme| scheme.name),
            Self::Gauss(4) => "Gauss, 4 stages",
            Self::Gauss(_) => "Gauss, 8 stages",
            Self::Rival => "DOP853",
        }
    }

    /// Its colour and its marker.
    pub(super) fn look(self) -> Look {
        let [four, six, eight, split] = Look::OTHERS;
        let [few, many] = Look::GAUSS;
        match self {
            Self::Own(plan::Method::Fixed) => Look::FIXED,
            Self::Own(plan::Method::Suzuki4) => four,
            Self::Own(plan::Method::KahanLi6) => six,
            Self::Own(plan::Method::KahanLi8) => eight,
            Self::Own(plan::Method::Splitting4 | plan::Method::Splitting6) => split,
            Self::Gauss(4) => few,
            Self::Gauss(_) | Self::Own(plan::Method::Gauss | plan::Method::Adaptive) => many,
            Self::Own(plan::Method::Energy) => Look::ENERGY,
            Self::Rival => Look::RIVAL,
        }
    }

    /// Whether it takes kicks and drifts.
    pub(super) fn is_splitting(self) -> bool {
        matches!(self, Self::Own(method) if method.splitting().is_some())
    }

    /// Whether it integrates this system.
    pub(super) fn suits(self, system: &dyn System) -> bool {
        match self {
            Self::Own(method) => method.splitting().is_none() || system.has(method),
            Self::Gauss(_) | Self::Rival => true,
        }
    }

    /// Number of fixed steps that one of its steps replaces: the substeps of a composition or splitting; four per stage of a Gauss
    /// step, which is efficient only if it is long.
    pub(super) fn parts(self) -> usize {
        match self {
            Self::Own(method) => {
                let substeps = method.scheme().map(|scheme| scheme.weights.len());
                substeps.or(method.splitting().map(|scheme| scheme.forces())).unwrap_or(1)
            }
            Self::Gauss(stages) => 4 * stages,
            Self::Rival => 1,
        }
    }

    /// Its setting in words.
    pub(super) fn setting(self, setting: f64) -> String {
        match self {
            Self::Rival => format!("tolerance {setting:.0e}"),
            Self::Own(plan::Method::Energy) => format!("h₀ = {setting:.4}"),
            Self::Own(_) | Self::Gauss(_) => format!("h = {setting:.4}"),
        }
    }
}

/// A run of one method: initial state, end, setting.
#[derive(Clone, Copy, Debug)]
pub(super) struct Task<'a> {
    /// Initial point.
    pub(super) start: &'a PhasePoint,
    /// End time.
    pub(super) end: f64,
    /// The method.
    pub(super) method: Method,
    /// Length of its step, or its tolerance.
    pub(super) setting: f64,
}

/// Time, coordinates and momenta at the end of a run.
#[derive(Clone, Debug)]
pub(super) struct FinalState {
    /// Time.
    pub(super) t: f64,
    /// Coordinates.
    pub(super) q: Vec<f64>,
    /// Momenta.
    pub(super) p: Vec<f64>,
}

impl Task<'_> {
    /// Number of steps of length `setting`.
    fn steps(&self) -> u64 {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a positive count far below 2⁵³
        let count = ((self.end - self.start.t) / self.setting).round() as u64;
        count.max(1)
    }

    /// The plan of a run of one of this project's integrators; `None` for the rival.
    fn plan(&self) -> Option<Plan> {
        let (method, stages) = match self.method {
            Method::Own(method) => (method, None),
            Method::Gauss(stages) => (plan::Method::Gauss, Some(stages)),
            Method::Rival => return None,
        };
        // The start whose midpoints lie on the energy of the motion.
        let start = plan::Start::Midpoint;
        Some(Plan { stages, start, ..Plan::new(method, self.setting, self.start.clone()) })
    }

    /// The final state, and the evaluations of its run.
    ///
    /// # Errors
    /// The reason why the end was not reached.
    pub(super) fn reached(&self, system: &dyn System) -> Result<(FinalState, u64), Ended> {
        let reached = if let Some(plan) = self.plan() {
            let mut run = system.begin(&plan)?;
            self.follow(run.as_mut())?;
            (FinalState { t: run.t(), q: run.q().to_vec(), p: run.p().to_vec() }, run.evaluations())
        } else {
            let evaluations = Cell::new(0);
            let at = system.studies().rival(self.start, self.end, self.setting, &evaluations, None)?;
            (FinalState { t: at.t, p: system.momentum(&at)?, q: at.q }, evaluations.get())
        };
        let is_finite = reached.0.q.iter().chain(&reached.0.p).all(|entry| entry.is_finite());
        if is_finite { Ok(reached) } else { Err(Ended::NonFinite) }
    }

    /// Steps to the end.
    fn follow(&self, run: &mut dyn Simulation) -> Result<(), Ended> {
        let steps = self.steps();
        if self.method != Method::ENERGY {
            return Ok(run.advance_by(steps)?);
        }
        run.advance_until(self.end, TOO_MANY * steps)?;
        if run.t() < self.end { Err(Ended::Short(run.t())) } else { Ok(()) }
    }
}

/// An energy-preserving run is stopped at this multiple of the steps of its initial length.
const TOO_MANY: u64 = 10;

/// The methods that run here and integrate the system.
pub(super) fn methods(system: &dyn System) -> impl Iterator<Item = Method> + '_ {
    Method::ALL.into_iter().filter(move |method| method.suits(system))
}
