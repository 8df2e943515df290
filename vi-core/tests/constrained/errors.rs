//! Failures of systems with constraints: a typed error with its numbers, and nothing else.

use super::systems::{Auto, DoublePendulum, HeavyTop, Mixed, PENDULUM, Pendulum, Sleigh, Twice};
use vi_core::motion::Motion as _;
use vi_core::{Gauss, SVector, Starts, State, StepError};

#[test]
fn a_start_off_the_constraint_is_inconsistent() {
    let begin = |q: [f64; 2], v: [f64; 2]| PENDULUM.at(0.0, q, v).integrate(Gauss::<1>, 0.05).err();
    assert_eq!(begin([0.6, -0.8], [0.8, 0.6]), None);
    let Some(StepError::InconsistentStart { constraint, residual, rate }) = begin([0.6, -0.801], [0.8, 0.6]) else {
        panic!("a start")
    };
    assert_eq!(constraint, "rod");
    // g = 0.36 + 0.641601 − 1, and 2 (0.6 · 0.8 − 0.801 · 0.6).
    assert!((residual - 1.601e-3).abs() < 1e-15 && (rate + 1.2e-3).abs() < 1e-15, "{residual} {rate}");
    let failure = begin([0.6, -0.8], [0.8, 0.7]).expect("no start");
    assert!(
        matches!(failure, StepError::InconsistentStart { residual, rate, .. } if residual.abs() < 1e-15 && (rate + 0.16).abs() < 1e-15),
        "{failure}"
    );
    let text = failure.to_string();
    assert!(text.contains("`rod`") && text.contains("-1.600e-1") && text.contains("State::projected"), "{text}");
    // At rest but for the rounding of a rounding.
    assert_eq!(begin([0.6, -0.8], [0.0, 1.44e-32]), None);
    assert!(begin([0.6, -0.8], [0.0, 1e-25]).is_some());
    // Sixteen roundings are the limit.
    assert_eq!(begin([0.6, -0.8 * (1.0 + 4e-16)], [0.8, 0.6]), None);
    assert!(begin([0.6, -0.8 * (1.0 + 4e-14)], [0.8, 0.6]).is_some());
    for lost in [f64::NAN, f64::INFINITY] {
        assert!(matches!(begin([lost, -0.8], [0.8, 0.6]), Some(StepError::NonFinite { .. })));
        assert!(matches!(begin([0.6, -0.8], [0.8, lost]), Some(StepError::NonFinite { .. })));
    }
    // Without inertia along the quaternion no velocity has a momentum along it.
    let top = Auto(HeavyTop { j: 0.0 });
    let mut state = State::at(&top, 0.0, [0.8, 0.4, 0.4, 0.2], [-0.4, 1.8, -2.2, 2.4]);
    assert_eq!(top.at_state(state).integrate(Gauss::<1>, 0.05).err(), None);
    state.p += state.q * 1e-6;
    let failure = top.at_state(state).integrate(Gauss::<1>, 0.05).err();
    assert!(matches!(failure, Some(StepError::InconsistentStart { constraint: "R", .. })), "{failure:?}");
    let sleigh = Auto(Sleigh { turns: false });
    let failure = sleigh.at(0.0, [0.0; 3], [1.0, 0.25, 2.0]).integrate(Gauss::<2>, 0.05).err();
    let Some(StepError::InconsistentStart { constraint: "blade", residual: 0.0, rate }) = failure else {
        panic!("{failure:?}")
    };
    assert!((rate - 0.25).abs() < 1e-15, "{rate}");
}

#[test]
fn the_projected_state_is_the_nearest_one() {
    // The nearest place on a circle lies along the radius, and the velocity loses its radial part.
    let projected = State::projected(&PENDULUM, 0.0, [0.9, -1.2], [1.0, 0.5]).unwrap_or_else(|error| panic!("{error}"));
    let state = projected.state;
    // Measured: at most 2.2e-16.
    assert!((state.q[0] - 0.6).abs() < 4e-16 && (state.q[1] + 0.8).abs() < 4e-16, "{projected:?}");
    assert!((state.p[0] - 0.88).abs() < 4e-16 && (state.p[1] - 0.66).abs() < 4e-16, "{projected:?}");
    assert!((projected.moved_q.norm() - 0.5).abs() < 1e-15 && (projected.moved_v.norm() - 0.2).abs() < 1e-15);
    PENDULUM.at_state(state).integrate(Gauss::<2>, 0.05).unwrap_or_else(|error| panic!("{error}"));
    // Several constraints, both kinds, and masses that differ.
    let far = State::projected(&Auto(DoublePendulum), 0.0, [0.7, -0.9, 0.9, -1.9], [1.0, 0.2, -0.3, 0.4]);
    let far = far.unwrap_or_else(|error| panic!("{error}"));
    Auto(DoublePendulum).at_state(far.state).integrate(Gauss::<1>, 0.05).unwrap_or_else(|error| panic!("{error}"));
    // M (q − q0) and M (v − v0) are combinations of the gradients: nothing is left across them.
    let (rows, _) = Auto(DoublePendulum).constraint_gradients(0.0, &far.state.q);
    let masses = vi_core::SVector::from([2.0, 2.0, 1.0, 1.0]);
    for moved in [far.moved_q, far.moved_v] {
        let momentum = moved.component_mul(&masses);
        let normals = vi_core::nalgebra::SMatrix::<f64, 4, 2>::from_columns(&rows);
        let multipliers =
            (normals.transpose() * normals).try_inverse().expect("independent") * normals.transpose() * momentum;
        let rest = (momentum - normals * multipliers).amax();
        println!("{rest:e}");
        // Measured: at most 1.1e-16.
        assert!(moved.norm() > 0.05 && rest < 4e-16, "{rest:e}");
    }
    let mixed = State::projected(&Auto(Mixed), 0.0, [0.1, 0.6, -0.9, 0.2], [1.0, 1.0, 1.0, 0.3]);
    let mixed = mixed.unwrap_or_else(|error| panic!("{error}")).state;
    Auto(Mixed).at_state(mixed).integrate(Gauss::<2>, 0.05).unwrap_or_else(|error| panic!("{error}"));
    // A state on the constraints does not move.
    let same = State::projected(&PENDULUM, 0.0, [0.6, -0.8], [0.8, 0.6]).unwrap_or_else(|error| panic!("{error}"));
    assert!(same.moved_q.amax() < 2e-16 && same.moved_v.amax() < 2e-16, "{same:?}");
    // The centre of the circle has no nearest place.
    let lost = State::projected(&PENDULUM, 0.0, [0.0, 0.0], [0.8, 0.6]);
    assert!(matches!(lost, Err(StepError::Singular { .. })), "{lost:?}");
    assert!(State::projected(&PENDULUM, 0.0, [f64::NAN, 0.0], [0.8, 0.6]).is_err());
}

#[test]
fn a_repeated_constraint_is_redundant() {
    let failure = Auto(Twice).at(0.0, [0.6, -0.8], [0.8, 0.6]).integrate(Gauss::<1>, 0.05).err();
    assert_eq!(failure, Some(StepError::Redundant { constraint: "again", of: 2, rank: 1 }));
    let text = failure.expect("a failure").to_string();
    assert!(text.contains("`again`") && text.contains("1 of 2"), "{text}");
    let state = State::at(&Auto(Twice), 0.0, [0.6, -0.8], [0.8, 0.6]);
    assert!(matches!(state.reaction(&Auto(Twice)), Err(StepError::Singular { .. })));
}

#[test]
fn no_step_turns_a_rod_by_a_right_angle() {
    let rotor = Auto(Pendulum { length: 1.0, g: 0.0 });
    for h in [1.01, 1.2, 1.5, 2.0, 3.0, 10.0, 1e3, 1e9] {
        for h in [h, -h] {
            let mut run = rotor.at(0.0, [1.0, 0.0], [0.0, 1.0]).integrate(Gauss::<1>, h).expect("a start");
            let failure = run.step().expect_err("no step");
            let StepError::NotConverged { turn, .. } = failure else { panic!("{h}: {failure}") };
            // The angle at the velocity of the start.
            assert!((f64::from(turn) / h.abs().to_degrees() - 1.0).abs() < 1e-4 || h.abs() > 100.0, "{h}: {turn}");
            assert!(failure.to_string().contains("degrees"), "{failure}");
            assert_eq!(run.step().expect_err("the same"), failure);
            // A shorter step goes on.
            run.step_of(0.5).unwrap_or_else(|error| panic!("{error}"));
        }
    }
    // More stages, weight, and steps of any length: a state on the constraint or an error.
    for k in 1..200 {
        let h = 0.02 * f64::from(k);
        let start = PENDULUM.at(0.0, [0.6, -0.8], [0.8, 0.6]);
        for outcome in [
            start.integrate(Gauss::<1>, h).expect("a start").step(),
            start.integrate(Gauss::<2>, h).expect("a start").step(),
            start.integrate(Gauss::<3>, h).expect("a start").step(),
        ] {
            match outcome {
                // g is far below the rounding of what it was before the step.
                Ok(state) => assert!((state.q.norm_squared() - 1.0).abs() < 1e-13, "{h}: {state:?}"),
                Err(StepError::NotConverged { .. } | StepError::TooLong { .. }) => assert!(h > 0.2, "{h}"),
                Err(error) => panic!("{h}: {error}"),
            }
        }
    }
}

#[test]
fn a_flat_linkage_is_singular() {
    // Both rods hang straight down, and a third point of attachment would be redundant: two rods in line still are not.
    let straight = Auto(DoublePendulum).at(0.0, [0.0, -1.0, 0.0, -2.0], [1.0, 0.0, 2.0, 0.0]);
    straight.integrate(Gauss::<1>, 0.05).unwrap_or_else(|error| panic!("{error}"));
    // A rod of no length has no gradient.
    let point = Auto(Pendulum { length: 0.0, g: 9.81 });
    let failure = point.at(0.0, [0.0, 0.0], [0.0, 0.0]).integrate(Gauss::<1>, 0.05).err();
    assert_eq!(failure, Some(StepError::Redundant { constraint: "rod", of: 1, rank: 0 }));
    let text = failure.map(|failure| failure.to_string()).unwrap_or_default();
    let expected = "the gradient of the constraint `rod` is zero at the start, as that of a rod without length; correct its lengths, or start elsewhere";
    assert_eq!(text, expected);
}

#[test]
fn a_guess_beside_the_centre_of_a_circle_is_projected() {
    let pendulum = Auto(Pendulum { length: 1.0, g: 9.81 });
    let projected = |x: f64| State::projected(&pendulum, 0.0, [x, 0.0], [0.0, 0.0]);
    for x in [0.5, 1e-9] {
        let found = projected(x).unwrap_or_else(|error| panic!("{x}: {error}"));
        assert!((found.state.q - SVector::from([1.0, 0.0])).amax() < 1e-15, "{found:?}");
    }
    // At the centre no direction is nearer than another.
    let failure = projected(0.0).err();
    assert!(matches!(failure, Some(StepError::Singular { .. })), "{failure:?}");
}
