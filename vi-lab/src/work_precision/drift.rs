//! The energy over a long time: which methods drift.
//!
//! In: a system, a start, the usual step, the long time. Out: per method the largest error so far of the energy, relative
//! to that of the start. What is compared is `H(t, q, v)`: at the nodes, v being the velocity that belongs to p; for the
//! energy-preserving integrator in the middles of its steps, which is where its rule preserves it. Where the energy is not
//! conserved, it is compared with that of the reference at the same time.

use super::counting::Counting;
use super::method::{Method, steps};
use super::reference::Reference;
use super::rival::{self, Ended};
use crate::numbers::order;
use crate::progress::Progress;
use core::cell::Cell;
use vi_core::check::Motion;
use vi_core::{Composition, EnergyPreserving, FixedStep, State, StepError, Stepping};

/// Tolerances of DOP853.
const TOLERANCES: [f64; 3] = [1e-6, 1e-9, 1e-12];
/// Nodes of a run at which the energy is looked at.
const SAMPLES: u64 = 200_000;
/// The same where every look follows the reference to that time.
const DEAR_SAMPLES: u64 = 400;

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
    /// Why the run ended before its time.
    pub(super) ended: Option<Ended>,
}

impl Drift {
    /// The power of the time by which the error grows over its last hundredfold: 0 is bounded, 1 a steady drift.
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

/// The largest error so far, as it is seen.
struct Watch<'a, S, const N: usize> {
    system: &'a S,
    reference: Option<&'a Reference<&'a S, N>>,
    initial: f64,
    largest: f64,
    worst: Vec<(f64, f64)>,
}

impl<S: Stepping<N>, const N: usize> Watch<'_, S, N> {
    fn see(&mut self, t: f64, energy: f64) -> Result<(), Ended> {
        let expected = match self.reference {
            None => self.initial,
            Some(reference) => {
                let Motion { t, q, v } = reference.at(t)?;
                self.system.energy(t, &q, &v)
            }
        };
        let unit = if self.initial == 0.0 { 1.0 } else { self.initial.abs() };
        let error = (energy - expected).abs() / unit;
        if !error.is_finite() {
            return Err(Ended::NonFinite);
        }
        self.largest = self.largest.max(error);
        // A hundred points a decade are more than a figure can show.
        if self.worst.last().is_none_or(|(last, _)| t > last * 1.02) {
            self.worst.push((t, self.largest));
        }
        Ok(())
    }

    fn see_motion(&mut self, motion: &Motion<N>) -> Result<(), Ended> {
        self.see(motion.t, self.system.energy(motion.t, &motion.q, &motion.v))
    }

    fn see_state(&mut self, state: State<N>) -> Result<(), Ended> {
        // Before its first step the integrator holds the velocity that belongs to the momenta.
        let v = FixedStep::new(self.system, state, 1.0)?.v();
        self.see_motion(&Motion { t: state.t, q: state.q, v })
    }
}

/// All methods: those of fixed steps at the usual length of their parts, DOP853 at three tolerances.
pub(super) fn all<S: Stepping<N>, const N: usize>(
    system: &S,
    start: &Motion<N>,
    (h, long): (f64, f64),
    reference: Option<&Reference<&S, N>>,
    progress: &mut Progress,
) -> Vec<Drift> {
    let stepping = Method::ALL.into_iter().filter(|method| *method != Method::Rival);
    #[allow(clippy::cast_precision_loss)] // at most 17
    let settings = stepping.map(|method| (method, h * method.parts() as f64));
    settings
        .chain(TOLERANCES.map(|tolerance| (Method::Rival, tolerance)))
        .map(|(method, setting)| {
            progress.advance_by(1);
            let initial = system.energy(start.t, &start.q, &start.v);
            let mut watch = Watch { system, reference, initial, largest: 0.0, worst: Vec::new() };
            let evaluations = Cell::new(0);
            let counting = Counting::new(system, &evaluations);
            let ended = run(&counting, &mut watch, start, long, (method, setting)).err();
            #[allow(clippy::cast_precision_loss)] // far below 2⁵³
            let count = evaluations.get() as f64;
            let reached = watch.worst.last().map_or(long, |(t, _)| *t);
            Drift { method, setting, worst: watch.worst, rate: count / reached, ended }
        })
        .collect()
}

/// Runs to the end `long`, and shows the energy on the way.
fn run<S: Stepping<N>, const N: usize>(
    counting: &Counting<'_, &S>,
    watch: &mut Watch<'_, S, N>,
    start: &Motion<N>,
    long: f64,
    (method, setting): (Method, f64),
) -> Result<(), Ended> {
    let count = steps(long, setting);
    let stride = (count / if watch.reference.is_some() { DEAR_SAMPLES } else { SAMPLES }).max(1);
    let state = State::at(counting, start.t, start.q, start.v);
    match method {
        Method::Fixed => {
            let mut run = FixedStep::new(counting, state, setting)?;
            each(count, stride, || run.step(), |state| watch.see_state(state))
        }
        Method::Composed(scheme) => {
            let mut run = Composition::new(counting, scheme, state, setting)?;
            each(count, stride, || run.step(), |state| watch.see_state(state))
        }
        Method::Energy => {
            let mut run = EnergyPreserving::from_midpoint(counting, start.t, start.q, start.v, setting)?;
            let mut taken = 0;
            while run.node().t < long {
                let step = run.step()?;
                taken += 1;
                if taken % stride == 0 && step.midpoint.0 <= long {
                    let (t, q, v) = step.midpoint;
                    watch.see_motion(&Motion { t, q, v })?;
                }
                if taken > 10 * count {
                    return Err(Ended::Short(step.t));
                }
            }
            Ok(())
        }
        Method::Rival => {
            let mut seen = Ok(());
            rival::motion(counting, start, long, setting, |motion| {
                if motion.t > start.t && seen.is_ok() {
                    seen = watch.see_motion(&motion);
                }
            })?;
            seen
        }
    }
}

/// Takes `count` steps and shows every `stride`-th.
fn each<const N: usize>(
    count: u64,
    stride: u64,
    mut step: impl FnMut() -> Result<State<N>, StepError>,
    mut see: impl FnMut(State<N>) -> Result<(), Ended>,
) -> Result<(), Ended> {
    for taken in 1..=count {
        let state = step()?;
        if taken % stride == 0 {
            see(state)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use vi_systems::Kepler;

    #[test]
    fn kepler_drifts_with_the_rival_and_not_with_fixed_steps() {
        let start = Motion { t: 0.0, q: [0.4, 0.0].into(), v: [0.0, 2.0].into() };
        let found = all(&Kepler::default(), &start, (0.005, 600.0), None, &mut Progress::new(8));
        for drift in &found {
            let ((t, error), growth) = (drift.last().expect("points"), drift.growth().expect("a growth"));
            assert!(t > 580.0 && drift.ended.is_none(), "{drift:?}");
            match drift.method {
                Method::Rival if drift.setting > 1e-10 => assert!(growth > 0.8, "{growth}"),
                Method::Fixed => assert!(growth < 0.1 && error > 1e-6, "{growth}, {error:e}"),
                Method::Energy => assert!(error < 2e-14, "{error:e}"),
                _ => {}
            }
        }
    }
}
