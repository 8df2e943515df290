//! Every predefined system starts with every method.

mod lost_motions;
mod studies;

use vi_core::StepError;
use vi_erased::plan::{DEFAULT_BOUND_ENERGY_STAGES, Method, PhasePoint, Plan, Shift};

#[test]
fn every_entry_starts_and_keeps_its_parameters() {
    for entry in vi_ready::systems() {
        let mut system = entry.system.copy();
        let name = system.name();
        // A list shows the data of an entry, without its system.
        assert_eq!((entry.name, &entry.coordinates), (name, &system.coordinates()));
        assert_eq!(entry.parameters, system.parameters(), "{name}");
        let size = entry.coordinates.len();
        assert_eq!((entry.q.len(), entry.v.len()), (size, size), "{name}");
        assert_eq!(entry.start.is_some(), system.has_constraints(), "{name}");
        let follows = entry.start.map(|start| start(&entry.parameters));
        assert!(follows.is_none_or(|of| of == [entry.q.clone(), entry.v.clone()]), "{name}");
        let methods: &[Method] = if system.has_constraints() {
            &[Method::Gauss, Method::Energy]
        } else if system.is_first_order() {
            &[Method::Gauss]
        } else {
            &[Method::Fixed, Method::KahanLi6, Method::Gauss, Method::Energy]
        };
        for &method in methods {
            let start = PhasePoint { t: 0.0, q: entry.q.clone(), v: entry.v.clone() };
            let mut plan = Plan::new(method, entry.h, start);
            if method == Method::Energy && system.has_constraints() {
                let shift = Some(Shift::Over(20.0 * entry.h));
                plan = Plan { stages: Some(DEFAULT_BOUND_ENERGY_STAGES), shift, ..plan };
            }
            let begun = system.begin(&plan);
            let mut run = begun.unwrap_or_else(|error| panic!("{name}: {error}"));
            let first = run.t();
            for _ in 0..10 {
                run.advance().unwrap_or_else(|error| panic!("{name}, {method:?}: {error}"));
            }
            assert!(run.t() > first && run.evaluations() > 0, "{name}");
        }
        for (parameter, value) in entry.parameters {
            assert!(system.set(parameter, value + 1.0), "{name}: {parameter}");
        }
        assert!(!system.set("no such parameter", 1.0));
    }
}

#[test]
fn starts_with_constraints_follow_the_parameters() {
    let entry = vi_ready::systems().into_iter().find(|entry| entry.name == "RodPendulum").expect("a system");
    let mut system = entry.system.copy();
    assert!(system.set("l", 0.5));
    let [q, v] = entry.start.expect("a start")(&system.parameters());
    assert!((q[0].hypot(q[1]) - 0.5).abs() < 1e-15, "{q:?}");
    // The start of the default parameters is off the constraint by g = 1 − 1/4.
    let plan = |q: &[f64]| Plan::new(Method::Gauss, 0.01, PhasePoint { t: 0.0, q: q.to_vec(), v: v.clone() });
    assert!(system.begin(&plan(&q)).is_ok());
    let refused = system.begin(&plan(&entry.q)).err();
    let is_off = matches!(refused, Some(StepError::InconsistentStart { constraint: "rod", residual, rate: 0.0 })
        if (residual - 0.75).abs() < 1e-15);
    assert!(is_off, "{refused:?}");
    let point = PhasePoint { t: 0.0, q: entry.q.clone(), v: vec![1.0, 0.0] };
    let found = system.project(&point).expect("a state on the constraints");
    // Half the way to the pivot, and without the part of the velocity along the rod.
    let (sin, cos) = 1.0_f64.sin_cos();
    let wanted = [0.5 * sin, -0.5 * cos, cos * cos, sin * cos];
    for (found, wanted) in found.point.q.iter().chain(&found.point.v).zip(wanted) {
        assert!((found - wanted).abs() < 1e-15, "{found} instead of {wanted}");
    }
    assert!(system.begin(&plan(&found.point.q)).is_ok());
}

#[test]
fn a_parallelogram_does_not_leave_its_way_at_a_dead_point() {
    let entry = vi_ready::systems().into_iter().find(|entry| entry.name == "FourBar").expect("a system");
    let mut system = entry.system.copy();
    // Opposite bars of equal length: at a height of zero an antiparallelogram begins, too.
    assert!(system.set("b", 3.0) && system.set("c", 1.0));
    let [q, v] = entry.start.expect("a start")(&system.parameters());
    let methods = [1, 2, 3, 4].map(|stages| (Method::Gauss, Some(stages)));
    for (method, stages) in methods.into_iter().chain([(Method::Adaptive, None), (Method::Energy, Some(2))]) {
        for (sign, h) in [1.0, -1.0].into_iter().flat_map(|sign| [(sign, 0.02), (sign, 0.005)]) {
            let start = PhasePoint { t: 0.0, q: q.clone(), v: v.iter().map(|v| sign * v).collect() };
            let plan = Plan { stages, ..Plan::new(method, h, start) };
            let mut run = system.begin(&plan).unwrap_or_else(|failure| panic!("{failure}"));
            let failure = loop {
                let q = run.q();
                let apart = (q[2] - q[0] - 3.0).abs() + (q[3] - q[1]).abs();
                assert!(apart < 1e-7 && run.t() < 1.0, "{method:?}, {stages:?}, {h}: {q:?}");
                if let Err(failure) = run.advance() {
                    break failure;
                }
            };
            let is_known = matches!(failure, StepError::Singular { .. })
                || method == Method::Energy && matches!(failure, StepError::NoForwardGaussStep { .. });
            assert!(is_known, "{method:?}, {stages:?}, {h}: {failure}");
        }
    }
}
