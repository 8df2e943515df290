//! Systems whose L is linear in the velocities, compiled and as texts, and Hamiltonians without an L in closed form.

use serde_json::Value;
use std::path::Path;
use vi_core::SVector;
use vi_core::lagrangian;
use vi_core::prelude::*;
use vi_erased::plan::{Method, PhasePoint, Plan};
use vi_erased::{System, kind};
use vi_systems::{GuidingCentre, MasslessParticle, PointVortices};

lagrangian! {
    /// Predator and prey: the momentum of a is ln(b)/a.
    struct LotkaVolterra {
        param k = 0.9, l = 1.3;
        coord a, b;
        L = ln(b)/a*dot(a) - (a - k*ln(a) + b - l*ln(b));
        check { a = 1.1; b = 0.6; h = 0.1; }
    }
}

lagrangian! {
    /// Four vortices of a plane.
    struct Vortices {
        param s[4] = [1.0, 1.5, -0.7, 0.4];
        coord y[4], x[4];
        let r2[i in 0..4][j in 0..4] = (x[i] - x[j])^2 + (y[i] - y[j])^2;
        L = sum(i in 0..4, s[i]*x[i]*dot(y[i]))
            + sum(i in 0..4, sum(j in 0..i, s[i]*s[j]*ln(r2[i][j])))/(4*pi);
    }
}

const VORTICES: [f64; 8] = [0.1, 1.2, -0.9, 0.3, 0.4, -0.3, 0.7, 1.5];

fn tape(clauses: &str) -> vi_tape::System {
    vi_tape::System::parse(&format!("struct System {{ {clauses} }}")).unwrap_or_else(|error| panic!("{error}"))
}

fn plan(stages: usize, h: f64, q: &[f64]) -> Plan {
    let start = PhasePoint { t: 0.3, q: q.to_vec(), v: vec![0.0; q.len()] };
    Plan { stages: Some(stages), ..Plan::new(Method::Gauss, h, start) }
}

/// Coordinates and momenta after steps.
fn after(system: &dyn System, stages: usize, h: f64, steps: u64, q: &[f64]) -> Vec<f64> {
    let mut run = system.begin(&plan(stages, h, q)).unwrap_or_else(|error| panic!("{error}"));
    run.advance_by(steps).unwrap_or_else(|error| panic!("{stages} {h} {}: {error}", run.t()));
    [run.q().to_vec(), run.p().to_vec()].concat()
}

fn distance(left: &[f64], right: &[f64]) -> f64 {
    assert_eq!(left.len(), right.len());
    left.iter().zip(right).map(|(left, right)| (left - right).abs()).fold(0.0, f64::max)
}

#[test]
fn texts_take_the_steps_of_compiled_systems() {
    let predator = kind!(LotkaVolterra, { gauss 4, 8 });
    let vortices = kind!(Vortices, { gauss 4, 8 });
    for (compiled, q, h) in [(predator, &[1.1, 0.6][..], 0.2), (vortices, &VORTICES, 0.1)] {
        let tape = vi_tape::System::parse(compiled.definition()).unwrap_or_else(|error| panic!("{error}"));
        for stages in [4, 8] {
            let [one, other] = [&*compiled, &*tape].map(|system| after(system, stages, h, 50, q));
            assert_eq!(one, other, "{} {stages}", compiled.name());
            assert!(distance(&one[..q.len()], q) > 0.1);
        }
    }
}

/// The compiled system of a reference that has one.
fn ready(name: &str) -> Option<Box<dyn System>> {
    Some(match name {
        "vortices" => kind!(PointVortices, { gauss 1, 2, 4, 8 }),
        "lotka_volterra" => kind!(vi_systems::LotkaVolterra, { gauss 1, 2, 4, 8 }),
        "massless_particle" => kind!(MasslessParticle, { gauss 1, 2, 4, 8 }),
        "guiding_centre" => kind!(GuidingCentre, { gauss 1, 2, 4, 8 }),
        _ => return None,
    })
}

/// The largest difference of a system to its reference, relative to the size of the state, and the number of steps.
fn off(system: &dyn System, stages: &[usize], case: &Value, coordinates: &[&str]) -> (f64, u64) {
    let number = |of: &Value| of.as_str().and_then(|text| text.parse::<f64>().ok()).expect("a number");
    let list = |of: &Value| of.as_array().expect("a list").clone();
    let names = [list(&case["x"]), list(&case["y"])].concat();
    // x and y in the order of the system.
    let state = |of: &Value| {
        let values = [list(&of["x"]), list(&of["y"])].concat();
        let place = |name: &str| names.iter().position(|of| of == name).expect("a coordinate");
        coordinates.iter().map(|name| number(&values[place(name)])).collect::<Vec<_>>()
    };
    let start = PhasePoint { t: 0.0, q: state(&case["start"]), v: vec![0.0; coordinates.len()] };
    let (mut worst, mut taken) = (0.0_f64, 0);
    for stages in stages {
        let plan = Plan { stages: Some(*stages), ..Plan::new(Method::Gauss, number(&case["h"]), start.clone()) };
        let mut run = system.begin(&plan).unwrap_or_else(|error| panic!("{error}"));
        let mut done = 0;
        for node in list(&case["gauss"][stages.to_string()]) {
            let step = node["step"].as_u64().expect("a count");
            run.advance_by(step - done).unwrap_or_else(|error| panic!("{stages} {step}: {error}"));
            (taken, done) = (taken + step - done, step);
            let q = state(&node);
            let size = q.iter().fold(0.0, |most, q| f64::max(most, q.abs()));
            worst = worst.max(distance(&run.q(), &q) / size);
            // The momenta of y are zero.
            for (name, p) in list(&case["x"]).iter().zip(list(&node["p"])) {
                let index = coordinates.iter().position(|of| name == of).expect("a coordinate");
                worst = worst.max((run.p()[index] - number(&p)).abs() / size);
            }
        }
    }
    (worst, taken)
}

/// Values of 40 digits that two programs computed in different ways (`tests/reference/first_order.py`).
#[test]
fn steps_are_those_of_the_reference() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/reference/first_order.json");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let file: Value = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut steps = 0;
    for (name, case) in file.as_object().expect("systems") {
        let Some(text) = case["text"].as_str() else { continue };
        let tape = vi_tape::System::parse(text).unwrap_or_else(|error| panic!("{name}: {error}"));
        let coordinates = tape.coordinates();
        let mut found = vec![off(&*tape, &[4, 8], case, &coordinates)];
        if let Some(mut compiled) = ready(name) {
            for ((of, _), (_, value)) in compiled.parameters().into_iter().zip(tape.parameters()) {
                assert!(compiled.set(of, value));
            }
            found.push(off(&*compiled, &[1, 2, 4, 8], case, &coordinates));
        }
        for (off, taken) in found {
            // Measured: 3.3e-16.
            assert!(off < 2e-15, "{name}: {off:e}");
            steps += taken;
        }
    }
    assert_eq!(steps, 10 * (7 * 2 + 4 * 4));
}

/// A momentum in no square, a coupling of many, a function that is no polynomial: none has an L in closed form.
#[test]
fn hamiltonians_without_a_lagrangian_have_steps_in_coordinates_and_momenta() {
    for (clauses, names, q) in [
        ("coord x; momentum p of x; H = p^4/4 + x^2/2;", "x p", &[0.3, 0.8][..]),
        ("angle x; momentum l of x; H = cos(l) - sin(x)/2;", "x l", &[0.3, 0.8]),
        (
            "param a = 1.3; coord x, y; momentum p of x, l of y; H = p^2 + l*x*a + sin(y);",
            "x y p l",
            &[0.3, 0.8, 0.1, 0.2],
        ),
        (
            "coord x[3]; momentum p of x; H = p*p/2 + (p[0] + p[1])^4 + x*x/2; force x = -p/10;",
            "x[0] x[1] x[2] p[0] p[1] p[2]",
            &[0.3, 0.8, 0.1, 0.2, 0.4, -0.4],
        ),
    ] {
        let system = tape(clauses);
        assert_eq!(system.coordinates().join(" "), names);
        let exact = after(&*system, 8, 0.05, 32, q);
        let [one, other] = [0.4, 0.2].map(|h| distance(&after(&*system, 4, h, if h > 0.3 { 4 } else { 8 }, q), &exact));
        let slope = (one / other).log2();
        // Measured: 6.7 to 8.1.
        assert!(slope > 6.5 && other < 1e-7, "{clauses}: slope {slope}, off by {other:e}");
    }
}

/// `x' = b, y' = a x, p' = −a l`: collocation by two points and more is exact.
#[test]
fn a_hamiltonian_that_is_linear_in_its_momenta_has_the_motion_of_its_closed_form() {
    let system = tape("param a = 1.3, b = 0.7; coord x, y; momentum p of x, l of y; H = a*l*x + b*p;");
    let found = after(&*system, 4, 0.4, 5, &[0.3, 0.8, 0.1, 0.2]);
    let t = 2.0;
    let wanted = [0.3 + 0.7 * t, 0.8 + 1.3 * (0.3 * t + 0.7 * t * t / 2.0), 0.1 - 1.3 * 0.2 * t, 0.2];
    // Measured: 4.5e-16.
    assert!(distance(&found[..4], &wanted) < 2e-15, "{found:?} instead of {wanted:?}");
}

#[test]
fn steps_that_need_a_mass_matrix_are_refused() {
    let system = tape("coord a, b; L = a*dot(b) - a^2 - b^4 - a*b^2;");
    for wanted in [
        (Method::Fixed, None, false),
        (Method::Splitting4, None, false),
        (Method::Energy, None, false),
        (Method::Energy, Some(2), false),
        (Method::Adaptive, Some(4), false),
        (Method::KahanLi6, None, false),
    ] {
        assert_eq!(system.offers(wanted), Err(StepError::FirstOrder { system: "System" }), "{wanted:?}");
    }
    let compiled = LotkaVolterra::default().at(0.0, [1.1, 0.6], [0.0, 0.0]);
    let refused = StepError::FirstOrder { system: "LotkaVolterra" };
    assert_eq!(compiled.integrate(Gauss::<3>.adaptive(), 0.1).err(), Some(refused));
    assert_eq!(compiled.integrate(EnergyPreservingGauss::<2>, 0.1).err(), Some(refused));
    let mistakes = vi_tape::System::parse("struct System { coord a, b; L = a*dot(b) - a^2; discretize midpoint; }");
    let text = mistakes.err().map(|mistakes| mistakes.to_string()).unwrap_or_default();
    assert!(text.contains("a system of first order takes no `discretize`"), "{text}");
}

#[test]
fn momenta_follow_from_coordinates() -> Result<(), StepError> {
    let vortices = Vortices::default();
    let mut wrong = State::at(&vortices, 0.0, VORTICES, [0.0; 8]);
    wrong.p[2] += 1e-3;
    assert!(matches!(vortices.at_state(wrong).integrate(Gauss::<4>, 0.1), Err(StepError::InvalidInput { .. })));
    let mut run = vortices.at(0.0, VORTICES, [0.0; 8]).integrate(Gauss::<4>, 0.1)?;
    run.step()?;
    let before = run.state();
    run.set_parameters(|system| system.s[0] = 1.3)?;
    assert_eq!(run.state().q, before.q);
    assert!((run.state().p[0] - 1.3 * before.q[4]).abs() < 1e-15);
    run.step()?;
    assert!((run.state().p[0] - 1.3 * run.state().q[4]).abs() < 1e-15);
    // The velocities of a start are not used.
    let other = vortices.at(0.0, VORTICES, [7.0; 8]).integrate(Gauss::<4>, 0.1)?.step()?;
    assert_eq!(other, before);
    Ok(())
}

/// Small motions about the equilibrium (l, k) have the rates ±i √(k l).
#[test]
fn equilibria_have_the_rates_of_first_order() -> Result<(), StepError> {
    let predator = LotkaVolterra::default();
    let rest = predator.equilibrium(0.0, [1.2, 1.0])?;
    // H_a = 1 − k/a, H_b = 1 − l/b.
    assert!((rest.q - SVector::from([0.9, 1.3])).amax() < 1e-14, "{}", rest.q);
    let rates = rest.rates()?;
    let wanted = (0.9_f64 * 1.3).sqrt();
    assert_eq!(rates.len(), 2);
    for (rate, im) in rates.iter().zip([-wanted, wanted]) {
        assert!(rate.re.abs() < 1e-14 && (rate.im - im).abs() < 1e-14, "{rates:?}");
    }
    let refused = Err(StepError::FirstOrder { system: "LotkaVolterra" });
    assert_eq!(predator.linearization(0.0, [1.1, 0.6], [0.0; 2]).map(|of| of.value), refused);
    Ok(())
}

/// H stays within what it reaches in the first hundredth of the steps: no step adds to the errors of those before.
#[test]
fn energies_do_not_drift() -> Result<(), StepError> {
    let predator = LotkaVolterra::default();
    let mut run = predator.at(0.0, [1.1, 0.6], [0.0; 2]).integrate(Gauss::<3>, 0.5)?;
    let start = run.energy()?;
    let mut off = [0.0_f64; 2];
    for step in 0..20_000 {
        run.step()?;
        let place = usize::from(step >= 200);
        off[place] = off[place].max((run.energy()? - start).abs());
    }
    // Measured: 1.0.
    assert!(off[0] > 1e-9 && off[1] < 1.05 * off[0], "{off:?}");
    Ok(())
}

/// Linear and quadratic integrals in coordinates and momenta, and the momentum of a cyclic coordinate.
#[test]
fn integrals_are_preserved() -> Result<(), StepError> {
    let vortices = PointVortices::default();
    let integrals = |q: &SVector<f64, 8>| {
        let sum = |of: &dyn Fn(usize) -> f64| (0..4).map(|a| vortices.strength[a] * of(a)).sum::<f64>();
        [sum(&|a| q[a]), sum(&|a| q[a + 4]), sum(&|a| q[a] * q[a] + q[a + 4] * q[a + 4])]
    };
    let mut run = vortices.at(0.0, VORTICES, [0.0; 8]).integrate(Gauss::<2>, 0.2)?;
    let (before, energy, mut off) = (integrals(&run.state().q), run.energy()?, [0.0_f64; 4]);
    for _ in 0..2000 {
        run.step()?;
        for (off, (found, before)) in off.iter_mut().zip(integrals(&run.state().q).into_iter().zip(before)) {
            *off = off.max((found - before).abs());
        }
        off[3] = off[3].max((run.energy()? - energy).abs());
    }
    // Measured: at most 1.8e-15, and 4.3e-8 for the energy.
    assert!(off[..3].iter().all(|off| *off < 2e-14) && off[3] > 1e-9 && off[3] < 1e-6, "{off:?}");

    let mut run = GuidingCentre::default().at(0.0, [0.0, 0.0, 0.25, 0.005], [0.0; 4]).integrate(Gauss::<2>, 100.0)?;
    let (momentum, energy, mut off, mut least) = (run.state().p[1], run.energy()?, [0.0_f64; 2], 1.0_f64);
    for _ in 0..2000 {
        run.step()?;
        off[0] = off[0].max((run.state().p[1] / momentum - 1.0).abs());
        off[1] = off[1].max((run.energy()? / energy - 1.0).abs());
        least = least.min(run.state().q[3]);
    }
    // A banana orbit: the velocity along the field turns back.
    assert!(off[0] < 1e-14 && off[1] > 1e-9 && off[1] < 1e-5 && least < -0.002, "{off:?} {least}");
    Ok(())
}

/// Iterations leave the domain of ln: steps continue shorter ones.
#[test]
fn long_steps_continue_short_ones() -> Result<(), StepError> {
    let mut run = LotkaVolterra::default().at(0.0, [1.1, 0.6], [0.0; 2]).integrate(Gauss::<8>, 1.0)?;
    let start = run.energy()?;
    for _ in 0..100 {
        run.step()?;
        // Measured: 5e-9.
        assert!((run.energy()? - start).abs() < 2e-8, "{}: {:e}", run.t(), run.energy()? - start);
    }
    let mut run = LotkaVolterra::default().at(0.0, [1.1, 0.6], [0.0; 2]).integrate(Gauss::<4>, 4.0)?;
    assert!(matches!(run.step(), Err(StepError::NonFinite { .. })));
    Ok(())
}

#[test]
fn kicks_and_drifts_are_those_of_another_method() {
    let text = "param c = 1.1, k = 0.9;
        coord x, y;
        momentum p of x, r of y;
        H = c * sqrt(c^2 + p^2 + r^2) + p^2 * r^2 / 9 + k * x^4 / 4 + x^2 * y / 4 + y^4 / 2 + sin(1.7 * t) * x / 2;";
    let system = tape(text);
    let q = [0.75, -0.25, 0.5, 0.875];
    let end = after(&*system, 8, 0.05, 40, &q);
    for (method, order) in [(Method::Splitting4, 4), (Method::Splitting6, 6)] {
        let error = |steps: u32| {
            let plan = Plan { method, stages: None, ..plan(8, 2.0 / f64::from(steps), &q) };
            let mut run = system.begin(&plan).unwrap_or_else(|error| panic!("{error}"));
            run.advance_by(u64::from(steps)).unwrap_or_else(|error| panic!("{error}"));
            distance(&[run.q().to_vec(), run.p().to_vec()].concat(), &end)
        };
        let slope = (error(24) / error(32)).ln() / (32.0_f64 / 24.0).ln();
        assert!((slope - f64::from(order)).abs() < 0.4, "{order}: {slope}"); // within 0.2
    }
    // Friction, a product of p and x, and another gauge do not split.
    for text in [
        "coord x; momentum p of x; H = p^2 + p^4 / 4 + x^4 / 4; force x = -dot(x) / 5;",
        "coord x; momentum p of x; H = p^2 + p^4 * x^2 / 4;",
        "coord x, y; L = ln(y) / x * dot(x) - x - y;",
    ] {
        let refused = tape(text).begin(&Plan { method: Method::Splitting4, stages: None, ..plan(8, 0.1, &[0.5; 2]) });
        assert!(matches!(refused, Err(StepError::FirstOrder { .. })), "{text}: {:?}", refused.err());
    }
}
