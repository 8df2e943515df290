//! Methods: how the next step is found.
//!
//! In: a system, a node, a length h and the [`Method::Memory`] of the steps before. Out: a step. Finding a step changes nothing; [`Method::take`] moves to its end.
//! [`Run`](crate::run::Run) takes steps, keeps the failure, and has states at given times, events and checkpoints for all methods.
//!
//! | file | method |
//! |---|---|
//! | `fixed` | [`FixedStep`]: the rule of the system, order 2 |
//! | `composition` | [`Composition`]: fixed steps of order 4, 6, 8 |
//! | `gauss` | [`Gauss`]: collocation at S Gauss points, order 2S |
//! | `transformed` | [`InTransformedTime`]: Gauss steps of constant length in transformed time |
//! | `energy` | [`EnergyPreserving`]: steps of order 2 whose length keeps the discrete energy |
//! | `energy_gauss` | [`EnergyPreservingGauss`]: the same with Gauss steps, order 2S |
//! | `bounds` | bounds of a step length, and fixed steps where no energy-preserving step exists |
//! | `length` | which length a step has: a search over a pure solve |

pub mod bounds;
pub mod composition;
pub mod energy;
pub mod energy_gauss;
pub mod fixed;
pub mod gauss;
pub(crate) mod length;
pub mod transformed;

pub use bounds::{Control, Controlled, Fallback, Switches};
pub use composition::Composition;
pub use energy::EnergyPreserving;
pub use energy_gauss::EnergyPreservingGauss;
pub use fixed::{Connected, FixedStep};
pub use gauss::Gauss;
pub use transformed::InTransformedTime;

use crate::error::StepError;
use crate::node::Node;
use crate::real::Scalar;
use crate::run::DenseOutput;
use crate::state::State;
use core::fmt::Debug;

/// What a step depends on beside the memory of a run.
#[derive(Debug)]
pub struct Problem<'a, S, P, const N: usize, T = f64> {
    /// The system.
    pub system: &'a S,
    /// What is the same in every step of this length.
    pub prepared: &'a P,
    /// The node before the step.
    pub node: &'a Node<N, T>,
    /// Length of the step, in the unit of the method. A method that finds its length ignores it.
    pub h: T,
}

impl<S, P, const N: usize, T: Copy> Clone for Problem<'_, S, P, N, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, P, const N: usize, T: Copy> Copy for Problem<'_, S, P, N, T> {}

/// What a run carries between two steps beside its node.
pub trait Memory: Clone + Debug {
    /// A copy that shares no memory with this one.
    ///
    /// A small memory passes each number through `black_box`, so that a loop over steps keeps its own numbers in registers. A large one is cloned.
    #[must_use]
    fn apart(&self) -> Self {
        self.clone()
    }

    /// What a checkpoint stores: finite numbers alone, so that a text format without infinities can hold it.
    #[must_use]
    fn stored(&self) -> Self {
        self.clone()
    }
}

/// How well the last step was solved, and by how much work.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// Largest residual of the equations of the step, in roundings. Zero before the first step.
    pub residual: f64,
    /// Newton or fixed-point iterations.
    pub iterations: u32,
}

/// A way to take steps of a system S of N coordinates, in the numbers T.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot integrate `{S}`",
    label = "this method needs something that `{S}` does not have",
    note = "`FixedStep`, `Composition`, `EnergyPreserving` need the clause `discretize midpoint;`, `Gauss` and `EnergyPreservingGauss` take every system",
    note = "a method in transformed time needs the clause `time_scale = …;`"
)]
pub trait Method<S, const N: usize, T: Scalar = f64>: Clone + Debug {
    /// What follows from the system and h alone. A checkpoint does not store it.
    type Prepared: Clone + Debug;
    /// What the next step is guessed from. A checkpoint stores it.
    type Memory: Memory;
    /// Buffers that are kept to be reused. No result depends on them.
    type Cache: Clone + Debug + Default;
    /// A step that was found.
    type Step;
    /// What an attempt got to that did not find one.
    type Left;
    /// The motion between the nodes of a step.
    type DenseOutput: DenseOutput<N, T> + 'static;

    /// Whether [`Method::solve`] finds the length of the step itself.
    const FINDS_LENGTH: bool = false;

    /// Name of the rule, if it is not the first one that the system is declared with. A checkpoint stores it.
    fn rule(&self) -> Option<&'static str> {
        None
    }

    /// The order p: the error of a step is O(h^(p+1)).
    fn order(&self) -> u32;

    /// Checks the length that a run is given.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for one that is zero, subnormal or not finite.
    fn check_length(&self, h: T) -> Result<(), StepError> {
        check_step(h)
    }

    /// What is the same in every step of the length h.
    fn prepare(&self, system: &S, h: T) -> Self::Prepared;

    /// The memory before the first step. Sets the energy of the node, if the method keeps one.
    ///
    /// # Errors
    /// Why no run can begin there.
    fn begin(&self, system: &S, node: &mut Node<N, T>, h: T) -> Result<Self::Memory, StepError>;

    /// The hot path to a step, inlined into the loop over steps.
    ///
    /// # Errors
    /// What it got to, for [`Method::recover`].
    fn attempt(
        &self,
        at: Problem<'_, S, Self::Prepared, N, T>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
    ) -> Result<Self::Step, Self::Left>;

    /// The cold path to a step.
    ///
    /// # Errors
    /// Why there is no step.
    fn recover(
        &self,
        at: Problem<'_, S, Self::Prepared, N, T>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
        left: Self::Left,
    ) -> Result<Self::Step, StepError>;

    /// The next step. Changes nothing.
    ///
    /// # Errors
    /// Why there is no step.
    fn solve(
        &self,
        at: Problem<'_, S, Self::Prepared, N, T>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
    ) -> Result<Self::Step, StepError> {
        self.attempt(at, memory, cache).or_else(|left| self.recover(at, memory, cache, left))
    }

    /// [`Method::attempt`], and [`Method::take`] if it found a step.
    ///
    /// A method overrides it to do both inside one dispatched function: a step that is returned by a wide store and copied by narrow ones stalls the next wide load.
    ///
    /// # Errors
    /// What the attempt got to. Nothing has changed then.
    #[inline(always)]
    fn advance(
        &self,
        system: &S,
        prepared: &Self::Prepared,
        h: T,
        (node, memory): (&mut Node<N, T>, &mut Self::Memory),
        cache: &mut Self::Cache,
    ) -> Result<(), Self::Left> {
        let step = self.attempt(Problem { system, prepared, node, h }, memory, cache)?;
        self.take(h, (node, memory), cache, step);
        Ok(())
    }

    /// Moves to the end of a step. Cannot fail: [`Method::solve`] has checked what can.
    fn take(&self, h: T, run: (&mut Node<N, T>, &mut Self::Memory), cache: &mut Self::Cache, step: Self::Step);

    /// The node and the memory after one step of the length h in time. Further steps have the length `next` of the run.
    ///
    /// # Errors
    /// Why there is no step.
    fn step_of(
        &self,
        system: &S,
        (node, memory): (&Node<N, T>, &Self::Memory),
        [h, next]: [T; 2],
    ) -> Result<(Node<N, T>, Self::Memory), StepError> {
        check_step(h)?;
        let (mut node, mut memory) = (*node, self.with_length(system, memory, node, h)?);
        let prepared = self.prepare(system, h);
        let at = Problem { system, prepared: &prepared, node: &node, h };
        let cache = &mut Self::Cache::default();
        let step = self.solve(at, &memory, cache)?;
        self.take(h, (&mut node, &mut memory), cache, step);
        let memory = self.with_length(system, &memory, &node, next)?;
        Ok((node, memory))
    }

    /// The memory for steps of another length from a node.
    ///
    /// # Errors
    /// Why no step can start there.
    fn with_length(
        &self,
        system: &S,
        memory: &Self::Memory,
        node: &Node<N, T>,
        h: T,
    ) -> Result<Self::Memory, StepError>;

    /// The memory after the system has changed from the first to the second, h the step of the run. A method that keeps an energy adds to it what the change brings.
    ///
    /// # Errors
    /// Why the run cannot continue with the new system.
    fn with_system(
        &self,
        systems: [&S; 2],
        node: &mut Node<N, T>,
        h: T,
        memory: &Self::Memory,
    ) -> Result<Self::Memory, StepError>;

    /// The memory for a run that continues from another state, to which the node is moved.
    ///
    /// # Errors
    /// Why no run can begin there.
    fn with_state(
        &self,
        system: &S,
        node: &mut Node<N, T>,
        h: T,
        _memory: &Self::Memory,
        state: State<N, T>,
    ) -> Result<Self::Memory, StepError> {
        *node = Node::new(state, T::zero());
        self.begin(system, node, h)
    }

    /// The motion over the last step, from `before` to the node.
    ///
    /// # Errors
    /// Why no velocity belongs to the momenta at its ends.
    fn dense_output(
        &self,
        system: &S,
        before: &State<N, T>,
        node: &Node<N, T>,
        h: T,
        memory: &Self::Memory,
    ) -> Result<Self::DenseOutput, StepError>;

    /// Length of a step in time. If the method finds it, that of the last step.
    fn length(&self, h: T, _memory: &Self::Memory) -> T {
        h
    }

    /// The longest that the next step can be in time, with the sign of h.
    fn longest(&self, h: T, _memory: &Self::Memory) -> T {
        h
    }

    /// How well the last step was solved.
    fn report(&self, memory: &Self::Memory) -> Report;

    /// Discrete energy `E1 = −D3 L_d − g_d⁺` of the last step; `None` if there is none.
    fn discrete_energy(&self, _system: &S, _node: &Node<N, T>, _h: T, _memory: &Self::Memory) -> Option<T> {
        None
    }

    /// Whether a run can continue from a stored memory: a file may hold anything.
    ///
    /// # Errors
    /// What is wrong with it.
    fn check(&self, _memory: &Self::Memory, _h: T, _t: T) -> Result<(), StepError> {
        Ok(())
    }
}

/// Rejects zero, subnormal and non-finite h: 1/h must be finite.
///
/// # Errors
/// [`StepError::InvalidInput`].
#[doc(hidden)]
pub fn check_step<T: Scalar>(h: T) -> Result<(), StepError> {
    let value = h.to_f64();
    if value.is_normal() {
        Ok(())
    } else {
        Err(StepError::InvalidInput { input: "the step h", allowed: "finite, not zero and not subnormal", value })
    }
}
