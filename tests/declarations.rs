//! The metadata of each system: name, coordinates, and the findings of the generator.

use crate::support::scenes::{self, Scene};
use vi_core::Lagrangian;
use vi_core::lagrangian::Parameters;
use vi_systems::HardDuffing;

/// The findings about a system.
#[derive(Debug, PartialEq)]
struct Declaration {
    name: &'static str,
    coordinates: Vec<&'static str>,
    parameters: Vec<&'static str>,
    autonomous: bool,
    forced: bool,
    cyclic: Vec<bool>,
}

fn of<const N: usize, S: Lagrangian<N> + Parameters>(_: &Scene<S, N>) -> Declaration {
    Declaration {
        name: S::NAME,
        coordinates: S::COORDINATES.to_vec(),
        parameters: S::PARAMETERS.to_vec(),
        autonomous: S::AUTONOMOUS,
        forced: S::FORCED,
        cyclic: S::CYCLIC.to_vec(),
    }
}

/// An autonomous system without force and without cyclic coordinate.
fn plain(name: &'static str, coordinates: &[&'static str], parameters: &[&'static str]) -> Declaration {
    Declaration {
        name,
        coordinates: coordinates.to_vec(),
        parameters: parameters.to_vec(),
        autonomous: true,
        forced: false,
        cyclic: vec![false; coordinates.len()],
    }
}

#[test]
fn each_system_has_its_metadata() {
    assert_eq!(of(&scenes::double_well()), plain("DoubleWell", &["q"], &["m"]));
    assert_eq!(of(&scenes::harmonic_oscillator()), plain("HarmonicOscillator", &["x"], &["m", "k"]));
    assert_eq!(of(&scenes::pendulum()), plain("Pendulum", &["θ"], &["m", "l", "g"]));
    assert_eq!(of(&scenes::rotating_hoop()), plain("RotatingHoop", &["θ"], &["m", "r", "Ω", "g"]));
    assert_eq!(of(&scenes::kepler()), plain("Kepler", &["x", "y"], &["mu"]));
    assert_eq!(of(&scenes::henon_heiles()), plain("HenonHeiles", &["x", "y"], &["lambda"]));
    let double_pendulum = plain("DoublePendulum", &["θ1", "θ2"], &["m1", "m2", "l1", "l2", "g"]);
    assert_eq!(of(&scenes::double_pendulum()), double_pendulum);
}

#[test]
fn forces_and_explicit_time_are_found() {
    let oscillator = plain("DampedOscillator", &["x"], &["m", "k", "c"]);
    assert_eq!(of(&scenes::damped_oscillator()), Declaration { forced: true, ..oscillator });
    let hard = plain("HardDuffing", &["x"], &["alpha", "beta", "c", "amplitude", "omega"]);
    assert_eq!(of(&scenes::hard_duffing()), Declaration { forced: true, autonomous: false, ..hard });
    let double_well = plain("DoubleWellDuffing", &["x"], &["c", "amplitude", "omega"]);
    assert_eq!(of(&scenes::double_well_duffing()), Declaration { forced: true, autonomous: false, ..double_well });
    let parametric = plain("ParametricPendulum", &["θ"], &["epsilon", "omega"]);
    assert_eq!(of(&scenes::parametric_pendulum()), Declaration { autonomous: false, ..parametric });
}

#[test]
fn cyclic_coordinates_are_found() {
    let pendulum = plain("SphericalPendulum", &["θ", "φ"], &["m", "l", "g"]);
    assert_eq!(of(&scenes::spherical_pendulum()), Declaration { cyclic: vec![false, true], ..pendulum });
    let particle = plain("ChargedParticle", &["x", "y", "z"], &["m", "e", "b", "s", "kappa"]);
    assert_eq!(of(&scenes::charged_particle()), Declaration { cyclic: vec![false, true, false], ..particle });
}

#[test]
fn every_parameter_can_be_read_and_set_by_name() {
    let mut system = scenes::hard_duffing().system;
    let wanted = HardDuffing { alpha: 0.1, beta: 0.2, c: 0.3, amplitude: 0.4, omega: 0.5 };
    for (name, value) in [("alpha", 0.1), ("beta", 0.2), ("c", 0.3), ("amplitude", 0.4), ("omega", 0.5)] {
        *system.parameter_mut(name).expect("a parameter") = value;
    }
    assert_eq!(system, wanted);
    assert_eq!(system.parameter_mut("x"), None);
    assert_eq!(system.parameter_mut("Alpha"), None);
}
