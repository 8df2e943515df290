//! Composition of steps with constraints: fixed steps of order 4, 6 and 8 from the midpoint rule [`Gauss<1>`].
//!
//! One step consists of the steps `γ_1 h, γ_2 h, …` with the weights of [`Composition`]. Each of them satisfies the
//! constraints at its end. The step is symmetric, and for holonomic constraints without force symplectic.
//! [`Gauss`] with more stages has the same orders with positive substeps, and tolerates damping.
//!
//! Each substep is extrapolated from the same substep of earlier steps.

use super::gauss::bound::{ConstrainedStep, ConstrainedSteps};
use super::{Change, Composition, Facts, Gauss, Memory, Method, Problem, Status};
use crate::constrained::solve::Workspace;
use crate::constrained::variation::vary;
use crate::derivatives::{Differentiable, Variation, not_last};
use crate::error::StepError;
use crate::kind::{Bound, Form, Multipliers};
use crate::node::Node;
use crate::run::{Hermite, Run};
use crate::state::State;
use crate::stepping::Convertible;
use alloc::borrow::Cow;
use alloc::boxed::Box;
use alloc::vec::Vec;

/// A symmetric composition of steps of order 2; see the [module](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Composed<M> {
    /// The method of a substep.
    pub method: M,
    /// Weights and order.
    pub scheme: Composition,
}

impl Gauss<1> {
    /// Steps of the order of a composition, each of which consists of steps of this method.
    ///
    /// ```
    /// use vi_core::prelude::*;
    /// use vi_core::Composition;
    /// # mod pendulum {
    /// # use vi_core::lagrangian;
    /// lagrangian! {
    ///     pub struct Pendulum {
    ///         coord x, y;
    ///         L = (dot(x)^2 + dot(y)^2) / 2 - 9.81 * y;
    ///         constraint rod = x^2 + y^2 - 1;
    ///     }
    /// }
    /// # }
    /// # use pendulum::Pendulum;
    ///
    /// let method = Gauss::<1>.composed(Composition::KAHAN_LI_6);
    /// let mut run = Pendulum::default().at(0.0, [0.6, -0.8], [0.0, 0.0]).integrate(method, 0.05)?;
    /// run.step()?;
    /// # Ok::<(), StepError>(())
    /// ```
    #[must_use]
    pub fn composed(self, scheme: Composition) -> Composed<Self> {
        Composed { method: self, scheme }
    }
}

/// Memory of a composition: one for each substep.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ComposedSteps<const N: usize> {
    pub(crate) all: Vec<ConstrainedSteps<N>>,
    /// Whether no step was taken yet: all memories are those of the first substep.
    is_new: bool,
}

impl<const N: usize> Memory for ComposedSteps<N> {}

/// Buffers of a composition.
#[derive(Clone, Debug)]
pub struct SubstepBuffers<const N: usize, M> {
    workspace: Option<Box<Workspace>>,
    /// Empty between steps.
    steps: Vec<ConstrainedStep<N, M>>,
    /// One for each substep of the next step.
    unknowns: Vec<Vec<f64>>,
}

impl<const N: usize, M> Default for SubstepBuffers<N, M> {
    fn default() -> Self {
        Self { workspace: None, steps: Vec::new(), unknowns: Vec::new() }
    }
}

impl<S, const N: usize, const K: usize, F: Form> Method<S, N> for Composed<Gauss<1>>
where
    S: Convertible<N, Kind = Bound<K, F>>,
{
    type Prepared = ();
    type Memory = ComposedSteps<N>;
    type Cache = SubstepBuffers<N, Multipliers<S, N>>;
    type Step = Vec<ConstrainedStep<N, Multipliers<S, N>>>;
    type Left = StepError;
    type DenseOutput = Hermite<N>;

    fn facts(&self) -> Facts {
        Facts { has_reactions: true, order: self.scheme.order, ..Facts::default() }
    }

    fn prepare(&self, _system: &S, _h: f64) {}

    fn begin(&self, system: &S, node: &mut Node<N>, h: f64) -> Result<Self::Memory, StepError> {
        let all = self.scheme.lengths(h).map(|h| self.method.begin(system, node, h)).collect::<Result<_, _>>()?;
        Ok(ComposedSteps { all, is_new: true })
    }

    fn attempt(
        &self,
        at: Problem<'_, S, (), N>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
    ) -> Result<Self::Step, StepError> {
        let Problem { system, node, h, .. } = at;
        let mut after = *node;
        let SubstepBuffers { workspace, steps, unknowns } = cache;
        let mut steps = core::mem::take(steps);
        for (own, h) in memory.all.iter().zip(self.scheme.lengths(h)) {
            if let (Some(workspace), Some(unknowns)) = (workspace.as_mut(), unknowns.pop()) {
                workspace.unknowns = unknowns;
            }
            // Before the first step, a substep is guessed from its own start.
            let own = if memory.is_new {
                self.method.restarted(system, &Change::NewLength, &mut after, h, own).map(Cow::Owned)
            } else {
                Ok(Cow::Borrowed(own))
            };
            let problem = Problem { system, prepared: &(), node: &after, h };
            let step = own.and_then(|own| self.method.solve(problem, &own, workspace));
            let step = step.map_err(|failure| failure.explained_at(system, &after, h))?;
            after = step.end;
            steps.push(step);
        }
        Ok(steps)
    }

    fn recover(
        &self,
        _at: Problem<'_, S, (), N>,
        _memory: &Self::Memory,
        _cache: &mut Self::Cache,
        left: StepError,
    ) -> Result<Self::Step, StepError> {
        Err(left)
    }

    fn take(
        &self,
        system: &S,
        h: f64,
        (node, memory): (&mut Node<N>, &mut Self::Memory),
        cache: &mut Self::Cache,
        mut steps: Self::Step,
    ) {
        for ((memory, step), h) in memory.all.iter_mut().zip(steps.drain(..)).zip(self.scheme.lengths(h)) {
            Method::<S, N>::take(&self.method, system, h, (node, memory), &mut cache.workspace, step);
            if let Some(workspace) = &mut cache.workspace {
                cache.unknowns.push(core::mem::take(&mut workspace.unknowns));
            }
        }
        cache.steps = steps;
        memory.is_new = false;
    }

    fn restarted(
        &self,
        system: &S,
        change: &Change<'_, S, N>,
        node: &mut Node<N>,
        h: f64,
        memory: &Self::Memory,
    ) -> Result<Self::Memory, StepError> {
        if !matches!(change, Change::NewLength) {
            return change.begun(self, system, node, h);
        }
        let substeps = memory.all.iter().zip(self.scheme.lengths(h));
        let all = substeps.map(|(memory, h)| self.method.restarted(system, change, node, h, memory));
        Ok(ComposedSteps { all: all.collect::<Result<_, _>>()?, is_new: true })
    }

    fn dense_output(
        &self,
        system: &S,
        before: &State<N>,
        node: &Node<N>,
        h: f64,
        _memory: &Self::Memory,
    ) -> Result<Hermite<N>, StepError> {
        Hermite::between(system, before, &node.state(), h)
    }

    fn status(&self, h: f64, memory: &Self::Memory) -> Status {
        let all = memory.all.iter().map(|memory| Method::<S, N>::status(&self.method, h, memory));
        all.fold(Status::of_length(h), |sum, of| Status {
            residual: sum.residual.max(of.residual),
            iterations: sum.iterations + of.iterations,
            ..sum
        })
    }

    fn check(&self, system: &S, (node, memory): (&Node<N>, &Self::Memory), h: f64) -> Result<(), StepError> {
        if memory.all.len() != self.scheme.weights.len() {
            #[allow(clippy::cast_precision_loss)] // a few substeps
            let value = memory.all.len() as f64;
            let allowed = "those of the composition of the restarted run";
            return Err(StepError::InvalidInput { input: "the substeps of a checkpoint", allowed, value });
        }
        let mut substeps = memory.all.iter().zip(self.scheme.lengths(h));
        substeps.try_for_each(|(memory, h)| self.method.check(system, (node, memory), h))
    }
}

impl<S, const N: usize, const K: usize, F: Form> Differentiable<S, N> for Composed<Gauss<1>>
where
    S: Convertible<N, Kind = Bound<K, F>>,
{
    /// Allocates the matrix of a substep.
    fn vary(run: &Run<Self, S, N>, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        let Run { system, node, memory, h, .. } = run;
        let substeps = &memory.all;
        let ends = substeps.iter().skip(1).map(ConstrainedSteps::start).chain([node]);
        let last: Option<Vec<_>> = substeps.iter().zip(ends).map(|(substep, end)| substep.last(end)).collect();
        let last = last.filter(|all| all.first().is_some_and(|(start, ..)| *start == before));
        let last = last.ok_or_else(|| not_last(before.t))?;
        let lengths: Vec<f64> = variations.iter().map(|variation| variation.h).collect();
        for (start, length, u, mu) in last {
            for (variation, of_length) in variations.iter_mut().zip(&lengths) {
                variation.h = of_length * (length / h);
            }
            vary::<S, N, 1>(system, (start, length), (u, mu), variations, None)?;
        }
        for (variation, of_length) in variations.iter_mut().zip(lengths) {
            variation.h = of_length;
        }
        Ok(())
    }
}
