//! The discrete energies of a step with constraints.
//!
//! With the energies En_i at the stages, the impulses λ_j at the Lobatto nodes and μ of the projection,
//!
//! ```text
//! E0 = Σ b_i En_i − h Σ b_i (1 − c_i) (f·v − L_t)_i + Σ_{j<s} (1 − c̃_j) λ_j·a_j
//! E1 = E0 + h Σ b_i (f·v − L_t)_i − Σ_{j<s} λ_j·a_j − μ·a_s
//! ```
//!
//! Constraints do work if they move: `a = g_t`, or the part of a nonholonomic constraint without velocities.

use super::equations::{configurations, impulses, stage_velocity};
use crate::gauss::energies::Energies;
use crate::gauss::lobatto::Lobatto;
use crate::gauss::tableau::Tableau;
use crate::motion::Motion;
use crate::node::Node;
use crate::real::Real;
use nalgebra::SVector;

/// The energies relative to `base` for the step of length h from `node` with these unknowns. E1 and the work lack the
/// impulse of the projection.
pub(crate) fn energies<S: Motion<N, T>, const N: usize, const STAGES: usize, T: Real>(
    system: &S,
    (node, h): (&Node<N, T>, T),
    u: &[T],
    base: T,
) -> Energies<T> {
    let Tableau { b, c, .. } = const { &Tableau::<STAGES>::VALUES };
    let lobatto = const { &Lobatto::<STAGES>::VALUES };
    let (stages, nodes, _) = configurations::<N, STAGES, T>(node, h, u);
    let [mut mean, mut size, mut done, mut left] = [T::zero(); 4];
    for i in 0..STAGES {
        let (t, q) = &stages[i];
        let v = stage_velocity(u, i);
        let energy = system.energy(*t, q, &v);
        mean += T::real(b[i]) * (energy - base);
        size += T::real(b[i]) * (v.dot(&system.momentum(*t, q, &v)).abs() + energy.abs());
        if !system.conserves_energy() {
            let work = h * T::real(b[i]) * system.power(*t, q, &v);
            done += work * T::real(c[i]);
            left += work * T::real(1.0 - c[i]);
        }
    }
    for j in 0..STAGES {
        let (c, (t, q)) = if j == 0 { (0.0, &(node.t, node.q)) } else { (lobatto.c[j - 1], &nodes[j - 1]) };
        let work =
            -power_of::<S, N, T>(system, (*t, q), impulses::<N, STAGES, T>(u, system.constraint_names().len(), j));
        done += work * T::real(c);
        left += work * T::real(1.0 - c);
        size += work.abs();
    }
    Energies { start: mean - left, end: mean + done, work: done + left, size }
}

/// `λ·a` of impulses at a place: the energy that they take from the system.
pub(crate) fn power_of<S: Motion<N, T>, const N: usize, T: Real>(
    system: &S,
    (t, q): (T, &SVector<T, N>),
    impulses: &[T],
) -> T {
    let (_, rates) = system.constraint_gradients(t, q);
    let terms = rates.as_ref().iter().zip(impulses);
    terms.fold(T::zero(), |sum, (rate, impulse)| sum + *rate * *impulse)
}
