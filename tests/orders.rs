//! Both integrators have order 2 on every system, including forced and time-dependent ones.
//!
//! Each node is compared with an accurate motion at its own time, because time is part of the solution of the
//! energy-preserving integrator. The order is the slope of log(error) over log(h), fitted over a ladder of steps.
//! Points near the rounding plateau are dropped; at least three must remain.

use crate::support::exact::Trajectory;
use crate::support::reference::{file, number};
use crate::support::scenes::{Scene, each_system};
use crate::support::slope;
use vi_core::stepping::EnergyStepping;
use vi_core::{EnergyPreserving, FixedStep, Lagrangian, Run, Starts, State, StepError};
use vi_systems::{DoublePendulum, HardDuffing, Kepler, Pendulum};

/// Number of steps of a run: powers of two times the steps of the scene.
const STEPS: u32 = 60;
/// Halvings of the step of the scene: the ladder.
const LADDER: core::ops::RangeInclusive<i32> = 1..=6;
/// Smaller errors of fixed steps are dropped. Their plateau: 1e-14.
const FIXED_PLATEAU: f64 = 1e-11;
/// Smaller errors of energy-preserving steps are dropped. Their plateau: 1e-10.
const ENERGY_PRESERVING_PLATEAU: f64 = 1e-8;

/// The largest difference in coordinates and momenta.
fn difference<const N: usize>(system: &impl Lagrangian<N>, state: &State<N>, exact: &Trajectory<N>) -> f64 {
    let p = system.momentum(exact.t, &exact.q, &exact.v);
    (state.q - exact.q).amax().max((state.p - p).amax())
}

/// Tolerance of the slopes around 2. Measured: 4e-4 with fixed steps, 9.0e-3 with energy-preserving ones.
const FROM_TWO: f64 = 0.02;

fn fixed_step<const N: usize, S: EnergyStepping<N> + Copy>(scene: Scene<S, N>) {
    let Scene { system, q, v, h, .. } = scene;
    let start = Trajectory::new(0.2, q, v);
    let span = h * f64::from(STEPS);
    let exact = start.at(&system, start.t + span);
    let points: Vec<(f64, f64)> = LADDER
        .map(|halvings| {
            let steps = STEPS << halvings;
            let h = span / f64::from(steps);
            let mut run = system.at(start.t, q, v).integrate(FixedStep, h).expect("a valid start");
            for _ in 0..steps {
                run.step().unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
            }
            (h, difference(&system, &run.state(), &exact))
        })
        .collect();
    let slope = slope(S::NAME, &points, FIXED_PLATEAU);
    assert!((slope - 2.0).abs() <= FROM_TWO, "{}: slope {slope}, {points:?}", S::NAME);
}

/// The energy-preserving integrator from one of its starts, given the start of the motion and h0.
fn energy_preserving<const N: usize, S: EnergyStepping<N> + Copy>(
    scene: &Scene<S, N>,
    begin: impl Fn(&S, &Trajectory<N>, f64) -> Result<Run<EnergyPreserving, S, N>, StepError>,
) {
    let start = Trajectory::new(0.2, scene.q, scene.v);
    let span = scene.h * f64::from(STEPS);
    assert!(span <= scene.span, "{}: a step has to exist all the time", S::NAME);
    let end = start.at(&scene.system, start.t + span);
    let points: Vec<(f64, f64)> = LADDER
        .map(|halvings| {
            let h0 = scene.h * 0.5_f64.powi(halvings);
            let mut run = begin(&scene.system, &start, h0).expect("a valid start");
            while run.state().t < end.t {
                run.step().unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
            }
            let state = run.state();
            (h0, difference(&scene.system, &state, &end.at(&scene.system, state.t)))
        })
        .collect();
    let slope = slope(S::NAME, &points, ENERGY_PRESERVING_PLATEAU);
    assert!((slope - 2.0).abs() <= FROM_TWO, "{}: slope {slope}, {points:?}", S::NAME);
}

fn from_midpoint<const N: usize, S: EnergyStepping<N> + Copy>(scene: Scene<S, N>) {
    energy_preserving(&scene, |system, start, h0| {
        EnergyPreserving::from_midpoint(*system, start.t, start.q, start.v, h0)
    });
}

fn from_points<const N: usize, S: EnergyStepping<N> + Copy>(scene: Scene<S, N>) {
    energy_preserving(&scene, |system, start, h0| {
        let second = start.at(system, start.t + h0);
        EnergyPreserving::from_points(*system, (start.t, start.q), (second.t, second.q))
    });
}

mod with_fixed_steps {
    super::each_system!(super::fixed_step);
}

mod energy_preserving_from_the_first_midpoint {
    super::each_system!(super::from_midpoint);
}

mod energy_preserving_from_two_points {
    super::each_system!(super::from_points);
}

/// The accurate motion against the states of a 50-digit reference.
fn accurate<const N: usize>(name: &str, system: impl Lagrangian<N>) {
    let file = file("continuous_reference.json");
    let numbers =
        |list: &serde_json::Value| -> Vec<f64> { list.as_array().expect("a list").iter().map(number).collect() };
    let vector = |list: &[f64]| vi_core::SVector::<f64, N>::from_column_slice(list);
    let (q, v) = (numbers(&file[name]["q0"]), numbers(&file[name]["v0"]));
    let mut motion = Trajectory::new(0.0, vector(&q), vector(&v));
    let mut worst = 0.0_f64;
    for entry in file[name]["states_qv"].as_array().expect("a list of states") {
        motion = motion.at(&system, number(&entry["t"]));
        let state = numbers(&entry["state"]);
        let (q, v) = state.split_at(N);
        worst = worst.max((motion.q - vector(q)).amax()).max((motion.v - vector(v)).amax());
    }
    println!("{name}: the accurate motion is off by {worst:.1e} at t = {}", motion.t);
    // Measured: 4.1e-14, 8.9e-15, 1.1e-11 (eight close passages), 4.1e-12.
    assert!(worst <= 3e-11, "{name}: off by {worst:e}");
}

#[test]
fn the_accurate_motion_is_accurate() {
    accurate::<1>("duffing_hard", HardDuffing::default());
    accurate::<1>("pendulum", Pendulum::default());
    accurate::<2>("kepler", Kepler::default());
    accurate::<2>("double_pendulum", DoublePendulum::default());
}
