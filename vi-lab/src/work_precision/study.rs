//! Every method at every setting, on one system: errors, evaluations and times.
//!
//! In: a system, where it starts, its usual step. Out: [`Findings`], from which the number of degrees of freedom is
//! erased. All but the seconds is the same in every run.

use super::clock;
use super::counting::Counting;
use super::drift::{self, Drift};
use super::method::{Method, reached};
use super::reference::{Agreement, Reference};
use super::rival::Ended;
use crate::numbers::{median, order};
use crate::progress::Progress;
use core::cell::Cell;
use vi_core::check::Motion;
use vi_core::{SVector, StepError, Stepping};

/// Usual steps up to the end of the runs whose errors are measured.
const STEPS: f64 = 4000.0;
/// Steps of a ladder run from this many times the usual length, in powers of √2, to the [`finest`].
const COARSEST: i32 = 6;
/// Tolerances of DOP853, as powers of ten.
const TOLERANCES: core::ops::RangeInclusive<i32> = -14..=-3;

/// What is to be compared.
#[derive(Clone, Debug)]
pub(crate) struct Study {
    /// Initial coordinates.
    pub(crate) q: Vec<f64>,
    /// Initial velocities.
    pub(crate) v: Vec<f64>,
    /// Usual step of the system.
    pub(crate) h: f64,
    /// Fewer and shorter runs, each timed once.
    pub(crate) quick: bool,
}

/// What was found.
#[derive(Clone, Debug)]
pub(crate) struct Findings {
    /// Time at which errors are taken.
    pub(super) until: f64,
    /// How well the reference is known there.
    pub(super) agreement: Agreement,
    /// Every run.
    pub(super) runs: Vec<Run>,
    /// Energy errors over the long time.
    pub(super) drifts: Vec<Drift>,
    /// Whether the energy is conserved, and the long time long.
    pub(super) conserved: bool,
    /// The long time.
    pub(super) long: f64,
}

/// One run.
#[derive(Clone, Debug)]
pub(super) struct Run {
    /// The method.
    pub(super) method: Method,
    /// Length of its step, or its tolerance.
    pub(super) setting: f64,
    /// What it cost and how far off it was, or why it ended.
    pub(super) outcome: Result<Point, Ended>,
}

/// What a run cost, and how far off it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    /// Error of the state reached; see [`Reference`].
    pub(super) error: f64,
    /// Evaluations of the equations.
    pub(super) evaluations: u64,
    /// Seconds of the fastest repetition.
    pub(super) seconds: f64,
    /// Seconds of the median repetition.
    pub(super) median: f64,
}

impl Findings {
    /// The runs of one method that reached the end, coarse to fine.
    pub(super) fn points(&self, method: Method) -> impl Iterator<Item = (f64, Point)> + '_ {
        let runs = self.runs.iter().filter(move |run| run.method == method);
        runs.filter_map(|run| Some((run.setting, run.outcome.ok()?)))
    }
}

/// Finest step of a ladder, as a power of √2 below the usual one: steps of many degrees of freedom take long.
fn finest(coordinates: usize, quick: bool) -> i32 {
    let doublings = i32::try_from(coordinates.ilog2()).unwrap_or(0);
    if quick { 2 } else { (10 - 2 * doublings).max(2) }
}

/// The settings of a method, coarse to fine. Methods that divide a step into parts take as much longer ones.
fn settings(method: Method, until: f64, finest: i32) -> Vec<f64> {
    if method == Method::Rival {
        return TOLERANCES.rev().map(|power| 10_f64.powi(power)).collect();
    }
    #[allow(clippy::cast_precision_loss)] // at most 17
    let parts = method.parts() as f64;
    (-COARSEST..=finest)
        .map(|power| until / (STEPS * core::f64::consts::SQRT_2.powi(power) / parts).round().max(1.0))
        .collect()
}

/// The comparison of all methods on `system`.
///
/// # Errors
/// What ended the reference, in words.
pub(crate) fn findings<S: Stepping<N>, const N: usize>(
    system: &S,
    study: &Study,
    progress: &mut Progress,
) -> Result<Findings, String> {
    let vector = |values: &[f64]| (values.len() == N).then(|| SVector::<f64, N>::from_column_slice(values));
    let (Some(q), Some(v)) = (vector(&study.q), vector(&study.v)) else {
        return Err(format!("{} coordinates were given, {N} are needed", study.q.len()));
    };
    let (start, until) = (Motion { t: 0.0, q, v }, STEPS * study.h);
    progress.message("reference");
    let reference = Reference::new(system, &start, until).map_err(|ended| ended.to_string())?;
    let agreement = reference.agreement(study.h).map_err(|ended| ended.to_string())?;
    let finest = finest(N, study.quick);
    let mut runs: Vec<Run> = Method::ALL
        .into_iter()
        .flat_map(|method| settings(method, until, finest).into_iter().map(move |setting| (method, setting)))
        .map(|(method, setting)| {
            progress.advance_by(1);
            Run { method, setting, outcome: untimed(system, &start, &reference, until, (method, setting)) }
        })
        .collect();
    timed(system, &start, until, &mut runs, if study.quick { 1 } else { 7 }, progress);
    let conserved = S::AUTONOMOUS && !S::FORCED;
    // A thousand times as long with one degree of freedom, and as much work with many.
    let longer = match (conserved, study.quick) {
        (false, _) => 1,
        (true, true) => 5,
        (true, false) => (1000 / N.pow(2)).max(10),
    };
    #[allow(clippy::cast_precision_loss)] // at most a thousand
    let long = until * longer as f64;
    progress.message("energy over a long time");
    let drifts = drift::all(system, &start, (study.h, long), (!conserved).then_some(&reference), progress);
    Ok(Findings { until, agreement, runs, drifts, conserved, long })
}

/// Runs that [`findings`] makes, for a bar.
pub(crate) fn length(study: &Study) -> u64 {
    let ladder = u64::try_from(COARSEST + finest(study.q.len(), study.quick) + 1).unwrap_or(1);
    let repetitions = if study.quick { 2 } else { 8 };
    repetitions * (5 * ladder + 12) + 8
}

/// Error and evaluations of one run; its times are still to be taken.
fn untimed<S: Stepping<N>, const N: usize>(
    system: &S,
    start: &Motion<N>,
    reference: &Reference<&S, N>,
    until: f64,
    (method, setting): (Method, f64),
) -> Result<Point, Ended> {
    let evaluations = Cell::new(0);
    let state = reached(Counting::new(system, &evaluations), start, until, method, setting)?;
    let error = reference.error(&state)?;
    Ok(Point { error, evaluations: evaluations.get(), seconds: f64::INFINITY, median: f64::INFINITY })
}

/// Times every run that reaches its end, in rounds: what disturbs the machine for a while then disturbs all alike.
fn timed<S: Stepping<N>, const N: usize>(
    system: &S,
    start: &Motion<N>,
    until: f64,
    runs: &mut [Run],
    rounds: u32,
    progress: &mut Progress,
) {
    let mut times = vec![Vec::new(); runs.len()];
    for _ in 0..rounds {
        for (run, times) in runs.iter().zip(&mut times) {
            progress.message(run.method.name());
            progress.advance_by(1);
            if run.outcome.is_ok() {
                let again = || reached(system, start, until, run.method, run.setting);
                // Once unwatched: another method's code was the last to run.
                core::hint::black_box(again().is_ok());
                times.push(clock::seconds(again));
            }
        }
    }
    for (run, times) in runs.iter_mut().zip(times) {
        if let Ok(point) = &mut run.outcome {
            point.seconds = times.iter().copied().fold(f64::INFINITY, f64::min);
            point.median = median(times).unwrap_or(f64::INFINITY);
        }
    }
}

/// The order at which errors fall with the step: the slope over the finest steps whose error stands well above `floor`;
/// none where fewer than three do.
pub(super) fn fitted_order(points: impl Iterator<Item = (f64, Point)>, floor: f64) -> Option<f64> {
    let clear: Vec<(f64, f64)> =
        points.map(|(h, point)| (h, point.error)).filter(|(_, error)| (30.0 * floor..1e-2).contains(error)).collect();
    let finest = clear.get(clear.len().checked_sub(FITTED)?..)?;
    Some(order(finest))
}

/// Points that an order is fitted to: a factor of 2.8 in the step.
const FITTED: usize = 4;

impl From<StepError> for Ended {
    fn from(error: StepError) -> Self {
        Self::Step(error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vi_systems::{DoublePendulum, DoubleWell, Pendulum};

    fn quick<S: Stepping<N>, const N: usize>(system: &S, q: [f64; N], v: [f64; N], h: f64) -> Findings {
        let study = Study { q: q.to_vec(), v: v.to_vec(), h, quick: true };
        findings(system, &study, &mut Progress::new(length(&study))).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn the_fitted_orders_are_those_of_the_methods() {
        let found = quick(&Pendulum::default(), [1.0], [0.0], 0.01);
        let floor = found.agreement.floor();
        for (method, order) in Method::ALL.into_iter().zip([2.0, 4.0, 6.0, 8.0, 2.0]) {
            let fitted = fitted_order(found.points(method), floor).expect("an order");
            assert!((fitted - order).abs() < 0.3, "{}: order {fitted}", method.name());
        }
    }

    #[test]
    fn a_run_that_ends_says_why() {
        // Across the barrier the energy-preserving step does not exist everywhere; the other methods go on.
        let found = quick(&DoubleWell::default(), [1.05], [0.0], 0.01);
        for run in &found.runs {
            let ended = matches!(run.outcome, Err(Ended::Step(StepError::NoForwardStep { .. })));
            assert_eq!(ended, run.method == Method::Energy, "{run:?}");
        }
    }

    #[test]
    fn only_the_seconds_differ_between_two_studies() {
        let found = || quick(&DoublePendulum::default(), [0.5, 0.3], [0.0, 0.0], 0.005);
        let (one, other) = (found(), found());
        let plain = |found: &Findings| -> Vec<_> {
            found.runs.iter().map(|run| run.outcome.map(|point| (point.error, point.evaluations))).collect()
        };
        assert_eq!(plain(&one), plain(&other));
        assert_eq!(one.agreement, other.agreement);
        assert!(one.drifts.iter().zip(&other.drifts).all(|(one, other)| one.worst == other.worst));
        let timed = one.runs.iter().filter_map(|run| run.outcome.ok());
        assert!(timed.clone().count() > 40 && timed.clone().all(|point| point.seconds > 0.0));
    }
}
