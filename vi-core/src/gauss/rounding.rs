//! Residuals of the stage equations, in units of their rounding-error bounds, by running error analysis.
//!
//! The system evaluates in numbers that carry their rounding-error bounds; stage values are rounded to the nearest
//! number. The result is the largest row over its bound,
//!
//! ```text
//! p0 + h Σ a_ij F_j − L_v(T_i, Q_i, V_i)                     with velocities
//! q0 + h Σ a_ij M⁻¹ (p0 + h Σ a_jk F_k) − Q_i                with positions only
//! ```
//!
//! and the velocities with the rounding error of their forces. The solver uses it if changes stall above the ulps of
//! the unknowns: a sum of cancelling terms has a larger rounding error.

use super::points::{EquationForm, ErasedSystem, Points};
use super::stages::Stages;
use super::tableau::Tableau;
use crate::linear::Matrix;
use crate::newton::roundings;
use crate::node::Node;
use crate::real::{Real, Rounded};
use crate::vector::worse;
use nalgebra::SVector;

/// The vector of one stage.
pub(crate) fn nearest<const N: usize, const S: usize>(of: &Stages<N, S>, i: usize) -> SVector<Rounded, N> {
    SVector::from_fn(|k, _| Rounded::nearest(of[k][i]))
}

/// The larger of a residual so far and that of a row, over its bound; NaN if the row has no bound.
pub(crate) fn worse_row(worst: f64, row: Rounded) -> f64 {
    worse(worst, roundings(row.to_f64(), row.ulps()))
}

/// The stage equations; see the [module](self).
struct Rows<'a, const N: usize, const S: usize> {
    node: &'a Node<N>,
    /// `h b_j`.
    weights: [Rounded; S],
    /// Forces minus L_v at each stage; minus L_v at rest if there are positions only.
    missing: [SVector<Rounded, N>; S],
    /// M⁻¹ times `missing`.
    velocity: [SVector<Rounded, N>; S],
}

impl<'a, const N: usize, const S: usize> Rows<'a, N, S> {
    fn of(
        system: &ErasedSystem<'_, N>,
        node: &'a Node<N>,
        h: f64,
        positions: &Stages<N, S>,
        velocities: Option<&Stages<N, S>>,
    ) -> Self {
        let Tableau { b, c, .. } = const { &Tableau::<S>::VALUES };
        let zeros = [SVector::zeros(); S];
        let mut rows = Self { node, weights: b.map(|b| Rounded::nearest(h * b)), missing: zeros, velocity: zeros };
        let points: [_; S] = core::array::from_fn(|i| {
            let t = Rounded::nearest(node.t + h * c[i]);
            match velocities {
                // Positions follow from velocities, and carry the rounding error of that sum.
                Some(v) => {
                    let q = SVector::from_fn(|k, _| rows.sum(rows.start(k), i, &|j| Rounded::nearest(v[k][j])));
                    system.at(t, &q, &nearest(v, i))
                }
                None => system.at(t, &nearest(positions, i), &SVector::zeros()),
            }
        });
        for i in 0..S {
            rows.missing[i] = SVector::from_fn(|k, _| {
                let start = Rounded::exact(node.p[k]) + Rounded::exact(node.p_low[k]) - points[i].momentum[k];
                rows.sum(start, i, &|j| points[j].force[k])
            });
        }
        for i in 0..S {
            rows.velocity[i] = points[i].mass.solve_unchecked(&rows.missing[i]);
        }
        rows
    }

    /// Coordinate k of the node.
    fn start(&self, k: usize) -> Rounded {
        Rounded::exact(self.node.q[k]) + Rounded::exact(self.node.q_low[k])
    }

    /// The sum over the stages, from `start`.
    fn sum(&self, start: Rounded, i: usize, of: &dyn Fn(usize) -> Rounded) -> Rounded {
        let first = const { &Tableau::<S>::VALUES.first };
        (0..S).fold(start, |sum, j| sum + Rounded::nearest(first[j][i]) * (self.weights[j] * of(j)))
    }
}

/// The residual of the stages of the step of length h from `node`, over its rounding-error bound; NaN without a bound.
pub(crate) fn residual<const N: usize, const S: usize>(
    system: &ErasedSystem<'_, N>,
    node: &Node<N>,
    h: f64,
    positions: &Stages<N, S>,
    velocities: Option<&Stages<N, S>>,
) -> f64 {
    let rows = Rows::of(system, node, h, positions, velocities);
    if velocities.is_some() {
        return rows.missing.iter().flat_map(|row| row.iter()).copied().fold(0.0, worse_row);
    }
    let mut worst = 0.0;
    for k in 0..N {
        for i in 0..S {
            let start = rows.start(k) - Rounded::nearest(positions[k][i]);
            worst = worse_row(worst, rows.sum(start, i, &|j| rows.velocity[j][k]));
        }
    }
    worst
}

/// The velocities at the stages, with the rounding error of their forces and therefore of the positions.
pub(crate) fn velocities<const N: usize, const S: usize>(
    system: &ErasedSystem<'_, N>,
    node: &Node<N>,
    h: f64,
    positions: &Stages<N, S>,
    velocities: &Stages<N, S>,
) -> [SVector<Rounded, N>; S] {
    let are_unknowns = Points::<N, Rounded>::form(system) != EquationForm::Separable;
    let rows = Rows::of(system, node, h, positions, are_unknowns.then_some(velocities));
    core::array::from_fn(|i| {
        rows.velocity[i]
            .zip_map(&nearest(velocities, i), |followed, v| v + followed - Rounded::exact(followed.to_f64()))
    })
}
