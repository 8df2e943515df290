//! What a run of Gauss steps carries from step to step.
//!
//! In: a node, or the run before. Out: the node with the stages of the last step, from which the next one starts, and how its sweeps ended.

use super::newton::Linearization;
use super::stages::{Stages, extrapolated};
use super::sweep::{Convergence, Pause};
use crate::checkpoint;
use crate::collocation::Collocation;
use crate::error::StepError;
use crate::node::Node;
use nalgebra::SMatrix;

/// Everything that a run of [`Gauss`](super::Gauss) carries, to be stored and resumed bit for bit.
pub type Checkpoint<const N: usize, const STAGES: usize> = checkpoint::Checkpoint<Stored<N, STAGES>>;

/// A run, and where the equations of its stiff steps are linearized.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Stored<const N: usize, const S: usize> {
    pub(super) run: Run<N, S>,
    pub(super) linearization: Option<Linearization<N>>,
}

/// What a run carries from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Run<const N: usize, const S: usize> {
    pub(super) node: Node<N>,
    /// The node before the last step.
    pub(super) before: Node<N>,
    pub(super) h: f64,
    /// Velocities at the stages of the last step, forces there of a separable system: a column a coordinate. Before the first
    /// step those of the node.
    pub(super) stages: SMatrix<f64, S, N>,
    pub(super) convergence: Convergence,
    pub(super) pause: Pause,
}

impl<const N: usize, const S: usize> Run<N, S> {
    /// A run that begins at a node, the stages of its first step guessed constant.
    pub(super) fn new<Y: Collocation<N>>(system: &Y, node: Node<N>, h: f64) -> Result<Self, StepError> {
        let flow = node.state().flow(system)?;
        let start = if Y::SEPARABLE { flow.force } else { flow.v };
        let stages = SMatrix::from_fn(|_, k| start[k]);
        Ok(Self { node, before: node, h, stages, convergence: Convergence::NONE, pause: Pause::NONE })
    }

    /// Whether the step is known that led to the node: its stages mean nothing by other parameters.
    pub(super) fn has_step(&self) -> bool {
        self.convergence.has_begun() && self.before != self.node
    }

    /// The run of a system with other parameters, for which the stages are a guess and no more.
    pub(super) fn with_other_parameters(self) -> Self {
        Self { before: self.node, ..self }
    }

    /// Velocities at the stages of the next step, or forces there: the polynomials of the last one, further on.
    #[inline(always)]
    pub(super) fn guess<const FUSED: bool>(&self) -> Stages<N, S> {
        if self.convergence.has_begun() { extrapolated::<N, S, FUSED>(&self.stages.data.0) } else { self.stages.data.0 }
    }
}
