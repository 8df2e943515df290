//! Searches for accepted steps of lanes that do not satisfy their equations, as `tests/hunt` does for other
//! integrators.
//!
//! This module recomputes the residual of each step in `f64` from the previous node and the accepted velocity. Each row
//! must be at most four roundings of the sum of its absolute terms plus its running error bound.

use crate::block::Block;
use crate::layout::WIDTH;
use vi_core::stepping::Batch;
use vi_core::{Lagrangian, State, lagrangian};
use vi_dispatch::Instructions;
use vi_systems::{DoublePendulum, DoubleWell, Kepler, SphericalPendulum};

/// Steps of a block of trajectories.
const STEPS: usize = 400;
/// Maximum residual of a solved row, in roundings.
const FLOOR: f64 = 4.0;

lagrangian! {
    /// A weight on a wall.
    struct Wall {
        param g = 1.0, k = 50.0;
        coord x;
        L = dot(x)^2 / 2 - g * x - exp(-k * x);
        discretize midpoint;
    }
}

lagrangian! {
    /// A weight on a hard core.
    struct HardCore {
        param g = 1.0, r = 0.1;
        coord x;
        L = dot(x)^2 / 2 - g * x - (r / x)^12;
        discretize midpoint;
    }
}

lagrangian! {
    /// An oscillator in the plane with a narrow bump.
    struct Bump {
        param a = 0.1, w = 1e-2;
        coord x, y;
        L = (dot(x)^2 + dot(y)^2) / 2 - (x^2 + 2 * y^2) / 2 - a * exp(-(x / w)^2);
        discretize midpoint;
    }
}

lagrangian! {
    /// A spring pendulum in polar coordinates.
    struct SpringPendulum {
        param k = 40.0, g = 9.81;
        coord r, θ;
        L = (dot(r)^2 + r^2 * dot(θ)^2) / 2 - k * (r - 1)^2 / 2 + g * r * cos(θ);
        discretize midpoint;
    }
}

/// Searches trajectories with starts between `(q, v)` and twice these values.
fn hunt<S: Batch<N> + Default, const N: usize>(h: f64, q: [f64; N], v: [f64; N]) {
    for instructions in [Instructions::BASELINE, Instructions::detected()] {
        hunt_by::<S, N>(instructions, h, q, v);
    }
}

fn hunt_by<S: Batch<N> + Default, const N: usize>(instructions: Instructions, h: f64, q: [f64; N], v: [f64; N]) {
    let system = S::default();
    let count = |number: usize| f64::from(u32::try_from(number).unwrap_or(0));
    let part = |number: usize| 1.0 + count(number) / count(WIDTH);
    let start = |number| State::at(&system, 0.0, q.map(|q| q * part(number)), v.map(|v| v * part(number)));
    let starts: Vec<_> = (0..WIDTH).map(|number| (system, start(number))).collect();
    let mut block: Block<S, N> = Block::new(&starts, h, instructions);
    let (mut worst, mut hunted) = (0.0_f64, 0);
    for _ in 0..STEPS {
        let before: Vec<_> = (0..WIDTH).map(|number| block.node(number)).collect();
        block.run(1);
        for (number, node) in before.iter().enumerate().filter(|(number, _)| block.result(*number).is_ok()) {
            let v = block.velocity(number);
            let (at, analysis) = (system.momentum_residual(node, h, &v), system.momentum_rounding(node, h, &v));
            for i in 0..N {
                let own = node.p[i].abs() + at.increment[i].abs();
                let scale = own.max(at.scale[i]).max(analysis[i]);
                let roundings = if at.residual[i] == 0.0 { 0.0 } else { at.residual[i].abs() / (f64::EPSILON * scale) };
                worst = if roundings > worst || roundings.is_nan() { roundings } else { worst };
            }
            hunted += 1;
        }
    }
    println!("{}, {instructions:?}: {hunted} steps, {worst} roundings", <S as Lagrangian<N>>::NAME);
    // Measured: 2.0 at most, for the bump.
    assert!(worst <= FLOOR, "{}: {worst} roundings", <S as Lagrangian<N>>::NAME);
    assert!(hunted > STEPS * WIDTH / 2 && worst > 0.1, "{}: {hunted}, {worst}", <S as Lagrangian<N>>::NAME);
}

#[test]
fn lanes_satisfy_their_equations_in_sudden_motions() {
    hunt::<Wall, 1>(0.01, [0.6], [0.1]);
    hunt::<Wall, 1>(0.0317, [0.6], [0.1]);
    hunt::<HardCore, 1>(0.01, [0.6], [0.1]);
    hunt::<Bump, 2>(0.0317, [0.7, 0.3], [0.1, 0.4]);
    hunt::<SpringPendulum, 2>(0.0317, [0.7, 0.9], [0.6, 0.3]);
    hunt::<SphericalPendulum, 2>(0.01, [0.7, 0.0], [0.0, 1e-3]);
}

#[test]
fn lanes_are_solved_in_the_catalogue() {
    hunt::<DoubleWell, 1>(0.02, [0.5], [0.0]);
    hunt::<Kepler, 2>(0.01, [0.6, 0.0], [0.0, 0.7]);
    hunt::<DoublePendulum, 2>(0.01, [0.5, 0.6], [0.3, 0.1]);
}
