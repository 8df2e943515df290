//! A method of a known type, behind the traits of [`AnyMethod`](super::AnyMethod): what is compiled for each method.

use super::{AnyMemory, AnyOutput};
use crate::erasable::{Erasable, Runnable};
use crate::simulation::ShiftedEnergy;
use core::fmt::Debug;
use core::marker::PhantomData;
use std::sync::Arc;
#[cfg(feature = "derivatives")]
use vi_core::derivatives::{Covector, Differentiable, Variation};
use vi_core::method::{Change, Facts, Memory as _, Problem, Status};
#[cfg(feature = "derivatives")]
use vi_core::nalgebra::DMatrix;
use vi_core::node::Node;
#[cfg(feature = "sessions")]
use vi_core::run::Crossing;
use vi_core::run::{Crossings, Event, Parts};
use vi_core::{Called, Method, Presumed, Run, State, StepError};

/// A run as the loop over its steps shows it.
pub(crate) trait Progress<const N: usize> {
    /// [`Run::t`].
    fn t(&self) -> f64;
    /// [`Run::state`].
    #[cfg(feature = "sessions")]
    fn state(&self) -> State<N>;
    /// [`Run::time_to`].
    #[cfg(feature = "sessions")]
    fn time_to(&self, t: f64) -> f64;
    /// [`Run::longest`].
    #[cfg(feature = "sessions")]
    fn longest(&self) -> f64;
    /// [`Run::h`].
    #[cfg(feature = "sessions")]
    fn h(&self) -> f64;
}

impl<M: Method<S, N>, S: Runnable<N>, const N: usize> Progress<N> for Run<M, S, N> {
    fn t(&self) -> f64 {
        self.t()
    }

    #[cfg(feature = "sessions")]
    fn state(&self) -> State<N> {
        self.state()
    }

    #[cfg(feature = "sessions")]
    fn time_to(&self, t: f64) -> f64 {
        self.time_to(t)
    }

    #[cfg(feature = "sessions")]
    fn longest(&self) -> f64 {
        self.longest()
    }

    #[cfg(feature = "sessions")]
    fn h(&self) -> f64 {
        self.h()
    }
}

/// Whether a loop takes a further step.
pub(crate) type GoesOn<'a, const N: usize> = &'a mut dyn FnMut(&dyn Progress<N>) -> bool;

/// The functions of a method that need no memory.
pub(super) trait ErasedMethod<S, const N: usize>: Debug + Send + Sync {
    fn facts(&self) -> Facts;
    fn with_tolerance(&self, tolerance: f64) -> Arc<dyn ErasedMethod<S, N>>;
    fn check_length(&self, system: &S, h: f64) -> Result<(), StepError>;
    fn begin(&self, system: &S, node: &mut Node<N>, h: f64) -> Result<AnyMemory<S, N>, StepError>;
    fn evaluations(&self, iterations: u32) -> u64;
    #[cfg(feature = "derivatives")]
    fn keeps_energy(&self) -> bool;
    #[cfg(feature = "derivatives")]
    fn depends_on_time(&self, system: &S) -> bool;
    #[cfg(feature = "checkpoints")]
    fn memory(&self, text: &str) -> Result<AnyMemory<S, N>, String>;
}

/// The functions of a method with its memory.
pub(super) trait ErasedMemory<S, const N: usize>: Debug + Send + Sync {
    fn copy(&self) -> AnyMemory<S, N>;
    fn stored(&self) -> AnyMemory<S, N>;
    /// [`Method::advance`], then [`Method::recover`] if that fails.
    fn advance(&mut self, system: &S, h: f64, node: &mut Node<N>) -> Result<(), StepError>;
    /// Takes steps while `goes_on`, and adds their evaluations.
    fn advance_while(
        &mut self,
        system: &S,
        parts: Parts<(), N>,
        evaluations: &mut u64,
        goes_on: GoesOn<'_, N>,
    ) -> (Parts<(), N>, Result<(), StepError>);
    /// [`Run::states_at`]. This and the two searches for events take single steps: behind a pointer each would allocate.
    #[cfg(feature = "sessions")]
    fn states_at(
        &mut self,
        system: &S,
        parts: Parts<(), N>,
        times: &[f64],
        push: &mut dyn FnMut(State<N>),
    ) -> (Parts<(), N>, Result<(), StepError>);
    /// [`Run::events`].
    fn events(
        &mut self,
        system: &S,
        parts: Parts<(), N>,
        events: (&[Event<N>], f64),
        search: &mut dyn FnMut(Crossings<'_, N>),
    ) -> Parts<(), N>;
    /// [`Run::next_event`].
    #[cfg(feature = "sessions")]
    fn next_event(
        &mut self,
        system: &S,
        parts: Parts<(), N>,
        events: (&[Event<N>], f64),
    ) -> (Parts<(), N>, Result<Option<Crossing<N>>, StepError>);
    fn step_of(&self, system: &S, node: &Node<N>, lengths: [f64; 2]) -> Result<(Node<N>, AnyMemory<S, N>), StepError>;
    fn restarted(
        &self,
        system: &S,
        change: &Change<'_, S, N>,
        node: &mut Node<N>,
        h: f64,
    ) -> Result<AnyMemory<S, N>, StepError>;
    fn dense_output(&self, system: &S, before: &State<N>, node: &Node<N>, h: f64) -> Result<AnyOutput<N>, StepError>;
    fn status(&self, h: f64) -> Status;
    fn discrete_energy(&self, system: &S, node: &Node<N>, h: f64) -> Option<f64>;
    fn check(&self, system: &S, node: &Node<N>, h: f64) -> Result<(), StepError>;
    fn sampled_energy(&self, system: &S, parts: Parts<(), N>) -> Result<(f64, f64), StepError>;
    fn shifted_energy(&self, system: &S, parts: Parts<(), N>) -> Option<ShiftedEnergy>;
    #[cfg(feature = "checkpoints")]
    fn text(&self) -> Result<String, String>;
    #[cfg(feature = "derivatives")]
    fn vary(
        &self,
        system: &S,
        parts: Parts<(), N>,
        before: &Node<N>,
        variations: &mut [Variation<N>],
    ) -> Result<(), StepError>;
    #[cfg(feature = "derivatives")]
    fn vary_step_of(
        &self,
        system: &S,
        parts: Parts<(), N>,
        length: f64,
        variations: &mut [Variation<N>],
    ) -> Result<(), StepError>;
    #[cfg(feature = "derivatives")]
    fn vary_start(&self, system: &S, parts: Parts<(), N>, variations: &mut [Variation<N>]) -> Result<(), StepError>;
    #[cfg(feature = "derivatives")]
    fn curvature(
        &self,
        system: &S,
        parts: Parts<(), N>,
        before: &Node<N>,
        of: (&[Variation<N>], &Covector<N>),
    ) -> Result<Option<DMatrix<f64>>, StepError>;
}

/// A system S as a method takes it: itself, or in a wrapper.
pub trait Wraps<S> {
    /// The system in the wrapper.
    fn wrapped(system: S) -> Self;
}

impl<S> Wraps<S> for S {
    fn wrapped(system: S) -> S {
        system
    }
}

impl<S> Wraps<S> for Called<S> {
    fn wrapped(system: S) -> Self {
        Called(system)
    }
}

impl<S> Wraps<S> for Presumed<S> {
    fn wrapped(system: S) -> Self {
        Presumed(system)
    }
}

/// A method M that takes the system as W.
pub(super) struct Known<M, W> {
    method: M,
    system: PhantomData<fn() -> W>,
}

impl<M, W> Known<M, W> {
    /// A method of this type.
    pub(super) fn of(method: M) -> Self {
        Self { method, system: PhantomData }
    }
}

impl<M: Debug, W> Debug for Known<M, W> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        self.method.fmt(f)
    }
}

impl<M: Erasable<W, N>, S: Runnable<N>, W: Runnable<N> + Wraps<S>, const N: usize> ErasedMethod<S, N> for Known<M, W> {
    fn facts(&self) -> Facts {
        Method::<W, N>::facts(&self.method)
    }

    fn with_tolerance(&self, tolerance: f64) -> Arc<dyn ErasedMethod<S, N>> {
        Arc::new(Self::of(Method::<W, N>::with_tolerance(&self.method, tolerance)))
    }

    fn check_length(&self, system: &S, h: f64) -> Result<(), StepError> {
        Method::check_length(&self.method, &W::wrapped(*system), h)
    }

    fn begin(&self, system: &S, node: &mut Node<N>, h: f64) -> Result<AnyMemory<S, N>, StepError> {
        let memory = self.method.begin(&W::wrapped(*system), node, h)?;
        Ok(Remembered::<M, W, N>::of(&self.method, memory))
    }

    fn evaluations(&self, iterations: u32) -> u64 {
        Erasable::<W, N>::evaluations(&self.method, iterations)
    }

    #[cfg(feature = "derivatives")]
    fn keeps_energy(&self) -> bool {
        Differentiable::<W, N>::keeps_energy(&self.method)
    }

    #[cfg(feature = "derivatives")]
    fn depends_on_time(&self, system: &S) -> bool {
        Differentiable::depends_on_time(&self.method, &W::wrapped(*system))
    }

    #[cfg(feature = "checkpoints")]
    fn memory(&self, text: &str) -> Result<AnyMemory<S, N>, String> {
        let memory = serde_json::from_str(text).map_err(|error| error.to_string())?;
        Ok(Remembered::<M, W, N>::of(&self.method, memory))
    }
}

/// A method with its memory.
pub(super) struct Remembered<M: Method<W, N>, W, const N: usize> {
    method: M,
    memory: M::Memory,
    /// Computed at the first step.
    prepared: Option<M::Prepared>,
    cache: M::Cache,
}

impl<M: Method<W, N>, W, const N: usize> Debug for Remembered<M, W, N> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        self.memory.fmt(f)
    }
}

impl<M: Erasable<W, N>, W: Runnable<N>, const N: usize> Remembered<M, W, N> {
    /// The memory behind a pointer.
    pub(super) fn of<S: Runnable<N>>(method: &M, memory: M::Memory) -> AnyMemory<S, N>
    where
        W: Wraps<S>,
    {
        AnyMemory(Box::new(Self { method: method.clone(), memory, prepared: None, cache: M::Cache::default() }))
    }

    /// The run of the known type.
    fn run<S: Runnable<N>>(&self, system: &S, parts: Parts<(), N>) -> Run<M, W, N>
    where
        W: Wraps<S>,
    {
        Run::from_parts(self.method.clone(), W::wrapped(*system), parts.with(self.memory.clone()))
    }

    /// Keeps the memory of a run that ends, and returns its parts.
    fn kept(&mut self, run: Run<M, W, N>) -> Parts<(), N> {
        let parts = run.parts();
        self.memory = run.into_memory();
        parts
    }
}

impl<M: Erasable<W, N>, S: Runnable<N>, W: Runnable<N> + Wraps<S>, const N: usize> ErasedMemory<S, N>
    for Remembered<M, W, N>
{
    fn copy(&self) -> AnyMemory<S, N> {
        Self::of(&self.method, self.memory.clone())
    }

    fn stored(&self) -> AnyMemory<S, N> {
        Self::of(&self.method, self.memory.stored())
    }

    fn advance(&mut self, system: &S, h: f64, node: &mut Node<N>) -> Result<(), StepError> {
        let Self { method, memory, prepared, cache } = self;
        let system = &W::wrapped(*system);
        let prepared = prepared.get_or_insert_with(|| method.prepare(system, h));
        if let Err(left) = method.advance(system, prepared, h, (node, memory), cache) {
            let at = Problem { system, prepared, node, h };
            let step = method.recover(at, memory, cache, left)?;
            Method::<W, N>::take(method, system, h, (node, memory), cache, step);
        }
        Ok(())
    }

    fn advance_while(
        &mut self,
        system: &S,
        parts: Parts<(), N>,
        evaluations: &mut u64,
        goes_on: GoesOn<'_, N>,
    ) -> (Parts<(), N>, Result<(), StepError>) {
        // A local run: behind a pointer its numbers would go through memory in every step.
        let mut run = self.run(system, parts);
        let mut outcome = Ok(());
        while outcome.is_ok() && goes_on(&run) {
            outcome = run.step().map(drop);
            if outcome.is_ok() {
                *evaluations += Erasable::<W, N>::evaluations(&self.method, run.iterations());
            }
        }
        (self.kept(run), outcome)
    }

    #[cfg(feature = "sessions")]
    fn states_at(
        &mut self,
        system: &S,
        parts: Parts<(), N>,
        times: &[f64],
        push: &mut dyn FnMut(State<N>),
    ) -> (Parts<(), N>, Result<(), StepError>) {
        let mut run = self.run(system, parts);
        let outcome = run.states_at(times.iter().copied()).try_for_each(|state| state.map(&mut *push));
        (self.kept(run), outcome)
    }

    fn events(
        &mut self,
        system: &S,
        parts: Parts<(), N>,
        (events, until): (&[Event<N>], f64),
        search: &mut dyn FnMut(Crossings<'_, N>),
    ) -> Parts<(), N> {
        let mut run = self.run(system, parts);
        search(run.events(events, until));
        self.kept(run)
    }

    #[cfg(feature = "sessions")]
    fn next_event(
        &mut self,
        system: &S,
        parts: Parts<(), N>,
        (events, until): (&[Event<N>], f64),
    ) -> (Parts<(), N>, Result<Option<Crossing<N>>, StepError>) {
        let mut run = self.run(system, parts);
        let outcome = run.next_event(events, until);
        (self.kept(run), outcome)
    }

    fn step_of(&self, system: &S, node: &Node<N>, lengths: [f64; 2]) -> Result<(Node<N>, AnyMemory<S, N>), StepError> {
        let Self { method, memory, .. } = self;
        let (node, memory) = method.step_of(&W::wrapped(*system), (node, memory), lengths)?;
        Ok((node, Self::of(method, memory)))
    }

    fn restarted(
        &self,
        system: &S,
        change: &Change<'_, S, N>,
        node: &mut Node<N>,
        h: f64,
    ) -> Result<AnyMemory<S, N>, StepError> {
        let Self { method, memory, .. } = self;
        let system = W::wrapped(*system);
        let before = change.before().map_or(system, |before| W::wrapped(*before));
        Ok(Self::of(method, method.restarted(&system, &change.of(&before), node, h, memory)?))
    }

    fn dense_output(&self, system: &S, before: &State<N>, node: &Node<N>, h: f64) -> Result<AnyOutput<N>, StepError> {
        let Self { method, memory, .. } = self;
        let output = method.dense_output(&W::wrapped(*system), before, node, h, memory)?;
        Ok(AnyOutput::of(output))
    }

    fn status(&self, h: f64) -> Status {
        Method::<W, N>::status(&self.method, h, &self.memory)
    }

    fn discrete_energy(&self, system: &S, node: &Node<N>, h: f64) -> Option<f64> {
        self.method.discrete_energy(&W::wrapped(*system), node, h, &self.memory)
    }

    fn check(&self, system: &S, node: &Node<N>, h: f64) -> Result<(), StepError> {
        self.method.check(&W::wrapped(*system), (node, &self.memory), h)
    }

    fn sampled_energy(&self, system: &S, parts: Parts<(), N>) -> Result<(f64, f64), StepError> {
        M::sampled_energy(&self.run(system, parts))
    }

    fn shifted_energy(&self, system: &S, parts: Parts<(), N>) -> Option<ShiftedEnergy> {
        M::shifted_energy(&self.run(system, parts))
    }

    #[cfg(feature = "checkpoints")]
    fn text(&self) -> Result<String, String> {
        let text = serde_json::to_string(&self.memory).map_err(|error| error.to_string())?;
        // JSON has no infinite number: it writes null.
        serde_json::from_str::<M::Memory>(&text).map_err(|error| error.to_string())?;
        Ok(text)
    }

    #[cfg(feature = "derivatives")]
    fn vary(
        &self,
        system: &S,
        parts: Parts<(), N>,
        before: &Node<N>,
        variations: &mut [Variation<N>],
    ) -> Result<(), StepError> {
        M::vary(&self.run(system, parts), before, variations)
    }

    #[cfg(feature = "derivatives")]
    fn vary_step_of(
        &self,
        system: &S,
        parts: Parts<(), N>,
        length: f64,
        variations: &mut [Variation<N>],
    ) -> Result<(), StepError> {
        M::vary_step_of(&self.run(system, parts), length, variations)
    }

    #[cfg(feature = "derivatives")]
    fn vary_start(&self, system: &S, parts: Parts<(), N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        M::vary_start(&self.run(system, parts), variations)
    }

    #[cfg(feature = "derivatives")]
    fn curvature(
        &self,
        system: &S,
        parts: Parts<(), N>,
        before: &Node<N>,
        (directions, weights): (&[Variation<N>], &Covector<N>),
    ) -> Result<Option<DMatrix<f64>>, StepError> {
        M::curvature(&self.run(system, parts), before, directions, weights)
    }
}
