//! Whether what stages leave of their equations is rounding, by running error analysis.
//!
//! In: a system in numbers that carry a bound of their rounding, and stages, each number the nearest to the one that is meant. Out:
//! whether every row is at most four of its bounds,
//!
//! ```text
//! p0 + h Σ a_ij F_j − L_v(T_i, Q_i, V_i)                     where there are velocities
//! q0 + h Σ a_ij M⁻¹ (p0 + h Σ a_jk F_k) − Q_i                where there are positions only
//! ```
//!
//! It is asked where changes stall above the rounding of the unknowns: where terms cancel, their sum is known less well.

use super::points::{Points, Rare};
use super::stages::Stages;
use super::tableau::Tableau;
use crate::linear::Matrix;
use crate::newton::FLOOR;
use crate::node::Node;
use crate::real::{Real, Rounded};
use nalgebra::SVector;

/// The vector of one stage.
pub(super) fn nearest<const N: usize, const S: usize>(of: &Stages<N, S>, i: usize) -> SVector<Rounded, N> {
    SVector::from_fn(|k, _| Rounded::nearest(of[k][i]))
}

/// Whether a row is zero as far as its arithmetic can tell; not where its rounding has no bound.
pub(super) fn is_rounding(row: Rounded) -> bool {
    let bound = FLOOR * f64::EPSILON * row.ulps();
    bound < f64::INFINITY && row.to_f64().abs() <= bound
}

/// Whether the stages of the step of length h from `node` satisfy their equations.
pub(super) fn are_solved<const N: usize, const S: usize>(
    system: &Rare<'_, N>,
    node: &Node<N>,
    h: f64,
    positions: &Stages<N, S>,
    velocities: Option<&Stages<N, S>>,
) -> bool {
    let Tableau { b, c, first, .. } = const { &Tableau::<S>::VALUES };
    let weights = b.map(|b| Rounded::nearest(h * b));
    // The sum over the stages, from `start`.
    let sum = |start: Rounded, i: usize, of: &dyn Fn(usize) -> Rounded| {
        (0..S).fold(start, |sum, j| sum + Rounded::nearest(first[j][i]) * (weights[j] * of(j)))
    };
    let start = |k: usize| Rounded::exact(node.q[k]) + Rounded::exact(node.q_low[k]);
    let points: [_; S] = core::array::from_fn(|i| {
        let t = Rounded::nearest(node.t + h * c[i]);
        match velocities {
            // Positions follow from velocities, and carry the rounding of that sum.
            Some(v) => {
                let q = SVector::from_fn(|k, _| sum(start(k), i, &|j| Rounded::nearest(v[k][j])));
                system.at(t, &q, &nearest(v, i))
            }
            None => system.at(t, &nearest(positions, i), &SVector::zeros()),
        }
    });
    let missing: [SVector<Rounded, N>; S] = core::array::from_fn(|i| {
        SVector::from_fn(|k, _| {
            let start = Rounded::exact(node.p[k]) + Rounded::exact(node.p_low[k]) - points[i].momentum[k];
            sum(start, i, &|j| points[j].force[k])
        })
    });
    if velocities.is_some() {
        return missing.iter().flat_map(|row| row.iter()).all(|row| is_rounding(*row));
    }
    let velocity: [SVector<Rounded, N>; S] = core::array::from_fn(|i| points[i].mass.solve_unchecked(&missing[i]));
    (0..N).all(|k| {
        (0..S).all(|i| {
            let start = start(k) - Rounded::nearest(positions[k][i]);
            is_rounding(sum(start, i, &|j| velocity[j][k]))
        })
    })
}
