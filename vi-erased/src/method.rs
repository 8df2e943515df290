//! A method behind a pointer.
//!
//! In: a method of a known type. Out: [`AnyMethod`], a method of the same system whose runs take the same steps, bit for
//! bit. Everything that a run can do is generic over its method: with this one it is compiled once for each system. Only
//! a step and the loop over steps are compiled for each method (`method/known.rs`).

mod known;
mod output;

use crate::erasable::{Erasable, Runnable};
use crate::simulation::ShiftedEnergy;
use core::fmt::Debug;
pub use known::Wraps;
use known::{ErasedMemory, ErasedMethod, Known, Remembered};
pub(crate) use known::{GoesOn, Progress};
pub use output::AnyOutput;
use std::sync::Arc;
#[cfg(feature = "derivatives")]
use vi_core::derivatives::{Covector, Differentiable, Variation};
use vi_core::method::{Change, Facts, Memory, Problem, Status};
#[cfg(feature = "derivatives")]
use vi_core::nalgebra::DMatrix;
use vi_core::node::Node;
#[cfg(feature = "sessions")]
use vi_core::run::Crossing;
use vi_core::run::{Crossings, Event, Parts};
use vi_core::{Method, Run, State, StepError};

/// A method of any type that takes the system S.
#[derive(Clone)]
pub struct AnyMethod<S, const N: usize>(Arc<dyn ErasedMethod<S, N>>);

/// The memory of such a method.
pub struct AnyMemory<S, const N: usize>(Box<dyn ErasedMemory<S, N>>);

/// A run of such a method.
pub(crate) type AnyRun<S, const N: usize> = Run<AnyMethod<S, N>, S, N>;

impl<S, const N: usize> Debug for AnyMethod<S, N> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        self.0.fmt(f)
    }
}

impl<S, const N: usize> Debug for AnyMemory<S, N> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        self.0.fmt(f)
    }
}

impl<S, const N: usize> Clone for AnyMemory<S, N> {
    fn clone(&self) -> Self {
        self.0.copy()
    }
}

impl<S, const N: usize> Memory for AnyMemory<S, N> {
    fn stored(&self) -> Self {
        self.0.stored()
    }
}

#[cfg(feature = "checkpoints")]
impl<S, const N: usize> AnyMemory<S, N> {
    /// The memory as text, for [`AnyMethod::memory`].
    ///
    /// # Errors
    /// A number that is not finite.
    pub(crate) fn text(&self) -> Result<String, String> {
        self.0.text()
    }
}

impl<S: Runnable<N>, const N: usize> AnyMethod<S, N> {
    /// A method that takes the system as W.
    pub(crate) fn of<M: Erasable<W, N>, W: Runnable<N> + Wraps<S>>(method: M, _: fn(S) -> W) -> Self {
        Self(Arc::new(Known::<M, W>::of(method)))
    }

    /// The run of a method of a known type.
    pub(crate) fn erased<M: Erasable<W, N>, W: Runnable<N> + Wraps<S>>(system: S, run: Run<M, W, N>) -> AnyRun<S, N> {
        let (method, parts) = (run.method().clone(), run.parts());
        let memory = Remembered::<M, W, N>::of(&method, run.into_memory());
        Run::from_parts(Self::of(method, W::wrapped), system, parts.with(memory))
    }

    /// Evaluations of the equations in a step with these iterations.
    pub(crate) fn evaluations(&self, iterations: u32) -> u64 {
        self.0.evaluations(iterations)
    }

    /// A memory from its text.
    ///
    /// # Errors
    /// Why it cannot be read.
    #[cfg(feature = "checkpoints")]
    pub(crate) fn memory(&self, text: &str) -> Result<AnyMemory<S, N>, String> {
        self.0.memory(text)
    }

    /// Takes steps of a run while `goes_on`, and adds their evaluations.
    ///
    /// # Errors
    /// The error of the failed step.
    pub(crate) fn advance_while(
        run: &mut AnyRun<S, N>,
        evaluations: &mut u64,
        goes_on: GoesOn<'_, N>,
    ) -> Result<(), StepError> {
        Self::within(run, |memory, system, parts| memory.advance_while(system, parts, evaluations, goes_on))
    }

    /// [`Run::states_at`].
    ///
    /// # Errors
    /// As [`Run::states_at`].
    #[cfg(feature = "sessions")]
    pub(crate) fn states_at(
        run: &mut AnyRun<S, N>,
        times: &[f64],
        push: &mut dyn FnMut(State<N>),
    ) -> Result<(), StepError> {
        Self::within(run, |memory, system, parts| memory.states_at(system, parts, times, push))
    }

    /// [`Run::events`], which `search` gets.
    pub(crate) fn events(
        run: &mut AnyRun<S, N>,
        events: &[Event<N>],
        until: f64,
        search: &mut dyn FnMut(Crossings<'_, N>),
    ) {
        Self::within(run, |memory, system, parts| (memory.events(system, parts, (events, until), search), ()));
    }

    /// [`Run::next_event`].
    ///
    /// # Errors
    /// As [`Run::next_event`].
    #[cfg(feature = "sessions")]
    pub(crate) fn next_event(
        run: &mut AnyRun<S, N>,
        events: &[Event<N>],
        until: f64,
    ) -> Result<Option<Crossing<N>>, StepError> {
        Self::within(run, |memory, system, parts| memory.next_event(system, parts, (events, until)))
    }

    /// Advances a run inside a function of its memory.
    fn within<R>(
        run: &mut AnyRun<S, N>,
        advance: impl FnOnce(&mut dyn ErasedMemory<S, N>, &S, Parts<(), N>) -> (Parts<(), N>, R),
    ) -> R {
        let (method, system, mut memory) = (run.method().clone(), *run.system(), run.memory().clone());
        let (parts, outcome) = advance(&mut *memory.0, &system, run.parts());
        *run = Run::from_parts(method, system, parts.with(memory));
        outcome
    }

    /// Time and H at which H is most accurate.
    ///
    /// # Errors
    /// The momenta have no velocity.
    pub(crate) fn sampled_energy(run: &AnyRun<S, N>) -> Result<(f64, f64), StepError> {
        run.memory().0.sampled_energy(run.system(), run.parts())
    }

    /// The conserved quantity of steps with a shift.
    pub(crate) fn shifted_energy(run: &AnyRun<S, N>) -> Option<ShiftedEnergy> {
        run.memory().0.shifted_energy(run.system(), run.parts())
    }
}

impl<S: Runnable<N>, const N: usize> Method<S, N> for AnyMethod<S, N> {
    type Prepared = ();
    type Memory = AnyMemory<S, N>;
    type Cache = ();
    type Step = (Node<N>, AnyMemory<S, N>);
    type Left = StepError;
    type DenseOutput = AnyOutput<N>;

    fn facts(&self) -> Facts {
        self.0.facts()
    }

    fn with_tolerance(&self, tolerance: f64) -> Self {
        Self(self.0.with_tolerance(tolerance))
    }

    fn check_length(&self, system: &S, h: f64) -> Result<(), StepError> {
        self.0.check_length(system, h)
    }

    fn prepare(&self, _system: &S, _h: f64) {}

    fn begin(&self, system: &S, node: &mut Node<N>, h: f64) -> Result<Self::Memory, StepError> {
        self.0.begin(system, node, h)
    }

    fn attempt(
        &self,
        Problem { system, node, h, .. }: Problem<'_, S, (), N>,
        memory: &Self::Memory,
        (): &mut (),
    ) -> Result<Self::Step, StepError> {
        let (mut node, mut memory) = (*node, memory.clone());
        memory.0.advance(system, h, &mut node)?;
        Ok((node, memory))
    }

    fn advance(
        &self,
        system: &S,
        (): &(),
        h: f64,
        (node, memory): (&mut Node<N>, &mut Self::Memory),
        (): &mut (),
    ) -> Result<(), StepError> {
        memory.0.advance(system, h, node)
    }

    fn recover(
        &self,
        _at: Problem<'_, S, (), N>,
        _memory: &Self::Memory,
        (): &mut (),
        left: StepError,
    ) -> Result<Self::Step, StepError> {
        Err(left)
    }

    fn take(
        &self,
        _system: &S,
        _h: f64,
        (node, memory): (&mut Node<N>, &mut Self::Memory),
        (): &mut (),
        step: Self::Step,
    ) {
        (*node, *memory) = step;
    }

    fn step_of(
        &self,
        system: &S,
        (node, memory): (&Node<N>, &Self::Memory),
        lengths: [f64; 2],
    ) -> Result<(Node<N>, Self::Memory), StepError> {
        memory.0.step_of(system, node, lengths)
    }

    fn restarted(
        &self,
        system: &S,
        change: &Change<'_, S, N>,
        node: &mut Node<N>,
        h: f64,
        memory: &Self::Memory,
    ) -> Result<Self::Memory, StepError> {
        memory.0.restarted(system, change, node, h)
    }

    fn dense_output(
        &self,
        system: &S,
        before: &State<N>,
        node: &Node<N>,
        h: f64,
        memory: &Self::Memory,
    ) -> Result<AnyOutput<N>, StepError> {
        memory.0.dense_output(system, before, node, h)
    }

    fn status(&self, h: f64, memory: &Self::Memory) -> Status {
        memory.0.status(h)
    }

    fn discrete_energy(&self, system: &S, node: &Node<N>, h: f64, memory: &Self::Memory) -> Option<f64> {
        memory.0.discrete_energy(system, node, h)
    }

    fn check(&self, system: &S, (node, memory): (&Node<N>, &Self::Memory), h: f64) -> Result<(), StepError> {
        memory.0.check(system, node, h)
    }
}

#[cfg(feature = "derivatives")]
impl<S: Runnable<N>, const N: usize> Differentiable<S, N> for AnyMethod<S, N> {
    fn keeps_energy(&self) -> bool {
        self.0.keeps_energy()
    }

    fn depends_on_time(&self, system: &S) -> bool {
        self.0.depends_on_time(system)
    }

    fn vary(run: &AnyRun<S, N>, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        run.memory().0.vary(run.system(), run.parts(), before, variations)
    }

    fn vary_step_of(run: &AnyRun<S, N>, length: f64, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        run.memory().0.vary_step_of(run.system(), run.parts(), length, variations)
    }

    fn curvature(
        run: &AnyRun<S, N>,
        before: &Node<N>,
        directions: &[Variation<N>],
        weights: &Covector<N>,
    ) -> Result<Option<DMatrix<f64>>, StepError> {
        run.memory().0.curvature(run.system(), run.parts(), before, (directions, weights))
    }

    fn vary_start(run: &AnyRun<S, N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        run.memory().0.vary_start(run.system(), run.parts(), variations)
    }
}
