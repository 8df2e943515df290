//! Dead points: events where a run passes one between two nodes, while no step ends there; linkages that have two ways on.

use vi_core::run::Event;
use vi_core::{EnergyPreservingGauss, Gauss, Method, Starts, State, StepError, lagrangian};

lagrangian! {
    /// Three posts with two beams, as high as they are apart: all bars are in one line where the posts lie flat.
    struct Windows {
        coord a[2], b[2], c[2];
        let posts = (dot(a) * dot(a) + dot(b) * dot(b) + dot(c) * dot(c)) / 6;
        let beams = (dot(a) * dot(a) + dot(a) * dot(b) + 2 * dot(b) * dot(b) + dot(b) * dot(c) + dot(c) * dot(c)) / 6;
        L = posts + beams - 9.81 * (a[1] + 1.5 * b[1] + c[1]);
        constraint left = a * a - 1, middle = (b[0] - 1)^2 + b[1]^2 - 1, right = (c[0] - 2)^2 + c[1]^2 - 1;
        constraint over = (b - a) * (b - a) - 1, beside = (c - b) * (c - b) - 1;
    }
}

lagrangian! {
    /// All posts have the same angle.
    struct Posts {
        coord angle;
        L = 3 * dot(angle)^2 / 2 - 9.81 * 3.5 * cos(angle);
    }
}

#[test]
fn events_at_a_dead_point_are_found() {
    let mut posts = Posts::default().at(0.0, [0.0], [1.0]).integrate(Gauss::<6>, 0.01).expect("regular");
    let flat = Event::crossing(|m: &vi_core::run::Moment<1>| m.q[0].cos());
    let right: Vec<f64> = posts.events(flat, 10.0).map(|found| found.expect("an event").state.t).collect();
    for speed in [1.0, -1.0] {
        let h = 0.01 * speed;
        let start = Windows::default().at(0.0, [0.0, 1.0, 1.0, 1.0, 2.0, 1.0], [speed, 0.0, speed, 0.0, speed, 0.0]);
        let run = start.integrate(Gauss::<3>, h).expect("a start");
        let mut plain = run.clone();
        plain.until(10.0 * speed).unwrap_or_else(|failure| panic!("{failure}"));
        let mut searched = run.clone();
        // Two functions that change their signs at the dead point, and one that does so elsewhere.
        let height = |of: usize| Event::crossing(move |m: &vi_core::run::Moment<6>| m.q[of]);
        let events = [height(3), height(1), Event::crossing(|m| m.q[3] - 0.5)];
        let mut worst = [0.0_f64; 3];
        let (mut times, mut others) = (Vec::new(), 0);
        for found in searched.events(events, 10.0 * speed) {
            let found = found.unwrap_or_else(|failure| panic!("{failure}"));
            if found.is_of(2) {
                others += 1;
                continue;
            }
            if found.is_of(0) {
                assert_eq!(found.direction(0), Some(times.len() % 2 == 1));
                times.push(found.state.t * speed);
            }
            let gap = found.state.q[0].powi(2) + found.state.q[1].powi(2) - 1.0;
            worst[0] = worst[0].max(gap.abs());
            worst[1] = worst[1].max((found.v[1] - found.v[5]).abs()).max(found.v[0].abs());
        }
        assert_eq!((times.len(), others), (right.len(), right.len()));
        for (found, right) in times.iter().zip(&right) {
            worst[2] = worst[2].max((found - right).abs());
        }
        println!("{worst:?}");
        // Measured: 9.5e-9, 1.8e-6, 1.0e-8: the errors of the dense output.
        assert!(worst[0] < 1.5e-8 && worst[1] < 3e-6 && worst[2] < 1.5e-8, "{worst:?}");
        // The search keeps the steps of the run.
        assert_eq!(searched.state(), plain.state());
        // No run can stop there.
        let mut stopped = run.clone();
        let failure = stopped.next_event(height(3), 10.0 * speed).err();
        let Some(failure @ StepError::Singular { .. }) = failure else { panic!("{failure:?}") };
        assert!(failure.to_string().contains("the iterator `events`"), "{failure}");
        assert!(stopped.step().is_ok());
    }
}

lagrangian! {
    /// Two cranks of equal length at a bar as long as the distance of their pivots: a parallelogram, or an
    /// antiparallelogram, whose bars are in one line at the same places.
    struct Cranks {
        coord p[2], q[2];
        L = (dot(p) * dot(p) + dot(q) * dot(q)) / 2 - p[1] - q[1];
        constraint left = p * p - 1, right = (q[0] - 2)^2 + q[1]^2 - 1, bar = (q - p) * (q - p) - 4;
    }
}

/// A start with the left crank at an angle from the right, turning at a speed.
fn cranks(is_parallel: bool, angle: f64, speed: f64) -> Result<State<4>, StepError> {
    let [y, x] = angle.sin_cos().into();
    // The end of the right crank, or its mirror image at the diagonal from the left end to the right pivot.
    let [along, across] = [2.0 - x, -y];
    let part = if is_parallel { 0.0 } else { 4.0 * y / along.hypot(across).powi(2) };
    let q = [x, y, x + 2.0 + part * across, y - part * along];
    let turn = if is_parallel { 1.0 } else { 0.0 };
    let v = [-y, x, -y * turn, x * turn].map(|v| v * speed);
    State::projected(&Cranks::default(), 0.0, q, v).map(|found| found.state)
}

/// Runs into the dead points from both sides, and on both ways. Returns the height of the left crank and the error where
/// a run ends.
fn ends<M: Method<Cranks, 4> + Copy>(method: M, h: f64) -> Vec<(f64, StepError)> {
    let starts =
        [(1.2, -1.0), (-1.2, 1.0), (1.9, 1.0), (-1.9, -1.0), (0.001, -2.0), (core::f64::consts::PI - 0.0016, 0.5)];
    let mut ends = Vec::new();
    for (is_parallel, (angle, speed)) in [true, false].into_iter().flat_map(|way| starts.map(|start| (way, start))) {
        let start = cranks(is_parallel, angle, speed).unwrap_or_else(|failure| panic!("{failure}"));
        let mut run = match Cranks::default().at_state(start).integrate(method, h) {
            Ok(run) => run,
            Err(failure) => {
                ends.push((start.q[1], failure));
                continue;
            }
        };
        while run.t() < 3.0 {
            match run.step() {
                Ok(State { q, .. }) => {
                    // On the other way the right crank is off by at least 4/3 of the height of the left one.
                    let apart = (q[2] - q[0] - 2.0).hypot(q[3] - q[1]);
                    let is_kept = if is_parallel { apart < 1e-7 } else { apart > q[1].abs() };
                    assert!(is_kept, "{is_parallel}, {angle}, {speed}, {h}: {q}");
                }
                Err(failure) => {
                    ends.push((run.state().q[1], failure));
                    break;
                }
            }
        }
    }
    ends
}

#[test]
fn no_step_leaves_its_way_at_a_dead_point() {
    for h in [0.1, 0.03, 0.01] {
        for ends in [ends(Gauss::<1>, h), ends(Gauss::<2>, h), ends(Gauss::<3>, h), ends(Gauss::<4>, h)] {
            // The other four starts turn back before.
            assert_eq!(ends.len(), 8, "{ends:?}");
            for (y, failure) in ends {
                assert!(matches!(failure, StepError::Singular { .. }) && y.abs() < 4.0 * h, "{h}: {y}, {failure}");
                assert!(failure.to_string().contains("dead point"), "{failure}");
            }
        }
        // They may end before, for want of a step that keeps H.
        let preserving = [
            ends(EnergyPreservingGauss::<1>, h),
            ends(EnergyPreservingGauss::<2>, h),
            ends(EnergyPreservingGauss::<3>, h),
        ];
        for (_, failure) in preserving.iter().flatten() {
            let is_known = matches!(
                failure,
                StepError::Singular { .. }
                    | StepError::NoForwardGaussStep { .. }
                    | StepError::DegenerateStep { .. }
                    | StepError::StepRatio { .. }
            );
            assert!(is_known, "{h}: {failure}");
        }
    }
}

#[test]
fn no_motion_is_chosen_at_a_dead_point() {
    // Both velocities are admissible there, one for each way.
    for v in [[0.0, 1.0, 0.0, 1.0], [0.0, 1.0, 0.0, -1.0]] {
        let refused = Cranks::default().at(0.0, [1.0, 0.0, 3.0, 0.0], v).integrate(Gauss::<2>, 0.01).err();
        let Some(failure @ StepError::Redundant { of: 3, rank: 2, .. }) = refused else { panic!("{refused:?}") };
        assert!(failure.to_string().contains("several motions may begin"), "{failure}");
    }
    // Beside it one way is left, but rounding hides which.
    let refused =
        cranks(true, 1e-9, 1.0).and_then(|start| Cranks::default().at_state(start).integrate(Gauss::<2>, 0.01));
    let Some(failure) = refused.err() else { panic!("a run at a dead point") };
    assert!(failure.to_string().contains("several motions may begin"), "{failure}");
}
