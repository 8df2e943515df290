//! Methods: solvers of the next step.
//!
//! A method solves a step from a system, a node, a length h and the [`Method::Memory`] of the last steps.
//! [`Method::solve`] changes nothing; [`Method::take`] advances to the end of the step. [`Run`](crate::run::Run) takes
//! steps and keeps the failure. It adds output at given times, events and checkpoints for all methods.
//!
//! | file | method |
//! |---|---|
//! | `fixed` | [`FixedStep`]: the rule of the system, order 2 |
//! | `composition` | [`Composition`]: fixed steps of order 4, 6, 8 |
//! | `splitting` | [`Splitting`]: explicit kicks and drifts of systems whose forces depend on the coordinates alone, order 2, 4, 6 |
//! | `composed` | [`Composed`]: compositions of steps with constraints, order 4, 6, 8 |
//! | `gauss` | [`Gauss`]: collocation at S Gauss points, order 2S, with or without constraints |
//! | `adaptive` | [`Adaptive`]: Gauss steps whose length follows the motion, order 2S |
//! | `transformed` | [`InTransformedTime`]: Gauss steps of constant length in transformed time |
//! | `energy` | [`EnergyPreserving`]: steps of order 2 whose length preserves the discrete energy |
//! | `energy_gauss` | [`EnergyPreservingGauss`]: the same with Gauss steps, order 2S |
//! | `change` | changes of a run between two steps: length, parameters, state |
//! | `bounds` | bounds of a step length, and fixed steps if no energy-preserving step exists |
//! | `preserving` | energy-preserving steps among steps of any length |
//! | `shift` | the shift of the step density |
//! | `length` | the search for the step length |

pub mod adaptive;
pub mod bounds;
pub mod change;
#[cfg(feature = "alloc")]
pub mod composed;
#[cfg(feature = "alloc")]
pub mod composition;
pub mod energy;
pub mod energy_gauss;
pub mod fixed;
pub mod gauss;
pub(crate) mod length;
pub(crate) mod preserving;
pub mod shift;
pub mod splitting;
pub mod transformed;

pub use adaptive::Adaptive;
pub use bounds::{Control, Controlled, Fallback, Switches};
pub use change::Change;
#[cfg(feature = "alloc")]
pub use composed::Composed;
#[cfg(feature = "alloc")]
pub use composition::Composition;
pub use energy::EnergyPreserving;
pub use energy_gauss::EnergyPreservingGauss;
/// The name of [`EnergyPreservingGauss`] for systems with constraints, until both became one.
pub use energy_gauss::EnergyPreservingGauss as EnergyPreservingGaussLobatto;
pub use fixed::{Connected, FixedStep};
pub use gauss::Gauss;
/// The name of [`Gauss`] for systems with constraints, until both became one.
pub use gauss::Gauss as GaussLobatto;
pub use shift::{Shiftable, StepPower};
pub use splitting::Splitting;
pub use transformed::InTransformedTime;

use crate::dense_output::DenseOutput;
use crate::error::StepError;
use crate::node::Node;
use crate::real::Scalar;
use crate::state::State;
use core::fmt::Debug;

/// Inputs of a step, except the memory of the run.
#[derive(Debug)]
pub struct Problem<'a, S, P, const N: usize, T = f64> {
    /// The system.
    pub system: &'a S,
    /// Data shared by all steps of this length.
    pub prepared: &'a P,
    /// The start node of the step.
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

/// Data that a checkpoint can store: with the feature `serde`, data that serde writes and reads.
#[cfg(feature = "serde")]
pub trait Storable: serde::Serialize + serde::de::DeserializeOwned {}
#[cfg(feature = "serde")]
impl<Y: serde::Serialize + serde::de::DeserializeOwned> Storable for Y {}

/// Data that a checkpoint can store: with the feature `serde`, data that serde writes and reads.
#[cfg(not(feature = "serde"))]
pub trait Storable {}
#[cfg(not(feature = "serde"))]
impl<Y> Storable for Y {}

/// Data that a run carries between steps, beside its node.
pub trait Memory: Clone + Debug + Send + Sync {
    /// A copy that shares no memory with this one.
    ///
    /// A small memory passes each number through `black_box`, so that a loop over steps keeps its own numbers in
    /// registers. A large one is cloned.
    #[must_use]
    fn apart(&self) -> Self {
        self.clone()
    }

    /// The data of a checkpoint: finite numbers only, so that a text format without infinities can store it.
    #[must_use]
    fn stored(&self) -> Self {
        self.clone()
    }
}

/// Facts about a method that hold for every system.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Facts {
    /// The order p: the error of a step is O(h^(p+1)).
    pub order: u32,
    /// Name of the rule, unless it is the first rule of the system. A checkpoint stores it.
    pub rule: Option<&'static str>,
    /// Whether [`Method::solve`] finds the step length itself.
    pub finds_length: bool,
    /// Whether these lengths follow the forces, so that a few steps show the errors of all.
    pub follows_forces: bool,
    /// Whether the method takes systems with constraints, whose reactions may do work.
    pub has_reactions: bool,
}

impl Facts {
    /// Steps of a given length and of this order, without constraints.
    #[allow(clippy::cast_possible_truncation)] // twice the stages
    pub(crate) fn of_order(order: usize) -> Self {
        Self { order: order as u32, ..Self::default() }
    }
}

/// Length, residual and cost of the last step, and a bound of the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status<T = f64> {
    /// Length of a step in time; that of the last step if the method finds it.
    pub length: T,
    /// Upper bound of the next step length in time, with the sign of h.
    pub longest: T,
    /// Largest residual of the step, in units of its rounding-error bound, or of a part of a tolerance. Zero before the first
    /// step.
    pub residual: f64,
    /// Newton or fixed-point iterations.
    pub iterations: u32,
}

impl<T: Copy> Status<T> {
    /// The status of steps of a given length, before the first one.
    pub(crate) fn of_length(h: T) -> Self {
        Self { length: h, longest: h, residual: 0.0, iterations: 0 }
    }
}

/// A method of stepping a system S of N coordinates over the numbers T.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot integrate `{S}`",
    label = "this method needs something that `{S}` does not have",
    note = "`Gauss` and `EnergyPreservingGauss` take every system; they keep constraints, which other methods would ignore",
    note = "`FixedStep`, `Composition`, `EnergyPreserving` need the clause `discretize midpoint;` and a system without constraints",
    note = "`Splitting` needs a constant mass matrix, and forces that depend on time and coordinates alone",
    note = "a method in transformed time needs the clause `time_scale = …;`"
)]
pub trait Method<S, const N: usize, T: Scalar = f64>: Clone + Debug + Send + Sync {
    /// Data that depends on the system and h only. A checkpoint does not store it.
    type Prepared: Clone + Debug + Send + Sync;
    /// Data for the guess of the next step. A checkpoint stores it.
    type Memory: Memory;
    /// Reusable buffers. No result depends on them.
    type Cache: Clone + Debug + Default + Send + Sync;
    /// A solved step.
    type Step;
    /// The result of a failed attempt.
    type Left;
    /// Dense output of a step.
    type DenseOutput: DenseOutput<N, T> + Send + Sync + 'static;

    /// Facts about the method that hold for every system.
    fn facts(&self) -> Facts;

    /// The method for steps whose errors may be as large as a tolerance. Only the lengths of the steps depend on it, unless
    /// the method says more.
    #[must_use]
    fn with_tolerance(&self, _tolerance: f64) -> Self {
        self.clone()
    }

    /// Checks the given step length.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for one that is zero, subnormal or not finite.
    fn check_length(&self, _system: &S, h: T) -> Result<(), StepError> {
        check_step(h)
    }

    /// Prepares the data shared by all steps of the length h.
    fn prepare(&self, system: &S, h: T) -> Self::Prepared;

    /// The memory before the first step. Sets the energy of the node if the method preserves one.
    ///
    /// # Errors
    /// The reason why no run can begin there.
    fn begin(&self, system: &S, node: &mut Node<N, T>, h: T) -> Result<Self::Memory, StepError>;

    /// Solves a step on the hot path, inlined into the loop over steps.
    ///
    /// # Errors
    /// The result of the failed attempt, for [`Method::recover`].
    fn attempt(
        &self,
        at: Problem<'_, S, Self::Prepared, N, T>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
    ) -> Result<Self::Step, Self::Left>;

    /// Solves a step on the cold path.
    ///
    /// # Errors
    /// The reason why the step failed.
    fn recover(
        &self,
        at: Problem<'_, S, Self::Prepared, N, T>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
        left: Self::Left,
    ) -> Result<Self::Step, StepError>;

    /// Solves the next step. Changes nothing.
    ///
    /// # Errors
    /// The reason why the step failed.
    fn solve(
        &self,
        at: Problem<'_, S, Self::Prepared, N, T>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
    ) -> Result<Self::Step, StepError> {
        self.attempt(at, memory, cache).or_else(|left| self.recover(at, memory, cache, left))
    }

    /// [`Method::attempt`], then [`Method::take`] on success.
    ///
    /// A method overrides it to do both inside one dispatched function: a step that is returned by a wide store and
    /// copied by narrow ones stalls the next wide load.
    ///
    /// # Errors
    /// The result of the failed attempt. Node and memory have then not changed.
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
        self.take(system, h, (node, memory), cache, step);
        Ok(())
    }

    /// Advances to the end of a step. Cannot fail: [`Method::solve`] has checked every condition.
    fn take(
        &self,
        system: &S,
        h: T,
        run: (&mut Node<N, T>, &mut Self::Memory),
        cache: &mut Self::Cache,
        step: Self::Step,
    );

    /// The node and the memory after one step of the length h in time. Later steps have the length `next` of the run.
    ///
    /// # Errors
    /// The reason why the step failed.
    fn step_of(
        &self,
        system: &S,
        (node, memory): (&Node<N, T>, &Self::Memory),
        [h, next]: [T; 2],
    ) -> Result<(Node<N, T>, Self::Memory), StepError> {
        check_step(h)?;
        let mut node = *node;
        let memory = self.restarted(system, &Change::NewLength, &mut node, h, memory)?;
        step_from(self, system, (&node, memory), [h, next])
    }

    /// The memory of a run that continues after a change with the system and the length h; moves the node. A method that
    /// preserves an energy adds the change of H to it.
    ///
    /// # Errors
    /// The reason why no step can start there.
    fn restarted(
        &self,
        system: &S,
        change: &Change<'_, S, N, T>,
        node: &mut Node<N, T>,
        h: T,
        memory: &Self::Memory,
    ) -> Result<Self::Memory, StepError>;

    /// Dense output of the last step, from `before` to the node.
    ///
    /// # Errors
    /// The reason why no velocity has the momenta at one of its ends.
    fn dense_output(
        &self,
        system: &S,
        before: &State<N, T>,
        node: &Node<N, T>,
        h: T,
        memory: &Self::Memory,
    ) -> Result<Self::DenseOutput, StepError>;

    /// Length, residual and cost of the last step, and a bound of the next one. h is the length of the steps in the
    /// unit of the method.
    fn status(&self, h: T, memory: &Self::Memory) -> Status<T>;

    /// Discrete energy `E1 = −D3 L_d − g_d⁺` of the last step, if there is one.
    fn discrete_energy(&self, _system: &S, _node: &Node<N, T>, _h: T, _memory: &Self::Memory) -> Option<T> {
        None
    }

    /// Checks whether a run can continue from a stored node, whose numbers are finite, and a stored memory. A file may
    /// contain any numbers.
    ///
    /// # Errors
    /// The first invalid number, or the constraint that the node does not satisfy.
    fn check(&self, _system: &S, _at: (&Node<N, T>, &Self::Memory), _h: T) -> Result<(), StepError> {
        Ok(())
    }
}

/// The node and the memory after one step of the length h, with the memory of steps of this length; that is then of the
/// length `next`.
///
/// # Errors
/// The reason why the step failed.
pub(crate) fn step_from<M: Method<S, N, T>, S, const N: usize, T: Scalar>(
    method: &M,
    system: &S,
    (node, mut memory): (&Node<N, T>, M::Memory),
    [h, next]: [T; 2],
) -> Result<(Node<N, T>, M::Memory), StepError> {
    let mut node = *node;
    let prepared = method.prepare(system, h);
    let at = Problem { system, prepared: &prepared, node: &node, h };
    let cache = &mut M::Cache::default();
    let step = method.solve(at, &memory, cache)?;
    method.take(system, h, (&mut node, &mut memory), cache, step);
    let memory = method.restarted(system, &Change::NewLength, &mut node, next, &memory)?;
    Ok((node, memory))
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
