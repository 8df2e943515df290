//! One run of a sweep. A failed start or step is not an error: the [`Outcome`] has an ending.

use super::keep::STEPS_OF_A_PERIOD;
use crate::run::csv::numbers;
use crate::run::{self, Length};
use vi_core::StepError;
use vi_erased::System;
use vi_erased::plan::Plan;
use vi_erased::section::Section;
use vi_erased::simulation::Met;
use vi_erased::{Row, Steps};

/// Maximum ratio of steps to the predicted number, for runs that solve for their steps.
const PATIENCE: f64 = 1000.0;

/// The ending of a complete run.
pub(super) const REACHED: &str = "reached its end";
/// The ending of a run that reached its end, but some of whose crossings could not be located.
pub(super) const NO_SECTION: &str = "section not found";
/// The ending of a run with an input that no run accepts.
const WRONG_INPUT: &str = "wrong input";
/// The ending of a run whose steps became too short to reach its end.
const TOO_SHORT: &str = "steps became too short";

/// The ending of a run whose step failed.
fn ending(error: StepError) -> &'static str {
    match error {
        StepError::NoForwardStep { .. } | StepError::NoForwardGaussStep { .. } => "no forward step",
        StepError::DegenerateStep { .. } => "degenerate step",
        StepError::StepRatio { .. } => "step ratio",
        StepError::StepBounds { .. } => "step bounds",
        StepError::NotConverged { .. } => "not converged",
        StepError::StagesNotConverged { .. } => "stages unsettled",
        StepError::TimeScale { .. } => "time scale",
        StepError::Singular { .. } => "singular matrix",
        StepError::NonFinite { .. } | StepError::Undefined { .. } => "not finite",
        StepError::InvalidInput { .. } => WRONG_INPUT,
        StepError::InconsistentStart { .. } => "inconsistent start",
        StepError::Redundant { .. } => "redundant constraints",
        StepError::TooLong { .. } => "step too long",
        _ => "another failure",
    }
}

/// A run to be computed.
pub(super) struct Member {
    pub(super) system: Box<dyn System>,
    pub(super) plan: Plan,
    pub(super) length: Length,
    /// Interval between shown nodes.
    pub(super) every: u64,
    /// Whether the ranges of coordinates and energies are kept.
    pub(super) is_watched: bool,
    /// Whether the errors of its steps are measured.
    pub(super) is_measured: bool,
}

/// The result of a run.
pub(super) struct Outcome {
    /// The ending, in words.
    pub(super) ending: &'static str,
    pub(super) steps: u64,
    /// The last node; `None` if the run did not start.
    last: Option<Row>,
    /// The ranges of each coordinate, of H and of E; `None` without values.
    ranges: Vec<Option<Range>>,
    /// The largest error of a step, relative to the scale of its motion; NaN if it was not measured.
    pub(super) step_error: f64,
}

/// First, smallest and largest value of a quantity: NaN once one of its values is NaN.
#[derive(Clone, Copy)]
struct Range {
    first: f64,
    low: f64,
    high: f64,
}

impl Range {
    fn push(range: &mut Option<Self>, value: f64) {
        let Self { first, low, high } = range.unwrap_or(Self { first: value, low: value, high: value });
        *range = Some(Self { first, low: extreme(low, value, f64::min), high: extreme(high, value, f64::max) });
    }
}

/// The smaller or larger of two numbers; NaN if one of them is.
fn extreme(of: f64, value: f64, choose: impl Fn(f64, f64) -> f64) -> f64 {
    if of.is_nan() || value.is_nan() { f64::NAN } else { choose(of, value) }
}

impl Outcome {
    /// The outcome of a run that did not start.
    const NONE: Self = Self { ending: WRONG_INPUT, steps: 0, last: None, ranges: Vec::new(), step_error: f64::NAN };

    /// Computes a run. Shows its first node, every `every`-th, and the last.
    pub(super) fn of(member: &Member, show: &mut dyn FnMut(&dyn Steps)) -> Self {
        let Member { system, plan, length, .. } = member;
        let mut outcome = Self { ranges: vec![None; plan.q.len() + 2], ..Self::NONE };
        if run::check(system.as_ref(), plan, *length).is_err() {
            return outcome;
        }
        match system.begin(plan) {
            Ok(simulation) if length.is_before(simulation.as_ref()) => {}
            Ok(mut simulation) => {
                if member.is_measured {
                    simulation.monitor();
                }
                outcome.ending = outcome.follow(member, simulation.as_mut(), show);
                outcome.last = Some(simulation.row());
                outcome.step_error = simulation.largest_error().map_or(f64::NAN, |largest| largest.estimate);
            }
            Err(error) => outcome.ending = ending(error),
        }
        outcome
    }

    /// Steps to the end.
    fn follow(&mut self, member: &Member, run: &mut dyn Steps, show: &mut dyn FnMut(&dyn Steps)) -> &'static str {
        let Member { plan, length, every, is_watched, .. } = member;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a limit
        let most = (PATIENCE * (length.steps(plan) + 1.0)) as u64;
        let mut shown = 0;
        show(run);
        if *is_watched {
            self.watch(run);
        }
        let ended = loop {
            let t = run.t();
            if length.is_reached(t, run.h(), self.steps) {
                break REACHED;
            }
            if self.steps == most {
                break TOO_SHORT;
            }
            if let Err(error) = length.advance(run) {
                break ending(error);
            }
            self.steps += 1;
            if *is_watched {
                self.watch(run);
            }
            if self.steps.is_multiple_of(*every) {
                shown = self.steps;
                show(run);
            }
            #[allow(clippy::float_cmp)] // exactly
            if run.t() == t {
                break TOO_SHORT;
            }
        };
        if shown < self.steps {
            show(run);
        }
        ended
    }

    /// Adds the last node to the ranges.
    fn watch(&mut self, run: &dyn Steps) {
        // Without H at some nodes its range is unknown too. Some nodes have no interval, and no E.
        let energies = [Some(run.energy().unwrap_or(f64::NAN)), run.discrete_energy()];
        let q = run.q();
        let values = q.iter().copied().map(Some).chain(energies);
        for (range, value) in self.ranges.iter_mut().zip(values) {
            if let Some(value) = value {
                Range::push(range, value);
            }
        }
    }

    /// Repeats the run up to its last node for the crossings of a section.
    ///
    /// # Errors
    /// The reason why they cannot be located.
    pub(super) fn cross(&self, member: &Member, section: &Section, take: &mut dyn FnMut(Row)) -> Result<(), StepError> {
        let Some(last) = &self.last else { return Ok(()) };
        if let Section::Period { period, .. } = section
            && *period < STEPS_OF_A_PERIOD * member.plan.h.abs()
        {
            let (input, allowed) = ("period of a section", "at least four steps");
            return Err(StepError::InvalidInput { input, allowed, value: *period });
        }
        let mut take = |met: Met| {
            take(met.row);
            true
        };
        member.system.begin(&member.plan)?.cross(core::slice::from_ref(section), last.t, &mut take)
    }

    /// The entries of the last node in `columns` columns.
    pub(super) fn end(&self, columns: usize) -> Vec<f64> {
        self.last.as_ref().map_or_else(|| vec![f64::NAN; columns], |row| numbers(row).collect())
    }

    /// Smallest and largest value of each coordinate, then of H.
    pub(super) fn extremes(&self) -> impl Iterator<Item = f64> + '_ {
        let ranges = &self.ranges[..self.ranges.len() - 1];
        ranges.iter().flat_map(|range| range.map_or([f64::NAN; 2], |range| [range.low, range.high]))
    }

    /// Largest deviations of H and E from their first values.
    pub(super) fn errors(&self) -> impl Iterator<Item = f64> + '_ {
        let largest = |range: Range| extreme(range.high - range.first, range.first - range.low, f64::max);
        self.ranges[self.ranges.len() - 2..].iter().map(move |range| range.map_or(f64::NAN, largest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_that_is_lost_is_not_left_out() {
        let mut range = None;
        let mut outcome = Outcome { ranges: vec![None; 3], ..Outcome::NONE };
        assert!(outcome.errors().chain(outcome.extremes()).all(f64::is_nan));
        for value in [2.0, 5.0, -1.5, 3.0] {
            Range::push(&mut range, value);
        }
        outcome.ranges = vec![range; 3];
        assert_eq!(outcome.errors().collect::<Vec<_>>(), [3.5, 3.5]);
        assert_eq!(outcome.extremes().collect::<Vec<_>>(), [-1.5, 5.0, -1.5, 5.0]);
        Range::push(&mut range, f64::NAN);
        Range::push(&mut range, 1.0);
        outcome.ranges = vec![range; 3];
        assert!(outcome.errors().chain(outcome.extremes()).all(f64::is_nan));
    }
}
