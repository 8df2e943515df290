//! Runs: one type for all methods.
//!
//! In: a system at a state ([`Start`]), a [`Method`], a step length. Out: states, step after step, at given times or at events; or the typed error of the step that
//! fails. AFTER AN ERROR the run holds the last good state, and returns that error again until it is changed: its parameters, its state or an option.
//!
//! | file | what it adds to a step |
//! |---|---|
//! | `dense_output` | the motion between the two nodes of a step, as polynomials |
//! | `times` | states at given times |
//! | `solution` | states with times and energies, as CSV |
//! | `events` | states at which functions of the motion change their sign |
//! | `search` | the search of one step for them |
//! | `side` | the side of zero on which a function is at a node |
//! | `estimate` | the error of a step, measured; a step length from a tolerance |
//! | `checkpoint` | everything that a run carries, to be stored and resumed bit for bit |
//!
//! A STATE AT A TIME t is reached by a last step that is exactly as long as is left. It is as accurate as a node, of the full order of the method. States at several
//! times and at events that are recorded are computed beside the run, which keeps its own steps bit for bit.

mod checkpoint;
mod dense_output;
mod estimate;
mod events;
mod search;
mod side;
mod solution;
mod times;

pub use checkpoint::{Checkpoint, Stored};
pub use dense_output::{DenseOutput, Hermite};
pub use estimate::{ErrorEstimate, ErrorMonitor, Length, LocalError, Monitored, Tolerance};
pub use events::{Crossing, Crossings, Event, Events, Met, Moment};
pub use solution::Solution;
pub use times::Grid;

use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::{Memory, Method, Problem};
use crate::node::Node;
use crate::real::{Real, Scalar};
use crate::state::{Numbers, State};
use core::hint::black_box;
use nalgebra::SVector;

/// A system at a state, from which any number of runs can start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start<S, const N: usize, T = f64> {
    /// The system.
    pub system: S,
    /// The state.
    pub state: State<N, T>,
}

/// Where runs of a system start: every system has these functions.
pub trait Starts<const N: usize, T: Real = f64>: Lagrangian<N, T> + Copy {
    /// The system at time t with coordinates q and velocities v, in the units of the system.
    fn at(self, t: T, q: impl Numbers<N, T>, v: impl Numbers<N, T>) -> Start<Self, N, T> {
        Start { system: self, state: State::at(&self, t, q, v) }
    }

    /// The system at a state.
    fn at_state(self, state: State<N, T>) -> Start<Self, N, T> {
        Start { system: self, state }
    }
}

impl<S: Lagrangian<N, T> + Copy, const N: usize, T: Real> Starts<N, T> for S {}

impl<S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar> Start<S, N, T> {
    /// A run from here by a method with the step h, in units of time, or with the step that has a [`Tolerance`]. A negative h goes backwards in time. A method that
    /// finds its own lengths begins with about h.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an h that is zero, subnormal or not finite, [`StepError::NonFinite`] for such a state, [`StepError::Singular`] or
    /// [`StepError::NotConverged`] if no velocity belongs to its momenta; those of the method;
    /// [`StepError::Tolerance`] if no step has the tolerance.
    pub fn integrate<M: Method<S, N, T>>(self, method: M, h: impl Length<T>) -> Result<Run<M, S, N, T>, StepError> {
        let h = h.length(&self, &method)?;
        let Self { system, state } = self;
        method.check_length(h)?;
        let mut node = Node::new(state, T::zero());
        let memory = method.begin(&system, &mut node, h)?;
        Ok(Run::resumed(method, system, (node, h, memory)))
    }
}

/// A run of a system S of N coordinates by a method M. See the [module](self).
#[derive(Clone, Debug)]
pub struct Run<M: Method<S, N, T>, S, const N: usize, T: Scalar = f64> {
    pub(crate) method: M,
    pub(crate) system: S,
    pub(crate) prepared: M::Prepared,
    pub(crate) node: Node<N, T>,
    /// Length of a step in the unit of the method.
    pub(crate) h: T,
    pub(crate) memory: M::Memory,
    pub(crate) cache: M::Cache,
    pub(crate) failure: Option<StepError>,
}

impl<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar> Run<M, S, N, T> {
    /// The run at a node.
    pub(crate) fn resumed(method: M, system: S, (node, h, memory): (Node<N, T>, T, M::Memory)) -> Self {
        let prepared = method.prepare(&system, h);
        Self { method, system, prepared, node, h, memory, cache: M::Cache::default(), failure: None }
    }

    /// Takes one step and returns the state reached.
    ///
    /// # Errors
    /// Why there is no step. The run holds the last good state, and a further call returns the same error.
    #[inline(always)]
    pub fn step(&mut self) -> Result<State<N, T>, StepError> {
        let Self { method, system, prepared, node, h, memory, cache, .. } = self;
        if let Err(left) = method.advance(system, prepared, *h, (node, memory), cache) {
            // Values, not references: the address of one field that leaves this function keeps the whole run in memory (double well: 29 ns a step instead of 23).
            let problem = (self.method.clone(), self.system, self.prepared.clone(), self.h);
            let before = (node.map(black_box), memory.apart(), core::mem::take(&mut self.cache), self.failure);
            let (node, memory, cache, failure) = cold_step(problem, before, left);
            self.node = node.map(black_box);
            self.memory = memory.apart();
            self.cache = cache;
            self.failure = failure;
            if let Some(failure) = failure {
                return Err(failure);
            }
        }
        Ok(self.node.state())
    }

    /// Takes one step of the length h in time. The length of further steps stays, and so does the energy that an energy-preserving run keeps. If it
    /// succeeds, an error of the step before is forgotten: a shorter step may pass the place where a longer one failed.
    ///
    /// # Errors
    /// Those of a step; the run stays what it was and can continue. [`StepError::InvalidInput`] for an h that is zero, subnormal or not finite, or negative
    /// if the method only goes forward.
    pub fn step_of(&mut self, h: T) -> Result<State<N, T>, StepError> {
        (self.node, self.memory) = self.method.step_of(&self.system, (&self.node, &self.memory), [h, self.h])?;
        self.failure = None;
        Ok(self.node.state())
    }

    /// The state reached last.
    #[inline]
    pub fn state(&self) -> State<N, T> {
        self.node.state()
    }

    /// The node reached last: the state with the low parts of its sums, and the energy that the method keeps.
    pub fn node(&self) -> &Node<N, T> {
        &self.node
    }

    /// Time of the state reached last.
    pub fn t(&self) -> T {
        self.node.t
    }

    /// The system.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// The method.
    pub fn method(&self) -> &M {
        &self.method
    }

    /// Length of a step in time: the one given, or that of the last step if the method finds it.
    pub fn h(&self) -> T {
        self.method.length(self.h, &self.memory)
    }

    /// Largest residual of the equations of the last step, in roundings. Zero before the first step.
    pub fn residual(&self) -> f64 {
        self.method.report(&self.memory).residual
    }

    /// Newton or fixed-point iterations of the last step.
    pub fn iterations(&self) -> u32 {
        self.method.report(&self.memory).iterations
    }

    /// Velocity at the state reached last, by its momenta.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    pub fn velocity(&self) -> Result<SVector<T, N>, StepError> {
        self.state().velocity(&self.system)
    }

    /// Energy `H = v·∂L/∂v − L` at the state reached last, in the units of L.
    ///
    /// # Errors
    /// Those of [`State::energy`].
    pub fn energy(&self) -> Result<T, StepError> {
        self.state().energy(&self.system)
    }

    /// Discrete energy `E1 = −D3 L_d − g_d⁺` of the last step, which energy-preserving runs keep. [`Run::energy`], the energy at the node, is another number.
    ///
    /// `None` before the first step, of a composition, and if it is not finite. Of Gauss steps also after [`Run::step_of`] and [`Run::set_parameters`].
    pub fn discrete_energy(&self) -> Option<T> {
        self.method.discrete_energy(&self.system, &self.node, self.h, &self.memory)
    }

    /// The motion over the last step, which began at `before`.
    ///
    /// # Errors
    /// [`StepError::Singular`], [`StepError::NotConverged`] or [`StepError::NonFinite`] if no velocity belongs to the momenta at its ends.
    pub fn dense_output(&self, before: &State<N, T>) -> Result<M::DenseOutput, StepError> {
        self.method.dense_output(&self.system, before, &self.node, self.h(), &self.memory)
    }

    /// Changes parameters of the system from the node reached last on. Coordinates and momenta stay; an error of the last step is forgotten.
    ///
    /// The energy that an energy-preserving run keeps gains `H_new − H_old` at the node. After the change, [`Run::discrete_energy`] and [`Run::dense_output`]
    /// of the last step are by the new parameters, or `None` and cubic for Gauss steps. The last step has no derivative any more: call
    /// [`vary`](crate::derivatives::Differentiable::vary) before.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for a parameter that is not finite; [`StepError::Singular`], [`StepError::NotConverged`] or [`StepError::NonFinite`] if the new
    /// system has no velocity or no energy at the node. The parameters are then what they were.
    pub fn set_parameters(&mut self, change: impl FnOnce(&mut S)) -> Result<(), StepError> {
        let system = changed(&self.system, change)?;
        let mut node = self.node;
        self.memory = self.method.with_system([&self.system, &system], &mut node, self.h, &self.memory)?;
        self.prepared = self.method.prepare(&system, self.h);
        (self.node, self.system, self.failure) = (node, system, None);
        Ok(())
    }

    /// Continues from another state: after an impact, or in another frame. An error of the last step is forgotten.
    ///
    /// The energy that an energy-preserving run keeps gains `H(state) − H(node)`.
    ///
    /// # Errors
    /// Those of a new run from there. The run is then what it was.
    pub fn set_state(&mut self, state: State<N, T>) -> Result<(), StepError> {
        let mut node = self.node;
        self.memory = self.method.with_state(&self.system, &mut node, self.h, &self.memory, state)?;
        (self.node, self.failure) = (node, None);
        Ok(())
    }

    /// [`Run::step`] outside of a loop: a step is inlined wherever it stands, and one more copy of it serves all these places.
    #[doc(hidden)]
    #[inline(never)]
    pub fn single_step(&mut self) -> Result<State<N, T>, StepError> {
        self.step()
    }
}

/// A step that the hot path did not find: node, memory, cache and failure after it.
#[cold]
#[inline(never)]
#[allow(clippy::type_complexity)] // the fields of a run, each for itself
fn cold_step<M: Method<S, N, T>, S, const N: usize, T: Scalar>(
    (method, system, prepared, h): (M, S, M::Prepared, T),
    (mut node, mut memory, mut cache, failure): (Node<N, T>, M::Memory, M::Cache, Option<StepError>),
    left: M::Left,
) -> (Node<N, T>, M::Memory, M::Cache, Option<StepError>) {
    if failure.is_some() {
        return (node, memory, cache, failure);
    }
    let at = Problem { system: &system, prepared: &prepared, node: &node, h };
    match method.recover(at, &memory, &mut cache, left) {
        Ok(step) => {
            method.take(h, (&mut node, &mut memory), &mut cache, step);
            (node, memory, cache, None)
        }
        Err(failure) => (node, memory, cache, Some(failure)),
    }
}

impl<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar> Iterator for Run<M, S, N, T> {
    type Item = Result<State<N, T>, StepError>;

    /// The next step; never `None`. After an error, the same error.
    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        Some(self.step())
    }
}

/// A system with changed parameters.
///
/// # Errors
/// [`StepError::InvalidInput`] for a parameter that is not finite.
fn changed<S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
    system: &S,
    change: impl FnOnce(&mut S),
) -> Result<S, StepError> {
    let mut system = *system;
    change(&mut system);
    let values = (0..S::PARAMETERS.len()).map(|index| system.parameter(index));
    match values.into_iter().find(|value| !value.is_finite()) {
        Some(value) => Err(StepError::InvalidInput { input: "a parameter", allowed: "finite", value: value.to_f64() }),
        None => Ok(system),
    }
}
