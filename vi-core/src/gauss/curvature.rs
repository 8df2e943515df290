//! Second derivatives of the end of a Gauss step, as [`crate::derivatives`] explains.
//!
//! The unknowns are the velocities V of the stages. With weights (w, y) of q1 and p1 and multipliers μ_i of the stage
//! equations, the terms that are not linear are
//!
//! ```text
//! Φ = Σ_j μ_j·L_v(T_j, Q_j, V_j) + h Σ_j ν_j·F(T_j, Q_j, V_j) + h Σ_j b_j w·V_j        ν_j = b_j y − Σ_i a_ij μ_i
//! ```

use super::stages::{Stages, scaled, stage, sum, weights};
use super::tableau::Tableau;
use super::variation::{Linearized, column, eliminate, integrals};
use crate::derivatives::curvature::{Curved, Pairs, second_derivatives, sides};
use crate::derivatives::{Covector, Variation};
use crate::error::StepError;
use crate::motion::Sides;
use crate::node::Node;
use crate::real::Number as _;
use crate::stepping::Convertible;
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::{DMatrix, SVector};

/// A tangent vector at the start of a step, with those of its stages.
struct StageTangent<const N: usize, const S: usize> {
    start: Variation<N>,
    /// δV_j.
    velocities: [SVector<f64, N>; S],
    /// `Σ_l a_jl δV_l`.
    means: [SVector<f64, N>; S],
}

/// The second derivatives of the weighted end of the Gauss step of length h with these stages, along pairs of tangent
/// vectors at its start.
pub(crate) fn curvature<S, const N: usize, const STAGES: usize>(
    system: &S,
    step: (&Node<N>, f64, &Stages<N, STAGES>),
    variations: &[Variation<N>],
    end: &Covector<N>,
) -> Result<DMatrix<f64>, StepError>
where
    S: Convertible<N>,
{
    let Tableau { b, c, first, .. } = const { &Tableau::<STAGES>::VALUES };
    let (before, h, _) = step;
    let mut linearized = Linearized::of(system, step);
    let multipliers = multipliers(&linearized, end)?;
    let velocities = by_stages(&linearized.at.velocities);
    let means = by_stages(&linearized.at.moved());
    let mut directions = Vec::with_capacity(variations.len());
    linearized.vary(
        system,
        &mut variations.to_vec(),
        Some(&mut |_, from, velocities| {
            directions.extend(from.iter().zip(velocities).map(|(start, velocities)| StageTangent {
                start: start.clone(),
                velocities: by_stages(velocities),
                means: by_stages(&integrals::<N, STAGES, false>(velocities, &weights(1.0))),
            }));
        }),
    )?;
    let curved = system.convert::<Curved>();
    second_derivatives(&directions, before.t, |pairs: Pairs<'_, StageTangent<N, STAGES>>| {
        let system = pairs.vary(system.parameters(), curved, |of| &of.start.parameters);
        let t = pairs.number(before.t, |of| of.start.t);
        let q = pairs.vector(&before.q, |of| &of.start.q);
        let h = pairs.number(h, |of| of.start.h);
        let mut total = Curved::real(0.0);
        for j in 0..STAGES {
            let v = pairs.vector(&velocities[j], |of| &of.velocities[j]);
            let position = q + pairs.vector(&means[j], |of| &of.means[j]) * h;
            let Sides { momentum, force } = sides(&system, t + h * Curved::real(c[j]), &position, &v);
            for k in 0..N {
                let kick = end.p[k] - sum(&scaled(&first[j], &multipliers[k]));
                let drift = v[k] * Curved::real(b[j] * end.q[k]) + force[k] * Curved::real(b[j] * kick);
                total += momentum[k] * Curved::real(multipliers[k][j]) + h * drift;
            }
        }
        total
    })
}

/// The vectors of all stages.
fn by_stages<const N: usize, const S: usize>(of: &Stages<N, S>) -> [SVector<f64, N>; S] {
    core::array::from_fn(|j| stage(of, j))
}

/// The multipliers of the stage equations for these weights of the end, by the transposed matrix of the tangent vectors.
fn multipliers<const N: usize, const S: usize>(
    step: &Linearized<N, S>,
    end: &Covector<N>,
) -> Result<Stages<N, S>, StepError> {
    let first = const { &Tableau::<S>::VALUES.first };
    let [momentum_dq, mass, force_dq, force_dv] = step.derivatives() else { return Err(step.unsolved()) };
    let weights = weights::<S>(step.h);
    let mut equations = vec![[[0.0; S]; N]; N * S + 1];
    for l in 0..N {
        for j in 0..S {
            let row = column::<N, S, false>([momentum_dq, mass, force_dq, force_dv], &weights, [l, j]);
            for k in 0..N {
                for i in 0..S {
                    equations[k * S + i][l][j] = row[k][i];
                }
            }
            let mut of_end = end.q[l];
            for k in 0..N {
                of_end += end.p[k] * (force_dv[k][l][j] + sum(&scaled(&weights, &scaled(&first[j], &force_dq[k][l]))));
            }
            equations[N * S][l][j] = -weights[j] * of_end;
        }
    }
    if eliminate::<N, S, false>(step.moving, &mut equations, mass) {
        Ok(equations[N * S])
    } else {
        Err(step.unsolved())
    }
}
