//! Energy errors over a long time, which show drift.
//!
//! In: a system, an initial state, the default step, the long time. Out: per method the running maximum of the energy
//! error, relative to the initial energy. The energy is `H(t, q, v)` at the nodes, with the velocity v of the momenta
//! p. For the energy-preserving integrator it is taken at the midpoints of its steps, at which its rule preserves it.
//! If the energy is not conserved, the error is the difference from the reference at the same time.

use super::method::{Method, TOO_MANY, Task, methods};
use super::reference::Reference;
use core::cell::Cell;
use vi_erased::System;
use vi_erased::plan::{PhasePoint, Plan};
use vi_erased::studies::rival::Ended;
use vi_report::numbers::order;
use vi_report::progress::Progress;

/// Tolerances of DOP853.
const TOLERANCES: [f64; 3] = [1e-6, 1e-9, 1e-12];
/// Number of nodes of a run at which the energy is evaluated.
const SAMPLES: u64 = 200_000;
/// The same if the reference is computed at every node.
const REFERENCE_SAMPLES: u64 = 400;

/// The energy error of one run.
#[derive(Clone, Debug)]
pub(super) struct Drift {
    /// The method.
    pub(super) method: Method,
    /// Length of its step, or its tolerance.
    pub(super) setting: f64,
    /// Time, and the largest error up to it.
    pub(super) worst: Vec<(f64, f64)>,
    /// Evaluations of the equations in a unit of time.
    pub(super) rate: f64,
    /// Why the run ended early.
    pub(super) ended: Option<Ended>,
}

impl Drift {
    /// The exponent of the growth of the error with time over the last factor 100: 0 is bounded, 1 is linear drift.
    pub(super) fn growth(&self) -> Option<f64> {
        let (end, _) = self.worst.last()?;
        let late: Vec<(f64, f64)> =
            self.worst.iter().copied().filter(|(t, error)| *t >= end / 100.0 && *error > 0.0).collect();
        (late.len() > 2).then(|| order(&late))
    }

    /// The error at the end.
    pub(super) fn last(&self) -> Option<(f64, f64)> {
        self.worst.last().copied()
    }
}

/// Running maximum of the error.
struct MaximumError<'a> {
    system: &'a dyn System,
    reference: Option<&'a Reference<'a>>,
    initial: f64,
    largest: f64,
    worst: Vec<(f64, f64)>,
}

impl MaximumError<'_> {
    fn see(&mut self, t: f64, energy: f64) -> Result<(), Ended> {
        let expected = match self.reference {
            None => self.initial,
            Some(reference) => self.system.energy(&reference.at(t)?)?,
        };
        let unit = if self.initial == 0.0 { 1.0 } else { self.initial.abs() };
        let error = (energy - expected).abs() / unit;
        if !error.is_finite() {
            return Err(Ended::NonFinite);
        }
        self.largest = self.largest.max(error);
        // A hundred points per decade suffice for a figure.
        if self.worst.last().is_none_or(|(last, _)| t > last * 1.02) {
            self.worst.push((t, self.largest));
        }
        Ok(())
    }
}

/// All methods up to the time `long`: those of fixed steps with substeps of length `h`, DOP853 with three tolerances.
///
/// # Errors
/// The initial energy has no value.
pub(super) fn all(
    system: &dyn System,
    start: &PhasePoint,
    h: f64,
    long: f64,
    reference: Option<&Reference<'_>>,
    progress: &mut Progress,
) -> Result<Vec<Drift>, Ended> {
    let initial = system.energy(start)?;
    let stepping = methods(system).filter(|method| *method != Method::Rival);
    #[allow(clippy::cast_precision_loss)] // at most 32
    let settings = stepping.map(|method| (method, h * method.parts() as f64));
    let drifts = settings.chain(TOLERANCES.map(|tolerance| (Method::Rival, tolerance))).map(|(method, setting)| {
        progress.advance_by(1);
        let mut watch = MaximumError { system, reference, initial, largest: 0.0, worst: Vec::new() };
        let task = Task { start, end: long, method, setting };
        let mut evaluations = 0;
        let ended = match task.plan() {
            Some(plan) => run(&task, &plan, &mut evaluations, &mut watch),
            None => run_rival(&task, &mut evaluations, &mut watch),
        };
        #[allow(clippy::cast_precision_loss)] // far below 2⁵³
        let count = evaluations as f64;
        let reached = watch.worst.last().map_or(long, |(t, _)| *t);
        Drift { method, setting, worst: watch.worst, rate: count / reached, ended: ended.err() }
    });
    Ok(drifts.collect())
}

/// Runs one of this project's integrators to the end, and shows the energy on the way.
fn run(task: &Task<'_>, plan: &Plan, evaluations: &mut u64, watch: &mut MaximumError<'_>) -> Result<(), Ended> {
    let count = task.steps();
    let samples = if watch.reference.is_some() { REFERENCE_SAMPLES } else { SAMPLES };
    let between = (count / samples).max(1);
    let mut run = watch.system.begin(plan)?;
    let finds_its_step = task.method == Method::ENERGY;
    // A given step is taken this number of times, independent of rounding in t.
    let end = if finds_its_step { task.end } else { f64::INFINITY };
    let most = if finds_its_step { TOO_MANY * count } else { count };
    let mut taken = 0;
    while taken < most && run.t() < end {
        let advanced = run.advance_until(end, between.min(most - taken));
        *evaluations = run.evaluations();
        taken += advanced?;
        if taken % between == 0 {
            let (t, energy) = run.sampled_energy()?;
            if t <= end {
                watch.see(t, energy)?;
            }
        }
    }
    if run.t() < end && finds_its_step { Err(Ended::Short(run.t())) } else { Ok(()) }
}

/// Runs DOP853 to the end, and shows the energy of every step.
fn run_rival(task: &Task<'_>, evaluations: &mut u64, watch: &mut MaximumError<'_>) -> Result<(), Ended> {
    let system = watch.system;
    let mut seen = Ok(());
    let mut see = |t: f64, energy: f64| {
        if t > task.start.t && seen.is_ok() {
            seen = watch.see(t, energy);
        }
    };
    let count = Cell::new(0);
    let reached = system.studies().rival(task.start, task.end, task.setting, &count, Some(&mut see));
    *evaluations = count.get();
    reached.and(seen)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ready;

    #[test]
    fn kepler_drifts_with_the_rival_and_not_with_fixed_steps() {
        let start = PhasePoint { t: 0.0, q: vec![0.4, 0.0], v: vec![0.0, 2.0] };
        let system = ready().find("kepler").expect("the system").system;
        let found = all(system.as_ref(), &start, 0.005, 600.0, None, &mut Progress::new(8)).expect("an energy");
        for drift in &found {
            let (t, error) = drift.last().expect("points");
            let growth = drift.growth().expect("a growth");
            assert!(t > 580.0 && drift.ended.is_none(), "{drift:?}");
            match drift.method {
                Method::Rival if drift.setting > 1e-10 => assert!(growth > 0.8, "{growth}"),
                Method::FIXED => assert!(growth < 0.1 && error > 1e-6, "{growth}, {error:e}"),
                Method::ENERGY => assert!(error < 2e-14, "{error:e}"),
                // Measured: 7.7e-14.
                Method::Gauss(8) => assert!(error < 2e-13 && growth < 0.8, "{growth}, {error:e}"),
                _ => {}
            }
        }
    }
}
