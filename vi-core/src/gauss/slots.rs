//! The slot derivatives of a Gauss step: its discrete Lagrangian with derivatives, and the discrete forces and powers.
//!
//! With the stages (T_i, Q_i, V_i) of a solved step, and `P = L_v` and `En = V·P − L` at each of them,
//!
//! ```text
//! L_d = h Σ b L
//! D1 = Σ b En + h Σ b (1−c) L_t        D3 = −Σ b En + h Σ b c L_t        g_d⁻ = −h Σ b (1−c) f·V        g_d⁺ = −h Σ b c f·V
//! D2 = h Σ b (1−c) L_q − Σ b P         D4 = h Σ b c L_q + Σ b P          f_d⁻ = h Σ b (1−c) f           f_d⁺ = h Σ b c f
//! ```
//!
//! L_d is a function of (t0, q0, t1, q1), with the stages at which `h Σ b L` is stationary. After a step, to its
//! residual,
//!
//! ```text
//! −D2 − f_d⁻ = p0        D4 + f_d⁺ = p1        D1 + g_d⁻ = E0        −D3 − g_d⁺ = E1 = E0 + h Σ b (f·V − L_t)
//! ```
//!
//! With a force only these sums are determined. Their split into slot and force is a convention, since the stages
//! depend on f (Marsden and West, *Discrete mechanics and variational integrators*, section 3.2).

use super::fixed_point::Equations;
use super::general::equations;
use super::points::ErasedSystem;
use super::stages::{Stages, stage, time};
use super::tableau::Tableau;
use crate::node::Node;
use crate::stepping::Convertible;
use nalgebra::SVector;

/// The slots of one step, with the names of [`DiscreteLagrangian`](crate::DiscreteLagrangian).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slots<const N: usize> {
    /// `L_d`.
    pub ld: f64,
    /// `∂L_d/∂t0`.
    pub d1_ld: f64,
    /// `∂L_d/∂q0`.
    pub d2_ld: SVector<f64, N>,
    /// `∂L_d/∂t1`.
    pub d3_ld: f64,
    /// `∂L_d/∂q1`.
    pub d4_ld: SVector<f64, N>,
    /// `f_d⁻`, on δq0.
    pub fd_minus: SVector<f64, N>,
    /// `f_d⁺`, on δq1.
    pub fd_plus: SVector<f64, N>,
    /// `g_d⁻`, on δt0.
    pub gd_minus: f64,
    /// `g_d⁺`, on δt1.
    pub gd_plus: f64,
}

impl<const N: usize> Slots<N> {
    /// Whether all values are finite: forces may be finite although L is not.
    pub(crate) fn is_finite(&self) -> bool {
        let Self { ld, d1_ld, d2_ld, d3_ld, d4_ld, fd_minus, fd_plus, gd_minus, gd_plus } = self;
        let vectors = [d2_ld, d4_ld, fd_minus, fd_plus].into_iter().flat_map(SVector::iter);
        [ld, d1_ld, d3_ld, gd_minus, gd_plus].into_iter().chain(vectors).all(|number| number.is_finite())
    }

    /// The slots of the step of length h from a node with these stages.
    pub(crate) fn of<Y: Convertible<N>, const S: usize>(
        system: &Y,
        node: &Node<N>,
        h: f64,
        stages: Stages<N, S>,
    ) -> Self {
        let Tableau { b, c, .. } = const { &Tableau::<S>::VALUES };
        let erased = ErasedSystem::of(system);
        let equations = equations(&erased, node, h, stages);
        let x = equations.start();
        let velocities = equations.velocity();
        let zeros = SVector::zeros();
        let mut slots = Self {
            ld: 0.0,
            d1_ld: 0.0,
            d2_ld: zeros,
            d3_ld: 0.0,
            d4_ld: zeros,
            fd_minus: zeros,
            fd_plus: zeros,
            gd_minus: 0.0,
            gd_plus: 0.0,
        };
        for i in 0..S {
            let t = time::<N, S, false, f64>(node, h, i);
            let q = stage(&x, i);
            let v = stage(&velocities, i);
            let point = system.point(t, &q, &v);
            let force = system.force(t, &q, &v);
            let energy = system.energy(t, &q, &v);
            let work = force.dot(&v);
            let lt = work - system.power(t, &q, &v);
            let lq = point.force - force;
            let weight = h * b[i];
            let [before, after] = [weight * (1.0 - c[i]), weight * c[i]];
            slots.ld += weight * system.lagrangian(t, &q, &v);
            slots.d1_ld += b[i] * energy + before * lt;
            slots.d2_ld += lq * before - point.momentum * b[i];
            slots.d3_ld += after * lt - b[i] * energy;
            slots.d4_ld += lq * after + point.momentum * b[i];
            slots.fd_minus += force * before;
            slots.fd_plus += force * after;
            slots.gd_minus -= before * work;
            slots.gd_plus -= after * work;
        }
        slots
    }
}
