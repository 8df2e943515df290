//! Residuals of the stage equations in transformed time, in units of their rounding-error bounds, by running error
//! analysis.
//!
//! The system evaluates in numbers that carry their rounding-error bounds; stage values are rounded to the nearest
//! number. The result is the largest row over its bound,
//!
//! ```text
//! q0 + Δτ Σ a_ij g_j V_j − Q_i        p0 + Δτ Σ a_ij P'_j − L_v(T_i, Q_i, V_i)        t0 + Δτ Σ a_ij g_j − T_i        E0 + Δτ Σ a_ij E'_j − E_i
//! ```
//!
//! The solver uses it if changes stall above the ulps of the unknowns: a sum of cancelling terms has a larger rounding
//! error.

use super::super::rounding::{nearest, worse_row};
use super::super::tableau::Tableau;
use super::TransformedStages;
use crate::motion::{Motion, ScaledPoint};
use crate::node::Node;
use crate::real::Rounded;
use nalgebra::SVector;

/// Time, position and energy at a stage, or their rates.
struct StageValues<const N: usize> {
    t: Rounded,
    q: SVector<Rounded, N>,
    energy: Rounded,
}

/// The residual of the stages of the step of length Δτ from `node`, over its rounding-error bound; NaN without a bound.
pub(crate) fn residual<Y, const N: usize, const S: usize>(
    system: &Y,
    node: &Node<N>,
    dtau: f64,
    solved: &TransformedStages<N, S>,
) -> f64
where
    Y: Motion<N, Rounded>,
{
    let Tableau { b, first, .. } = const { &Tableau::<S>::VALUES };
    let TransformedStages { iteration, velocity, clock, .. } = solved;
    // Row value at stage i: its start plus the sum over the stages.
    let sum = |i: usize, start: [f64; 2], of: &dyn Fn(usize) -> Rounded| {
        let weight = |j: usize| Rounded::nearest(first[j][i]) * Rounded::nearest(dtau * b[j]);
        let start = Rounded::exact(start[0]) + Rounded::exact(start[1]);
        (0..S).fold(start, |sum, j| sum + weight(j) * of(j))
    };
    let at = |i: usize, StageValues { t, q, energy }: &StageValues<N>| {
        let v = nearest(velocity, i);
        let at = system.scaled_point(*t, q, &v);
        let excess = at.energy - *energy;
        (at, excess, v)
    };
    let places: [StageValues<N>; S] = core::array::from_fn(|i| {
        let [t, energy] = [clock.time[i], clock.energy[i]].map(Rounded::nearest);
        StageValues { t, q: nearest(&iteration.positions, i), energy }
    });
    let rates: [StageValues<N>; S] = core::array::from_fn(|i| {
        let (ScaledPoint { g, g_dt, power, .. }, excess, v) = at(i, &places[i]);
        StageValues { t: g, q: v.map(|v| g * v), energy: g * power + excess * g_dt }
    });
    // Times, positions and energies follow from their rates, and carry the rounding error of that sum.
    let followed: [StageValues<N>; S] = core::array::from_fn(|i| StageValues {
        t: sum(i, [node.t, node.t_low], &|j| rates[j].t),
        q: SVector::from_fn(|k, _| sum(i, [node.q[k], node.q_low[k]], &|j| rates[j].q[k])),
        energy: sum(i, [node.energy, node.energy_low], &|j| rates[j].energy),
    });
    let points: [_; S] = core::array::from_fn(|i| {
        let (ScaledPoint { point, g, g_dq, .. }, excess, _) = at(i, &followed[i]);
        let force = point.force.zip_map(&g_dq, |force, g_dq| g * force - excess * g_dq);
        (point.momentum, force)
    });
    let mut worst = 0.0;
    for i in 0..S {
        let (place, reached) = (&places[i], &followed[i]);
        let clock = [reached.t - place.t, reached.energy - place.energy];
        let motion = (0..N).flat_map(|k| {
            let p = sum(i, [node.p[k], node.p_low[k]], &|j| points[j].1[k]);
            [reached.q[k] - place.q[k], p - points[i].0[k]]
        });
        worst = clock.into_iter().chain(motion).fold(worst, worse_row);
    }
    worst
}
