//! Runs: one type for all methods.
//!
//! A run starts from a system at a state ([`Start`]), a [`Method`] and a step length. It returns states step by step,
//! at given times or at events, or the typed error of a failed step. After an error the run holds the last good state.
//! It returns the same error until its parameters, its state or an option change, or a step of another length succeeds.
//!
//! | file | contents |
//! |---|---|
//! | `dense_output` | polynomials between the two nodes of a step |
//! | `times` | states at given times |
//! | `solution` | states with times and energies, as CSV |
//! | `event`, `events` | event functions; states at their sign changes |
//! | `search` | event search within one step |
//! | `reached` | a run at a part of its next step, type-erased for the search |
//! | `side` | sign of an event function just after a node |
//! | `estimate` | measured error of a step, and of the steps of a run |
//! | `tolerance` | a step length from a tolerance |
//! | `checkpoint` | stored runs that resume bit for bit |
//!
//! A state at a time t is the end of a last step of exactly the remaining length. It has the full order of the method.
//! The run computes output at several times and recorded events on a copy, and keeps its own steps bit for bit.

#[cfg(feature = "alloc")]
mod checkpoint;

mod estimate;
#[cfg(feature = "alloc")]
mod event;
#[cfg(feature = "alloc")]
mod events;
#[cfg(feature = "alloc")]
mod reached;
#[cfg(feature = "alloc")]
mod search;
#[cfg(feature = "alloc")]
mod side;
#[cfg(feature = "alloc")]
mod solution;
mod times;
mod tolerance;

pub use crate::dense_output::{DenseOutput, Hermite};
#[cfg(feature = "alloc")]
pub use checkpoint::{Checkpoint, Stored};
pub use estimate::{ErrorEstimate, ErrorMonitor, LocalError, Monitored};
#[cfg(feature = "alloc")]
pub use event::{Crossing, Event, Events, Met, Moment};
#[cfg(feature = "alloc")]
pub use events::Crossings;
#[cfg(feature = "alloc")]
pub use solution::Solution;
pub use times::Grid;
pub use tolerance::{Length, Tolerance, check_tolerance};

use crate::angles::{self, Turns};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::{Change, Memory, Method, Problem};
use crate::node::Node;
use crate::real::{Real, Scalar};
use crate::state::{Numbers, State};
use nalgebra::SVector;

/// A system at a state, the start of any number of runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start<S, const N: usize, T = f64> {
    /// The system.
    pub system: S,
    /// The state.
    pub state: State<N, T>,
}

/// Starts of runs, for every system.
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
    /// Starts a run by a method with the step h, in units of time, or with the step of a [`Tolerance`].
    ///
    /// A negative h integrates backwards in time. A method that finds its own step lengths begins with about h.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an h that is zero, subnormal or not finite, [`StepError::NonFinite`] for such a
    /// state, [`StepError::Singular`] or [`StepError::NotConverged`] if no velocity has its momenta,
    /// [`StepError::Tolerance`] if no step has the tolerance; errors of the method.
    pub fn integrate<M: Method<S, N, T>>(self, method: M, h: impl Length<T>) -> Result<Run<M, S, N, T>, StepError> {
        let Self { system, state } = self;
        angles::check(&system, &state.q, &Turns::zeros())?;
        let mut node = Node::new(state, T::zero());
        let explained = |failure: StepError| failure.explained_at(&system, &Node::new(state, T::zero()), T::zero());
        let method = match h.tolerance() {
            Some(tolerance) => method.with_tolerance(tolerance),
            None => method,
        };
        let h = self.length(&method, h)?;
        method.check_length(&system, h)?;
        let memory = method.begin(&system, &mut node, h).map_err(explained)?;
        Ok(Run::resumed(method, system, (node, h, memory)))
    }

    /// The length of the steps of a method from here.
    ///
    /// # Errors
    /// The errors of [`Start::integrate`] for this length.
    #[doc(hidden)]
    pub fn length<M: Method<S, N, T>>(&self, method: &M, h: impl Length<T>) -> Result<T, StepError> {
        let node = Node::new(self.state, T::zero());
        h.length(self, method).map_err(|failure| failure.explained_at(&self.system, &node, T::zero()))
    }
}

/// A run of a system S of N coordinates by a method M. See the [module](self).
#[derive(Clone, Debug)]
pub struct Run<M: Method<S, N, T>, S, const N: usize, T: Scalar = f64> {
    pub(crate) method: M,
    pub(crate) system: S,
    pub(crate) prepared: M::Prepared,
    /// The node, with angles reduced by their turns.
    pub(crate) node: Node<N, T>,
    /// Whole turns of angles; zero for other coordinates.
    pub(crate) turns: Turns<N>,
    /// Length of a step in the unit of the method.
    pub(crate) h: T,
    pub(crate) memory: M::Memory,
    pub(crate) cache: M::Cache,
    pub(crate) failure: Option<StepError>,
}

impl<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar> Run<M, S, N, T> {
    /// Resumes a run at a node.
    pub(crate) fn resumed(method: M, system: S, (node, h, memory): (Node<N, T>, T, M::Memory)) -> Self {
        let prepared = method.prepare(&system, h);
        let (turns, cache) = (Turns::zeros(), M::Cache::default());
        Self { method, system, prepared, node, turns, h, memory, cache, failure: None }
    }

    /// Takes one step and returns its end state.
    ///
    /// # Errors
    /// The reason why the step failed. The run holds the last good state, and a further call returns the same error.
    #[inline(always)]
    pub fn step(&mut self) -> Result<State<N, T>, StepError> {
        let mut kept = None;
        if angles::are_far(&self.system, &self.node.q) {
            let (system, far) = (self.system, (self.node.q, self.node.q_low, self.turns));
            (self.node.q, self.node.q_low, self.turns) = angles::reduced(&system, far)?;
            kept = Some(far);
        }
        let Self { method, system, prepared, node, h, memory, cache, .. } = self;
        if let Err(left) = method.advance(system, prepared, *h, (node, memory), cache) {
            // Values, not references: one escaping field address keeps the whole run in memory (double well: 29 ns a
            // step instead of 23).
            let problem = (self.method.clone(), self.system, self.prepared.clone(), self.h);
            let before = (node.apart(), memory.apart(), core::mem::take(&mut self.cache), self.failure);
            let (node, memory, cache, failure) = cold_step(problem, before, left);
            self.node = node.apart();
            self.memory = memory.apart();
            self.cache = cache;
            self.failure = failure;
            if let Some(failure) = failure {
                if let Some(far) = kept {
                    (self.node.q, self.node.q_low, self.turns) = far;
                }
                return Err(failure);
            }
        }
        Ok(self.state())
    }

    /// Takes one step of the length h in time. The length of later steps and the preserved energy do not change. If it
    /// succeeds, the run continues from an error too: a shorter step may pass the place where a longer one failed.
    ///
    /// # Errors
    /// The errors of a step, and the run does not change. [`StepError::InvalidInput`] for an h that is zero, subnormal
    /// or not finite, or that is negative although the method only steps forward.
    pub fn step_of(&mut self, h: T) -> Result<State<N, T>, StepError> {
        let (mut node, mut turns) = (self.node, self.turns);
        if angles::are_far(&self.system, &node.q) {
            (node.q, node.q_low, turns) = angles::reduced(&self.system, (node.q, node.q_low, turns))?;
        }
        let after = self.method.step_of(&self.system, (&node, &self.memory), [h, self.h]);
        (self.node, self.memory) = after.map_err(|failure| failure.explained_at(&self.system, &self.node, h))?;
        (self.turns, self.failure) = (turns, None);
        Ok(self.state())
    }

    /// The last state. An angle includes its turns, and is rounded: after 1e7 turns to 7e-9. [`Run::reduced`] and
    /// [`Run::turns`] return all its digits.
    #[inline]
    pub fn state(&self) -> State<N, T> {
        angles::state::<S, N, T>(&self.node, &self.turns)
    }

    /// Whole turns of each coordinate that is declared as an `angle`, zero for the others: `state().q` is
    /// [`Run::reduced`] plus 2π times these.
    pub fn turns(&self) -> [i64; N] {
        angles::normalized(&self.system, &self.node, &self.turns).1.into()
    }

    /// The coordinates of the last state, with angles in [-π, π].
    pub fn reduced(&self) -> SVector<T, N> {
        angles::normalized(&self.system, &self.node, &self.turns).0
    }

    /// Sets the whole turns of the angles. The motion does not change: later states, events and dense output include
    /// the new turns.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for turns of a coordinate that is no angle, or beyond 2^53.
    pub fn set_turns(&mut self, turns: [i64; N]) -> Result<(), StepError> {
        let turns = Turns::from(turns);
        angles::check(&self.system, &self.node.q, &turns)?;
        let (_, nearest) = angles::normalized(&self.system, &self.node, &Turns::zeros());
        self.turns = turns - nearest;
        Ok(())
    }

    /// The last node: the state with the low parts of its sums, and the preserved energy. Angles are less whole turns.
    pub fn node(&self) -> &Node<N, T> {
        &self.node
    }

    /// Time of the last state.
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

    /// Length of a step in time: the given one, or that of the last step if the method finds it.
    pub fn h(&self) -> T {
        self.method.status(self.h, &self.memory).length
    }

    /// Largest residual of the last step, in units of its rounding-error bound, or of a part of the tolerance if the method
    /// solves steps to that. Zero before the first step.
    pub fn residual(&self) -> f64 {
        self.method.status(self.h, &self.memory).residual
    }

    /// Newton or fixed-point iterations of the last step.
    pub fn iterations(&self) -> u32 {
        self.method.status(self.h, &self.memory).iterations
    }

    /// Velocity at the last state, from its momenta.
    ///
    /// # Errors
    /// As [`State::velocity`].
    pub fn velocity(&self) -> Result<SVector<T, N>, StepError> {
        self.node.state().velocity(&self.system)
    }

    /// Energy `H = v·∂L/∂v − L` at the last state, in the units of L.
    ///
    /// # Errors
    /// As [`State::energy`].
    pub fn energy(&self) -> Result<T, StepError> {
        self.node.state().energy(&self.system)
    }

    /// Discrete energy `E1 = −D3 L_d − g_d⁺` of the last step. Energy-preserving runs keep it: it changes only by the work
    /// of forces and moving constraints, and by an explicit time. With a shift they keep [`Run::shifted_energy`] instead.
    /// It differs from [`Run::energy`].
    ///
    /// `None` before the first step, for compositions, and if it is not finite. For Gauss steps also after
    /// [`Run::step_of`] and [`Run::set_parameters`].
    pub fn discrete_energy(&self) -> Option<T> {
        self.method.discrete_energy(&self.system, &self.node, self.h, &self.memory)
    }

    /// Dense output of the last step, which began at `before`.
    ///
    /// # Errors
    /// [`StepError::Singular`], [`StepError::NotConverged`] or [`StepError::NonFinite`] if no velocity has the momenta
    /// at one of its ends.
    pub fn dense_output(&self, before: &State<N, T>) -> Result<M::DenseOutput, StepError> {
        let output = |before| self.method.dense_output(&self.system, before, &self.node, self.h(), &self.memory);
        if const { !angles::has_angles::<S, N, T>() } {
            return output(before);
        }
        let turned = angles::with_turns(&SVector::zeros(), &SVector::zeros(), &self.turns);
        output(&angles::without_turns(before, &self.turns)).map(|output| output.moved(&turned))
    }

    /// Changes parameters of the system from the last node on. Coordinates and momenta stay; the run clears an error of
    /// the last step. [`Run::set_parameters_and_state`] changes both.
    ///
    /// The energy of an energy-preserving run increases by `H_new − H_old` at the node. Afterwards
    /// [`Run::discrete_energy`] and [`Run::dense_output`] of the last step use the new parameters; for Gauss steps they
    /// are `None` and cubic. The last step then has no derivative: call
    /// [`vary`](crate::derivatives::Differentiable::vary) first.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for a parameter that is not finite; [`StepError::Singular`],
    /// [`StepError::NotConverged`] or [`StepError::NonFinite`] if the new system has no velocity or no energy at the
    /// node. The parameters then keep their values.
    pub fn set_parameters(&mut self, change: impl FnOnce(&mut S)) -> Result<(), StepError> {
        let system = changed(&self.system, change)?;
        let mut node = self.node;
        let change = Change::NewSystem(&self.system);
        self.memory = self.method.restarted(&system, &change, &mut node, self.h, &self.memory)?;
        self.prepared = self.method.prepare(&system, self.h);
        (self.node, self.system, self.failure) = (node, system, None);
        Ok(())
    }

    /// Continues from another state, for example after an impact or in another frame. The run clears an error of the
    /// last step.
    ///
    /// The energy of an energy-preserving run increases by `H(state) − H(node)`.
    ///
    /// # Errors
    /// The errors of a new run from that state. The run then does not change.
    pub fn set_state(&mut self, state: State<N, T>) -> Result<(), StepError> {
        self.set_parameters_and_state(|_| (), state)
    }

    /// Changes parameters and the state together, for example the length of a rod: the new state has to be on the new
    /// constraint; see [`State::projected`]. The run clears an error of the last step.
    ///
    /// The energy of an energy-preserving run increases by `H_new(state) − H_old(node)`.
    ///
    /// # Errors
    /// The errors of [`Run::set_parameters`] and of a new run from that state. The run then does not change.
    pub fn set_parameters_and_state(
        &mut self,
        change: impl FnOnce(&mut S),
        state: State<N, T>,
    ) -> Result<(), StepError> {
        angles::check(&self.system, &state.q, &Turns::zeros())?;
        let system = changed(&self.system, change)?;
        let mut node = self.node;
        let change = Change::NewState(&self.system, state);
        self.memory = self.method.restarted(&system, &change, &mut node, self.h, &self.memory)?;
        self.prepared = self.method.prepare(&system, self.h);
        (self.node, self.system, self.turns, self.failure) = (node, system, Turns::zeros(), None);
        Ok(())
    }

    /// [`Run::step`] outside of loops. The inlined step has one copy per call site; this shared copy keeps the code
    /// small.
    #[doc(hidden)]
    #[inline(never)]
    pub fn single_step(&mut self) -> Result<State<N, T>, StepError> {
        self.step()
    }
}

/// The data that a run carries from step to step beside its method and its system, for runs behind a pointer.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Parts<Y, const N: usize> {
    node: Node<N>,
    turns: Turns<N>,
    h: f64,
    memory: Y,
    failure: Option<StepError>,
}

impl<Y, const N: usize> Parts<Y, N> {
    /// These data with another memory.
    pub fn with<Z>(self, memory: Z) -> Parts<Z, N> {
        let Self { node, turns, h, failure, .. } = self;
        Parts { node, turns, h, memory, failure }
    }
}

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> Run<M, S, N> {
    /// The parts of the run without the memory.
    #[doc(hidden)]
    pub fn parts(&self) -> Parts<(), N> {
        let Self { node, turns, h, failure, .. } = self;
        Parts { node: *node, turns: *turns, h: *h, memory: (), failure: *failure }
    }

    /// Consumes the run and returns the memory of its method.
    #[doc(hidden)]
    pub fn into_memory(self) -> M::Memory {
        self.memory
    }

    /// The run of these parts.
    #[doc(hidden)]
    pub fn from_parts(method: M, system: S, parts: Parts<M::Memory, N>) -> Self {
        let Parts { node, turns, h, memory, failure } = parts;
        Self { turns, failure, ..Self::resumed(method, system, (node, h, memory)) }
    }

    /// The memory of the method.
    #[doc(hidden)]
    pub fn memory(&self) -> &M::Memory {
        &self.memory
    }
}

/// Takes a step on the cold path. Returns node, memory, cache and failure.
#[cold]
#[inline(never)]
#[allow(clippy::type_complexity)] // the fields of a run
fn cold_step<M: Method<S, N, T>, S: Lagrangian<N, T>, const N: usize, T: Scalar>(
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
            method.take(&system, h, (&mut node, &mut memory), &mut cache, step);
            (node, memory, cache, None)
        }
        Err(failure) => {
            let failure = failure.explained_at(&system, &node, method.status(h, &memory).length);
            (node, memory, cache, Some(failure))
        }
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

/// Applies a change of parameters to a copy of the system.
///
/// # Errors
/// [`StepError::InvalidInput`] for a parameter that is not finite.
fn changed<S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
    system: &S,
    change: impl FnOnce(&mut S),
) -> Result<S, StepError> {
    let mut system = *system;
    change(&mut system);
    let values = (0..system.parameters().len()).map(|index| system.parameter(index));
    match values.into_iter().find(|value| !value.is_finite()) {
        Some(value) => Err(StepError::InvalidInput { input: "a parameter", allowed: "finite", value: value.to_f64() }),
        None => Ok(system),
    }
}
