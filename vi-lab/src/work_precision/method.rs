//! The compared methods, and one run of each.
//!
//! In: a system, an initial point, the end time, a [`Method`] and its setting: a step, or a tolerance. Out: the final
//! state, or the reason why it was not reached. Methods that find their lengths stop at the first node at or after the
//! end; the others take the nearest number of steps.

use core::cell::Cell;
use vi_core::StepError;
use vi_erased::System;
use vi_erased::plan::{self, PhasePoint, Plan};
use vi_erased::simulation::Simulation;
use vi_erased::studies::rival::Ended;
use vi_report::chart::Look;

/// A method of the comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Method {
    /// Its name in legends and tables.
    pub(super) name: &'static str,
    /// Its colour and its marker.
    pub(super) look: Look,
    /// The integrator of this project with its stages, if it has some; `None` for the rival.
    integrator: Option<(plan::Method, Option<usize>)>,
}

const fn own(name: &'static str, look: Look, method: plan::Method) -> Method {
    Method { name, look, integrator: Some((method, None)) }
}

const fn gauss(name: &'static str, look: Look, method: plan::Method, stages: usize) -> Method {
    Method { name, look, integrator: Some((method, Some(stages))) }
}

impl Method {
    /// Fixed steps composed to order 8.
    pub(super) const KAHAN_LI_8: Self = own("Kahan–Li 8", Look::OTHERS[2], plan::Method::KahanLi8);
    /// The integrator that solves for its own step.
    pub(super) const ENERGY: Self = own("energy-preserving", Look::ENERGY, plan::Method::Energy);
    /// The Runge–Kutta method of order 8 with adaptive steps.
    pub(super) const RIVAL: Self = Self { name: "DOP853", look: Look::RIVAL, integrator: None };

    /// All methods, in the order of the legends.
    pub(super) const ALL: [Self; 10] = [
        own("fixed step", Look::FIXED, plan::Method::Fixed),
        own("Suzuki 4", Look::OTHERS[0], plan::Method::Suzuki4),
        own("Kahan–Li 6", Look::OTHERS[1], plan::Method::KahanLi6),
        Self::KAHAN_LI_8,
        own("splitting, order 6", Look::OTHERS[3], plan::Method::Splitting6),
        gauss("Gauss, 4 stages", Look::GAUSS[0], plan::Method::Gauss, 4),
        gauss("Gauss, 8 stages", Look::GAUSS[1], plan::Method::Gauss, 8),
        gauss("Gauss, 8 stages, adaptive", Look::GAUSS[2], plan::Method::Adaptive, 8),
        Self::ENERGY,
        Self::RIVAL,
    ];

    /// Whether it takes kicks and drifts.
    pub(super) fn is_splitting(self) -> bool {
        self.integrator.is_some_and(|(method, _)| method.splitting().is_some())
    }

    /// Whether its setting is the length of the first step only.
    fn finds_length(self) -> bool {
        self.integrator.is_some_and(|(method, _)| method.finds_length())
    }

    /// Whether its setting is a tolerance.
    pub(super) fn has_tolerance(self) -> bool {
        self.integrator.is_none_or(|(method, _)| method == plan::Method::Adaptive)
    }

    /// Whether it integrates this system.
    pub(super) fn suits(self, system: &dyn System) -> bool {
        self.integrator.is_none_or(|(method, _)| method.splitting().is_none() || system.has(method))
    }

    /// Number of steps in each factor of 2 of a ladder. Errors of Gauss methods change by up to 60 000 in this interval:
    /// with two steps the least time for an error would be off by two fifths, of the fast steps of splittings by a
    /// quarter.
    pub(super) fn rungs(self) -> i32 {
        let is_gauss = matches!(self.integrator, Some((_, Some(_))));
        if is_gauss || self.is_splitting() { 4 } else { 2 }
    }

    /// Number of fixed steps that one of its steps replaces: the substeps of a composition or splitting; four per stage of a Gauss
    /// step, which is efficient only if it is long.
    pub(super) fn parts(self) -> usize {
        match self.integrator {
            Some((_, Some(stages))) => 4 * stages,
            Some((method, None)) => {
                let substeps = method.scheme().map(|scheme| scheme.weights.len());
                substeps.or(method.splitting().map(|scheme| scheme.forces())).unwrap_or(1)
            }
            None => 1,
        }
    }

    /// Its setting in words.
    pub(super) fn setting(self, setting: f64) -> String {
        match self.integrator {
            _ if self.has_tolerance() => format!("tolerance {setting:.0e}"),
            Some(_) if self.finds_length() => format!("h₀ = {setting:.4}"),
            _ => format!("h = {setting:.4}"),
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
    /// Number of steps of the length h.
    fn steps(&self, h: f64) -> u64 {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a positive count far below 2⁵³
        let count = ((self.end - self.start.t) / h).round() as u64;
        count.max(1)
    }

    /// A run at its start. With a tolerance it has found its first step. `None` for DOP853.
    ///
    /// # Errors
    /// The reason why no run begins.
    pub(super) fn begun(&self, system: &dyn System) -> Result<Option<Box<dyn Simulation>>, StepError> {
        let Some((method, stages)) = self.method.integrator else { return Ok(None) };
        // The start whose midpoints lie on the energy of the motion.
        let start = plan::Start::Midpoint;
        let tolerance = self.method.has_tolerance().then_some(self.setting);
        let plan = Plan { stages, start, tolerance, ..Plan::new(method, self.setting, self.start.clone()) };
        system.begin(&plan).map(Some)
    }

    /// The final state, and the evaluations of its run.
    ///
    /// # Errors
    /// The reason why the end was not reached.
    pub(super) fn reached(&self, system: &dyn System) -> Result<(FinalState, u64), Ended> {
        self.reached_from(system, self.begun(system)?)
    }

    /// The same from [`Task::begun`].
    ///
    /// # Errors
    /// The reason why the end was not reached.
    pub(super) fn reached_from(
        &self,
        system: &dyn System,
        begun: Option<Box<dyn Simulation>>,
    ) -> Result<(FinalState, u64), Ended> {
        let reached = if let Some(mut run) = begun {
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
        if !self.method.finds_length() {
            return Ok(run.advance_by(self.steps(self.setting))?);
        }
        let steps = self.steps(run.h());
        let times = if self.method.has_tolerance() { MOST_FOLLOWING } else { TOO_MANY };
        run.advance_until(self.end, times * steps)?;
        if run.t() < self.end { Err(Ended::Short(run.t())) } else { Ok(()) }
    }
}

/// A run that finds its lengths is stopped at this multiple of the steps of its initial length.
const TOO_MANY: u64 = 10;
/// The same of lengths that follow the motion: the first one may be the longest.
const MOST_FOLLOWING: u64 = 1000;

/// The methods that run here and integrate the system.
pub(super) fn methods(system: &dyn System) -> impl Iterator<Item = Method> + '_ {
    Method::ALL.into_iter().filter(move |method| method.suits(system))
}
