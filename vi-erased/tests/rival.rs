//! DOP853 against an exact motion, and into a centre.

use core::cell::Cell;
use vi_core::StepError;
use vi_core::check::Trajectory;
use vi_erased::studies::rival::{Ended, motion};
use vi_systems::{DampedOscillator, Kepler};

#[test]
fn the_damped_oscillator_is_met() {
    let system = DampedOscillator::default();
    let t = 40.0;
    let start = Trajectory { t: 0.0, q: [1.0].into(), v: [0.0].into() };
    let evaluations = Cell::new(0);
    let end = motion(system, &start, t, 1e-14, &evaluations, &mut |_| ()).expect("the motion");
    let decay = 0.02_f64;
    let omega = (4.0_f64 - 0.02 * 0.02).sqrt();
    let exact = (-decay * t).exp() * ((omega * t).cos() + decay / omega * (omega * t).sin());
    // Measured 3.5e-14.
    assert!((end.q[0] - exact).abs() < 4e-14, "{:e}", end.q[0] - exact);
    assert!((end.t - t).abs() < 1e-14);
    assert!(evaluations.get() > 1000, "{}", evaluations.get());
}

#[test]
fn every_step_is_shown_and_a_run_into_the_centre_ends() {
    let system = Kepler::default();
    let start = Trajectory { t: 0.0, q: [1.0, 0.0].into(), v: [0.0, 0.0].into() };
    let mut times = Vec::new();
    let ended = motion(system, &start, 2.0, 1e-9, &Cell::new(0), &mut |motion| times.push(motion.t));
    // Free fall from r = 1 with μ = 1 ends at t = π/√8.
    let fall = core::f64::consts::PI / 8.0_f64.sqrt();
    let at_the_centre = |t: f64| (t - fall).abs() < 1e-6;
    assert!(matches!(ended, Err(Ended::Step(StepError::NonFinite { t, .. })) if at_the_centre(t)), "{ended:?}");
    assert!(times.len() > 10 && times.is_sorted());
}
