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

use super::newton::slopes;
use super::points::Rare;
use super::stages::{stage, time};
use super::sweep::Equations;
use super::tableau::Tableau;
use super::{Gauss, general};
use crate::collocation::Collocation;
use crate::derivatives::{Differentiable, Variation};
use crate::error::StepError;
use crate::linear::Pivoted;
use crate::node::Node;
use crate::real::Dual;
use crate::stepping::{Convertible, FixedStepping};
use nalgebra::{DMatrix, DVector, SMatrix, SVector};

/// A stage of a solved step, linearized.
struct Linearized<const N: usize> {
    t: f64,
    q: SVector<f64, N>,
    v: SVector<f64, N>,
    /// C and M.
    momentum_by_q: SMatrix<f64, N, N>,
    momentum_by_v: SMatrix<f64, N, N>,
    /// K and B.
    force_by_q: SMatrix<f64, N, N>,
    force_by_v: SMatrix<f64, N, N>,
}

impl<const N: usize> Linearized<N> {
    /// The equations at a stage.
    fn of(system: &Rare<'_, N>, t: f64, q: SVector<f64, N>, v: SVector<f64, N>) -> Self {
        let zeros = SMatrix::zeros();
        let mut stage =
            Self { t, q, v, momentum_by_q: zeros, momentum_by_v: zeros, force_by_q: zeros, force_by_v: zeros };
        for column in 0..N {
            let [momentum, force] = slopes(system, t, &q, &v, column);
            stage.momentum_by_q.set_column(column, &momentum);
            stage.force_by_q.set_column(column, &force);
            let [momentum, force] = slopes(system, t, &q, &v, column + N);
            stage.momentum_by_v.set_column(column, &momentum);
            stage.force_by_v.set_column(column, &force);
        }
        stage
    }
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
        let equations = general(&rare, before, h, run.stages.data.0);
        let positions = equations.start();
        let velocities = equations.guess();
        let stages: Vec<Linearized<N>> = (0..STAGES)
            .map(|i| {
                let t = time::<N, STAGES, false, f64>(before, h, i);
                Linearized::of(&rare, t, stage(&positions, i), stage(&velocities, i))
            })
            .collect();
        // a_ij h
        let weight = |i: usize, j: usize| h * b[j] * first[j][i];
        let mut matrix = DMatrix::zeros(N * STAGES, N * STAGES);
        for i in 0..STAGES {
            for j in 0..STAGES {
                let mut block = (stages[i].momentum_by_q - stages[j].force_by_v) * weight(i, j);
                for k in 0..STAGES {
                    block -= stages[k].force_by_q * (weight(i, k) * weight(k, j));
                }
                if i == j {
                    block += stages[i].momentum_by_v;
                }
                matrix.view_mut((N * i, N * j), (N, N)).copy_from(&block);
            }
        }
        let mut factors = Pivoted::new(N * STAGES);
        factors.factor(&matrix);
        for variation in variations {
            let dual = variation.system(system);
            let zeros = SVector::<f64, N>::zeros();
            let mut of_momentum = [zeros; STAGES];
            let mut of_force = [zeros; STAGES];
            for (i, stage) in stages.iter().enumerate() {
                let t = Dual { value: stage.t, slope: variation.t };
                let point = dual.point(t, &stage.q.map(Dual::fixed), &stage.v.map(Dual::fixed));
                of_momentum[i] = point.momentum.map(|entry| entry.slope) + stage.momentum_by_q * variation.q;
                of_force[i] = point.force.map(|entry| entry.slope) + stage.force_by_q * variation.q;
            }
            let mut change = DVector::zeros(N * STAGES);
            for i in 0..STAGES {
                let mut row = variation.p - of_momentum[i];
                for j in 0..STAGES {
                    row += of_force[j] * weight(i, j);
                }
                change.rows_mut(N * i, N).copy_from(&row);
            }
            factors.solve(change.as_mut_slice());
            if !change.iter().all(|entry| entry.is_finite()) {
                return Err(singular);
            }
            let of_velocity = |j: usize| SVector::<f64, N>::from_fn(|k, _| change[N * j + k]);
            for j in 0..STAGES {
                let mut moved = zeros;
                for k in 0..STAGES {
                    moved += of_velocity(k) * weight(j, k);
                }
                let force = of_force[j] + stages[j].force_by_q * moved + stages[j].force_by_v * of_velocity(j);
                variation.q += of_velocity(j) * (h * b[j]);
                variation.p += force * (h * b[j]);
            }
        }
        Ok(())
    }
}
