//! Steps from many nodes: their ends are those of runs, their Jacobians those of differences.

use vi_erased::shooting::{Ends, Shots};
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
