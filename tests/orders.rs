//! The accurate motion with which other tests compare, against 50 digits.

use crate::support::exact::Trajectory;
use crate::support::reference::{file, number};
use vi_core::Lagrangian;
use vi_systems::{DoublePendulum, HardDuffing, Kepler, Pendulum};

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
