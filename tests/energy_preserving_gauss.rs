//! Energy-preserving steps of order 2s: density, order, preserved quantities, existence, shift, failures.

use crate::gauss::{Everything, System};
use crate::support::assert_order_of;
use crate::support::exact::Trajectory;
use crate::support::reference::{file, number, vector};
use crate::support::scenes::{self, Scene};
use core::f64::consts::{FRAC_PI_2, TAU};
use vi_core::gauss::step_density;
use vi_core::real::Rounded;
use vi_core::state::StepKind;
use vi_core::stepping::EnergyStepping;
use vi_core::{
    EnergyPreserving, EnergyPreservingGauss, Fallback, Gauss, Lagrangian, Run, SVector, Starts, State, StepError,
    run::Checkpoint,
};
use vi_systems::{
    DampedOscillator, DoublePendulum, DoubleWell, HarmonicOscillator, HenonHeiles, Kepler, ParametricPendulum,
    Pendulum, SphericalPendulum,
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
) -> Run<EnergyPreservingGauss<S>, Y, N> {
    system.at(0.2, q, v).integrate(EnergyPreservingGauss, h).expect("a valid start")
}

/// Rounding bound of H at a state from running error analysis, in units of ε.
fn size_of_energy<const N: usize>(system: &impl System<N>, state: &State<N>) -> f64 {
    let q = state.q.map(Rounded::nearest);
    let v = state.velocity(system).expect("a velocity").map(Rounded::nearest);
    system.convert::<Rounded>().energy(Rounded::nearest(state.t), &q, &v).ulps()
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

/// With one stage it equals the emitted density.
fn emitted<const N: usize>(Scene { system, q, v, .. }: Scene<impl System<N> + EnergyStepping<N>, N>) {
    let state = State::at(&system, 0.2, q, v);
    let found = step_density::<_, N, 1>(&system, &state).expect("a density");
    let exact = system.step_density(0.2, &q.into(), &v.into()).expect("a density");
    // Measured: 1.7e-14, for a chain.
    assert!((found / exact - 1.0).abs() < 5e-14, "{}: {found}, not {exact}", name_of(&system));
}

mod one_stage_has_the_emitted_density {
    use crate::support::scenes::each_system;

    each_system!(super::emitted);
}

/// The density that follows from a short step equals the density at its midpoint.
fn density_of_short_step<const N: usize, const S: usize>(
    system: impl System<N>,
    (q, v): ([f64; N], [f64; N]),
    h: f64,
) -> f64 {
    let mut run = begin::<N, S, _>(system, (q, v), h);
    let before = run.state();
    run.step().expect("a step");
    let middle = system
        .at_state(before)
        .integrate(Gauss::<S>, 0.5 * run.h())
        .and_then(|mut half| half.step())
        .expect("half a step");
    let exact = step_density::<_, N, S>(&system, &middle).expect("a density");
    (run.density() / exact - 1.0).abs()
}

#[test]
fn a_step_tells_its_density() {
    let Scene { system, q, v, .. } = scenes::hard_duffing();
    let everything = (Everything::default(), ([0.6, 0.9], [0.4, -0.3]));
    let well = (DoubleWell { m: 1.3 }, ([0.8], [0.1]));
    // Ratio of the deviations for half the step.
    let cases = [
        density_of_short_step::<1, 1>(system, (q, v), 0.02) / density_of_short_step::<1, 1>(system, (q, v), 0.01),
        density_of_short_step::<1, 2>(system, (q, v), 0.1) / density_of_short_step::<1, 2>(system, (q, v), 0.05),
        density_of_short_step::<1, 3>(well.0, well.1, 0.1) / density_of_short_step::<1, 3>(well.0, well.1, 0.05),
        density_of_short_step::<2, 1>(everything.0, everything.1, 0.02)
            / density_of_short_step::<2, 1>(everything.0, everything.1, 0.01),
        density_of_short_step::<2, 2>(everything.0, everything.1, 0.1)
            / density_of_short_step::<2, 2>(everything.0, everything.1, 0.05),
    ];
    println!("{cases:?}");
    // Measured: 3.93 to 4.20.
    assert!(cases.iter().all(|ratio| (ratio - 4.0).abs() < 0.4), "{cases:?}");
}

// Order.

/// The slope of the error of S stages over a ladder of first steps, at the nodes of the steps.
fn order<const N: usize, const S: usize>(scene: &Scene<impl System<N>, N>, longest: f64, shift: f64) {
    let span = 8.0 * longest;
    let points: Vec<(f64, f64)> = [1.0, 1.3, 1.7, 2.2, 2.9, 3.7]
        .into_iter()
        .map(|part: f64| {
            let h = longest / part;
            let run = begin::<N, S, _>(scene.system, (scene.q, scene.v), h);
            let mut run = run.with_shift(shift).expect("a shift");
            let mut exact = Trajectory::new(0.2, scene.q, scene.v);
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
    assert_order_of(S, name_of(&scene.system), &points, 0.05);
}

#[test]
fn the_order_is_twice_the_number_of_stages() {
    order::<1, 2>(&scenes::double_well(), 0.1, 0.0);
    order::<1, 3>(&scenes::double_well(), 0.2, 0.0);
    order::<2, 2>(&scenes::kepler(), 0.04, 0.0);
    order::<2, 3>(&scenes::kepler(), 0.08, 0.0);
    order::<2, 2>(&scenes::spherical_pendulum(), 0.03, 0.0);
    order::<2, 3>(&scenes::henon_heiles(), 0.2, 0.0);
    // Forced and time-dependent; with a shift, since D_3 changes sign.
    order::<1, 2>(&scenes::hard_duffing(), 0.1, 0.0);
    order::<1, 2>(&scenes::hard_duffing(), 0.1, 150.0);
    order::<1, 3>(&scenes::hard_duffing(), 0.2, 2e3);
    order::<1, 2>(&scenes::parametric_pendulum(), 0.1, 0.0);
    order::<1, 3>(&scenes::parametric_pendulum(), 0.2, 50.0);
    let everything = Scene { system: Everything::default(), q: [0.6, 0.9], v: [0.4, -0.3], h: 0.05, span: 1.0 };
    order::<2, 2>(&everything, 0.1, 150.0);
    order::<2, 3>(&everything, 0.2, 3e3);
}

// The equations of a step.

/// Nodes c, weights b and matrix a of collocation at the S Gauss points, from their closed forms.
fn tableau<const S: usize>() -> ([f64; S], [f64; S], [[f64; S]; S]) {
    let (root, ten) = (3.0_f64.sqrt() / 6.0, 15.0_f64.sqrt());
    let c: &[f64] = match S {
        1 => &[0.5],
        2 => &[0.5 - root, 0.5 + root],
        _ => &[0.5 - ten / 10.0, 0.5, 0.5 + ten / 10.0],
    };
    let b: &[f64] = match S {
        1 => &[1.0],
        2 => &[0.5, 0.5],
        _ => &[5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0],
    };
    let a: &[f64] = match S {
        1 => &[0.5],
        2 => &[0.25, 0.25 - root, 0.25 + root, 0.25],
        _ => &[
            5.0 / 36.0,
            2.0 / 9.0 - ten / 15.0,
            5.0 / 36.0 - ten / 30.0,
            5.0 / 36.0 + ten / 24.0,
            2.0 / 9.0,
            5.0 / 36.0 - ten / 24.0,
            5.0 / 36.0 + ten / 30.0,
            2.0 / 9.0 + ten / 15.0,
            5.0 / 36.0,
        ],
    };
    let of = |index: usize, list: &[f64]| list[index];
    (
        core::array::from_fn(|i| of(i, c)),
        core::array::from_fn(|i| of(i, b)),
        core::array::from_fn(|i| core::array::from_fn(|j| of(i * S + j, a))),
    )
}

/// The step of length h from a state by the formulas, with simple fixed-point iteration of the stages: q1, p1, E0 and
/// E1.
fn by_the_formulas<const N: usize, const S: usize>(
    system: &impl System<N>,
    State { t, q, p }: State<N>,
    h: f64,
) -> (State<N>, [f64; 2]) {
    let (c, b, a) = tableau::<S>();
    let flow = |i: usize, q: &SVector<f64, N>, p: &SVector<f64, N>| system.flow(t + c[i] * h, q, p).expect("a flow");
    let mut flows: [_; S] = core::array::from_fn(|i| flow(i, &q, &p));
    let mut positions = [q; S];
    for _ in 0..100 {
        positions = core::array::from_fn(|i| q + (0..S).map(|j| flows[j].v * (h * a[i][j])).sum::<SVector<f64, N>>());
        let momenta: [_; S] =
            core::array::from_fn(|i| p + (0..S).map(|j| flows[j].force * (h * a[i][j])).sum::<SVector<f64, N>>());
        flows = core::array::from_fn(|i| flow(i, &positions[i], &momenta[i]));
    }
    let mut end = State { t: t + h, q, p };
    let mut energies = [0.0; 2];
    for i in 0..S {
        end.q += flows[i].v * (h * b[i]);
        end.p += flows[i].force * (h * b[i]);
        let energy = system.energy(t + c[i] * h, &positions[i], &flows[i].v);
        energies[0] += b[i] * (energy - h * (1.0 - c[i]) * flows[i].power);
        energies[1] += b[i] * (energy + h * c[i] * flows[i].power);
    }
    (end, energies)
}

/// Checks every step of a run against the formulas: its nodes, its initial and final energy.
fn satisfies<const N: usize, const S: usize>(system: impl System<N>, start: ([f64; N], [f64; N]), h: f64, shift: f64) {
    let mut run = begin::<N, S, _>(system, start, h).with_shift(shift).expect("a shift");
    let mut worst = [0.0_f64; 3];
    let mut preserved = run.shifted_energy();
    for _ in 0..200 {
        let before = run.state();
        let state = run.step().unwrap_or_else(|error| panic!("{}, {S} stages: {error}", name_of(&system)));
        let (end, [first, last]) = by_the_formulas::<N, S>(&system, before, run.h());
        let extra = power(S, run.h()) * shift;
        let scale = state.p.dot(&state.velocity(&system).expect("a velocity")).abs() + first.abs();
        let off = [
            (end.q - state.q).amax() / end.q.amax() + (end.p - state.p).amax() / end.p.amax(),
            (first - extra - preserved).abs() / scale,
            (last - extra - run.shifted_energy()).abs() / scale,
        ];
        worst = core::array::from_fn(|k| worst[k].max(off[k]));
        preserved = run.shifted_energy();
    }
    println!(
        "{}, {S} stages, shift {shift}: nodes off by {:.1e}, energies by {:.1e} and {:.1e}",
        name_of(&system),
        worst[0],
        worst[1],
        worst[2]
    );
    // Measured: 2.5e-14, for small momenta, and 9.8e-16.
    assert!(worst[0] < 4e-14 && worst[1] < 4e-15 && worst[2] < 4e-15, "{}: {worst:?}", name_of(&system));
}

#[test]
fn steps_satisfy_their_equations() {
    let Scene { system, q, v, .. } = scenes::double_well();
    satisfies::<1, 2>(system, (q, v), 0.1, 0.0);
    satisfies::<1, 3>(system, (q, v), 0.2, 0.0);
    let Scene { system, q, v, .. } = scenes::kepler();
    satisfies::<2, 1>(system, (q, v), 0.02, 0.0);
    satisfies::<2, 2>(system, (q, v), 0.04, 0.0);
    let Scene { system, q, v, .. } = scenes::hard_duffing();
    satisfies::<1, 2>(system, (q, v), 0.05, 0.0);
    satisfies::<1, 2>(system, (q, v), 0.05, 30.0);
    let Scene { system, q, v, .. } = scenes::parametric_pendulum();
    satisfies::<1, 2>(system, (q, v), 0.1, 8.0);
    let Scene { system, q, v, .. } = scenes::double_pendulum();
    satisfies::<2, 2>(system, (q, v), 0.02, 2e4);
    let everything = ([0.6, 0.9], [0.4, -0.3]);
    satisfies::<2, 1>(Everything::default(), everything, 0.05, 20.0);
    satisfies::<2, 2>(Everything::default(), everything, 0.1, 200.0);
    satisfies::<2, 3>(Everything::default(), everything, 0.2, 5000.0);
}

/// With one stage it is the energy-preserving integrator of one stage.
#[test]
fn one_stage_is_the_midpoint_rule_with_its_energy() {
    let Scene { system, q, v, h, .. } = scenes::kepler();
    let mut paper = EnergyPreserving::from_midpoint(system, 0.2, q, v, h).expect("a valid start");
    let (state, energy) = (paper.state(), paper.node().energy);
    let mut gauss = EnergyPreservingGauss::<1>::from_energy(system, state, energy, h).expect("a valid start");
    let mut worst = 0.0_f64;
    for _ in 0..200 {
        let (one, other) = (paper.step().expect("a step"), gauss.step().expect("a step"));
        worst = worst.max((one.q - other.q).amax()).max((one.p - other.p).amax()).max((one.t - other.t).abs());
    }
    println!("one stage: off by {worst:.1e}, last step {}", gauss.h());
    // The length of a step has a relative accuracy of 1e-12. Measured: 2.2e-11.
    assert!(worst < 1e-10, "{worst:e}");
}

// Preserved quantities.

/// The largest deviation of the discrete energy from its first value, with recomputed stages, relative to the largest
/// size of its terms.
fn energy_of_many<const N: usize, const S: usize>(
    system: impl System<N>,
    start: ([f64; N], [f64; N]),
    h: f64,
    count: u32,
) -> f64 {
    let mut run = begin::<N, S, _>(system, start, h);
    let preserved = run.discrete_energy().expect("an energy");
    let mut scale = 0.0_f64;
    let mut worst = 0.0_f64;
    for _ in 0..count {
        let before = run.state();
        run.step().unwrap_or_else(|error| panic!("{}: {error}", name_of(&system)));
        // A fixed step of that length has the same stages.
        let mut same = system.at_state(before).integrate(Gauss::<S>, run.h()).expect("a valid start");
        let state = same.step().expect("a step");
        scale = scale.max(size_of_energy(&system, &state));
        worst = worst.max((same.discrete_energy().expect("an energy") - preserved).abs());
    }
    println!(
        "{}, {S} stages: energy off by {:.1e} of {scale:.2}, {:.1e} relative",
        name_of(&system),
        worst,
        worst / scale
    );
    worst / scale
}

fn discrete_energies_are_kept(count: u32) {
    let well = energy_of_many::<1, 2>(DoubleWell { m: 1.3 }, ([0.8], [0.0]), 0.05, count);
    let pendulum = energy_of_many::<1, 2>(Pendulum { m: 1.0, l: 1.0, g: 1.0 }, ([1.0], [0.0]), 0.05, count);
    let kepler = energy_of_many::<2, 2>(Kepler { mu: 1.0 }, ([0.7, 0.0], [0.0, (1.3_f64 / 0.7).sqrt()]), 0.05, count);
    let henon = energy_of_many::<2, 2>(HenonHeiles { lambda: 1.0 }, ([0.3, -0.2], [0.1, 0.25]), 0.1, count);
    for off in [well, pendulum, kepler, henon] {
        // Measured: 1.0e-16.
        assert!(off <= 2e-16, "{off:e}");
    }
}

#[test]
fn the_discrete_energy_is_kept_to_rounding() {
    discrete_energies_are_kept(3000);
}

#[test]
#[ignore = "many steps: `.ci/run nightly`"]
fn the_discrete_energy_is_kept_to_rounding_for_long() {
    discrete_energies_are_kept(100_000);
}

#[test]
fn momenta_of_cyclic_coordinates_are_kept_bit_for_bit() {
    let Scene { system, q, v, .. } = scenes::spherical_pendulum();
    let cyclic = <SphericalPendulum as Lagrangian<2>>::CYCLIC.iter().position(|cyclic| *cyclic).expect("the azimuth");
    let run = begin::<2, 2, _>(system, (q, v), 0.03).with_shift_from(3.0).expect("a shift");
    let start = run.state();
    let end = run.take(10_000).last().expect("steps").expect("a step");
    assert_eq!(end.p[cyclic].to_bits(), start.p[cyclic].to_bits());
    assert!((end.p[1 - cyclic] - start.p[1 - cyclic]).abs() > 1e-3);
}

// The step law.

/// The largest deviation of `h (D_s + D_*)^(1/(2s+1))` from its first value, with D_s at the midpoint of each step,
/// over the time `span`.
fn law<const N: usize, const S: usize>(
    system: impl System<N>,
    start: ([f64; N], [f64; N]),
    h: f64,
    shift: f64,
    span: f64,
) -> f64 {
    let mut run = begin::<N, S, _>(system, start, h).with_shift(shift).expect("a shift");
    let exponent = 1.0 / f64::from(u32::try_from(2 * S + 1).expect("a few stages"));
    let mut first = None;
    let mut worst = 0.0_f64;
    let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
    while run.state().t < span {
        let before = run.state();
        run.step().unwrap_or_else(|error| panic!("{}: {error}", name_of(&system)));
        let middle = system.at_state(before).integrate(Gauss::<S>, 0.5 * run.h()).and_then(|mut half| half.step());
        let density = step_density::<_, N, S>(&system, &middle.expect("half a step")).expect("a density");
        let value = run.h() * (density + shift).abs().powf(exponent);
        worst = worst.max((value / *first.get_or_insert(value) - 1.0).abs());
        (shortest, longest) = (shortest.min(run.h()), longest.max(run.h()));
    }
    println!(
        "{}, {S} stages, h0 = {h}, shift {shift}: deviation {worst:.2e}, steps {shortest:.4} to {longest:.4}",
        name_of(&system)
    );
    assert!(longest > 1.05 * shortest, "{}: all steps alike", name_of(&system));
    worst
}

#[test]
fn the_step_law_holds_up_to_the_square_of_the_step() {
    let kepler = (Kepler { mu: 1.6 }, ([0.6, 0.1], [-0.2, 1.9]));
    let pendulum = (Pendulum { m: 1.4, l: 0.7, g: 9.81 }, ([1.2], [0.4]));
    let orders = [
        law::<2, 1>(kepler.0, kepler.1, 0.02, 0.0, 5.0) / law::<2, 1>(kepler.0, kepler.1, 0.01, 0.0, 5.0),
        law::<2, 2>(kepler.0, kepler.1, 0.04, 0.0, 5.0) / law::<2, 2>(kepler.0, kepler.1, 0.02, 0.0, 5.0),
        law::<2, 3>(kepler.0, kepler.1, 0.05, 0.0, 5.0) / law::<2, 3>(kepler.0, kepler.1, 0.025, 0.0, 5.0),
        law::<1, 2>(pendulum.0, pendulum.1, 0.04, 0.0, 5.0) / law::<1, 2>(pendulum.0, pendulum.1, 0.02, 0.0, 5.0),
        law::<1, 2>(pendulum.0, pendulum.1, 0.04, 1e4, 5.0) / law::<1, 2>(pendulum.0, pendulum.1, 0.02, 1e4, 5.0),
    ];
    // For a time-dependent system too.
    let timed = scenes::parametric_pendulum();
    let timed = [0.2, 0.1].map(|h| law::<1, 2>(timed.system, (timed.q, timed.v), h, 5.0, 20.0));
    let orders = [orders[0], orders[1], orders[2], orders[3], orders[4], timed[0] / timed[1]];
    println!("{orders:?}");
    // Measured: 3.85 to 4.58.
    assert!(orders.iter().all(|ratio| (ratio - 4.0).abs() < 0.8), "{orders:?}");
}

#[test]
fn steps_of_the_damped_oscillator_grow_and_end() {
    fn grows<const S: usize>(h: f64) {
        let (m, k, c) = (1.2, 3.4, 0.1);
        let system = DampedOscillator { m, k, c };
        let mut run = begin::<1, S, _>(system, ([0.8], [0.5]), h);
        let rate = c / (2.0 * m) / f64::from(u32::try_from(S).expect("a few stages"));
        let mut worst = 0.0_f64;
        let mut count = 0.0;
        let error = loop {
            let before = run.state().t;
            match run.step() {
                Ok(state) => {
                    count += 1.0;
                    let middle = 0.5 * (before + state.t) - 0.2;
                    if run.h() < 10.0 * h {
                        worst = worst.max((run.h() / (h * (rate * middle).exp()) - 1.0).abs());
                    }
                }
                Err(error) => break error,
            }
        };
        println!("{S} stages: off the law by {worst:.3}, {count} steps of {:.0}: {error}", 1.0 / (rate * h));
        assert!(worst < 0.05 && (count * rate * h - 1.0).abs() < 0.1, "{S} stages: {worst}, {count} steps");
    }
    grows::<1>(0.02);
    grows::<2>(0.05);
    grows::<3>(0.1);
}

// Existence of steps.

/// Runs from rest, or from the pericentre, over the time `span`; returns the error if it ends.
fn runs<const N: usize, const S: usize>(
    system: impl System<N>,
    start: ([f64; N], [f64; N]),
    h: f64,
    span: f64,
) -> Result<(), StepError> {
    let mut run = begin::<N, S, _>(system, start, h);
    while run.state().t < span {
        run.step()?;
    }
    Ok(())
}

/// A run exists one per cent below a threshold, and ends in a typed error one per cent above.
fn threshold(name: &str, limit: f64, run: impl Fn(f64) -> Result<(), StepError>) {
    let below = run(0.99 * limit);
    let above = run(1.01 * limit);
    println!("{name}: {below:?} below {limit:.4}, {above:?} above");
    below.unwrap_or_else(|error| panic!("{name} below {limit}: {error}"));
    let error = above.expect_err("no step beyond the threshold");
    assert!(matches!(error, StepError::NoForwardGaussStep { .. } | StepError::StepRatio { .. }), "{name}: {error}");
}

/// The amplitude, within an interval, at which the density of a motion first changes sign.
fn vanishing<const N: usize, const S: usize, Y: System<N>>(
    motion: impl Fn(f64) -> (Y, State<N>),
    [mut low, mut high]: [f64; 2],
    span: f64,
) -> f64 {
    let keeps_its_sign = |amplitude: f64| {
        let (system, start) = motion(amplitude);
        let of = |state: &State<N>| step_density::<_, N, S>(&system, state).expect("a density");
        let first = of(&start);
        let mut run = system.at_state(start).integrate(Gauss::<6>, span / 2000.0).expect("a valid start");
        (0..2000).all(|_| of(&run.step().expect("a step")) * first > 0.0)
    };
    assert!(keeps_its_sign(low) && !keeps_its_sign(high));
    for _ in 0..20 {
        let middle = 0.5 * (low + high);
        if keeps_its_sign(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[test]
fn steps_exist_up_to_the_threshold_of_each_order() {
    fn swing<const S: usize>(known: f64, h: f64) {
        let system = Pendulum { m: 1.0, l: 1.0, g: 1.0 };
        let motion = |angle: f64| (system, State::at(&system, 0.0, [angle], [0.0]));
        // At pi the period is infinite.
        let limit = vanishing::<1, S, _>(motion, [0.5, 2.5], 12.0);
        assert!((limit / known - 1.0).abs() < 0.005, "pendulum, {S} stages: {limit}");
        threshold(&format!("pendulum, {S} stages"), limit, |angle| runs::<1, S>(system, ([angle], [0.0]), h, 40.0));
    }
    fn orbit<const S: usize>(known: f64, h: f64) {
        let system = Kepler { mu: 1.0 };
        let start = |e: f64| ([1.0 - e, 0.0], [0.0, ((1.0 + e) / (1.0 - e)).sqrt()]);
        let motion = |e: f64| (system, State::at(&system, 0.0, start(e).0, start(e).1));
        let limit = vanishing::<2, S, _>(motion, [0.3, 0.9], TAU);
        assert!((limit / known - 1.0).abs() < 0.005, "Kepler, {S} stages: {limit}");
        threshold(&format!("Kepler, {S} stages"), limit, |e| runs::<2, S>(system, start(e), h, 40.0));
    }
    fn well<const S: usize>(known: f64, h: f64) {
        let system = DoubleWell { m: 1.0 };
        let motion = |q: f64| (system, State::at(&system, 0.0, [q], [0.0]));
        let limit = vanishing::<1, S, _>(motion, [0.8, 0.99999], 20.0);
        assert!((limit / known - 1.0).abs() < 0.005, "double well, {S} stages: {limit}");
        threshold(&format!("double well, {S} stages"), limit, |q| runs::<1, S>(system, ([q], [0.0]), h, 60.0));
    }
    swing::<2>(FRAC_PI_2, 0.02);
    swing::<3>(0.81, 0.05);
    orbit::<1>((5.0_f64 / 8.0).sqrt(), 0.002);
    orbit::<2>(2.0 / 3.0, 0.02);
    orbit::<3>(0.587, 0.008);
    well::<2>((5.0_f64 / 6.0).sqrt(), 0.02);
}

#[test]
fn steps_of_two_stages_exist_above_the_barrier() {
    let well = DoubleWell { m: 1.0 };
    for q in [1.05, 1.2, 2.0] {
        runs::<1, 2>(well, ([q], [0.0]), 0.03, 100.0).unwrap_or_else(|error| panic!("q0 = {q}: {error}"));
        let error = runs::<1, 1>(well, ([q], [0.0]), 0.03, 100.0).expect_err("no step of one stage");
        assert!(matches!(error, StepError::NoForwardGaussStep { .. } | StepError::StepRatio { .. }), "{error}");
    }
}

// The shift.

/// A run whose density changes sign, with twice the largest density of a first part as the shift. It continues over the
/// time `span`, preserves E', and the deviation of H follows the lengths of its steps.
fn shifted<const N: usize, const S: usize, Y: System<N>>(
    system: Y,
    start: ([f64; N], [f64; N]),
    h: f64,
    [period, span]: [f64; 2],
) {
    let name = name_of(&system);
    let plain = runs::<N, S>(system, start, h, span).expect_err("the density changes its sign");
    assert!(!matches!(plain, StepError::NonFinite { .. }), "{name}: {plain}");
    let mut run = begin::<N, S, _>(system, start, h).with_shift_from(period).expect("a shift");
    let shift = run.shift();
    let mut preserved = run.shifted_energy();
    let mut scale = 0.0_f64;
    let mut worst = 0.0_f64;
    let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
    let mut swing = [f64::INFINITY, f64::NEG_INFINITY];
    let mut total_swing = swing;
    let mut count = 0.0;
    while run.state().t < span {
        let before = run.state();
        let state = run.step().unwrap_or_else(|error| panic!("{name}, {S} stages, shift {shift:.3e}: {error}"));
        let mut same = system.at_state(before).integrate(Gauss::<S>, run.h()).expect("a valid start");
        same.step().expect("a step");
        let energy = same.discrete_energy().expect("an energy");
        // For a time-dependent system E' changes by the work of the integrator.
        if <Y as Lagrangian<N>>::AUTONOMOUS {
            assert_eq!(run.shifted_energy().to_bits(), preserved.to_bits());
        }
        preserved = run.shifted_energy();
        scale = scale.max(size_of_energy(&system, &state));
        worst = worst.max((energy - power(S, run.h()) * shift - preserved).abs());
        (shortest, longest) = (shortest.min(run.h()), longest.max(run.h()));
        swing = [swing[0].min(energy), swing[1].max(energy)];
        let total = state.energy(&system).expect("an energy");
        total_swing = [total_swing[0].min(total), total_swing[1].max(total)];
        count += 1.0;
    }
    let band = shift * (power(S, longest) - power(S, shortest));
    // H − E' = C_s h^2s (D_s + D_*) = constant/h.
    let total_band = power(S, run.h()) * (run.density() + shift) * run.h() * (1.0 / shortest - 1.0 / longest);
    println!(
        "{name}, {S} stages, D_* = {shift:.4}: {count} steps of {shortest:.4} to {longest:.4}, E' preserved to {:.1e}, E swings by {:.3e}, {band:.3e} expected, H by {:.3e}, {total_band:.3e} expected",
        worst / scale,
        swing[1] - swing[0],
        total_swing[1] - total_swing[0],
    );
    // Relative to the size of its terms. Measured: 3.6e-16.
    assert!(worst <= 5e-16 * scale, "{name}, {S} stages: {worst:e} of {scale}");
    assert!(longest <= 3.0 * shortest, "{name}: steps from {shortest} to {longest}");
    if <Y as Lagrangian<N>>::AUTONOMOUS {
        let ratio = (swing[1] - swing[0]) / band;
        let total_ratio = (total_swing[1] - total_swing[0]) / total_band;
        assert!((ratio - 1.0).abs() < 0.01 && (total_ratio - 1.0).abs() < 0.1, "{name}: {ratio}, {total_ratio}");
    }
}

#[test]
fn with_a_shift_steps_exist_where_the_density_changes_its_sign() {
    let well = DoubleWell { m: 1.0 };
    let pendulum = Pendulum { m: 1.0, l: 1.0, g: 1.0 };
    let double = DoublePendulum::default();
    let parametric = ParametricPendulum::default();
    let kepler = Kepler { mu: 1.0 };
    let orbit = ([0.1, 0.0], [0.0, 19.0_f64.sqrt()]);
    // Approximate periods: 4.4 above the barrier, 8.4 and 16.2 for librations, 2.9 for a rotation, 2π for the orbit.
    // The double pendulum is chaotic: its maximum over four units of time is not that over ten.
    shifted::<1, 1, _>(well, ([1.1], [0.0]), 0.02, [6.0, 60.0]);
    shifted::<1, 3, _>(well, ([1.005], [0.0]), 0.06, [12.0, 80.0]);
    shifted::<1, 2, _>(pendulum, ([2.0], [0.0]), 0.05, [8.4, 84.0]);
    shifted::<1, 2, _>(pendulum, ([3.0], [0.0]), 0.05, [16.2, 160.0]);
    shifted::<1, 3, _>(pendulum, ([2.0], [0.0]), 0.1, [8.4, 84.0]);
    shifted::<1, 1, _>(pendulum, ([0.0], [2.5]), 0.02, [2.9, 60.0]);
    shifted::<1, 2, _>(pendulum, ([0.0], [2.5]), 0.05, [2.9, 60.0]);
    shifted::<2, 1, _>(double, ([2.0, 2.0], [0.0, 0.0]), 0.005, [10.0, 12.0]);
    shifted::<2, 2, _>(double, ([2.0, 2.0], [0.0, 0.0]), 0.01, [10.0, 12.0]);
    shifted::<1, 1, _>(parametric, ([1.0], [0.0]), 0.02, [6.3, 63.0]);
    shifted::<1, 2, _>(parametric, ([1.0], [0.0]), 0.05, [6.3, 63.0]);
    shifted::<2, 1, _>(kepler, orbit, 0.001, [6.3, 20.0]);
    shifted::<2, 2, _>(kepler, orbit, 0.004, [6.3, 20.0]);
}

#[test]
fn a_large_shift_is_the_fixed_step() {
    let Scene { system, q, v, .. } = scenes::double_well();
    let mut run = begin::<1, 2, _>(system, (q, v), 0.03).with_shift(1e7).expect("a shift");
    let mut fixed = system.at(0.2, q, v).integrate(Gauss::<2>, 0.03).expect("a valid start");
    for _ in 0..100 {
        run.step().expect("a step");
        fixed.step().expect("a step");
    }
    let off = (run.state().q - fixed.state().q).amax().max((run.h() / 0.03 - 1.0).abs());
    println!("off by {off:.1e}");
    // The densities are about 20. Measured: 5.5e-6.
    assert!(off < 2e-5 && off > 1e-9, "{off:e}");
}

#[test]
fn a_shift_of_nothing_changes_nothing_and_one_can_be_taken_back() {
    let Scene { system, q, v, .. } = scenes::kepler();
    let plain = begin::<2, 2, _>(system, (q, v), 0.04);
    let zero = plain.clone().with_shift(0.0).expect("a shift");
    let back = plain.clone().with_shift(1e3).and_then(|run| run.with_shift(0.0)).expect("a shift");
    let mut runs = [plain, zero, back];
    for _ in 0..50 {
        let [plain, zero, back] = runs.each_mut().map(|run| run.step().expect("a step"));
        assert_eq!(plain, zero);
        assert!((plain.q - back.q).amax() < 1e-12);
    }
}

// Failures.

#[test]
fn a_density_that_changes_its_sign_is_a_typed_error_and_nothing_is_lost() {
    let system = Pendulum { m: 1.0, l: 1.0, g: 1.0 };
    let mut run = begin::<1, 2, _>(system, ([2.0], [0.0]), 0.05);
    let (state, error) = loop {
        let state = run.state();
        if let Err(error) = run.step() {
            break (state, error);
        }
    };
    println!("{error}");
    let StepError::NoForwardGaussStep { t, stages, largest, shift, .. } = error else { panic!("{error}") };
    assert_eq!((t, stages, shift), (state.t, 2, 0.0));
    assert_eq!(run.state(), state);
    assert_eq!(run.step().expect_err("the same error"), error);
    let message = error.to_string();
    assert!(message.contains(&format!("`with_shift({:.3e})`", 2.0 * largest)), "{message}");
    assert!(message.contains("s = 2") && message.contains("Fallback::FixedSteps"), "{message}");
    // Its advice works.
    let mut run = begin::<1, 2, _>(system, ([2.0], [0.0]), 0.05).with_shift(2.0 * largest).expect("a shift");
    while run.state().t < t + 1.0 {
        run.step().expect("a step with the shift");
    }
}

/// D_3 falls below zero for a shorter time than a step. Across it h changed for good, up to 1.2, with the energy kept.
#[test]
fn a_step_across_a_change_of_sign_is_a_typed_error() {
    let system = DoublePendulum { g: 9.81, ..DoublePendulum::default() };
    for (h, steps) in [(0.08, 16), (0.04, 34)] {
        let mut run = begin::<2, 3, _>(system, ([0.3, 0.2], [0.0; 2]), h);
        for _ in 0..steps {
            let state = run.step().expect("a step");
            assert!(run.h() < 2.0 * h && step_density::<_, 2, 3>(&system, &state).expect("a density") > 0.0);
        }
        let error = run.step().expect_err("a change of sign");
        let StepError::NoForwardGaussStep { density, excess, .. } = error else { panic!("{error}") };
        assert!(density < 0.0 && excess > 0.0, "{error}");
        assert_eq!(run.step().expect_err("the same error"), error);
        // D does change its sign within the next step, and has its sign again at the end.
        let mut motion = system.at_state(run.state()).integrate(Gauss::<6>, 0.002).expect("a start");
        let densities = (0..60).map(|_| step_density::<_, 2, 3>(&system, &motion.step().expect("a step")));
        let densities: Vec<f64> = densities.map(|density| density.expect("a density")).collect();
        assert!(densities.iter().any(|density| *density < 0.0), "{densities:?}");
        // Fixed steps lead across.
        let mut run = begin::<2, 3, _>(system, ([0.3, 0.2], [0.0; 2]), h).with_fallback(Fallback::FixedSteps);
        run.until(4.0).unwrap_or_else(|error| panic!("{error}"));
        assert!(run.switches().fixed_steps > 0 && run.switches().returns > 0, "{:?}", run.switches());
    }
}

#[test]
fn a_step_of_no_length_is_degenerate() {
    // In free motion every length is valid; for short steps rounding hides the energy difference.
    let system = HarmonicOscillator { m: 1.0, k: 1e-9 };
    let error = begin::<1, 2, _>(system, ([0.0], [1.0]), 0.1).step().expect_err("no length");
    assert!(matches!(error, StepError::DegenerateStep { .. }), "{error}");
    let well = DoubleWell { m: 1.0 };
    let error = begin::<1, 2, _>(well, ([0.8], [0.0]), 5e-4).step().expect_err("no length");
    assert!(matches!(error, StepError::DegenerateStep { .. }), "{error}");
    assert!(begin::<1, 2, _>(well, ([0.8], [0.0]), 1e-2).step().is_ok());
    // With a shift the length is determined.
    assert!(begin::<1, 2, _>(system, ([0.0], [1.0]), 0.1).with_shift(1.0).expect("a shift").step().is_ok());
}

#[test]
fn inputs_that_make_no_step_are_refused() {
    let system = Kepler { mu: 1.0 };
    let state = State::at(&system, 0.0, [1.0, 0.0], [0.0, 1.1]);
    let invalid = |error: StepError| assert!(matches!(error, StepError::InvalidInput { .. }), "{error}");
    for h in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        invalid(system.at_state(state).integrate(EnergyPreservingGauss::<2>, h).expect_err("no step"));
    }
    let run = system.at_state(state).integrate(EnergyPreservingGauss::<2>, 0.1).expect("a valid start");
    invalid(run.clone().with_shift(f64::NAN).expect_err("no shift"));
    invalid(run.clone().with_shift_from(-1.0).expect_err("no duration"));
    invalid(run.clone().with_shift_from(f64::INFINITY).expect_err("no duration"));
    invalid(run.clone().with_step_bounds(0.2, 0.1).expect_err("no bounds"));
    let error = EnergyPreservingGauss::<2>::from_energy(system, state, f64::NAN, 0.1).expect_err("no energy");
    assert!(matches!(error, StepError::NonFinite { .. }), "{error}");
    let centre = State::at(&system, 0.0, [0.0, 0.0], [1.0, 0.0]);
    let error = system.at_state(centre).integrate(EnergyPreservingGauss::<2>, 0.1).expect_err("no force at the centre");
    assert!(matches!(error, StepError::NonFinite { .. }), "{error}");
}

#[test]
fn an_energy_far_from_that_of_the_state_has_no_step_near() {
    let Scene { system, q, v, .. } = scenes::kepler();
    let state = State::at(&system, 0.0, q, v);
    let total = state.energy(&system).expect("an energy");
    let density = step_density::<_, 2, 2>(&system, &state).expect("a density");
    let begin = |h: f64, energy: f64| EnergyPreservingGauss::<2>::from_energy(system, state, energy, h);
    // The energy of a step of 0.04: found from half of it, not from a fifth.
    let energy = total - power(2, 0.04) * density;
    let mut near = begin(0.02, energy).expect("a valid start");
    near.step().expect("a step");
    println!("the first step has h = {}", near.h());
    assert!((near.h() / 0.04 - 1.0).abs() < 0.05, "h = {}", near.h());
    let error = begin(0.008, energy).and_then(|mut run| run.step()).expect_err("too far");
    assert!(matches!(error, StepError::StepRatio { .. }), "{error}");
    // Beyond H there is no step.
    let error = begin(0.04, total + 1e-3).and_then(|mut run| run.step()).expect_err("no step");
    assert!(matches!(error, StepError::NoForwardGaussStep { .. }), "{error}");
}

#[test]
fn bounds_are_kept() {
    let Scene { system, q, v, .. } = scenes::kepler();
    let bounded = |fallback| {
        let run = begin::<2, 2, _>(system, (q, v), 0.03).with_step_bounds(0.0, 0.05).expect("bounds");
        run.with_fallback(fallback)
    };
    let error = bounded(Fallback::Stop).find_map(Result::err).expect("a longer step");
    assert!(matches!(error, StepError::StepBounds { h_max: 0.05, .. }), "{error}");
    let mut run = bounded(Fallback::FixedSteps);
    let mut longest = 0.0_f64;
    while run.state().t < 20.0 {
        run.step().unwrap_or_else(|error| panic!("{error}"));
        longest = longest.max(run.h());
    }
    println!("{:?}", run.switches());
    assert!((longest - 0.05).abs() < 1e-12, "{longest}");
    assert!(run.switches().returns > 3 && run.switches().reseeds == 0, "{:?}", run.switches());
}

#[test]
fn with_the_fallback_a_run_goes_on_and_its_energy_comes_back() {
    let system = Pendulum { m: 1.0, l: 1.0, g: 1.0 };
    let mut run = begin::<1, 2, _>(system, ([2.0], [0.0]), 0.05).with_fallback(Fallback::FixedSteps);
    let preserved = run.discrete_energy().expect("an energy");
    let start = run.state().energy(&system).expect("an energy");
    let (mut worst, mut worst_kept) = (0.0_f64, 0.0_f64);
    while run.state().t < 200.0 {
        let state = run.step().unwrap_or_else(|error| panic!("{error}"));
        worst = worst.max((state.energy(&system).expect("an energy") - start).abs());
        if run.step_kind() == StepKind::EnergyPreserving {
            worst_kept = worst_kept.max((run.discrete_energy().expect("an energy") - preserved).abs());
        }
    }
    println!("H off by {worst:.1e}, E by {worst_kept:.1e}, {:?}", run.switches());
    assert!(run.switches().fixed_steps > 10 && run.switches().returns > 10, "{:?}", run.switches());
    assert!(worst < 1e-6 && worst_kept <= run.switches().energy_cost, "{worst:e}, {worst_kept:e}");
}

// Restarts.

/// Restarts after each step: the next steps must equal those of the uninterrupted run, up to its error.
fn resumes<Y: System<N>, const N: usize, const S: usize>(mut whole: Run<EnergyPreservingGauss<S>, Y, N>, count: u32) {
    let system = *whole.system();
    let mut resumed = whole.clone();
    for step in 0..count {
        let text = serde_json::to_string(&resumed.checkpoint()).expect("numbers");
        let stored: Checkpoint<_, N> = serde_json::from_str(&text).expect("the same numbers");
        resumed = Run::restart(system, EnergyPreservingGauss, stored).expect("a checkpoint of this system");
        let next = whole.step();
        let again = resumed.step();
        assert_eq!(format!("{next:?}"), format!("{again:?}"), "{}, step {step}", name_of(&system));
        assert_eq!(format!("{:?}", whole.checkpoint()), format!("{:?}", resumed.checkpoint()));
    }
}

#[test]
fn a_run_that_is_stored_goes_on_bit_for_bit() {
    let Scene { system, q, v, .. } = scenes::kepler();
    resumes(begin::<2, 2, _>(system, (q, v), 0.04), 100);
    let Scene { system, q, v, .. } = scenes::hard_duffing();
    resumes(begin::<1, 3, _>(system, (q, v), 0.1).with_shift_from(5.0).expect("a shift"), 100);
    let pendulum = Pendulum { m: 1.0, l: 1.0, g: 1.0 };
    // Through fixed steps, and to an error.
    resumes(begin::<1, 2, _>(pendulum, ([2.0], [0.0]), 0.05).with_fallback(Fallback::FixedSteps), 200);
    resumes(begin::<1, 2, _>(pendulum, ([2.0], [0.0]), 0.05), 50);
    let error = Run::restart(
        Pendulum { g: 2.0, ..pendulum },
        EnergyPreservingGauss::<2>,
        begin::<1, 2, _>(pendulum, ([1.0], [0.0]), 0.05).checkpoint(),
    );
    assert!(matches!(error, Err(StepError::OtherSystem { parameter: Some("g"), .. })));
}

// As one of several integrators.

#[test]
fn states_at_times_are_those_of_the_motion_and_the_energy_stays() {
    let Scene { system, q, v, .. } = scenes::kepler();
    let mut run = begin::<2, 3, _>(system, (q, v), 0.03);
    let preserved = run.shifted_energy();
    let mut worst = 0.0_f64;
    for k in 1..=20 {
        let t = 0.2 + 0.31 * f64::from(k);
        let state = run.until(t).expect("a state");
        let exact = Trajectory::new(0.2, q, v).at(&system, t);
        assert_eq!(state.t.to_bits(), t.to_bits());
        worst = worst.max((state.q - exact.q).amax());
    }
    println!("states at times off by {worst:.1e}");
    // Measured: 3.4e-9.
    assert!(worst < 1e-8 && run.shifted_energy().to_bits() == preserved.to_bits(), "{worst:e}");
}

#[test]
fn a_run_goes_on_with_what_a_change_brings() {
    let Scene { system, q, v, .. } = scenes::kepler();
    let mut run = begin::<2, 2, _>(system, (q, v), 0.04);
    run.by_ref().take(20).for_each(|step| {
        step.expect("a step");
    });
    let excess = |run: &Run<EnergyPreservingGauss<2>, Kepler, 2>| {
        run.energy().expect("an energy") - run.discrete_energy().expect("an energy")
    };
    let before = excess(&run);
    run.set_parameters(|system| system.mu *= 1.1).expect("other parameters");
    assert!((excess(&run) - before).abs() < 1e-14);
    run.step().expect("a step with other parameters");
    let before = excess(&run);
    let state = run.state();
    run.set_state(State { p: state.p * 1.02, ..state }).expect("another state");
    assert!((excess(&run) - before).abs() < 1e-14);
    let preserved = run.discrete_energy().expect("an energy");
    for _ in 0..100 {
        run.step().expect("a step from another state");
    }
    assert_eq!(run.discrete_energy().map(f64::to_bits), Some(preserved.to_bits()));
}

#[test]
fn parameters_whose_energy_is_beyond_the_numbers_change_nothing() {
    let mut run = begin::<1, 2, _>(Pendulum { m: 1.0, l: 1.0, g: 1.0 }, ([0.1], [0.0]), 0.1);
    run.set_parameters(|system| system.g = 1.7e308).expect("H = −m g l cos θ is finite");
    let before = format!("{run:?}");
    // So is this one, but not by the difference.
    let error = run.set_parameters(|system| system.g = -1.7e308).expect_err("too much energy");
    assert!(matches!(error, StepError::NonFinite { quantity: "energy", .. }), "{error}");
    assert_eq!(format!("{run:?}"), before);
    run.set_parameters(|system| system.g = 1.0).expect("the parameters of before");
    run.step().expect("a step as before");
}
