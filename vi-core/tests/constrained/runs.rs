//! What every run has, for systems with constraints.

use super::systems::{Auto, Model, PENDULUM, Pendulum};
use vi_core::motion::Motion as _;
use vi_core::prelude::{Event, Moment};
use vi_core::run::{Checkpoint, DenseOutput};
use vi_core::{Composition, EnergyPreservingGauss, Gauss, Method, Run, SVector, Starts, State, StepError, Tolerance};

fn pendulum<const STAGES: usize>(h: f64) -> Run<Gauss<STAGES>, Auto<Pendulum, 1>, 2> {
    PENDULUM.at(0.0, [0.6, -0.8], [0.8, 0.6]).integrate(Gauss::<STAGES>, h).unwrap_or_else(|error| panic!("{error}"))
}

/// g at a state.
fn off<M: Model<2, 1>>(system: &Auto<M, 1>, state: &State<2>) -> f64 {
    system.constraints(state.t, &state.q)[0].abs()
}

#[test]
fn dense_output_is_near_the_constraint_between_nodes() {
    let off_at = |h: f64| {
        let mut run = pendulum::<2>(h);
        let before = run.state();
        let after = run.step().unwrap_or_else(|error| panic!("{error}"));
        let output = run.dense_output(&before).unwrap_or_else(|error| panic!("{error}"));
        // At both ends it is the node.
        assert!((output.state(before.t).q - before.q).amax() + (output.state(after.t).q - after.q).amax() < 1e-15);
        off(&PENDULUM, &output.state(0.5 * h))
    };
    let [coarse, fine] = [0.05, 0.025].map(off_at);
    println!("{coarse:e} {fine:e}");
    // O(h⁴).
    assert!(coarse < 1e-4 && (coarse / fine - 16.0).abs() < 2.0, "{coarse:e} {fine:e}");
}

#[test]
fn a_rod_goes_slack_where_its_reaction_vanishes() {
    // From the bottom with v² = 36: 2Λ = g y − |v|² is zero at y = (36 − 2g)/(3g).
    let start = PENDULUM.at(0.0, [0.0, -1.0], [6.0, 0.0]);
    let mut run = start.integrate(Gauss::<3>, 0.01).unwrap_or_else(|error| panic!("{error}"));
    let slack = Event::rising(|moment: &Moment<2>| {
        let state = State::at(&PENDULUM, moment.t, moment.q, moment.v);
        state.reaction(&PENDULUM).map_or(f64::NAN, |[multiplier]| multiplier)
    });
    let met = run.until_event(slack, 5.0).unwrap_or_else(|error| panic!("{error}")).expect("an event");
    let height = (36.0 - 2.0 * 9.81) / (3.0 * 9.81);
    println!("{:e} {:e}", met.state.q[1] - height, off(&PENDULUM, &met.state));
    // Measured: 9.7e-13, the error of order 6.
    assert!((met.state.q[1] - height).abs() < 2e-12, "{}", met.state.q[1]);
    // The state is the end of a step, on the constraint.
    assert!(off(&PENDULUM, &met.state) < 1e-15);
}

/// Restarts with the stored node as `change` leaves it.
fn restarted<M>(method: M, change: impl Fn(&mut serde_json::Value)) -> Result<(), StepError>
where
    M: Method<Auto<Pendulum, 1>, 2, Memory: serde::Serialize + serde::de::DeserializeOwned>,
{
    let start = PENDULUM.at(0.0, [0.6, -0.8], [0.8, 0.6]);
    let mut run = start.integrate(method.clone(), 0.02).unwrap_or_else(|error| panic!("{error}"));
    for _ in 0..10 {
        run.step().unwrap_or_else(|error| panic!("{error}"));
    }
    let mut stored = serde_json::to_value(run.checkpoint()).expect("a text");
    change(&mut stored["run"]["node"]);
    let stored: Checkpoint<_, 2> = serde_json::from_value(stored).expect("a checkpoint");
    Run::restart(PENDULUM, method, stored).map(drop)
}

/// Multiplies the entries of a vector of a node.
fn scale(node: &mut serde_json::Value, vector: &str, by: f64) {
    for entry in node[vector].as_array_mut().expect("a vector") {
        *entry = (entry.as_f64().expect("a number") * by).into();
    }
}

#[test]
fn a_stored_node_off_the_constraint_is_refused() {
    fn refuses<M>(method: M)
    where
        M: Method<Auto<Pendulum, 1>, 2, Memory: serde::Serialize + serde::de::DeserializeOwned> + Clone,
    {
        assert_eq!(restarted(method.clone(), |_| ()), Ok(()));
        // Faster or slower is another motion, on the constraint.
        assert_eq!(restarted(method.clone(), |node| scale(node, "p", 1.5)), Ok(()));
        for by in [1.0 + 1e-9, 1.001, 3.0] {
            let failure = restarted(method.clone(), |node| scale(node, "q", by)).expect_err("off");
            let StepError::InconsistentStart { constraint: "rod", residual, .. } = failure else { panic!("{failure}") };
            assert!((residual - (by * by - 1.0)).abs() < 1e-14, "{failure}");
        }
        // Momenta along the rod.
        let failure = restarted(method, |node| {
            for k in 0..2 {
                let along = node["p"][k].as_f64().expect("a number") + 1e-6 * node["q"][k].as_f64().expect("a number");
                node["p"][k] = along.into();
            }
        });
        let Err(StepError::InconsistentStart { constraint: "rod", residual, rate }) = failure else {
            panic!("{failure:?}")
        };
        assert!(residual.abs() < 1e-14 && (rate - 2e-6).abs() < 1e-12, "{residual:e} {rate:e}");
    }
    refuses(Gauss::<2>);
    refuses(EnergyPreservingGauss::<1>);
    refuses(Gauss::<1>.composed(Composition::SUZUKI_4));
}

#[test]
fn parameters_that_break_a_constraint_are_refused() {
    let mut run = pendulum::<2>(0.05);
    run.step().unwrap_or_else(|error| panic!("{error}"));
    assert!(run.impulses().is_some() && run.discrete_energy().is_some());
    let before = run.clone();
    let failure = run.set_parameters(|system| system.0.length = 1.1).expect_err("another circle");
    let StepError::InconsistentStart { constraint: "rod", residual, .. } = failure else { panic!("{failure}") };
    assert!((residual + 0.21).abs() < 1e-14, "{residual}");
    assert_eq!((run.state(), run.system().0.length.to_bits()), (before.state(), 1.0_f64.to_bits()));
    // Another weight is fine.
    run.set_parameters(|system| system.0.g = 1.62).unwrap_or_else(|error| panic!("{error}"));
    assert!(run.impulses().is_none() && run.discrete_energy().is_none());
    let state = run.step().unwrap_or_else(|error| panic!("{error}"));
    assert!(off(&PENDULUM, &state) < 1e-15);
    let lost = run.set_state(State { t: 0.0, q: SVector::from([1.0, 1.0]), p: SVector::zeros() });
    assert!(matches!(lost, Err(StepError::InconsistentStart { .. })), "{lost:?}");
    run.set_state(State { t: 0.0, q: SVector::from([1.0, 0.0]), p: SVector::from([0.0, 0.5]) })
        .unwrap_or_else(|error| panic!("{error}"));
    run.step().unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn a_tolerance_finds_a_step() {
    let start = PENDULUM.at(0.0, [0.6, -0.8], [0.8, 0.6]);
    let mut run = start.integrate(Gauss::<2>, Tolerance(1e-8)).unwrap_or_else(|error| panic!("{error}"));
    println!("{}", run.h());
    assert!(run.h() > 1e-3 && run.h() < 0.2, "{}", run.h());
    run.step().unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn a_reference_to_a_system_is_integrated() {
    let mut by_value = pendulum::<2>(0.05);
    let start = (&PENDULUM).at(0.0, [0.6, -0.8], [0.8, 0.6]);
    let mut by_reference = start.integrate(Gauss::<2>, 0.05).unwrap_or_else(|error| panic!("{error}"));
    for _ in 0..5 {
        assert_eq!(by_value.step(), by_reference.step());
    }
}
