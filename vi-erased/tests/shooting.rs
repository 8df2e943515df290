//! Steps from many nodes: their ends are those of runs, their derivatives those of differences and of closed forms.

use vi_core::prelude::*;
use vi_core::real::{Dual, Real};
use vi_erased::shooting::{Curvatures, Ends, Shots};
use vi_erased::{Method, PhasePoint, Plan, System, kind};
use vi_systems::{Kepler, ParametricPendulum, RodPendulum};

/// Two nodes of a pendulum whose gravity depends on the time.
const T: [f64; 2] = [0.3, 1.1];
const Q: [f64; 2] = [0.7, -0.4];
const P: [f64; 2] = [0.2, 0.9];
const H: [f64; 2] = [0.1, 0.25];

fn plan(method: Method) -> Plan {
    Plan::new(method, f64::NAN, PhasePoint { t: f64::NAN, q: Vec::new(), v: Vec::new() })
}

fn pendulum() -> Box<dyn System> {
    kind!(ParametricPendulum, { gauss 4 })
}

fn defaults(system: &dyn System, count: usize) -> Vec<f64> {
    let values: Vec<f64> = system.parameters().iter().map(|(_, value)| *value).collect();
    values.repeat(count)
}

#[test]
fn jacobians_are_those_of_differences() {
    let (system, plan) = (pendulum(), Plan { stages: Some(4), ..plan(Method::Gauss) });
    let (parameters, varied) = (defaults(&*system, 2), [1]);
    let count = system.parameters().len();
    for (steps, has_velocities) in [(1, false), (3, true), (0, true)] {
        let ends = |change: [f64; 5]| {
            let [q, p, u, h, t] = change;
            let mut parameters = parameters.clone();
            parameters.iter_mut().skip(varied[0]).step_by(count).for_each(|value| *value += u);
            let moved = |of: [f64; 2], by: f64| of.map(|value| value + by);
            let (t, q, p, h) = (moved(T, t), moved(Q, q), moved(P, p), moved(H, h));
            let shots = Shots { t: &t, q: &q, p: &p, h: &h, parameters: &parameters };
            shots.ends(&*system, &plan, &varied, steps, has_velocities)
        };
        let found = ends([0.0; 5]);
        assert!(found.errors.is_empty() && found.states.len() == 4 && found.jacobians.len() == 2 * 2 * 5);
        for column in 0..5 {
            let moved = |by: f64| ends(core::array::from_fn(|at| if at == column { by } else { 0.0 })).states;
            for (row, (above, below)) in moved(1e-5).iter().zip(moved(-1e-5)).enumerate() {
                let (difference, slope) = ((above - below) / 2e-5, found.jacobians[5 * row + column]);
                // Measured at most 5e-11.
                assert!((difference - slope).abs() < 1e-9, "{steps} {column} {row}: {difference} {slope}");
            }
        }
    }
}

#[test]
fn ends_have_the_bits_of_runs() {
    let (system, plan) = (pendulum(), Plan { stages: Some(4), ..plan(Method::Gauss) });
    let parameters = defaults(&*system, 2);
    let shots = Shots { t: &T, q: &Q, p: &P, h: &H, parameters: &parameters };
    let Ends { states, .. } = shots.ends(&*system, &plan, &[], 2, false);
    for index in 0..2 {
        let (q, p) = (vec![Q[index]], Some(vec![P[index]]));
        let mut run = system.begin(&Plan { h: H[index], t: T[index], q, p, ..plan.clone() }).expect("a start");
        run.advance_by(2).expect("steps");
        let found = [states[2 * index], states[2 * index + 1]];
        assert_eq!([run.q()[0], run.p()[0]].map(f64::to_bits), found.map(f64::to_bits));
    }
}

#[test]
fn a_failed_step_leaves_the_others() {
    let (system, plan) = (kind!(Kepler, { gauss 4 }), Plan { stages: Some(4), ..plan(Method::Gauss) });
    let parameters = defaults(&*system, 2);
    // The first planet is in the centre.
    let (q, p) = ([0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]);
    let shots = Shots { t: &[0.0; 2], q: &q, p: &p, h: &[0.1; 2], parameters: &parameters };
    let Ends { states, jacobians, errors } = shots.ends(&*system, &plan, &[], 1, false);
    assert!(matches!(errors[..], [(0, _)]), "{errors:?}");
    assert!(states[..4].iter().all(|number| number.is_nan()) && states[4..].iter().all(|number| number.is_finite()));
    assert_eq!((states.len(), jacobians.len()), (8, 2 * 4 * 6));
    assert!((states[4] - 0.1_f64.cos()).abs() < 1e-12 && (states[5] - 0.1_f64.sin()).abs() < 1e-12);
}

#[test]
fn steps_start_on_the_constraints() {
    let (system, plan) = (kind!(RodPendulum, { gauss 3 }), Plan { stages: Some(3), ..plan(Method::Gauss) });
    let parameters = defaults(&*system, 2);
    // The second node is off the rod, on its extension: the nearest state on it is the first node.
    let (q, p) = ([0.6, -0.8, 0.606, -0.808], [0.4, 0.3, 0.4, 0.3]);
    let shots = Shots { t: &[0.0; 2], q: &q, p: &p, h: &[0.1; 2], parameters: &parameters };
    let Ends { states, errors, .. } = shots.ends(&*system, &plan, &[], 1, true);
    assert!(errors.is_empty(), "{errors:?}");
    for end in states.chunks(4) {
        assert!((end[0].hypot(end[1]) - 1.0).abs() < 1e-14 && (end[0] * end[2] + end[1] * end[3]).abs() < 1e-14);
    }
    assert!(states[..2].iter().zip(&states[4..6]).all(|(on, off)| (on - off).abs() < 1e-3));
}

lagrangian! {
    /// An oscillator with a force.
    struct Driven {
        param k = 1.7;
        input u = 0.4;
        coord x;
        L = dot(x)^2 / 2 - k * x^2 / 2;
        force x = u;
    }
}

/// `0.3 x1 − 0.8 p1` after a midpoint step of this oscillator, with respect to x, p, k, u, h and t.
fn end_of_midpoint<T: Real>([x, p, k, u, h, _]: [T; 6]) -> T {
    let half = h / T::real(2.0);
    let v = (p + half * (u - k * x)) / (T::one() + half * half * k);
    T::real(0.3) * (x + h * v) - T::real(0.8) * (T::real(2.0) * v - p)
}

#[test]
fn curvatures_of_a_midpoint_step_are_its_closed_form() {
    let (system, plan) = (kind!(Driven, { gauss 1 }), Plan { stages: Some(1), ..plan(Method::Gauss) });
    let at = [0.6, -0.2, 1.9, 0.4, 0.3, 0.0];
    let [x, p, k, u, h, t] = at;
    let shots = Shots { t: &[t], q: &[x], p: &[p], h: &[h], parameters: &[k, u] };
    let Curvatures { values, errors } = shots.curvatures(&*system, &plan, &[0, 1], 1, false, &[0.3, -0.8]);
    assert!(errors.is_empty() && values.len() == 36, "{errors:?}");
    for row in 0..6 {
        for column in 0..6 {
            let number = |index: usize| Dual {
                value: Dual { value: at[index], slope: f64::from(u8::from(index == row)) },
                slope: Dual { value: f64::from(u8::from(index == column)), slope: 0.0 },
            };
            let exact = end_of_midpoint(core::array::from_fn(number)).slope.slope;
            // Measured at most 3e-16.
            let error = (values[6 * row + column] - exact).abs();
            assert!(error < 2e-15, "{row} {column}: {exact}, {error:e}");
        }
    }
}

lagrangian! {
    /// A body of variable mass on an arm, with forces of the time, the velocities and an input.
    struct Arm {
        param m = 1.3, c = 0.2;
        input u[2] = [0.4, -0.3];
        angle a;
        coord r;
        L = m * (dot(r)^2 + r^2 * dot(a)^2) / 2 * (1 + u[1] * sin(a) / 5) - r^2 * cos(2 * t) + m * cos(a) * r;
        force a = u[0] * r^2 - c * dot(a) * dot(r);
        force r = u[0]^2 * sin(t) - c * dot(r);
        discretize trapezoidal;
    }
}

/// q, p, the parameters, h and t of a node of the arm.
const NODE: [f64; 10] = [0.6, 1.2, 0.9, -0.3, 1.4, 0.2, 0.7, -0.2, 0.2, 0.35];

/// A node of these numbers.
fn shot(of: &[f64; 10]) -> Shots<'_> {
    Shots { q: &of[..2], p: &of[2..4], parameters: &of[4..8], h: &of[8..9], t: &of[9..] }
}

/// The largest error of the curvatures of the arm, relative to the largest one, against differences of Jacobians.
fn error_of_curvatures(plan: &Plan, steps: u64, has_velocities: bool) -> f64 {
    const BY: f64 = 1e-3;
    let (varied, weights) = ([0, 1, 2, 3], [0.7, -0.3, 1.1, 0.4]);
    let system = kind!(Arm, { fixed; gauss 1, 2, 4 });
    let gradient = |place: usize, by: f64| {
        let mut moved = NODE;
        moved[place] += by;
        let Ends { jacobians, errors, .. } = shot(&moved).ends(&*system, plan, &varied, steps, has_velocities);
        assert!(errors.is_empty(), "{errors:?}");
        core::array::from_fn::<_, 10, _>(|of| (0..4).map(|row| weights[row] * jacobians[10 * row + of]).sum::<f64>())
    };
    let Curvatures { values, errors } =
        shot(&NODE).curvatures(&*system, plan, &varied, steps, has_velocities, &weights);
    assert!(errors.is_empty() && values.len() == 100, "{errors:?}");
    let largest = |of: &[f64]| of.iter().fold(0.0, |largest: f64, entry| largest.max(entry.abs()));
    let mut errors = Vec::new();
    for row in 0..10 {
        let [far, near, below, under] = [2.0, 1.0, -1.0, -2.0].map(|times| gradient(row, times * BY));
        for column in 0..10 {
            assert_eq!(values[10 * row + column].to_bits(), values[10 * column + row].to_bits());
            let by_four = 8.0 * (near[column] - below[column]) - (far[column] - under[column]);
            errors.push(by_four / (12.0 * BY) - values[10 * row + column]);
        }
    }
    largest(&errors) / largest(&values)
}

#[test]
fn curvatures_are_those_of_differences() {
    for (method, stages) in [
        (Method::Fixed, None),
        (Method::Suzuki4, None),
        (Method::Gauss, Some(1)),
        (Method::Gauss, Some(2)),
        (Method::Gauss, Some(4)),
    ] {
        // Three steps are differences. Measured at most 1.4e-11 and 2.7e-9.
        for (steps, has_velocities, most) in [(1, false, 5e-11), (1, true, 5e-11), (0, true, 5e-11), (3, true, 1e-8)] {
            let error = error_of_curvatures(&Plan { stages, ..plan(method) }, steps, has_velocities);
            println!("{method:?} {stages:?}, {steps} steps: {error:.1e}");
            assert!(error < most, "{method:?} {stages:?}, {steps} steps: {error:e}");
        }
    }
}

#[test]
fn a_failed_curvature_leaves_the_others() {
    let (system, plan) = (kind!(Kepler, { gauss 4 }), Plan { stages: Some(4), ..plan(Method::Gauss) });
    let parameters = defaults(&*system, 2);
    let (q, p) = ([0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]);
    let shots = Shots { t: &[0.0; 2], q: &q, p: &p, h: &[0.1; 2], parameters: &parameters };
    let Curvatures { values, errors } = shots.curvatures(&*system, &plan, &[], 1, false, &[1.0; 8]);
    assert!(matches!(errors[..], [(0, _)]), "{errors:?}");
    assert!(values[..36].iter().all(|number| number.is_nan()) && values[36..].iter().all(|number| number.is_finite()));
    assert_eq!(values.len(), 72);
}
