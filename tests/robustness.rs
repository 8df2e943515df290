//! Any numbers give a step or a typed error, and never a panic, NaN, or an endless iteration.
//!
//! States, steps and parameters are random over many magnitudes, including zeros, infinities and NaN. The sequence is
//! fixed.

use crate::support::Sequence;
use crate::support::ending::{self, assert_typed};
use crate::support::scenes::{Scene, each_system};
use vi_core::lagrangian::Parameters;
use vi_core::stepping::EnergyStepping;
use vi_core::{EnergyPreserving, Fallback, FixedStep, SVector, Starts, State, StepError};

/// Draws for each system, each from four starts.
const DRAWS: usize = if cfg!(feature = "long") { 1500 } else { 400 };
const STEPS: usize = 5;

/// An unreasonable number.
fn wild(draw: &mut Sequence) -> f64 {
    let sign = if draw.next() < 0.5 { -1.0 } else { 1.0 };
    match draw.next() {
        x if x < 0.05 => f64::NAN,
        x if x < 0.10 => sign * f64::INFINITY,
        x if x < 0.15 => sign * f64::MAX,
        x if x < 0.20 => sign * f64::MIN_POSITIVE,
        x if x < 0.30 => 0.0,
        x if x < 0.65 => sign * 10_f64.powf(draw.within(-150.0, 150.0)),
        _ => sign * 10_f64.powf(draw.within(-12.0, 12.0)),
    }
}

/// One draw: the extreme quantities and their values.
struct Drawn<S, const N: usize> {
    system: S,
    t: f64,
    q: SVector<f64, N>,
    v: SVector<f64, N>,
    h: f64,
}

fn drawn<const N: usize, S: EnergyStepping<N> + Parameters + Copy>(
    scene: &Scene<S, N>,
    draw: &mut Sequence,
) -> Drawn<S, N> {
    // Each quantity is extreme in three draws of ten; otherwise it stays near the scene, where steps exist.
    let is_wild: [bool; 5] = core::array::from_fn(|_| draw.next() < 0.3);
    let mut vector = |near: [f64; N], is_wild: bool| {
        SVector::from_fn(|index: usize, _| if is_wild { wild(draw) } else { near[index] * draw.within(0.5, 1.5) })
    };
    let (q, v) = (vector(scene.q, is_wild[0]), vector(scene.v, is_wild[1]));
    let t = if is_wild[2] { wild(draw) } else { draw.within(-1.0, 1.0) };
    // From 1e-9 to 1e3, or any number.
    let h = if is_wild[3] { wild(draw) } else { 10_f64.powf(draw.within(-9.0, 3.0)) };
    let mut system = scene.system;
    for name in S::PARAMETERS {
        if is_wild[4] && draw.next() < 0.5 {
            *system.parameter_mut(name).expect("a name of the list") = wild(draw);
        }
    }
    Drawn { system, t, q, v, h }
}

/// Frequency of each outcome.
#[derive(Debug, Default)]
struct Tally {
    refused: usize,
    ended: usize,
    ran: usize,
}

impl Tally {
    fn count<R>(&mut self, start: Result<R, StepError>, run: impl FnOnce(R) -> Option<StepError>) {
        match start.map(run) {
            Err(error) => {
                assert_typed(error);
                self.refused += 1;
            }
            Ok(Some(_)) => self.ended += 1,
            Ok(None) => self.ran += 1,
        }
    }
}

fn check<const N: usize, S: EnergyStepping<N> + Parameters + Copy>(scene: Scene<S, N>) {
    let mut draw = Sequence::new(23);
    let [mut fixed, mut energy_preserving, mut falling_back] = [(); 3].map(|()| Tally::default());
    for _ in 0..DRAWS {
        let Drawn { system, t, q, v, h } = drawn(&scene, &mut draw);
        let state = State { t, q, p: if draw.next() < 0.5 { v } else { system.momentum(t, &q, &v) } };
        fixed.count(system.at_state(state).integrate(FixedStep, h), |run| ending::fixed(run, STEPS));
        let starts = [
            EnergyPreserving::from_midpoint(system, t, q, v, h),
            EnergyPreserving::from_points(system, (t, q), (t + h, q + v * h)),
            EnergyPreserving::from_state(system, state, wild(&mut draw), h, v),
            EnergyPreserving::from_state(system, state, system.energy(t, &q, &v), h, v),
        ];
        for start in starts {
            let fallback = start.clone().map(|run| run.with_fallback(Fallback::FixedSteps));
            let bounded = fallback.clone().and_then(|run| run.with_step_bounds(h.abs() / 2.0, wild(&mut draw)));
            energy_preserving.count(start, |run| ending::energy_preserving(run, STEPS).error);
            falling_back.count(fallback, |run| ending::energy_preserving(run, STEPS).error);
            falling_back.count(bounded, |run| ending::energy_preserving(run, STEPS).error);
        }
    }
    println!("{}: fixed {fixed:?}, energy-preserving {energy_preserving:?}, falling back {falling_back:?}", S::NAME);
    for tally in [fixed, energy_preserving, falling_back] {
        let least = tally.refused.min(tally.ended).min(tally.ran);
        assert!(least * 150 >= DRAWS, "{}: a kind of outcome is hardly met: {tally:?}", S::NAME);
    }
}

each_system!(check);
