//! Redundant constraints: an independent subset has the motion of all.

use super::systems::{Auto, Twice};
use vi_core::constrained::{Independent, Projection};
use vi_core::derivatives::{Lyapunov, Tangent, Variation};
use vi_core::motion::Motion as _;
use vi_core::nalgebra::SVector;
use vi_core::{Gauss, Starts, State, StepError, lagrangian};

lagrangian! {
    /// A coupler on three parallel cranks, two of which would hold it, and a mass on a spring.
    struct Parallelogram {
        param g = 9.81, third = 1.0;
        coord x, y, u, w, s;
        L = (dot(x)^2 + dot(y)^2 + dot(u)^2 + dot(w)^2 + dot(s)^2 - s^2) / 2 - g * (y + w);
        constraint left = x^2 + y^2 - 1;
        constraint middle = ((x + u) / 2 - 1)^2 + ((y + w) / 2)^2 - third^2;
        constraint right = (u - 2)^2 + w^2 - 1;
        constraint coupler = (u - x)^2 + (w - y)^2 - 4;
    }
}

lagrangian! {
    /// The same with two cranks.
    struct TwoCranks {
        param g = 9.81;
        coord x, y, u, w, s;
        L = (dot(x)^2 + dot(y)^2 + dot(u)^2 + dot(w)^2 + dot(s)^2 - s^2) / 2 - g * (y + w);
        constraint left = x^2 + y^2 - 1;
        constraint right = (u - 2)^2 + w^2 - 1;
        constraint coupler = (u - x)^2 + (w - y)^2 - 4;
    }
}

lagrangian! {
    /// The coupler moves on a circle like a pendulum.
    struct Angle {
        param g = 9.81;
        coord a;
        L = dot(a)^2 - g * (-2 * cos(a));
    }
}

lagrangian! {
    /// The coupler alone: as many constraints as coordinates.
    struct Bars {
        param g = 9.81;
        coord x, y, u, w;
        L = (dot(x)^2 + dot(y)^2 + dot(u)^2 + dot(w)^2) / 2 - g * (y + w);
        constraint left = x^2 + y^2 - 1;
        constraint right = (u - 2)^2 + w^2 - 1;
        constraint coupler = (u - x)^2 + (w - y)^2 - 4;
        constraint middle = ((x + u) / 2 - 1)^2 + ((y + w) / 2)^2 - 1;
    }
}

/// The cranks at an angle from straight down, and the speed.
fn place(angle: f64, speed: f64) -> ([f64; 5], [f64; 5]) {
    let (sine, cosine) = angle.sin_cos();
    ([sine, -cosine, 2.0 + sine, -cosine, 0.1], [cosine * speed, sine * speed, cosine * speed, sine * speed, 0.0])
}

#[test]
fn a_third_crank_changes_nothing() {
    let system = Parallelogram::default();
    let (q, v) = place(0.5, 1.0);
    let refused = system.at(0.0, q, v).integrate(Gauss::<2>, 0.02).err();
    let Some(StepError::Redundant { of: 4, rank: 3, .. }) = refused else { panic!("{refused:?}") };
    assert!(refused.expect("an error").to_string().contains("Independent::at"));

    let kept = Independent::at(system, 0.0, q).unwrap_or_else(|failure| panic!("{failure}"));
    let dropped: Vec<usize> = (0..4).filter(|r| kept.is_dropped(*r)).collect();
    assert_eq!(dropped.len(), 1, "{dropped:?}");
    let mut run = kept.at(0.0, q, v).integrate(Gauss::<3>, 0.02).unwrap_or_else(|failure| panic!("{failure}"));
    let mut two = TwoCranks::default().at(0.0, q, v).integrate(Gauss::<3>, 0.02).expect("independent");
    let mut angle = Angle::default().at(0.0, [0.5], [1.0]).integrate(Gauss::<6>, 0.02).expect("regular");
    let mut worst = [0.0_f64; 4];
    for _ in 0..500 {
        let state = run.step().unwrap_or_else(|failure| panic!("{failure}"));
        let other = two.step().unwrap_or_else(|failure| panic!("{failure}"));
        let exact = angle.step().unwrap_or_else(|failure| panic!("{failure}")).q[0];
        let measured = kept.dropped(&state).unwrap_or_else(|failure| panic!("{failure}"));
        let reaction = state.reaction(&kept).unwrap_or_else(|failure| panic!("{failure}"));
        assert!(reaction[dropped[0]].abs() <= 0.0);
        assert!(run.impulses().expect("a step").mu[dropped[0]].abs() <= 0.0);
        worst[0] = worst[0].max(measured[0].1.abs());
        worst[1] = worst[1].max((state.q - other.q).amax().max((state.p - other.p).amax()));
        worst[2] = worst[2].max((state.q[0] - exact.sin()).abs());
        // The weight and the acceleration of all masses: the force of all reactions.
        let force = state.reaction_force(&kept).expect("regular");
        let of_two = state.reaction_force(&TwoCranks::default()).expect("regular");
        worst[3] = worst[3].max((force - of_two).amax());
    }
    println!("{worst:?}");
    // Measured: 4.5e-16, 0, 2.7e-11 (the error of order 6), 0.
    assert!(worst[0] < 1e-15 && worst[1] < 1e-13 && worst[2] < 6e-11 && worst[3] < 1e-13, "{worst:?}");
}

#[test]
fn as_many_constraints_as_coordinates_may_move() {
    let system = Bars::default();
    let (q, v) = place(0.5, 1.0);
    let [q, v] = [q, v].map(|of| [of[0], of[1], of[2], of[3]]);
    let refused = system.at(0.0, q, v).integrate(Gauss::<2>, 0.02).err();
    assert_eq!(refused, Some(StepError::Redundant { constraint: "middle", of: 4, rank: 3 }));
    let kept = Independent::at(system, 0.0, q).unwrap_or_else(|failure| panic!("{failure}"));
    assert_eq!(kept.dropped_names().count(), 1);
    let mut run = kept.at(0.0, q, v).integrate(Gauss::<3>, 0.02).unwrap_or_else(|failure| panic!("{failure}"));
    let mut angle = Angle::default().at(0.0, [0.5], [1.0]).integrate(Gauss::<6>, 0.02).expect("regular");
    for _ in 0..200 {
        let state = run.step().unwrap_or_else(|failure| panic!("{failure}"));
        let exact = angle.step().unwrap_or_else(|failure| panic!("{failure}")).q[0];
        // As with the mass on a spring.
        assert!((state.q[0] - exact.sin()).abs() < 6e-11, "{}", state.q[0] - exact.sin());
        assert!(system.constraints(0.0, &state.q).iter().all(|value| value.abs() < 1e-14), "{state:?}");
    }
}

#[test]
fn dropped_constraints_are_measured() {
    let system = Parallelogram::default();
    let (q, v) = place(0.5, 1.0);
    let kept = Independent::at(system, 0.0, q).unwrap_or_else(|failure| panic!("{failure}"));
    // A crank of another length contradicts the others.
    let mut run = kept.at(0.0, q, v).integrate(Gauss::<1>, 0.02).expect("a start");
    let failure = run.set_parameters(|kept| {
        *vi_core::lagrangian::Parameters::parameter_mut(kept, "third").expect("a parameter") = 1.1;
    });
    assert!(
        matches!(failure, Err(StepError::DroppedConstraint { .. } | StepError::InconsistentStart { .. })),
        "{failure:?}"
    );
    // With all cranks in line the others are redundant too, and the linkage may leave the parallelogram. No step
    // crosses this place, and no state before is wrong.
    for speed in [6.0, 6.5, 7.0, 8.0] {
        let (q, v) = place(0.3, speed);
        let kept = Independent::at(system, 0.0, q).expect("a subset");
        let mut run = kept.at(0.0, q, v).integrate(Gauss::<2>, 0.01).expect("a start");
        for _ in 0..400 {
            match run.step() {
                Ok(state) => {
                    let values = system.constraints(0.0, &state.q);
                    assert!(values.iter().all(|value| value.abs() < 1e-13), "{speed}: {values:?}");
                }
                Err(failure) => {
                    let is_flat = matches!(
                        failure,
                        StepError::NotConverged { .. }
                            | StepError::Singular { .. }
                            | StepError::DroppedConstraint { .. }
                    );
                    assert!(is_flat && run.state().q[1].abs() < 0.1, "{speed}: {failure}");
                    break;
                }
            }
        }
        assert!(run.step().is_err(), "{speed}");
    }
}

#[test]
fn runs_with_dropped_constraints_have_the_rest() {
    // Twice the same rod, in different units.
    let kept = Independent::at(Auto(Twice), 0.0, [0.6, -0.8]).unwrap_or_else(|failure| panic!("{failure}"));
    assert!(!kept.is_dropped(0) && kept.is_dropped(1));
    let projected = State::projected(&kept, 0.0, [0.9, -1.2], [1.0, 0.5]).unwrap_or_else(|failure| panic!("{failure}"));
    assert!((projected.state.q[0] - 0.6).abs() < 4e-16, "{projected:?}");
    let held = Projection::of(&kept).holding(&[0]).expect("an index").assembled(0.0, [0.6, -1.2], [0.0, 0.0]);
    assert!((held.unwrap_or_else(|failure| panic!("{failure}")).state.q[1] + 0.8).abs() < 4e-16);
    let run = kept.at_state(projected.state).integrate(Gauss::<2>, 0.02).expect("a start");
    let mut tangent = Tangent::new(run, Variation::of_state());
    tangent.project().unwrap_or_else(|failure| panic!("{failure}"));
    for _ in 0..5 {
        tangent.step().unwrap_or_else(|failure| panic!("{failure}"));
    }
    let energy = tangent.run().energy().expect("regular");
    assert!((energy - projected.state.energy(&kept).expect("regular")).abs() < 1e-6, "{energy}");
    let all = Independent::at(Auto(Twice), 0.0, [f64::NAN, 0.0]);
    assert!(matches!(all, Err(StepError::NonFinite { .. })));
}

lagrangian! {
    /// Bricard's linkage of three symmetry planes, with twists of a right angle: six regular tetrahedra in a ring, joined
    /// along opposite edges. One is fixed; the ends of the four other hinges have masses.
    struct Bricard {
        param g = 1.0;
        coord x[4][2][3];
        let s = sqrt(2 / 3), c = sqrt(3) / 2;
        let first = [[s, 0, -1 / 2], [s, 0, 1 / 2]];
        let inner = s / 2 - 1 / 2, outer = s / 2 + 1 / 2;
        let second = [[inner / 2, c * inner, 0], [outer / 2, c * outer, 0]];
        L = sum(i in 0..4, sum(a in 0..2, dot(x[i][a]) * dot(x[i][a]) / 2 - g * x[i][a][2]));
        constraint hinge[i in 0..4] = (x[i][1] - x[i][0]) * (x[i][1] - x[i][0]) - 1;
        constraint near[a in 0..2] = (x[0][0] - second[a]) * (x[0][0] - second[a]) - 1;
        constraint far[a in 0..2] = (x[0][1] - second[a]) * (x[0][1] - second[a]) - 1;
        constraint low[i in 0..3][a in 0..2] = (x[i][a] - x[i + 1][0]) * (x[i][a] - x[i + 1][0]) - 1;
        constraint high[i in 0..3][a in 0..2] = (x[i][a] - x[i + 1][1]) * (x[i][a] - x[i + 1][1]) - 1;
        constraint left[a in 0..2] = (x[3][0] - first[a]) * (x[3][0] - first[a]) - 1;
        constraint right[a in 0..2] = (x[3][1] - first[a]) * (x[3][1] - first[a]) - 1;
    }
}

/// The ends of all hinges of a ring with threefold symmetry, whose hinges are upright and radial in turn.
fn ring() -> Vec<f64> {
    let s = (2.0_f64 / 3.0).sqrt();
    let hinge = |k: u8| {
        let (sine, cosine) = (f64::from(k) * core::f64::consts::FRAC_PI_3).sin_cos();
        [-0.5, 0.5].into_iter().flat_map(move |end| {
            let (radius, height) = if k.is_multiple_of(2) { (s, end) } else { (s / 2.0 + end, 0.0) };
            [radius * cosine, radius * sine, height]
        })
    };
    (0..6).flat_map(hinge).collect()
}

/// The cosines of the joint angles at the hinges, between the common perpendiculars on both sides.
fn joints(free: &[f64]) -> [f64; 6] {
    let all = [&ring()[..12], free].concat();
    let middle =
        |k: usize| SVector::<f64, 3>::from_fn(|i, _| f64::midpoint(all[6 * (k % 6) + i], all[6 * (k % 6) + 3 + i]));
    core::array::from_fn(|k| {
        let (before, after) = (middle(k) - middle(k + 5), middle(k + 1) - middle(k));
        before.dot(&after) / (before.norm() * after.norm())
    })
}

#[test]
fn bricards_linkage_moves() {
    let system = Bricard::default();
    let q = SVector::<f64, 24>::from_column_slice(&ring()[12..]);
    let kept = Independent::at(system, 0.0, q).unwrap_or_else(|failure| panic!("{failure}"));
    assert_eq!((system.constraints(0.0, &q).len(), kept.dropped_names().count()), (24, 1));
    let push = SVector::<f64, 24>::from_fn(|i, _| if i % 3 == 2 { 0.5 } else { 0.1 });
    let start = State::projected(&kept, 0.0, q, push).unwrap_or_else(|failure| panic!("{failure}")).state;
    let mut run = kept.at_state(start).integrate(Gauss::<3>, 0.02).unwrap_or_else(|failure| panic!("{failure}"));
    let before = run.energy().expect("regular");
    let [mut least, mut most] = [joints(start.q.as_slice())[0]; 2];
    let mut worst = [0.0_f64; 3];
    // At t = 5.12 the constraints that are kept at the start depend on each other.
    for _ in 0..240 {
        let state = run.step().unwrap_or_else(|failure| panic!("{failure}"));
        worst[0] =
            worst[0].max(system.constraints(0.0, &state.q).iter().fold(0.0, |most, value| most.max(value.abs())));
        worst[1] = worst[1].max((run.energy().expect("regular") - before).abs());
        // Its closure: Chen, You, Tarnai, Int. J. Solids and Structures 42 (2005) 2287.
        let cosines = joints(state.q.as_slice());
        for [one, other] in [[0, 1], [2, 3], [4, 5], [0, 3], [2, 5]] {
            let (one, other): (f64, f64) = (cosines[one], cosines[other]);
            worst[2] = worst[2].max((one + other + one * other).abs());
        }
        (least, most) = (least.min(cosines[0]), most.max(cosines[0]));
    }
    println!("{worst:?} {least} {most}");
    // Measured: 2.2e-15, 1.1e-13, 1.3e-15, and the whole range from -0.5 to 1.
    assert!(most - least > 1.4, "{least} {most}");
    assert!(worst[0] < 5e-15 && worst[1] < 3e-13 && worst[2] < 4e-15, "{worst:?}");
}

#[test]
fn redundant_constraints_are_chosen_where_all_hold() {
    let system = Bars::default();
    let ([x, y, u, w, _], _) = place(0.5, 1.0);
    // All four are independent there.
    let off = [x + 0.1, y - 0.1, u - 0.2, w + 0.1];
    let refused = Independent::at(system, 0.0, off).err();
    let Some(StepError::InconsistentStart { constraint: "left", residual, .. }) = refused else {
        panic!("{refused:?}")
    };
    assert!((residual - ((x + 0.1).powi(2) + (y - 0.1).powi(2) - 1.0)).abs() < 1e-15, "{residual}");
    let singular = State::projected(&system, 0.0, [x, y, u, w], [0.0; 4]).expect_err("redundant");
    assert!(singular.to_string().contains("Independent::at(system, t, q)"), "{singular}");
}

#[test]
fn redundant_mechanisms_are_projected_and_assembled() {
    let all = Independent::of(Bars::default());
    let ([x, y, u, w, _], [a, b, c, d, _]) = place(0.5, 1.0);
    let on = State::projected(&all, 0.0, [x, y, u, w], [a, b, c, d]).unwrap_or_else(|failure| panic!("{failure}"));
    assert!(on.moved_q.amax() < 1e-15 && on.moved_v.amax() < 1e-15, "{on:?}");
    // The same place as with the constraints that a run keeps.
    let kept = Independent::at(Bars::default(), 0.0, [x, y, u, w]).expect("a subset");
    for (far, change) in [(false, 1e-6), (false, 0.1), (true, 0.1), (true, 0.3)] {
        let q = [x + change, y - change, u - 2.0 * change, w + change];
        let find = if far { State::assembled } else { State::projected };
        let found = find(&all, 0.0, q, [a, b, c, d]).unwrap_or_else(|failure| panic!("{change}: {failure}"));
        let by_kept = State::projected(&kept, 0.0, q, [a, b, c, d]).expect("a state");
        assert!((found.state.q - by_kept.state.q).amax() < 1e-14, "{change}: {found:?} {by_kept:?}");
        assert!((found.moved_v - by_kept.moved_v).amax() < 1e-14, "{change}: {found:?} {by_kept:?}");
        let again = Independent::at(Bars::default(), 0.0, found.state.q).unwrap_or_else(|failure| panic!("{failure}"));
        assert_eq!(again.dropped_names().count(), 1);
        again.at_state(found.state).integrate(Gauss::<2>, 0.02).unwrap_or_else(|failure| panic!("{failure}"));
    }
    // Constraints that contradict the others have no such place.
    let contradicting = Independent::of(Parallelogram { third: 1.1, ..Parallelogram::default() });
    let refused = State::projected(&contradicting, 0.0, place(0.5, 1.0).0, [0.0; 5]);
    assert!(matches!(refused, Err(StepError::NotAssembled { .. } | StepError::Singular { .. })), "{refused:?}");

    let system = Bricard::default();
    let q = SVector::<f64, 24>::from_column_slice(&ring()[12..]);
    let near = q + SVector::<f64, 24>::from_fn(|i, _| if i % 2 == 0 { 0.01 } else { -0.02 });
    let found = State::projected(&Independent::of(system), 0.0, near, SVector::<f64, 24>::zeros());
    let found = found.unwrap_or_else(|failure| panic!("{failure}")).state;
    assert!(system.constraints(0.0, &found.q).iter().all(|value| value.abs() < 1e-14), "{found:?}");
    assert_eq!(Independent::at(system, 0.0, found.q).expect("a subset").dropped_names().count(), 1);
}

#[test]
fn dropped_constraints_leave_exponents() {
    let (q, v) = place(0.5, 1.0);
    let kept = Independent::at(Parallelogram::default(), 0.0, q).expect("a subset");
    let exponents = |kept: Result<Vec<f64>, StepError>| kept.unwrap_or_else(|failure| panic!("{failure}"));
    let all = kept.at(0.0, q, v).integrate(Gauss::<3>, 0.02).and_then(|run| {
        let mut lyapunov = Lyapunov::new(run, 4)?;
        lyapunov.advance(200)?;
        Ok(lyapunov.exponents())
    });
    let two = TwoCranks::default().at(0.0, q, v).integrate(Gauss::<3>, 0.02).and_then(|run| {
        let mut lyapunov = Lyapunov::new(run, 4)?;
        lyapunov.advance(200)?;
        Ok(lyapunov.exponents())
    });
    for (one, other) in exponents(all).iter().zip(exponents(two)) {
        assert!((one - other).abs() < 1e-12, "{one} {other}");
    }
    let run = kept.at(0.0, q, v).integrate(Gauss::<3>, 0.02).expect("a start");
    assert!(matches!(Lyapunov::new(run, 5), Err(StepError::InvalidInput { .. })));
}
