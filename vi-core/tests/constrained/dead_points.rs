//! Events at a dead point: a run passes it between two nodes, while no step ends there.

use vi_core::run::Event;
use vi_core::{Gauss, Starts, StepError, lagrangian};

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
