//! What the generator says it found is what the numbers show, for every ready system.
//!
//! The Jacobian A of the momentum equation is evaluated at generic states: where it is said to be free of v or of the node,
//! it does not change with them, bit for bit; where it is said to depend on them, it does. The same for its symmetry, its
//! zeros, and the mass matrix, whose change shows in that of p with v.

use std::fs;
use std::path::Path;
use vi_codegen::found::{Dependence, Findings, Pattern};
use vi_codegen::inspect::source;
use vi_codegen::{derive, syntax::parse};
use vi_core::linear::Matrix;
use vi_core::nalgebra::SMatrix;
use vi_core::node::Node;
use vi_core::stepping::FixedStepping;
use vi_core::{SVector, State};

/// The findings of a ready system.
fn findings(file: &str) -> Findings {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(file).with_extension("rs");
    let text = fs::read_to_string(path).expect("the declaration");
    let tokens = source::declarations(&text).expect("Rust").remove(0);
    derive(&parse::system(tokens).expect("a system")).expect("a right system").own.findings
}

/// A vector without any symmetry.
fn generic<const N: usize>(seed: f64) -> SVector<f64, N> {
    SVector::from_fn(|i, _| {
        let i = f64::from(u8::try_from(i).unwrap_or(0));
        (0.7 * seed + 0.31 + 1.9 * i).sin() + 0.1 * i
    })
}

/// A at a node with the coordinates and the time of a seed.
fn jacobian<S: FixedStepping<N>, const N: usize>(system: &S, node: f64, h: f64, v: f64) -> SMatrix<f64, N, N> {
    let state = State { t: node, q: generic(node), p: generic(node + 2.0) };
    system.momentum_equation(&Node::new(state, 0.3), h, &generic(v)).jacobian.dense()
}

fn check<S: FixedStepping<N> + Default, const N: usize>(file: &str) -> Findings {
    let (system, found) = (S::default(), findings(file));
    let steps = found.steps.as_ref().expect("a rule");
    let of = |node, h, v| jacobian(&system, node, h, v);
    let a = of(1.0, 0.1, 3.0);
    assert_eq!((found.autonomous, found.forced), (S::AUTONOMOUS, S::FORCED), "{file}");
    let cyclic: Vec<usize> = (0..N).filter(|index| S::CYCLIC[*index]).collect();
    assert_eq!(found.cyclic, cyclic, "{file}");
    assert_eq!(steps.jacobian >= Dependence::Unknown, a != of(1.0, 0.1, 4.0), "{file}: depends on v");
    if steps.jacobian < Dependence::Node {
        assert_eq!(a, of(2.0, 0.1, 4.0), "{file}: does not depend on the node");
    }
    assert_eq!(steps.jacobian >= Dependence::Step, a != of(1.0, 0.2, 3.0), "{file}: depends on h");
    assert_eq!(steps.symmetric, a == a.transpose(), "{file}: symmetric");
    let filled = |i: usize, j: usize| a[(i, j)] != 0.0 || a[(j, i)] != 0.0;
    match &steps.pattern {
        Pattern::Scalar => assert_eq!(N, 1, "{file}"),
        Pattern::Blocks(blocks) => {
            let block = |index: usize| blocks.iter().position(|block| block.contains(&index));
            assert!((0..N).all(|i| (0..N).all(|j| !filled(i, j) || block(i) == block(j))), "{file}: {a}");
        }
        Pattern::Dense => assert!((0..N).all(|i| (0..i).any(|j| filled(i, j)) || i == 0), "{file}: {a}"),
        other => panic!("{file}: no ready system is {other:?}"),
    }
    // M = ∂p/∂v, to first order by a difference; what is constant does not change at all for L quadratic in v.
    let p = |q: f64, v: f64| system.momentum(0.4, &generic(q), &generic(v));
    let difference = |q: f64| p(q, 3.0) - p(q, 4.0);
    let change = (difference(1.0) - difference(2.0)).amax();
    assert_eq!(found.constant_mass, change < 1e-12, "{file}: the mass matrix changes by {change}");
    assert_eq!(found.separable, (p(1.0, 3.0) - p(2.0, 3.0)).amax() == 0.0, "{file}: separable");
    found
}

#[test]
fn findings_are_what_the_numbers_show() {
    use vi_systems as systems;
    check::<systems::ChargedParticle, 3>("charged_particle");
    check::<systems::DoubleWell, 1>("double_well");
    check::<systems::DoubleWellDuffing, 1>("double_well_duffing");
    check::<systems::DoublePendulum, 2>("double_pendulum");
    check::<systems::HardDuffing, 1>("hard_duffing");
    check::<systems::HenonHeiles, 2>("henon_heiles");
    check::<systems::Kepler, 2>("kepler");
    check::<systems::ParametricPendulum, 1>("parametric_pendulum");
    check::<systems::OuterSolarSystem, 18>("outer_solar_system");
    check::<systems::Pendulum, 1>("pendulum");
    check::<systems::RotatingHoop, 1>("rotating_hoop");
    check::<systems::ThreeBody, 6>("three_body");
    let spherical = check::<systems::SphericalPendulum, 2>("spherical_pendulum");
    assert_eq!((spherical.cyclic.len(), spherical.constant_mass), (1, false), "the azimuth is cyclic");
    for file in ["damped_oscillator", "harmonic_oscillator"] {
        let found = findings(file).steps.expect("a rule");
        assert_eq!(found.jacobian, Dependence::Step, "{file}");
    }
    check::<systems::DampedOscillator, 1>("damped_oscillator");
    check::<systems::HarmonicOscillator, 1>("harmonic_oscillator");
}
