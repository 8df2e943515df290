//! Events in long runs: many impacts, and random functions against their signs along the exact motion.

use core::f64::consts::SQRT_2;
use vi_core::run::{Event, Moment};
use vi_core::{Composition, FixedStep, Gauss, Lagrangian, Method, Run, SVector, Starts, State, StepError, lagrangian};

lagrangian! {
    /// A ball above the floor.
    struct Ball {
        param g = 1.0;
        coord z;
        L = dot(z)^2 / 2 - g * z;
        discretize midpoint;
    }
}

lagrangian! {
    /// Two bodies in free fall, or in free flight without g.
    struct Bodies {
        param g = 1.0;
        coord x, y;
        L = (dot(x)^2 + dot(y)^2) / 2 - g * (x + y);
        discretize midpoint;
    }
}

lagrangian! {
    /// A spring: x = cos t from (1, 0).
    struct Spring {
        coord x;
        L = dot(x)^2 / 2 - x^2 / 2;
        discretize midpoint;
    }
}

/// Uniform numbers of [0, 1).
fn uniform(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    #[allow(clippy::cast_precision_loss)]
    let number = (*seed >> 11) as f64;
    number / 9_007_199_254_740_992.0
}

/// The largest relative error of the times of many impacts.
fn worst_of_impacts<M: Method<S, 1>, S: Lagrangian<1> + Copy>(mut run: Run<M, S, 1>, floor: f64, impacts: u32) -> f64 {
    let event = Event::falling(move |s| s.q[0] - floor);
    let mut worst = 0.0_f64;
    for impact in 0..impacts {
        let hit = run.next_event(&event, 1e9).expect("the run goes on").expect("an impact");
        assert!((0.0..1e-14).contains(&(hit.state.q[0] - floor)), "{impact}: {:?}", hit.state);
        let exact = SQRT_2 * f64::from(2 * impact + 1);
        worst = worst.max((hit.state.t - exact).abs() / exact);
        run.set_state(State { p: -hit.state.p, ..hit.state }).expect("valid");
    }
    worst
}

/// Impacts at exact times, on two floors by three methods; a fifth as many by the last one.
fn impacts(count: u32, tolerance: f64) {
    let ball = Ball::default();
    for floor in [0.0, 1.0] {
        let start = State::at(&ball, 0.0, [1.0 + floor], [0.0]);
        let worst = [
            worst_of_impacts(ball.at_state(start).integrate(FixedStep, 0.3).expect("valid"), floor, count),
            worst_of_impacts(ball.at_state(start).integrate(Gauss::<3>, 1.7).expect("valid"), floor, count),
            worst_of_impacts(
                ball.at_state(start).integrate(Composition::SUZUKI_4, 1.7).expect("valid"),
                floor,
                count / 5,
            ),
        ];
        println!("floor {floor}: {worst:?}");
        assert!(worst.iter().all(|worst| *worst < tolerance), "{floor}: {worst:?}");
    }
}

/// Measured 7.2e-15.
#[test]
fn a_thousand_impacts() {
    impacts(1000, 1.5e-14);
}

/// Measured 1.8e-12: each impact rounds the time and the speed.
#[test]
#[ignore = "many steps: `.ci/run nightly`"]
fn a_hundred_thousand_impacts() {
    impacts(100_000, 4e-12);
}

/// Points that start in every fourth way hit the walls and corners until this time.
fn stay_in_a_box(until: f64, least: u32) {
    let free = Bodies { g: 0.0 };
    let mut seed = 5;
    let mut seen = 0;
    for trial in 0..40 {
        // Some repeatedly run into corners.
        let side = |seed: &mut u64| f64::from(trial % 4) * 0.25 + 2.0 * uniform(seed);
        let v = if trial % 2 == 0 { [1.0, 1.0] } else { [uniform(&mut seed), side(&mut seed)] };
        let walls = [
            Event::falling(|s| 1.0 - s.q[0]),
            Event::falling(|s| 1.0 - s.q[1]),
            Event::falling(|s| 1.0 + s.q[0]),
            Event::falling(|s| 1.0 + s.q[1]),
        ];
        let mut run = free.at(0.0, [0.0, 0.0], v).integrate(FixedStep, 0.4).expect("valid");
        let mut counts = [0; 2];
        while let Some(crossing) = run.next_event(&walls, until).expect("the run goes on") {
            let mut state = crossing.state;
            for met in &crossing.events {
                counts[met.event % 2] += 1;
                state.p[met.event % 2] *= -1.0;
            }
            assert!(state.q.amax() <= 1.0, "{state:?}");
            run.set_state(state).expect("valid");
            seen += 1;
        }
        for (count, v) in counts.iter().zip(v) {
            let exact = (0.5 * (v * until + 1.0)).floor();
            assert!((f64::from(*count) - exact).abs() < 0.5 || v < 1e-3, "{v}: {count} {exact}");
        }
    }
    println!("{seen} impacts");
    assert!(seen > least, "{seen}");
}

#[test]
fn a_point_in_a_box_stays_in_it() {
    stay_in_a_box(100.0, 1000);
}

#[test]
#[ignore = "many steps: `.ci/run nightly`"]
fn a_point_in_a_box_stays_in_it_for_long() {
    stay_in_a_box(1000.0, 10_000);
}

#[test]
fn two_balls_that_lose_speed_come_to_rest_above_the_floor() {
    let bodies = Bodies::default();
    let mut seed = 17;
    for _ in 0..200 {
        let restitution = [uniform(&mut seed), uniform(&mut seed).powi(8)].map(|e| 0.95 * e);
        let floor = [0.0, (4.0 * uniform(&mut seed)).floor() - 1.0];
        let start = State::at(&bodies, 0.0, [1.0 + floor[0], floor[1] + 0.5 + uniform(&mut seed)], [0.0, 0.3]);
        let mut run = bodies.at_state(start).integrate(Gauss::<4>, 0.1 + uniform(&mut seed)).expect("valid");
        let events = [0, 1].map(|i| Event::falling(move |s: &Moment<2>| s.q[i] - floor[i]));
        let mut impacts = 0;
        let error = loop {
            match run.next_event(&events, 1e3) {
                Ok(Some(crossing)) => {
                    let mut state = crossing.state;
                    for met in &crossing.events {
                        state.p[met.event] *= -restitution[met.event];
                    }
                    run.set_state(state).expect("valid");
                }
                Ok(None) => panic!("through the floor: {:?}", run.state()),
                Err(error) => break error,
            }
            impacts += 1;
            assert!(impacts < 5000, "endless: {restitution:?} {:?}", run.state());
        };
        let StepError::CannotLeave { t, event, .. } = error else { panic!("{error}") };
        let above = run.state().q - SVector::from(floor);
        assert!(
            t.to_bits() == run.t().to_bits() && above[event].abs() < 1e-15 && above.min() > -1e-15,
            "{restitution:?} {above}"
        );
    }
}

#[test]
fn random_functions_change_their_sign_where_events_say() {
    let spring = Spring::default();
    let start = State::at(&spring, 0.0, [1.0], [0.0]);
    let mut seed = 3;
    let mut seen = 0;
    let mut missed = 0;
    let mut worst = 0.0_f64;
    for _ in 0..300 {
        let [a, b, c, d] = [(); 4].map(|()| 2.0 * uniform(&mut seed) - 1.0);
        let g = move |t: f64, x: f64, v: f64| (4.0 * a * x + 2.0 * b * v + c * t + d).sin() + 0.5 * d * x;
        let h = 0.05 + 0.4 * uniform(&mut seed);
        let mut run = spring.at_state(start).integrate(Gauss::<8>, h).expect("valid");
        let event = Event::crossing(move |s: &Moment<1>| g(s.t, s.q[0], s.v[0]));
        let found: Vec<_> = run.events(&event, 20.0).map(|crossing| crossing.expect("the run goes on")).collect();
        // The exact motion, finely sampled.
        let exact = |t: f64| g(t, t.cos(), -t.sin());
        let changes = (1..40_000).filter(|&k| {
            let t = 20.0 * f64::from(k) / 40_000.0;
            (exact(t) >= 0.0) != (exact(t - 5e-4) >= 0.0)
        });
        let count = changes.count();
        seen += found.len();
        missed += count.abs_diff(found.len());
        for crossing in &found {
            let t = crossing.state.t;
            let rate = (exact(t + 1e-6) - exact(t - 1e-6)) / 2e-6;
            worst = worst.max(exact(t).abs() / (1.0 + rate.abs()));
        }
        // Signs alternate.
        assert!(found.windows(2).all(|pair| pair[0].direction(0) != pair[1].direction(0)), "{found:?}");
    }
    // Measured 2.8e-15; every change of sign was found.
    assert!(worst < 6e-15 && seen > 3000 && missed == 0, "{worst:e}, {seen} found, {missed} missed");
}
