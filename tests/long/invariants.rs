//! Preserved quantities: the energy of the energy-preserving integrator, momenta of cyclic coordinates, angular
//! momentum; and the errors of other quantities against the table of `docs/mathematics.md`. Runs of a million steps.

use crate::support::exact::Trajectory;
use crate::support::reference::{file, number, vector};
use crate::support::scenes::{self, Scene};
use core::ops::RangeInclusive;
use serde_json::Value;
use vi_core::stepping::EnergyStepping;
use vi_core::{EnergyPreserving, FixedStep, Lagrangian, Run, Starts, State};
use vi_systems::{DampedOscillator, DoubleWell, Kepler};

const MILLION: u32 = 1_000_000;

/// A case of the double well: q0, h0, and the stated max |E − E1| of fixed steps and h_max/h0.
struct Case {
    q0: f64,
    h0: f64,
    fixed: f64,
    stretch: f64,
}

const CASES: [Case; 4] = [
    Case { q0: 0.74, h0: 0.01, fixed: 7.189e-9, stretch: 1.0657 },
    Case { q0: 0.74, h0: 0.1, fixed: 7.093e-7, stretch: 1.0655 },
    Case { q0: 0.995, h0: 0.01, fixed: 7.843e-6, stretch: 4.6260 },
    Case { q0: 0.995, h0: 0.1, fixed: 7.723e-4, stretch: 4.2895 },
];

/// The paper's start: the second node from the accurate motion.
fn papers_start<const N: usize, S: EnergyStepping<N> + Copy>(
    system: S,
    q0: [f64; N],
    v0: [f64; N],
    h0: f64,
) -> Run<EnergyPreserving, S, N> {
    let second = Trajectory::new(0.0, q0, v0).at(&system, h0);
    EnergyPreserving::from_points(system, (0.0, q0), (h0, second.q)).expect("a valid start")
}

/// The run of the reference with this start.
fn reference_run(q0: f64, h0: f64) -> Value {
    let runs = file("double_well.json");
    let runs = runs.as_array().expect("a list of runs");
    let run = runs.iter().find(|run| (number(&run["q0"]) - q0).abs() + (number(&run["h0"]) - h0).abs() < 1e-12);
    run.expect("a run of each case").clone()
}

#[test]
fn the_papers_start_is_that_of_the_reference() {
    for Case { q0, h0, .. } in CASES {
        let run = papers_start(DoubleWell::default(), [q0], [0.0], h0);
        let initial = &reference_run(q0, h0)["initial"];
        // A rounding of q1 is a rounding of p1 divided by h0.
        let errors = [
            run.state().t - number(&initial["t1"]),
            run.state().q[0] - number(&initial["q1"]),
            (run.state().p[0] - number(&initial["p1"])) * h0,
            run.node().energy - number(&initial["E1"]),
        ];
        // Measured: 5.1e-17.
        assert!(errors.iter().all(|error| error.abs() <= 2e-16), "{q0}, {h0}: {errors:?}");
    }
}

#[test]
fn the_double_well_keeps_its_energy_for_a_million_steps() {
    for Case { q0, h0, stretch, .. } in CASES {
        let initial = &reference_run(q0, h0)["initial"];
        let state = State {
            t: number(&initial["t1"]),
            q: vector::<1>(&initial["q1"]).into(),
            p: vector::<1>(&initial["p1"]).into(),
        };
        let e1 = number(&initial["E1"]);
        let v = vector::<1>(&initial["v_first"]);
        let mut run = EnergyPreserving::from_state(DoubleWell::default(), state, e1, h0, v).expect("a valid start");
        let (mut worst, mut longest) = (0.0_f64, 0.0_f64);
        for _ in 0..MILLION {
            let step = run.detailed_step().unwrap_or_else(|error| panic!("{q0}, {h0}: {error}"));
            let (t, q, v) = step.midpoint;
            worst = worst.max((run.system().energy(t, &q, &v) - e1).abs());
            longest = longest.max(step.h / h0);
        }
        println!("q0 = {q0}, h0 = {h0}: max |E - E1| = {worst:.1e}, h_max/h0 = {longest:.5}");
        // Measured: 1.2e-16, 5.6e-17, 2.1e-16, 1.5e-16.
        assert!(worst <= 5e-16, "{q0}, {h0}: {worst:e}");
        // Half a unit of the last digit stated.
        assert!((longest - stretch).abs() <= 0.5e-4, "{q0}, {h0}: {longest}");
    }
}

#[test]
fn the_energy_of_fixed_steps_oscillates_as_stated() {
    for Case { q0, h0, fixed, .. } in CASES {
        let start = papers_start(DoubleWell::default(), [q0], [0.0], h0);
        let mut run = DoubleWell::default().at_state(start.state()).integrate(FixedStep, h0).expect("a valid start");
        let mut worst = 0.0_f64;
        for _ in 0..MILLION {
            run.step().unwrap_or_else(|error| panic!("{q0}, {h0}: {error}"));
            worst = worst.max((run.discrete_energy().expect("a step was taken") - start.node().energy).abs());
        }
        println!("q0 = {q0}, h0 = {h0}: fixed steps, max |E - E1| = {worst:.4e}");
        // Half a unit of the last of four digits.
        let digit = 10_f64.powf(fixed.log10().floor() - 3.0);
        assert!((worst - fixed).abs() <= 0.5 * digit, "{q0}, {h0}: {worst:e}");
    }
}

#[test]
fn steps_of_the_damped_oscillator_grow_as_stated() {
    for (zeta, stretch) in [(0.001, 1.221), (0.005, 2.712), (0.01, 7.361)] {
        let system = DampedOscillator { c: 4.0 * zeta, ..DampedOscillator::default() };
        let mut run = papers_start(system, [1.0], [0.0], 0.01);
        let step = loop {
            let step = run.detailed_step().unwrap_or_else(|error| panic!("{zeta}: {error}"));
            if step.t >= 100.0 {
                break step;
            }
        };
        println!("zeta = {zeta}: h/h0 = {:.5} at t = {:.3}", step.h / 0.01, step.t);
        assert!((step.h / 0.01 - stretch).abs() <= 0.5e-3, "{zeta}: {}", step.h);
    }
}

/// Largest change of `x p_y − y p_x` along the states.
fn drift_of_angular_momentum(start: State<2>, states: impl Iterator<Item = State<2>>) -> f64 {
    let angular_momentum = |state: &State<2>| state.q[0] * state.p[1] - state.q[1] * state.p[0];
    let initial = angular_momentum(&start);
    states.fold(0.0, |worst: f64, state| worst.max((angular_momentum(&state) - initial).abs()))
}

#[test]
fn kepler_keeps_its_angular_momentum_for_a_million_steps() {
    let (q, v, h) = ([0.4, 0.0], [0.0, 2.0], 0.01);
    let start = State::at(&Kepler::default(), 0.0, q, v);
    let run = Kepler::default().at_state(start).integrate(FixedStep, h).expect("a valid start");
    let fixed = drift_of_angular_momentum(start, run.take(MILLION as usize).map(|state| state.expect("a step")));
    let run = EnergyPreserving::from_midpoint(Kepler::default(), 0.0, q, v, h).expect("a valid start");
    let states = run.clone().take(MILLION as usize).map(|state| state.expect("a step"));
    let energy_preserving = drift_of_angular_momentum(run.state(), states);
    println!("angular momentum drifts by {fixed:.1e} with fixed, {energy_preserving:.1e} with energy-preserving steps");
    // Measured: 1.3e-15, 2.4e-15.
    assert!(fixed <= 3e-15 && energy_preserving <= 5e-15, "{fixed:e}, {energy_preserving:e}");
}

/// The momentum `index` keeps every bit; the others, and its coordinate, change.
fn keeps_every_bit<const N: usize, S: EnergyStepping<N> + Copy>(scene: Scene<S, N>, index: usize) {
    const STEPS: RangeInclusive<u32> = 1..=200_000;
    let Scene { system, q, v, h, .. } = scene;
    assert_eq!(S::CYCLIC, core::array::from_fn(|coordinate| coordinate == index), "{}", S::NAME);
    let start = State::at(&system, 0.0, q, v);
    let mut fixed = system.at_state(start).integrate(FixedStep, h).expect("a valid start");
    let mut energy_preserving = EnergyPreserving::from_midpoint(system, 0.0, q, v, h).expect("a valid start");
    assert!(start.p[index].abs() > 0.1);
    assert_eq!(energy_preserving.state().p[index].to_bits(), start.p[index].to_bits(), "{}: the start", S::NAME);
    let mut moved = [false; N];
    for step in STEPS {
        let one = fixed.step().unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
        let other = energy_preserving.step().unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
        for state in [one, other] {
            assert_eq!(state.p[index].to_bits(), start.p[index].to_bits(), "{}: step {step}", S::NAME);
            for (coordinate, moved) in moved.iter_mut().enumerate() {
                *moved |= (state.p[coordinate] - start.p[coordinate]).abs() > 0.1;
            }
        }
    }
    assert_eq!(moved, core::array::from_fn(|coordinate| coordinate != index), "{}: nothing moved", S::NAME);
    assert!((fixed.state().q[index] - start.q[index]).abs() > 0.1);
}

#[test]
fn the_spherical_pendulum_keeps_every_bit_of_the_momentum_of_its_azimuth() {
    keeps_every_bit(scenes::spherical_pendulum(), 1);
}

#[test]
fn the_charged_particle_keeps_every_bit_of_its_canonical_momentum() {
    keeps_every_bit(scenes::charged_particle(), 1);
}
