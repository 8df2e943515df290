//! Variations of a solved Gauss step.
//!
//! In: the stages of the last step, variations of its node. Out: those of the next node. With `C = ∂L_v/∂q, M = ∂L_v/∂v, K = ∂F/∂q, B = ∂F/∂v` at each stage,
//! and m, f what L_v and F change by the time and the parameters, the velocities of the stages vary by the solution of
//!
//! ```text
//! C_i δQ_i + M_i δV_i + m_i = δp0 + h Σ_j a_ij δF_j        δQ_i = δq0 + h Σ_j a_ij δV_j        δF_j = K_j δQ_j + B_j δV_j + f_j
//! ```
//!
//! one matrix of S N rows, factored once for all directions. It is not the simplified matrix of `newton`: derivatives have to be those of every stage.

use super::Gauss;
use super::general::equations;
use super::newton::jacobians;
use super::points::Rare;
use super::stages::{stage, time};
use super::sweep::Equations;
use super::tableau::Tableau;
use crate::collocation::Collocation;
use crate::derivatives::{Changes, Differentiable, Jacobians, TOGETHER, Variation, changes};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::linear::Pivoted;
use crate::node::Node;
use crate::real::Dual;
use crate::stepping::{Convertible, FixedStepping};
use nalgebra::{DMatrix, DVector, SVector};

/// A stage of a solved step.
struct Stage<const N: usize> {
    t: f64,
    q: SVector<f64, N>,
    v: SVector<f64, N>,
    jacobians: Jacobians<N>,
}

impl<S, const N: usize, const STAGES: usize> Differentiable<N> for Gauss<S, N, STAGES>
where
    S: Collocation<N> + Convertible<N> + FixedStepping<N>,
{
    /// Allocates: the linearized equations of all stages are one matrix.
    fn vary(&self, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        let Tableau { b, first, .. } = const { &Tableau::<STAGES>::VALUES };
        let Self { system, run, .. } = self;
        let h = run.h;
        let singular = StepError::Singular { t: before.t, matrix: "derivative of the equations of a step" };
        let rare = Rare::of(system);
        let equations = equations(&rare, before, h, run.stages.data.0);
        let positions = equations.start();
        let velocities = equations.velocity();
        let stages: Vec<Stage<N>> = (0..STAGES)
            .map(|i| {
                let t = time::<N, STAGES, false, f64>(before, h, i);
                let [q, v] = [stage(&positions, i), stage(&velocities, i)];
                Stage { t, q, v, jacobians: jacobians(&rare, t, &q, &v) }
            })
            .collect();
        // h a_ij
        let mut weights = [[0.0; STAGES]; STAGES];
        for i in 0..STAGES {
            for j in 0..STAGES {
                weights[i][j] = h * b[j] * first[j][i];
            }
        }
        let mut matrix = DMatrix::zeros(N * STAGES, N * STAGES);
        for i in 0..STAGES {
            for j in 0..STAGES {
                let mut block = (stages[i].jacobians.by_q[0] - stages[j].jacobians.by_v[1]) * weights[i][j];
                for k in 0..STAGES {
                    block -= stages[k].jacobians.by_q[1] * (weights[i][k] * weights[k][j]);
                }
                if i == j {
                    block += stages[i].jacobians.by_v[0];
                }
                matrix.view_mut((N * i, N * j), (N, N)).copy_from(&block);
            }
        }
        let mut factors = Pivoted::new(N * STAGES);
        factors.factor(&matrix);
        let mut change = DVector::zeros(N * STAGES);
        for variations in variations.chunks_mut(TOGETHER) {
            let explicit = explicit(system, &stages, variations);
            for (direction, variation) in variations.iter_mut().enumerate() {
                let mut of_momentum = [SVector::<f64, N>::zeros(); STAGES];
                let mut of_force = of_momentum;
                for (i, stage) in stages.iter().enumerate() {
                    let [momentum, force] = explicit.as_ref().map_or([SVector::zeros(); 2], |of| of[i][direction]);
                    of_momentum[i] = momentum + stage.jacobians.by_q[0] * variation.q;
                    of_force[i] = force + stage.jacobians.by_q[1] * variation.q;
                }
                for i in 0..STAGES {
                    let mut row = variation.p - of_momentum[i];
                    for j in 0..STAGES {
                        row += of_force[j] * weights[i][j];
                    }
                    change.rows_mut(N * i, N).copy_from(&row);
                }
                factors.solve(change.as_mut_slice());
                if !change.iter().all(|entry| entry.is_finite()) {
                    return Err(singular);
                }
                let of_velocity = |j: usize| SVector::<f64, N>::from_fn(|k, _| change[N * j + k]);
                for j in 0..STAGES {
                    let mut moved = SVector::zeros();
                    for k in 0..STAGES {
                        moved += of_velocity(k) * weights[j][k];
                    }
                    let force = of_force[j]
                        + stages[j].jacobians.by_q[1] * moved
                        + stages[j].jacobians.by_v[1] * of_velocity(j);
                    variation.q += of_velocity(j) * (h * b[j]);
                    variation.p += force * (h * b[j]);
                }
            }
        }
        Ok(())
    }
}

/// What `L_v` and `L_q + f` change by with the time and the parameters, a row a stage; none where neither varies in any direction.
fn explicit<S: Convertible<N> + Lagrangian<N>, const N: usize>(
    system: &S,
    stages: &[Stage<N>],
    variations: &[Variation<N>],
) -> Option<Vec<Changes<N>>> {
    let varied = Variation::varying_system(variations, system)?;
    let at = |stage: &Stage<N>| {
        let t = Variation::number(variations, stage.t, |variation| variation.t);
        let point = varied.point(t, &stage.q.map(Dual::fixed), &stage.v.map(Dual::fixed));
        changes(&[point.momentum, point.force])
    };
    Some(stages.iter().map(at).collect())
}
