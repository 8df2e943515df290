//! The root that a fixed step takes if the momentum equation has several: beyond `h = 2/√(−V''_min/m)`, 2 for the
//! double well.

use crate::systems::{DoubleWell, UnitMass};
use vi_core::node::Node;
use vi_core::stepping::FixedStepping;
use vi_core::{Connected, FixedStep, SVector, Starts, State, StepError};

const SYSTEM: UnitMass<DoubleWell> = UnitMass(DoubleWell);

/// The branch from h = 0 in 2000 parts, by Newton iteration; `None` if its derivative changes sign, which ends the
/// branch.
fn branch(state: State<1>, h: f64) -> Option<f64> {
    let node = Node::new(state, 0.0);
    let mut v = state.p[0];
    for part in 1..=2000 {
        let before = v;
        let mut change = 1.0;
        for _ in 0..30 {
            let equation = SYSTEM.momentum_equation(&node, h * f64::from(part) / 2000.0, &SVector::from([v]));
            if equation.jacobian[0] <= 1e-6 {
                return None;
            }
            change = equation.residual[0] / equation.jacobian[0];
            v -= change;
            if change.abs() <= 1e-15 * v.abs() {
                break;
            }
        }
        if change.abs() > 1e-13 * (1.0 + v.abs()) || (v - before).abs() > 0.2 {
            return None;
        }
    }
    Some(v)
}

/// Irregular states: 20 steps from each of some starts.
macro_rules! each_step {
    ($starts:expr, $h:expr, $method:expr, $see:expr) => {{
        #[allow(unused_mut)] // some of them count
        let mut see = $see;
        each_state($starts, |start| {
            let run = SYSTEM.at_state(start).integrate($method, $h);
            let mut run = run.unwrap_or_else(|error| panic!("{error}"));
            for _ in 0..20 {
                let before = run.state();
                let step = run.step();
                see(before, step.map(|_| run.v()[0]));
                if step.is_err() {
                    break;
                }
            }
        });
    }};
}

/// The starts.
fn each_state(starts: u32, mut see: impl FnMut(State<1>)) {
    let mut seed = 1_u32;
    let mut draw = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(seed >> 8) / f64::from(1_u32 << 23) - 1.0
    };
    for _ in 0..starts {
        let start = State { t: 0.0, q: [1.5 * draw()].into(), p: [1.5 * draw()].into() };
        see(start);
    }
}

fn both_choices_are_the_one_root(starts: u32) {
    let check = |before: State<1>, step: Result<f64, StepError>| {
        let expected = branch(before, 1.9).unwrap_or(f64::NAN);
        assert!(step.is_ok_and(|v| (v - expected).abs() < 1e-9), "{before:?}: {step:?}, {expected}");
    };
    each_step!(starts, 1.9, FixedStep, check);
    each_step!(starts, 1.9, FixedStep.connected(), check);
}

#[test]
fn below_the_bound_both_choices_are_the_one_root() {
    both_choices_are_the_one_root(12);
}

#[test]
#[ignore = "many steps: `.ci/run nightly`"]
fn below_the_bound_both_choices_of_all_starts_are_the_one_root() {
    both_choices_are_the_one_root(60);
}

fn the_connected_root_is_taken_or_none(lengths: &[f64]) {
    for &h in lengths {
        let (mut same, mut ended, mut different) = (0, 0, 0);
        each_step!(
            60,
            h,
            Connected,
            |before: State<1>, step: Result<f64, StepError>| match (step, branch(before, h)) {
                (Ok(v), Some(expected)) if (v - expected).abs() < 1e-6 => same += 1,
                (Err(StepError::NotConverged { .. } | StepError::TooLong { .. }), None) => ended += 1,
                (step, expected) => {
                    println!("h = {h}: {before:?}: {step:?} instead of {expected:?}");
                    different += 1;
                }
            }
        );
        println!("h = {h}: {same} steps the same, {ended} branches end, {different} differ");
        // Measured: at most 1 differs, at nearly touching branches.
        assert!(same > 800 && ended > 0 && different <= 2, "h = {h}: {same}, {ended}, {different}");
        // Steps from extrapolated velocities take it too, or are refused.
        let mut others = 0;
        each_step!(60, h, FixedStep, |before: State<1>, step: Result<f64, StepError>| {
            let is_same = |v: f64| branch(before, h).is_some_and(|w| (v - w).abs() < 1e-6);
            others += u32::from(step.is_ok_and(|v| !is_same(v)));
        });
        println!("h = {h}: {others} steps take another root");
        assert!(others <= 2, "h = {h}: {others}");
    }
}

#[test]
fn beyond_the_bound_the_connected_root_is_taken_or_none() {
    the_connected_root_is_taken_or_none(&[2.5]);
}

#[test]
#[ignore = "many steps: `.ci/run nightly`"]
fn beyond_the_bound_the_connected_root_of_all_lengths_is_taken_or_none() {
    the_connected_root_is_taken_or_none(&[2.1, 2.5, 3.0, 4.0, 6.0]);
}

#[test]
fn the_connected_root_does_not_depend_on_the_steps_before() {
    let mut compared = 0;
    each_step!(60, 3.0, Connected, |before: State<1>, step: Result<f64, StepError>| {
        let fresh = SYSTEM.at_state(before).integrate(Connected, 3.0);
        let mut fresh = fresh.unwrap_or_else(|error| panic!("{error}"));
        match (fresh.step(), step) {
            (Ok(_), Ok(v)) => assert!((fresh.v()[0] - v).abs() < 1e-9, "{before:?}"),
            (fresh, step) => assert!(fresh.is_err() && step.is_err(), "{before:?}: {fresh:?}, {step:?}"),
        }
        compared += 1;
    });
    assert!(compared > 800, "{compared}");
}
