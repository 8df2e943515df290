//! The order that is left where tables and conditions limit the smoothness of L.
//!
//! Errors of runs from several starts, so that knots and borders are at any place of a step. The slope is that of the
//! root mean square of the errors.

use crate::support::slope;
use vi_core::prelude::*;

macro_rules! well {
    ($name:ident: $($clauses:tt)*) => {
        lagrangian! {
            struct $name {
                param m = 1.3;
                coord x;
                $($clauses)*
                discretize midpoint;
            }
        }
    };
}

well!(Smooth: L = m * dot(x)^2 / 2 - x^4 / 2 - cos(x););
well!(Cubic:
    table V(x) = [(-2, 8), (-1.3, 2.4), (-0.7, 1.1), (-0.2, 0.9), (0.35, 1.0), (0.8, 1.3), (1.4, 2.9), (2.1, 9)];
    L = m * dot(x)^2 / 2 - V(x););
well!(Quintic:
    table V(x) = [(-2, 8), (-1.3, 2.4), (-0.7, 1.1), (-0.2, 0.9), (0.35, 1.0), (0.8, 1.3), (1.4, 2.9), (2.1, 9)] quintic;
    L = m * dot(x)^2 / 2 - V(x););
well!(Monotone:
    table V(x) = [(-2, 8), (-1.3, 2.4), (-0.7, 1.1), (-0.2, 0.9), (0.35, 1.0), (0.8, 1.3), (1.4, 2.9), (2.1, 9)] monotone;
    L = m * dot(x)^2 / 2 - V(x););
well!(Stop: L = m * dot(x)^2 / 2 - x^2 / 2 - 40 * max(x - 0.5, 0)^2 / 2;);
well!(LinearForce:
    table F(x) = [(-2, 3), (-1, 1), (0, 0), (1, -1), (2, -3)] linear;
    L = m * dot(x)^2 / 2;
    force x = F(x););
well!(Kink: L = m * dot(x)^2 / 2 - x^2 / 2 - 3 * max(x - 0.5, 0););

/// Time of a run.
const SPAN: f64 = 3.0;
/// Number of starts.
const STARTS: u32 = 12;
/// Steps of a reference run.
const ACCURATE: u32 = 6000;

/// The slope of the error over six halvings of the step, from `first` steps on.
macro_rules! order {
    ($system:ident, $method:expr, $first:expr) => {{
        let system = $system::default();
        let starts = (0..STARTS).map(|k| ([-0.9 + 0.14 * f64::from(k)], [0.9 - 0.026 * f64::from(k)]));
        let run = |q: [f64; 1], v: [f64; 1], steps: u32| {
            let mut run = system.at(0.0, q, v).integrate($method, SPAN / f64::from(steps)).expect("a start");
            (0..steps).map(|_| run.step()).last().expect("steps").expect("a step exists")
        };
        let exact: Vec<State<1>> = starts
            .clone()
            .map(|(q, v)| {
                let mut run = system.at(0.0, q, v).integrate(Gauss::<3>, SPAN / f64::from(ACCURATE)).expect("a start");
                (0..ACCURATE).map(|_| run.step()).last().expect("steps").expect("a step exists")
            })
            .collect();
        let points: Vec<(f64, f64)> = (0..6)
            .map(|halvings| {
                let steps = $first << halvings;
                let square = |((q, v), exact): (([f64; 1], [f64; 1]), &State<1>)| {
                    let state = run(q, v, steps);
                    (state.q - exact.q).norm_squared() + (state.p - exact.p).norm_squared()
                };
                let squares: f64 = starts.clone().zip(&exact).map(square).sum();
                (SPAN / f64::from(steps), (squares / f64::from(STARTS)).sqrt())
            })
            .collect();
        slope(concat!(stringify!($system), " by ", stringify!($method)), &points, 1e-13)
    }};
}

fn assert_near(slope: f64, wanted: f64, tolerance: f64) {
    assert!((slope - wanted).abs() <= tolerance, "slope {slope}, not {wanted}");
}

#[test]
fn fixed_steps_keep_order_two_down_to_one_continuous_derivative() {
    assert_near(order!(Smooth, FixedStep, 30_u32), 2.0, 0.01);
    assert_near(order!(Cubic, FixedStep, 30_u32), 2.0, 0.05);
    assert_near(order!(Quintic, FixedStep, 30_u32), 2.0, 0.05);
    assert_near(order!(Monotone, FixedStep, 30_u32), 2.0, 0.15);
    assert_near(order!(LinearForce, FixedStep, 30_u32), 2.0, 0.05);
    assert_near(order!(Stop, FixedStep, 60_u32), 2.0, 0.2);
}

#[test]
fn gauss_steps_have_one_order_more_than_continuous_derivatives() {
    assert_near(order!(Smooth, Gauss::<3>, 6_u32), 6.0, 0.1);
    assert_near(order!(Quintic, Gauss::<3>, 15_u32), 5.0, 0.6);
    assert_near(order!(Cubic, Gauss::<3>, 15_u32), 3.0, 0.4);
    assert_near(order!(Monotone, Gauss::<3>, 15_u32), 2.0, 0.4);
    assert_near(order!(LinearForce, Gauss::<3>, 15_u32), 2.0, 0.4);
    assert_near(order!(Stop, Gauss::<3>, 30_u32), 2.0, 0.4);
}

/// Where L has a kink the force jumps, and some steps have no solution: the run holds its last state, and shorter steps
/// go on from there.
#[test]
fn a_kink_ends_in_a_typed_error_or_in_order_one() {
    let system = Kink::default();
    let (mut errors, mut squares) = (0, [0.0; 5]);
    for start in 0..STARTS {
        let begin = system.at(0.0, [-0.9 + 0.14 * f64::from(start)], [0.9 - 0.026 * f64::from(start)]);
        let end = |steps: u32| {
            let mut run = begin.integrate(FixedStep, SPAN / f64::from(steps)).ok()?;
            while run.state().t < SPAN * (1.0 - 1e-9) {
                if let Err(error) = run.step() {
                    assert!(matches!(error, StepError::NotConverged { .. } | StepError::TooLong { .. }), "{error}");
                    assert!(run.state().q[0].is_finite() && run.step_of(0.37 * run.h()).is_ok(), "{error}");
                    return None;
                }
            }
            Some(run.state())
        };
        let Some(exact) = end(3 << 14) else { continue };
        for (level, square) in squares.iter_mut().enumerate() {
            match end(40 << level) {
                Some(state) => *square += (state.q - exact.q).norm_squared(),
                None => errors += 1,
            }
        }
    }
    let points: Vec<(f64, f64)> =
        (0_i32..).zip(squares).map(|(level, square)| (0.5_f64.powi(level), f64::sqrt(square))).collect();
    let slope = slope("Kink by FixedStep", &points, 1e-9);
    println!("{errors} runs end at the kink");
    assert_near(slope, 1.0, 0.3);
    assert!(errors > 0, "no run meets the kink");
}
