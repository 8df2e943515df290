//! Every method at every setting, on one system: errors, evaluations and times.
//!
//! In: a system, its initial state, its default step. Out: [`Findings`]. Everything except the seconds is reproducible.

use super::method::{Method, Task, methods};
use super::reference::{Agreement, Reference};
use std::time::Instant;
use vi_erased::System;
use vi_erased::plan::PhasePoint;
use vi_erased::simulation::Simulation;
use vi_erased::studies::rival::Ended;
use vi_report::entry::Entry;
use vi_report::numbers::{median, order};
use vi_report::progress::Progress;

/// Number of default steps in the runs for errors.
const STEPS: f64 = 4000.0;
/// The ladder of steps extends from this number of doublings of the default step to [`finest`].
const COARSEST: i32 = 4;
/// Number of timed repetitions.
const ROUNDS: u32 = 7;
/// Tolerances of DOP853 and of adaptive steps, as powers of √10; each changes the steps by a
/// seventh or a fourteenth.
const TOLERANCES: core::ops::RangeInclusive<i32> = -28..=-6;

/// Results of the comparison.
#[derive(Clone, Debug)]
pub(super) struct Findings {
    /// Time at which errors are taken.
    pub(super) until: f64,
    /// Accuracy of the reference there.
    pub(super) agreement: Agreement,
    /// Every run.
    pub(super) runs: Vec<TimedRun>,
}

/// One run.
#[derive(Clone, Debug)]
pub(super) struct TimedRun {
    /// The method.
    pub(super) method: Method,
    /// Length of its step, or its tolerance.
    pub(super) setting: f64,
    /// Its cost and error, or the reason why it ended.
    pub(super) outcome: Result<Point, Ended>,
}

/// Cost and error of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    /// Error of the final state; see [`Reference`].
    pub(super) error: f64,
    /// Evaluations of the equations.
    pub(super) evaluations: u64,
    /// Seconds of the fastest repetition.
    pub(super) seconds: f64,
    /// Seconds of the median repetition.
    pub(super) median: f64,
}

impl Findings {
    /// The methods of the comparison, in the order of the legends.
    pub(super) fn methods(&self) -> impl Iterator<Item = Method> + '_ {
        Method::ALL.into_iter().filter(|method| self.runs.iter().any(|run| run.method == *method))
    }

    /// The runs of one method that reached the end, coarse to fine.
    pub(super) fn points(&self, method: Method) -> impl Iterator<Item = (f64, Point)> + '_ {
        let runs = self.runs.iter().filter(move |run| run.method == method);
        runs.filter_map(|run| Some((run.setting, run.outcome.ok()?)))
    }
}

/// Number of halvings from the default step to the finest one; fewer for many degrees of freedom, whose steps are slow.
fn finest(coordinates: usize, quick: bool) -> i32 {
    let doublings = i32::try_from(coordinates.ilog2()).unwrap_or(0);
    if quick { 1 } else { (5 - doublings).max(2) }
}

/// The settings of a method, coarse to fine. Methods with substeps take longer steps.
fn settings(method: Method, until: f64, finest: i32) -> Vec<f64> {
    if method.has_tolerance() {
        return TOLERANCES.rev().map(|power| 10_f64.powf(0.5 * f64::from(power))).collect();
    }
    #[allow(clippy::cast_precision_loss)] // at most 32
    let parts = method.parts() as f64;
    let rungs = method.rungs();
    // Splittings are fast, also with the short steps of small errors.
    let finest = if method.is_splitting() { finest + 3 } else { finest };
    (-COARSEST * rungs..=finest * rungs)
        .map(|rung| until / (STEPS * (f64::from(rung) / f64::from(rungs)).exp2() / parts).round().max(1.0))
        .collect()
}

/// The comparison of all methods on the system of an entry, from its initial state; with `quick`, fewer and shorter
/// runs, each timed once.
///
/// # Errors
/// The reason why the reference ended.
pub(super) fn findings(entry: &Entry, quick: bool) -> Result<Findings, Ended> {
    let system = entry.system.as_ref();
    let start = PhasePoint { t: 0.0, q: entry.q.clone(), v: entry.v.clone() };
    let until = STEPS * entry.h;
    let finest = finest(start.q.len(), quick);
    let all = methods(system).flat_map(|of| settings(of, until, finest).into_iter().map(move |setting| (of, setting)));
    let all: Vec<(Method, f64)> = all.collect();
    let rounds = if quick { 1 } else { ROUNDS };
    let mut progress = Progress::new((1 + u64::from(rounds)) * all.len() as u64);
    progress.message("reference");
    let reference = Reference::new(system, &start, until)?;
    let agreement = reference.agreement(entry.h)?;
    let untimed = |task: &Task<'_>, begun| -> Result<Point, Ended> {
        let (state, evaluations) = task.reached_from(system, begun)?;
        Ok(Point { error: reference.error(&state)?, evaluations, seconds: f64::INFINITY, median: f64::INFINITY })
    };
    let mut runs = Vec::with_capacity(all.len());
    for (method, setting) in all {
        progress.advance_by(1);
        let task = Task { start: &start, end: until, method, setting };
        let begun = task.begun(system);
        let outcome = match &begun {
            Ok(begun) => untimed(&task, begun.as_ref().map(|run| run.copy())),
            Err(error) => Err(Ended::Step(*error)),
        };
        let found = begun.ok().flatten().filter(|_| method.has_tolerance());
        runs.push((TimedRun { method, setting, outcome }, found));
    }
    time(system, &start, until, &mut runs, rounds, &mut progress);
    let runs = runs.into_iter().map(|(run, _)| run).collect();
    Ok(Findings { until, agreement, runs })
}

/// Times every completed run in rounds: a temporary disturbance of the machine then affects all runs alike. Runs of a
/// tolerance go on from one that has found its first step.
fn time(
    system: &dyn System,
    start: &PhasePoint,
    end: f64,
    runs: &mut [(TimedRun, Option<Box<dyn Simulation>>)],
    rounds: u32,
    progress: &mut Progress,
) {
    let mut times = vec![Vec::new(); runs.len()];
    for _ in 0..rounds {
        for ((run, begun), times) in runs.iter().zip(&mut times) {
            progress.message(run.method.name);
            progress.advance_by(1);
            if run.outcome.is_ok() {
                let task = Task { start, end, method: run.method, setting: run.setting };
                let reached = || match begun {
                    Some(begun) => task.reached_from(system, Some(begun.copy())),
                    None => task.reached(system),
                };
                // A first run without timing restores caches after another method.
                core::hint::black_box(reached().is_ok());
                let begin = Instant::now();
                core::hint::black_box(reached().is_ok());
                times.push(begin.elapsed().as_secs_f64());
            }
        }
    }
    for ((run, _), times) in runs.iter_mut().zip(times) {
        if let Ok(point) = &mut run.outcome {
            point.seconds = times.iter().copied().fold(f64::INFINITY, f64::min);
            point.median = median(times).unwrap_or(f64::INFINITY);
        }
    }
}

/// The convergence order: the slope over the finest steps whose error exceeds `floor` clearly, up to [`FITTED`] times
/// the finest of them; `None` for fewer than four.
pub(super) fn fitted_order(points: impl Iterator<Item = (f64, Point)>, floor: f64) -> Option<f64> {
    let clear: Vec<(f64, f64)> =
        points.map(|(h, point)| (h, point.error)).filter(|(_, error)| (30.0 * floor..1e-2).contains(error)).collect();
    let &(finest, _) = clear.last()?;
    let first = clear.iter().position(|&(h, _)| h <= FITTED * finest)?;
    let fitted = &clear[first..];
    (fitted.len() >= 4).then(|| order(fitted))
}

/// Ratio of the longest to the shortest step in a fit: three steps of two per factor of 2, 2.83 up to rounding of the
/// number of steps.
const FITTED: f64 = 2.9;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ready;
    use vi_core::StepError;

    fn quick(name: &str, q: &[f64], v: &[f64]) -> Findings {
        let entry = ready().find(name).expect("the system");
        let entry = Entry { q: q.to_vec(), v: v.to_vec(), ..entry };
        findings(&entry, true).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn the_fitted_orders_are_those_of_the_methods() {
        let found = quick("pendulum", &[1.0], &[0.0]);
        let floor = found.agreement.floor();
        // Gauss methods of eight stages are exact at once.
        let [fixed, four, six, eight, split, gauss, .., energy, _] = Method::ALL;
        let orders = [(fixed, 2.0), (four, 4.0), (six, 6.0), (eight, 8.0), (split, 6.0), (gauss, 8.0), (energy, 2.0)];
        for (method, order) in orders {
            let fitted = fitted_order(found.points(method), floor).expect("an order");
            assert!((fitted - order).abs() < 0.3, "{}: order {fitted}", method.name);
        }
    }

    #[test]
    fn adaptive_steps_take_fewer_evaluations_on_an_eccentric_orbit() {
        // Eccentricity 0.8.
        let found = quick("kepler", &[0.2, 0.0], &[0.0, 3.0]);
        let least = |method| {
            let accurate = found.points(method).filter(|(_, point)| point.error < 1e-6);
            accurate.map(|(_, point)| point.evaluations).min().expect("an accurate run")
        };
        let [.., equal, adaptive, _, _] = Method::ALL;
        assert!(least(adaptive) < least(equal), "{} and {}", least(adaptive), least(equal));
    }

    #[test]
    fn a_run_that_ends_says_why() {
        // Across the barrier the energy-preserving step does not always exist; the other methods continue.
        let found = quick("double-well", &[1.05], &[0.0]);
        for run in &found.runs {
            // The longest steps end earlier, for their length.
            let ended = match run.outcome {
                Err(Ended::Step(StepError::NoForwardStep { .. })) => true,
                Err(Ended::Step(StepError::StepRatio { .. })) => run.setting > 0.1,
                Err(Ended::Step(StepError::StagesNotConverged { .. })) if run.setting > 3.0 => continue,
                _ => false,
            };
            assert_eq!(ended, run.method == Method::ENERGY, "{run:?}");
        }
    }

    #[test]
    fn only_the_seconds_differ_between_two_studies() {
        let found = || quick("pendulum", &[0.5], &[0.0]);
        let one = found();
        let other = found();
        let plain = |found: &Findings| -> Vec<_> {
            found.runs.iter().map(|run| run.outcome.map(|point| (point.error, point.evaluations))).collect()
        };
        assert_eq!(plain(&one), plain(&other));
        assert_eq!(one.agreement, other.agreement);
        let timed = one.runs.iter().filter_map(|run| run.outcome.ok());
        assert!(timed.clone().count() > 40 && timed.clone().all(|point| point.seconds > 0.0));
    }
}
