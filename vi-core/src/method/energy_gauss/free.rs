//! Energy-preserving Gauss steps of systems without constraints.

#[cfg(feature = "alloc")]
use super::{EnergyPreservingGauss, Lengths};
use super::{GivenStep, LengthSolver};
use crate::dense_output::Hermite;
#[cfg(feature = "alloc")]
use crate::derivatives::{Sought, Variation, check_fallback, not_last};
use crate::error::StepError;
use crate::gauss::density::{power, step_density};
use crate::gauss::energies::{Energies, bounded_energies, energies};
use crate::gauss::fixed_point::Convergence;
use crate::gauss::history::StepHistory;
use crate::gauss::newton::Buffer;
use crate::gauss::solve::{Start, Step};
use crate::gauss::stages::{EXACT, Stages, at};
#[cfg(feature = "alloc")]
use crate::gauss::variation::{vary, vary_length};
use crate::kind::Free;
use crate::method::Gauss;
use crate::method::bounds::Alternating;
use crate::method::gauss::free::{GaussOutput, LastStages};
use crate::method::length::Trial;
use crate::method::preserving::{Ended, Preserving, PreservingStep, StepsOfAnyLength, measured};
use crate::node::Node;
use crate::run::Run;
use crate::state::State;
#[cfg(feature = "alloc")]
use crate::state::StepKind;
use crate::stepping::Convertible;
use core::cell::RefCell;
use nalgebra::{ArrayStorage, SMatrix};
use vi_dispatch::Instructions;

/// A step of some length with solved stages.
#[derive(Clone, Copy, Debug)]
struct Tried<const N: usize, const S: usize> {
    step: Step<N, S>,
    /// `E0(h) − C_s h^2s D_* − E'`.
    residual: f64,
    /// `E1 − E0`.
    work: f64,
    /// Sum of the absolute terms of E0.
    size: f64,
}

impl<const N: usize, const S: usize> Trial for Tried<N, S> {
    fn h(&self) -> f64 {
        self.step.h
    }

    fn residual(&self) -> f64 {
        self.residual
    }

    fn size(&self) -> f64 {
        self.size
    }
}

/// Buffers for stiff steps.
type Cache<const N: usize, const S: usize> = Buffer<N, S>;

/// The steps of any length from the node of a run.
struct LengthsOfStages<'a, S, const N: usize, const K: usize> {
    system: &'a S,
    instructions: Instructions,
    stages: &'a LastStages<N, K>,
    cache: RefCell<&'a mut Cache<N, K>>,
}

impl<'a, S, const N: usize, const K: usize> LengthsOfStages<'a, S, N, K> {
    /// The steps after the last one.
    fn of(system: &'a S, instructions: Instructions, stages: &'a LastStages<N, K>, cache: &'a mut Cache<N, K>) -> Self {
        Self { system, instructions, stages, cache: RefCell::new(cache) }
    }

    /// The stages of the step of length h, extrapolated from the last one.
    fn guess(&self, h: f64) -> Stages<N, K> {
        let LastStages { stages, convergence, h: last, .. } = self.stages;
        if convergence.has_begun() { at(&stages.data.0, |c| 1.0 + c * (h / last)) } else { stages.data.0 }
    }
}

impl<S, const N: usize, const K: usize> StepsOfAnyLength<N, K> for LengthsOfStages<'_, S, N, K>
where
    S: Convertible<N>,
{
    type Trial = Tried<N, K>;
    type Taken = Step<N, K>;

    fn tried(&self, node: &Node<N>, h: f64, shift: f64, near: Option<&Tried<N, K>>) -> Result<Tried<N, K>, StepError> {
        let Self { system, instructions, stages: last, cache } = self;
        let (system, instructions, cache) = (*system, *instructions, &mut **cache.borrow_mut());
        let stages = near.map_or_else(
            || self.guess(h),
            |other| {
                let ratio = h / other.h();
                at(&other.step.stages, |c| ratio * c)
            },
        );
        let before = &Convergence { iterations: 0, ..last.convergence };
        let (pause, accuracy) = (last.pause, EXACT);
        let start = Start { node, h, stages: &stages, are_last: false, before, pause, accuracy };
        let by_fixed_point =
            if last.pause.is_over() { start.by_fixed_point(system, instructions).map_err(Some) } else { Err(None) };
        // Lengths differ from step to step, so each has its own linearization.
        let step =
            by_fixed_point.or_else(|left| start.recover(system, instructions, (left.as_ref(), None), false, cache))?;
        let energies = energies(system, node, h, step.stages, node.energy);
        let residual = energies.start - node.energy_low - power::<K>(h) * shift;
        if !residual.is_finite() {
            return Err(StepError::NonFinite { t: node.t, quantity: "energy", expression: None });
        }
        Ok(Tried { step: Step { linearization: None, ..step }, residual, work: energies.work, size: energies.size })
    }

    #[cold]
    fn rounding_of(&self, node: &Node<N>, trial: &Tried<N, K>) -> f64 {
        bounded_energies(self.system, node, trial.h(), trial.step.stages, node.energy).start.ulps()
    }

    fn iterations(trial: &Tried<N, K>) -> u32 {
        trial.step.convergence.iterations
    }

    fn density(&self, state: &State<N>) -> Result<f64, StepError> {
        step_density::<S, N, K>(self.system, state)
    }

    fn measured(&self, node: &Node<N>) -> Result<[f64; 2], StepError> {
        measured(self.system, node)
    }

    fn ended(&self, node: &Node<N>, trial: &Tried<N, K>) -> Result<Ended<Step<N, K>, N>, StepError> {
        let step = trial.step;
        let mut after = *node;
        after.advance(step.h, &step.increment.velocity, &step.increment.momentum);
        let gain = if self.system.conserves_energy() { 0.0 } else { trial.work };
        after.add_energy(gain);
        after.check_finite(node.t)?;
        Ok(Ended { taken: step, state: after.state(), gain, measured: measured(self.system, &after)? })
    }

    fn between(&self, before: &State<N>, after: &State<N>, h: f64) -> Result<Hermite<N>, StepError> {
        Hermite::between(self.system, before, after, h)
    }
}

/// The step of the length h from a node, guessed from the last step.
///
/// # Errors
/// As [`StepsOfAnyLength::tried`].
fn alone<S, const N: usize, const K: usize>(
    system: &S,
    (node, stages): (&Node<N>, &LastStages<N, K>),
    h: f64,
    shift: f64,
) -> Result<Tried<N, K>, StepError>
where
    S: Convertible<N>,
{
    let cache = &mut Buffer::default();
    LengthsOfStages::of(system, Instructions::detected(), stages, cache).tried(node, h, shift, None)
}

/// The solver of [`EnergyPreservingGauss`](super::EnergyPreservingGauss) steps without constraints.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FreeLengths<const STAGES: usize>;

impl<S, const N: usize, const STAGES: usize> LengthSolver<S, N, STAGES> for FreeLengths<STAGES>
where
    S: Convertible<N, Kind = Free>,
{
    type Steps = LastStages<N, STAGES>;
    type Cache = Cache<N, STAGES>;
    type Taken = Step<N, STAGES>;
    type DenseOutput = GaussOutput<N, STAGES>;

    fn check_start(_system: &S, _node: &Node<N>) -> Result<(), StepError> {
        Ok(())
    }

    fn fresh(system: &S, node: &Node<N>, h: f64) -> Result<Self::Steps, StepError> {
        LastStages::constant(system, node, h)
    }

    fn first(system: &S, node: &Node<N>, h: f64, steps: &mut Self::Steps) -> Result<f64, StepError> {
        let first = alone(system, (node, steps), h, 0.0)?;
        steps.stages = SMatrix::from_array_storage(ArrayStorage(first.step.stages));
        Ok(first.residual)
    }

    fn next(
        system: &S,
        instructions: Instructions,
        (node, stages, history): (&Node<N>, &Self::Steps, &StepHistory),
        cache: &mut Self::Cache,
    ) -> Result<PreservingStep<Step<N, STAGES>>, StepError> {
        let steps = &LengthsOfStages::of(system, instructions, stages, cache);
        Preserving { steps, node, history }.next()
    }

    fn given(
        system: &S,
        (node, stages, history): (&Node<N>, &Self::Steps, &StepHistory),
        h: f64,
    ) -> Result<GivenStep<Step<N, STAGES>>, StepError> {
        let cache = &mut Buffer::default();
        super::given(&LengthsOfStages::of(system, Instructions::detected(), stages, cache), node, h, history.shift)
    }

    fn end(node: &Node<N>, step: &Step<N, STAGES>) -> Node<N> {
        let mut after = *node;
        after.advance(step.h, &step.increment.velocity, &step.increment.momentum);
        after
    }

    fn take(stages: &mut Self::Steps, before: &Node<N>, step: &Step<N, STAGES>, _cache: &mut Self::Cache) {
        stages.keep(before, step);
    }

    fn changed(_system: &S, node: &Node<N>, _h: f64, stages: &Self::Steps) -> Result<Self::Steps, StepError> {
        Ok(LastStages { before: *node, ..*stages })
    }

    fn residual(stages: &Self::Steps) -> f64 {
        stages.convergence.change
    }

    fn dense_output(
        system: &S,
        stages: &Self::Steps,
        before: &State<N>,
        node: &Node<N>,
        h: f64,
    ) -> Result<GaussOutput<N, STAGES>, StepError> {
        stages.dense_output(system, before, node, h)
    }

    fn check(_system: &S, node: &Node<N>, stages: &Self::Steps) -> Result<(), StepError> {
        stages.check(node.t)
    }

    fn step_density(system: &S, state: &State<N>) -> Result<f64, StepError> {
        step_density::<S, N, STAGES>(system, state)
    }

    fn energies(run: &Run<Gauss<STAGES>, S, N>, base: f64) -> [f64; 2] {
        let LastStages { before, stages, h, .. } = &run.memory;
        let Energies { start, end, .. } = energies(&run.system, before, *h, stages.data.0, base);
        [start, end]
    }

    #[cfg(feature = "alloc")]
    fn vary(
        run: &Run<EnergyPreservingGauss<STAGES>, S, N>,
        before: &Node<N>,
        variations: &mut [Variation<N>],
    ) -> Result<(), StepError> {
        let Lengths { steps: last, history } = &run.memory;
        check_fallback(history.control.fallback, before.t)?;
        // The energy differs if `set_parameters` came between `before` and the step.
        if !last.has_step(&run.node) || !last.before.is_at(before) || history.control.kind != StepKind::EnergyPreserving
        {
            return Err(not_last(before.t));
        }
        vary_length::<N, STAGES>((before.t, last.h), history.shift, Sought::Length, variations, |all, energies| {
            vary(&run.system, (before, last.h, &last.stages.data.0), all, Some(energies))
        })
    }

    #[cfg(feature = "alloc")]
    fn vary_given(
        Run { system, node, memory: Lengths { steps, history }, .. }: &Run<EnergyPreservingGauss<STAGES>, S, N>,
        h: f64,
        sought: Sought,
        variations: &mut [Variation<N>],
    ) -> Result<(), StepError> {
        let stages = alone(system, (node, steps), h, history.shift)?.step.stages;
        vary_length::<N, STAGES>((node.t, h), history.shift, sought, variations, |all, energies| {
            vary(system, (node, h, &stages), all, Some(energies))
        })
    }
}
