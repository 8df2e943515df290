//! Energy-preserving Gauss steps of systems with constraints.

use super::{EnergyPreservingGauss, GivenStep, LengthSolver, Lengths};
use crate::constrained::guess::from_node;
use crate::constrained::lengths::{ConstrainedLengths, TakenLength, TriedLength};
use crate::constrained::solve::Workspace;
use crate::constrained::variation::vary;
use crate::constrained::{bordered, energies, start, step_density, unknowns};
use crate::derivatives::{Sought, Variation, check_fallback, not_last};
use crate::error::StepError;
use crate::gauss::history::StepHistory;
use crate::gauss::variation::vary_length;
use crate::kind::{Bound, Form, Multipliers};
use crate::method::Gauss;
use crate::method::bounds::Alternating;
use crate::method::gauss::bound::{ConstrainedSteps, Impulses};
use crate::method::length::Trial;
use crate::method::preserving::{Preserving, PreservingStep, StepsOfAnyLength};
use crate::motion::Motion;
use crate::node::Node;
use crate::run::{Hermite, Run};
use crate::state::{State, StepKind};
use crate::stepping::Convertible;
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::cell::RefCell;
use vi_dispatch::Instructions;

/// Steps of any length from the last node of a run.
fn lengths<'a, S: Motion<N>, const N: usize, const STAGES: usize>(
    system: &'a S,
    steps: &'a ConstrainedSteps<N>,
    cache: &'a mut Option<Box<Workspace>>,
) -> ConstrainedLengths<'a, S, N> {
    let workspace = cache.get_or_insert_with(|| Box::new(Workspace::new::<S, N, STAGES>(system)));
    ConstrainedLengths { system, last: &steps.unknowns, sign: steps.sign, workspace: RefCell::new(workspace) }
}

/// The solver of [`EnergyPreservingGauss`] steps with constraints.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BoundLengths<const STAGES: usize>;

impl<S, const N: usize, const K: usize, F: Form, const STAGES: usize> LengthSolver<S, N, STAGES>
    for BoundLengths<STAGES>
where
    S: Convertible<N, Kind = Bound<K, F>>,
{
    type Steps = ConstrainedSteps<N>;
    type Cache = Option<Box<Workspace>>;
    type Taken = TakenLength<N, STAGES, Multipliers<S, N>>;
    type DenseOutput = Hermite<N>;

    fn check_start(system: &S, node: &Node<N>) -> Result<(), StepError> {
        start::checked(system, node, &mut bordered(system)).map(drop)
    }

    fn fresh(system: &S, node: &Node<N>, h: f64) -> Result<Self::Steps, StepError> {
        let (v, bordered) = (node.state().velocity(system)?, &mut bordered(system));
        let mut guess = from_node::<S, N, STAGES>(system, (node, h, &v), bordered)?;
        guess.push(h);
        Ok(ConstrainedSteps::new(system, (node, h), &guess, bordered.determinant_sign()))
    }

    fn first(system: &S, node: &Node<N>, h: f64, steps: &mut Self::Steps) -> Result<f64, StepError> {
        let first: TriedLength<N, STAGES, Multipliers<S, N>> =
            lengths::<S, N, STAGES>(system, steps, &mut None).tried(node, h, 0.0, None)?;
        let mut unknowns = Vec::new();
        first.write(&mut unknowns);
        unknowns.push(h);
        *steps = ConstrainedSteps::new(system, (node, h), &unknowns, steps.sign);
        Ok(first.residual())
    }

    fn next(
        system: &S,
        _instructions: Instructions,
        (node, steps, history): (&Node<N>, &Self::Steps, &StepHistory),
        cache: &mut Self::Cache,
    ) -> Result<PreservingStep<Self::Taken>, StepError> {
        let steps = &lengths::<S, N, STAGES>(system, steps, cache);
        Preserving::<_, N, STAGES> { steps, node, history }.next()
    }

    fn given(
        system: &S,
        (node, steps, history): (&Node<N>, &Self::Steps, &StepHistory),
        h: f64,
    ) -> Result<GivenStep<Self::Taken>, StepError> {
        super::given::<_, N, STAGES>(&lengths::<S, N, STAGES>(system, steps, &mut None), node, h, history.shift)
    }

    fn end(node: &Node<N>, taken: &Self::Taken) -> Node<N> {
        Node { energy: node.energy, energy_low: node.energy_low, ..taken.end }
    }

    fn take(
        steps: &mut Self::Steps,
        before: &Node<N>,
        TakenLength { tried, mu, residual, .. }: &Self::Taken,
        cache: &mut Self::Cache,
    ) {
        // The solver of this step has left its buffer.
        if let Some(workspace) = cache {
            tried.write(&mut workspace.unknowns);
            workspace.unknowns.push(tried.h);
            steps.take((before, tried.h), &workspace.unknowns, mu.as_ref(), *residual);
        }
    }

    fn changed(system: &S, node: &Node<N>, h: f64, _steps: &Self::Steps) -> Result<Self::Steps, StepError> {
        <Self as LengthSolver<S, N, STAGES>>::fresh(system, node, h)
    }

    fn residual(steps: &Self::Steps) -> f64 {
        steps.residual
    }

    fn dense_output(
        system: &S,
        _steps: &Self::Steps,
        before: &State<N>,
        node: &Node<N>,
        h: f64,
    ) -> Result<Hermite<N>, StepError> {
        Hermite::between(system, before, &node.state(), h)
    }

    fn check(system: &S, node: &Node<N>, steps: &Self::Steps) -> Result<(), StepError> {
        let constraints = system.constraint_names().len();
        steps.check([unknowns::<N, STAGES>(constraints) + 1, constraints], node.t)?;
        start::check_stored(system, node)
    }

    fn step_density(system: &S, state: &State<N>) -> Result<f64, StepError> {
        step_density::<S, N, STAGES>(system, state)
    }

    fn energies(run: &Run<Gauss<STAGES>, S, N>, base: f64) -> [f64; 2] {
        let ConstrainedSteps { before, h, unknowns, mu, .. } = &run.memory;
        let found = energies::energies::<S, N, STAGES, f64>(&run.system, (before, *h), unknowns.newest(), base);
        let State { t, q, .. } = run.node.state();
        [found.start, found.end - energies::power_of::<S, N, f64>(&run.system, (t, &q), mu)]
    }

    fn vary(
        Run { system, node, memory: Lengths { steps, history }, .. }: &Run<EnergyPreservingGauss<STAGES>, S, N>,
        before: &Node<N>,
        variations: &mut [Variation<N>],
    ) -> Result<(), StepError> {
        check_fallback(history.control.fallback, before.t)?;
        let (start, h, u, mu) = steps.last(node).ok_or_else(|| not_last(before.t))?;
        // The energy differs if `set_parameters` came between `before` and the step.
        let (Some((_, u)), true, StepKind::EnergyPreserving) =
            (u.split_last(), start.is_at(before), history.control.kind)
        else {
            return Err(not_last(before.t));
        };
        vary_length::<N, STAGES>((before.t, h), history.shift, Sought::Length, variations, |all, energies| {
            vary::<S, N, STAGES>(system, (before, h), (u, mu), all, Some(energies))
        })
    }

    fn vary_given(
        Run { system, node, memory: Lengths { steps, history }, .. }: &Run<EnergyPreservingGauss<STAGES>, S, N>,
        h: f64,
        sought: Sought,
        variations: &mut [Variation<N>],
    ) -> Result<(), StepError> {
        let (shift, cache) = (history.shift, &mut None);
        let steps = lengths::<S, N, STAGES>(system, steps, cache);
        let tried: TriedLength<N, STAGES, Multipliers<S, N>> = steps.tried(node, h, shift, None)?;
        let TakenLength { mu, .. } = steps.ended(node, &tried)?.taken;
        let mut u = Vec::new();
        tried.write(&mut u);
        vary_length::<N, STAGES>((node.t, h), shift, sought, variations, |all, energies| {
            vary::<S, N, STAGES>(system, (node, h), (&u, mu.as_ref()), all, Some(energies))
        })
    }
}

impl<S, const N: usize, const K: usize, F: Form, const STAGES: usize> Run<EnergyPreservingGauss<STAGES>, S, N>
where
    S: Convertible<N, Kind = Bound<K, F>>,
{
    /// The impulses λ and μ of the constraints in the last step, as for [`Gauss`]. `None` before the first step, and after
    /// [`Run::set_parameters`], [`Run::set_state`] or [`Run::step_of`].
    pub fn impulses(&self) -> Option<Impulses<Multipliers<S, N>, STAGES>> {
        self.memory.steps.impulses(&self.system, &self.node)
    }
}
