//! One run of a sweep.
//!
//! In: a [`Member`]. Out: its [`Course`]: how it ended, and what is kept of it. A run that cannot start or go on is no error: it has an ending.

use super::ending::Ending;
use super::keep::STEPS_OF_A_PERIOD;
use crate::run::{self, Length};
use core::cell::Cell;
use vi_core::StepError;
use vi_runs::plan::Plan;
use vi_runs::simulation::{Row, Section, Simulation};
use vi_runs::system::System;

/// Steps that find their own length may become so many times more than was foreseen.
const PATIENCE: f64 = 1000.0;

/// A run to be taken.
pub(super) struct Member {
    /// The system with its parameters.
    pub(super) system: Box<dyn System>,
    /// Integrator, step and initial state.
    pub(super) plan: Plan,
    /// How long.
    pub(super) length: Length,
    /// Every so many nodes one is shown.
    pub(super) every: u64,
    /// Whether extremes and energies are followed.
    pub(super) is_watched: bool,
}

/// A run that was taken.
pub(super) struct Course {
    /// How it ended.
    pub(super) ending: Ending,
    /// Steps taken.
    pub(super) steps: u64,
    /// The last node; none of a run that did not start.
    last: Option<Row>,
    /// Those of each coordinate, then of H.
    extremes: Vec<Extremes>,
    /// Those of H and E.
    drifts: [Drift; 2],
}

/// Smallest and largest value.
#[derive(Clone, Copy)]
struct Extremes {
    low: f64,
    high: f64,
}

/// The first value, and the largest distance from it.
#[derive(Clone, Copy, Default)]
struct Drift {
    first: Option<f64>,
    largest: f64,
}

impl Drift {
    fn push(&mut self, value: f64) {
        let first = *self.first.get_or_insert(value);
        self.largest = extreme(self.largest, (value - first).abs(), f64::max);
    }
}

impl Course {
    /// Takes a run, and shows its first node, every so many, and the last.
    pub(super) fn of(member: &Member, show: &mut dyn FnMut(&dyn Simulation)) -> Self {
        let dimension = member.plan.q.len();
        let none = Extremes { low: f64::INFINITY, high: f64::NEG_INFINITY };
        let drifts = [Drift::default(); 2];
        let mut course =
            Self { ending: Ending::REACHED, steps: 0, last: None, extremes: vec![none; dimension + 1], drifts };
        let evaluations = Cell::new(0);
        let begun = match run::check(member.system.as_ref(), &member.plan, member.length) {
            Ok(()) => member.system.begin(&member.plan, &evaluations).map_err(Ending::of),
            Err(_) => Err(Ending::WRONG_INPUT),
        };
        match begun {
            Ok(simulation) if member.length.is_before(simulation.as_ref()) => course.ending = Ending::WRONG_INPUT,
            Ok(mut simulation) => {
                course.ending = course.follow(member, simulation.as_mut(), show);
                course.last = Some(simulation.row());
            }
            Err(ending) => course.ending = ending,
        }
        course
    }

    /// Steps to the end.
    fn follow(&mut self, member: &Member, run: &mut dyn Simulation, show: &mut dyn FnMut(&dyn Simulation)) -> Ending {
        let Member { plan, length, every, is_watched, .. } = member;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a limit
        let most = (PATIENCE * (length.steps(plan) + 1.0)) as u64;
        let mut shown = 0;
        show(run);
        if *is_watched {
            self.watch(run);
        }
        let ending = loop {
            let t = run.t();
            if length.is_reached(t, run.h(), self.steps) {
                break Ending::REACHED;
            }
            if self.steps == most {
                break Ending::TOO_SHORT;
            }
            if let Err(error) = length.advance(run) {
                break Ending::of(error);
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
                break Ending::TOO_SHORT;
            }
        };
        if shown < self.steps {
            show(run);
        }
        ending
    }

    /// Looks at the node reached last.
    fn watch(&mut self, run: &dyn Simulation) {
        // Of nodes without H there are no extremes, rather than those of the others.
        let energy = run.energy().unwrap_or(f64::NAN);
        for (extremes, value) in self.extremes.iter_mut().zip(run.q().iter().copied().chain([energy])) {
            extremes.low = extreme(extremes.low, value, f64::min);
            extremes.high = extreme(extremes.high, value, f64::max);
        }
        let [of_energy, of_discrete_energy] = &mut self.drifts;
        of_energy.push(energy);
        // Some nodes have no interval.
        if let Some(energy) = run.discrete_energy() {
            of_discrete_energy.push(energy);
        }
    }

    /// Takes the run once more, to its last node, for the crossings of a section.
    ///
    /// # Errors
    /// Where they cannot be located.
    pub(super) fn cross(&self, member: &Member, section: &Section, take: &mut dyn FnMut(Row)) -> Result<(), StepError> {
        let Some(last) = &self.last else { return Ok(()) };
        if let Section::Period { period, .. } = section
            && *period < STEPS_OF_A_PERIOD * member.plan.h.abs()
        {
            return Err(StepError::InvalidInput {
                input: "period of a section",
                allowed: "at least four steps",
                value: *period,
            });
        }
        let evaluations = Cell::new(0);
        let mut run = member.system.begin(&member.plan, &evaluations)?;
        run.cross(section, last.t, take)
    }

    /// The entries of the last node, in so many columns.
    pub(super) fn end(&self, columns: usize) -> Vec<f64> {
        let entries = |row: &Row| row.entries().map(|entry| entry.unwrap_or(f64::NAN)).collect();
        self.last.as_ref().map_or_else(|| vec![f64::NAN; columns], entries)
    }

    /// Smallest and largest value of each coordinate, then of H.
    pub(super) fn extremes(&self) -> impl Iterator<Item = f64> + '_ {
        let pair = |extremes: &Extremes| {
            if extremes.low <= extremes.high { [extremes.low, extremes.high] } else { [f64::NAN; 2] }
        };
        self.extremes.iter().flat_map(pair)
    }

    /// Largest distances of H and E from their first values.
    pub(super) fn errors(&self) -> impl Iterator<Item = f64> + '_ {
        self.drifts.iter().map(|drift| drift.first.map_or(f64::NAN, |_| drift.largest))
    }
}

/// The smaller or larger of two numbers; not a number once one is none.
fn extreme(of: f64, value: f64, choose: impl Fn(f64, f64) -> f64) -> f64 {
    if of.is_nan() || value.is_nan() { f64::NAN } else { choose(of, value) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_that_is_lost_is_not_left_out() {
        let mut drift = Drift::default();
        for value in [1.0, 3.0, 2.0] {
            drift.push(value);
        }
        assert_eq!(drift.largest.to_bits(), 2.0_f64.to_bits());
        drift.push(f64::NAN);
        drift.push(1.0);
        assert!(drift.largest.is_nan() && extreme(f64::NAN, 1.0, f64::min).is_nan());
        assert_eq!(extreme(f64::INFINITY, 1.0, f64::min).to_bits(), 1.0_f64.to_bits());
    }
}
