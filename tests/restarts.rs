//! A stored and resumed run continues bit for bit, for every kind of step, and only with the same system.

use vi_core::stepping::FixedStepping;
use vi_core::{EnergyPreserving, FixedStep, Run, Starts, State, StepError, lagrangian, run::Checkpoint};
use vi_systems::{DampedOscillator, DoubleWell, HarmonicOscillator, Kepler};

lagrangian! {
    /// Linear, and too large for one matrix: the inverse of A is computed once.
    struct Springs {
        param m = 1.2, k = 1.7;
        coord q[6];
        L = sum(i in 0..6, m * dot(q[i])^2 / 2 - k * q[i]^2 / 8) - k * sum(i in 0..5, (q[i + 1] - q[i])^2) / 2;
        discretize midpoint;
    }
}

lagrangian! {
    /// With the trapezoidal rule a step is explicit.
    struct Explicit {
        param k = 1.4;
        coord x;
        L = dot(x)^2 / 2 - k * x^4 / 4;
        discretize trapezoidal;
    }
}

/// Restarts after each of `steps` steps: the next steps must equal those of the uninterrupted run.
fn resumes<const N: usize, S: FixedStepping<N>>(system: S, (q, v): ([f64; N], [f64; N]), h: f64, steps: u32) {
    let mut whole = system.at(0.3, q, v).integrate(FixedStep, h).expect("a start");
    let mut resumed = whole.clone();
    for step in 0..steps {
        let text = serde_json::to_string(&resumed.checkpoint()).expect("numbers");
        let stored: Checkpoint<_, N> = serde_json::from_str(&text).expect("the same numbers");
        resumed = Run::restart(system, FixedStep, stored).expect("a checkpoint of this system");
        let (next, again) = (whole.step(), resumed.step());
        assert_eq!(format!("{next:?}"), format!("{again:?}"), "{}, h = {h}, step {step}", S::NAME);
        assert!(next.is_ok(), "{}: {next:?}", S::NAME);
        assert_eq!(format!("{:?}", whole.checkpoint()), format!("{:?}", resumed.checkpoint()), "{}", S::NAME);
    }
}

#[test]
fn every_way_of_stepping_resumes_bit_for_bit() {
    // A step of 10 is far beyond the period: a step solved by one matrix must be followed by one too.
    for h in [0.01, 1.0, 10.0, -3.0] {
        resumes(HarmonicOscillator { m: 1.3, k: 0.7 }, ([0.7], [0.3]), h, 500);
        resumes(DampedOscillator::default(), ([0.7], [0.3]), h, 200);
        resumes(Springs::default(), ([0.1, 0.5, -0.3, 0.2, 0.0, 0.7], [0.3; 6]), h, 500);
    }
    for h in [0.01, 0.2] {
        resumes(DoubleWell { m: 1.3 }, ([0.9], [0.1]), h, 500);
        resumes(Explicit::default(), ([0.9], [0.1]), h, 500);
        resumes(Kepler { mu: 1.2 }, ([1.1, 0.0], [0.1, 0.9]), h, 500);
    }
}

#[test]
fn a_checkpoint_is_resumed_by_its_own_system_only() {
    let system = Kepler { mu: 1.2 };
    let start = State::at(&system, 0.0, [1.0, 0.0], [0.0, 1.1]);
    let mut run = system.at_state(start).integrate(FixedStep, 0.01).expect("a start");
    run.step().expect("a step");

    let other = Run::restart(Kepler { mu: 1.3 }, FixedStep, run.checkpoint()).expect_err("another parameter");
    let StepError::OtherSystem { system: name, parameter, stored, given } = other else { panic!("{other}") };
    assert_eq!((name, parameter, stored, given), ("Kepler", Some("mu"), 1.2, 1.3));
    assert!(other.to_string().contains("`mu` = 1.2"), "{other}");

    let text = serde_json::to_string(&run.checkpoint()).expect("numbers").replace("Kepler", "Keller");
    let stored: Checkpoint<_, 2> = serde_json::from_str(&text).expect("the same numbers");
    let other = Run::restart(system, FixedStep, stored).expect_err("another system");
    assert!(matches!(other, StepError::OtherSystem { parameter: None, .. }), "{other:?}");

    let both = EnergyPreserving::from_midpoint(system, 0.0, [1.0, 0.0], [0.0, 1.1], 0.01).expect("a start");
    let other = Run::restart(Kepler { mu: -1.2 }, EnergyPreserving, both.checkpoint()).expect_err("another parameter");
    assert!(matches!(other, StepError::OtherSystem { parameter: Some("mu"), .. }), "{other:?}");
}
