//! Energy-preserving steps of order 2s: their density, their order, what they keep, where they exist, the shift, and where they fail.

use crate::gauss::{Everything, System};
use crate::support::exact::Motion;
use crate::support::reference::{file, number, vector};
use crate::support::scenes::{self, Scene};
use crate::support::slope;
use core::f64::consts::{FRAC_PI_2, TAU};
use vi_core::gauss::energy::{self, step_density};
use vi_core::state::Method;
use vi_core::{EnergyPreserving, EnergyPreservingGauss, Fallback, Gauss, Lagrangian, SVector, State, StepError};
use vi_systems::{
    DampedOscillator, DoublePendulum, DoubleWell, HardDuffing, HarmonicOscillator, HenonHeiles, Kepler,
    ParametricPendulum, Pendulum, SphericalPendulum,
};

/// `C_s = (s!)⁴/((2s)!)³`.
fn constant(stages: usize) -> f64 {
    let factorial = |n: usize| (1..=n).map(|k| f64::from(u32::try_from(k).expect("a small number"))).product::<f64>();
    factorial(stages).powi(4) / factorial(2 * stages).powi(3)
}

/// `C_s h^2s`.
fn power(stages: usize, h: f64) -> f64 {
    constant(stages) * h.powi(2 * i32::try_from(stages).expect("a few stages"))
}

fn begin<const N: usize, const S: usize, Y: System<N>>(
    system: Y,
    (q, v): ([f64; N], [f64; N]),
    h: f64,
) -> EnergyPreservingGauss<Y, N, S> {
    EnergyPreservingGauss::new(system, State::at(&system, 0.2, q, v), h).expect("a valid start")
}

fn name_of<const N: usize, S: Lagrangian<N>>(_: &S) -> &'static str {
    S::NAME
}

// The step density.

/// The densities of one system against references.
fn densities<const N: usize>(case: &str, system: impl System<N>) {
    let references = file("step_density.json");
    let entry = &references[case];
    let state = State::at(&system, number(&entry["t"]), vector(&entry["q"]), vector(&entry["v"]));
    let found = [
        step_density::<_, N, 1>(&system, &state),
        step_density::<_, N, 2>(&system, &state),
        step_density::<_, N, 3>(&system, &state),
    ];
    for (stages, found) in (1..).zip(found) {
        let exact = number(&entry[&format!("D{stages}")]);
        let found = found.expect("a density");
        let error = (found / exact - 1.0).abs();
        println!("{case}, {stages} stages: {found}, off by {error:.1e}");
        // Relative. Measured: 7.2e-15.
        assert!(error < 2e-14, "{case}, {stages} stages: {found}, not {exact}");
    }
}

#[test]
fn step_densities_are_those_of_the_references() {
    densities("hard_duffing", scenes::hard_duffing().system);
    densities("parametric_pendulum", scenes::parametric_pendulum().system);
    densities("kepler", scenes::kepler().system);
    densities("spherical_pendulum", scenes::spherical_pendulum().system);
    densities("everything", Everything::default());
}

#[test]
fn step_densities_of_one_degree_of_freedom_have_a_closed_form() {
    // V', V'', V''', V'''' of the double well and of the pendulum.
    let well = |q: f64| [2.0 * q.powi(3) - q, 6.0 * q * q - 1.0, 12.0 * q, 12.0];
    let pendulum = |q: f64| [q.sin(), q.cos(), -q.sin(), -q.cos()];
    let closed = |[d1, d2, d3, d4]: [f64; 4], v: f64| {
        3.0 * (d2 * v).powi(2) + 3.0 * d2 * d1 * d1 - 6.0 * d1 * d3 * v * v + d4 * v.powi(4)
    };
    for (q, v) in [(0.74, 0.0), (0.9, 0.4), (-1.3, 0.2), (0.1, -1.1)] {
        let state = State { t: 0.0, q: SVector::from([q]), p: SVector::from([v]) };
        let cases = [
            (step_density::<_, 1, 2>(&DoubleWell::default(), &state), closed(well(q), v)),
            (step_density::<_, 1, 2>(&Pendulum::default(), &state), closed(pendulum(q), v)),
        ];
        for (found, exact) in cases {
            let found = found.expect("a density");
            // Measured: 4.2e-16.
            assert!((found / exact - 1.0).abs() < 4e-15, "q = {q}, v = {v}: {found}, not {exact}");
        }
    }
}

/// With one stage it is the density that is emitted.
fn emitted<const N: usize>(Scene { system, q, v, .. }: Scene<impl System<N>, N>) {
    let state = State::at(&system, 0.2, q, v);
    let found = step_density::<_, N, 1>(&system, &state).expect("a density");
    let exact = system.step_density(0.2, &q.into(), &v.into()).expect("a density");
    // Measured: 1.7e-14, of a chain.
    assert!((found / exact - 1.0).abs() < 5e-14, "{}: {found}, not {exact}", name_of(&system));
}

mod one_stage_has_the_emitted_density {
    use crate::support::scenes::each_system;

    each_system!(super::emitted);
}

/// The density that a short step tells is that of its middle.
fn told<const N: usize, const S: usize>(system: impl System<N>, (q, v): ([f64; N], [f64; N]), h: f64) -> f64 {
    let mut run = begin::<N, S, _>(system, (q, v), h);
    let before = run.state();
    run.step().expect("a step");
    let middle =
        Gauss::<_, N, S>::new(system, before, 0.5 * run.h()).and_then(|mut half| half.step()).expect("half a step");
    let exact = step_density::<_, N, S>(&system, &middle).expect("a density");
    (run.density() / exact - 1.0).abs()
}

#[test]
fn a_step_tells_its_density() {
    let Scene { system, q, v, .. } = scenes::hard_duffing();
    let everything = (Everything::default(), ([0.6, 0.9], [0.4, -0.3]));
    // How many times less the deviation is with half the step.
    let cases = [
        told::<1, 1>(system, (q, v), 0.02) / told::<1, 1>(system, (q, v), 0.01),
        told::<1, 2>(system, (q, v), 0.1) / told::<1, 2>(system, (q, v), 0.05),
        told::<1, 3>(system, (q, v), 0.1) / told::<1, 3>(system, (q, v), 0.05),
        told::<2, 1>(everything.0, everything.1, 0.02) / told::<2, 1>(everything.0, everything.1, 0.01),
        told::<2, 2>(everything.0, everything.1, 0.1) / told::<2, 2>(everything.0, everything.1, 0.05),
    ];
    println!("{cases:?}");
    // Measured: 3.93 to 4.20.
    assert!(cases.iter().all(|ratio| (ratio - 4.0).abs() < 0.4), "{cases:?}");
}

// Order.

/// The slope of the error of S stages over a ladder of first steps, at the nodes that the steps reach.
fn order<const N: usize, const S: usize>(scene: &Scene<impl System<N>, N>, longest: f64, tolerance: f64) {
    let span = 8.0 * longest;
    let points: Vec<(f64, f64)> = [1.0, 1.3, 1.7, 2.2, 2.9, 3.7]
        .into_iter()
        .map(|part: f64| {
            let h = longest / part;
            let mut run = begin::<N, S, _>(scene.system, (scene.q, scene.v), h);
            let mut exact = Motion::new(0.2, scene.q, scene.v);
            let mut error = 0.0_f64;
            while run.state().t < 0.2 + span {
                let node = run.step().unwrap_or_else(|error| panic!("{}: {error}", name_of(&scene.system)));
                exact = exact.at(&scene.system, node.t);
                let p = scene.system.momentum(exact.t, &exact.q, &exact.v);
                error = error.max((node.q - exact.q).amax()).max((node.p - p).amax());
            }
            (h, error)
        })
        .collect();
    let name = name_of(&scene.system);
    let slope = slope(&format!("{name}, {S} stages"), &points, 1e-13);
    let expected = f64::from(2 * u32::try_from(S).expect("a few stages"));
    assert!((slope - expected).abs() <= tolerance * expected, "{name}, {S} stages: slope {slope}, {points:?}");
}

#[test]
fn the_order_is_twice_the_number_of_stages() {
    order::<1, 2>(&scenes::double_well(), 0.1, 0.05);
    order::<1, 3>(&scenes::double_well(), 0.2, 0.05);
    order::<2, 2>(&scenes::kepler(), 0.04, 0.05);
    order::<2, 3>(&scenes::kepler(), 0.08, 0.05);
    order::<2, 2>(&scenes::spherical_pendulum(), 0.03, 0.05);
    order::<2, 3>(&scenes::henon_heiles(), 0.2, 0.05);
    // Forced.
    order::<1, 2>(&scenes::hard_duffing(), 0.1, 0.05);
    order::<1, 3>(&scenes::hard_duffing(), 0.2, 0.05);
    // Depending on the time.
    order::<1, 2>(&scenes::parametric_pendulum(), 0.1, 0.05);
    order::<1, 3>(&scenes::parametric_pendulum(), 0.1, 0.05);
    let everything = Scene { system: Everything::default(), q: [0.6, 0.9], v: [0.4, -0.3], h: 0.05, span: 1.0 };
    order::<2, 2>(&everything, 0.05, 0.05);
}
