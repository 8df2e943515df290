//! Steps of order 2 whose length preserves the discrete energy.
//!
//! One step solves, in the unknowns `(v, h)` with q1 = q0 + h v, t1 = t0 + h, h > 0,
//!
//! ```text
//! −D2 L_d − f_d⁻ = p0       p1 =  D4 L_d + f_d⁺
//!  D1 L_d + g_d⁻ = E0       E1 = −D3 L_d − g_d⁺
//! ```
//!
//! The node carries p1 and E1 as p0 and E0 plus their increments, with compensated sums. The pair `(v, −h)` of the last
//! step also solves these equations, but is not a step. [`crate::energy_preserving`] solves them. Every accepted (v, h)
//! satisfies both equations to rounding.
//!
//! Source: Sharma, Patil, Woolsey, *Energy-preserving Variational Integrators for Forced Lagrangian Systems*.

use super::bounds::{Alternating, FORWARD, Fallback, FirstStep, check_forward, too_long};
use super::{Change, Facts, FixedStep, Method, Problem, Status};
use crate::angles;
use crate::called::Called;
#[cfg(feature = "alloc")]
use crate::condition::Condition;
use crate::energy_preserving::interval::Last;
use crate::energy_preserving::lengths::{After, Lengths, Search};
use crate::energy_preserving::predicted::Predicted;
use crate::energy_preserving::start;
use crate::error::StepError;
use crate::node::Node;
use crate::real::Scalar;
use crate::run::{Hermite, Run};
use crate::state::{Numbers, State, Step};
use crate::stepping::EnergyStepping;
use nalgebra::SVector;

/// Steps of order 2 whose length preserves the discrete energy. See the [module](self).
///
/// A run from a state starts with a step of the length h, and preserves the discrete energy of that step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EnergyPreserving;

impl FixedStep {
    /// Steps whose length preserves the discrete energy.
    #[must_use]
    pub fn preserving_energy(self) -> EnergyPreserving {
        EnergyPreserving
    }
}

/// A solved step.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant)] // inlined on the hot path, which makes the small one
pub enum EnergySolution<const N: usize, T = f64> {
    /// Solved from a guess of the highest order.
    Predicted(Predicted<N, T>),
    /// Solved otherwise: the run after the step.
    After(After<N, T>),
}

impl<S: EnergyStepping<N, T>, const N: usize, T: Scalar> Method<S, N, T> for EnergyPreserving {
    type Prepared = ();
    type Memory = Lengths<N, T>;
    type Cache = ();
    type Step = EnergySolution<N, T>;
    type Left = ();
    type DenseOutput = Hermite<N, T>;

    fn facts(&self) -> Facts {
        Facts { finds_length: true, rule: S::RULE, ..Facts::of_order(2) }
    }

    fn check_length(&self, _system: &S, h: T) -> Result<(), StepError> {
        check_forward(FORWARD, h)
    }

    fn prepare(&self, _system: &S, _h: T) {}

    fn begin(&self, system: &S, node: &mut Node<N, T>, h: T) -> Result<Lengths<N, T>, StepError> {
        start::from_state(system, node, h)
    }

    #[inline(always)]
    fn attempt(
        &self,
        at: Problem<'_, S, (), N, T>,
        memory: &Lengths<N, T>,
        (): &mut (),
    ) -> Result<EnergySolution<N, T>, ()> {
        let Problem { system, node, .. } = at;
        if memory.is_common()
            && let Some(predicted) = memory.predicted(system, node, memory.prediction.guess_highest())
            && node.advanced(system, predicted.step.h, &predicted.step.v, &predicted.increment).is_finite()
        {
            return Ok(EnergySolution::Predicted(predicted));
        }
        Err(())
    }

    fn recover(
        &self,
        at: Problem<'_, S, (), N, T>,
        memory: &Lengths<N, T>,
        (): &mut (),
        (): (),
    ) -> Result<EnergySolution<N, T>, StepError> {
        let Problem { system, node, .. } = at;
        let called = &Called(*system);
        let is_first = memory.last.is_first();
        if is_first && memory.control.fallback == Fallback::Stop {
            start::check_length(called, node, &memory.last)?;
        }
        let failure = match (Search { system: called, node, lengths: memory }).next() {
            Ok(after) => return Ok(EnergySolution::After(after)),
            Err(failure) => explained(failure, system, node, memory),
        };
        Err(if is_first { first_failure(failure, called, node, &memory.last) } else { failure })
    }

    #[inline(always)]
    fn take(
        &self,
        system: &S,
        _h: T,
        (node, memory): (&mut Node<N, T>, &mut Lengths<N, T>),
        (): &mut (),
        step: EnergySolution<N, T>,
    ) {
        match &step {
            EnergySolution::Predicted(predicted) => {
                let step = &predicted.step;
                *node = node.advanced(system, step.h, &step.v, &predicted.increment);
                memory.last = memory.last.followed(step);
                memory.prediction.push_common(predicted);
            }
            EnergySolution::After(after) => (*node, *memory) = (after.node, after.lengths),
        }
    }

    fn step_of(
        &self,
        system: &S,
        (node, memory): (&Node<N, T>, &Lengths<N, T>),
        [h, _]: [T; 2],
    ) -> Result<(Node<N, T>, Lengths<N, T>), StepError> {
        check_forward("the step h", h)?;
        let after = Search { system: &Called(*system), node, lengths: memory }.step_of(h);
        after.map(|After { node, lengths }| (node, lengths)).map_err(|failure| explained(failure, system, node, memory))
    }

    fn restarted(
        &self,
        system: &S,
        change: &Change<'_, S, N, T>,
        node: &mut Node<N, T>,
        _h: T,
        memory: &Lengths<N, T>,
    ) -> Result<Lengths<N, T>, StepError> {
        let changed = change.moved_with_energy(system, node)?;
        let mut lengths = *memory;
        match change {
            Change::NewLength => {}
            Change::NewSystem(_) => lengths.last.is_step = false,
            Change::NewState(_, state) => {
                lengths.last.v = state.velocity(system)?;
                lengths.resume_after(&memory.last);
            }
        }
        *node = changed;
        Ok(lengths)
    }

    fn dense_output(
        &self,
        system: &S,
        before: &State<N, T>,
        node: &Node<N, T>,
        h: T,
        _memory: &Lengths<N, T>,
    ) -> Result<Hermite<N, T>, StepError> {
        Hermite::between(system, before, &node.state(), h)
    }

    fn status(&self, _h: T, memory: &Lengths<N, T>) -> Status<T> {
        let Lengths { last, control, .. } = memory;
        let Last { h, measured, iterations, .. } = last;
        Status { length: *h, longest: control.longest(*h), residual: measured.roundings(), iterations: *iterations }
    }

    fn discrete_energy(&self, _system: &S, node: &Node<N, T>, _h: T, memory: &Lengths<N, T>) -> Option<T> {
        Some(memory.discrete_energy(node))
    }

    fn check(&self, _system: &S, (node, memory): (&Node<N, T>, &Lengths<N, T>), _h: T) -> Result<(), StepError> {
        memory.check(node.t)
    }
}

/// The error of a first step: it names a shorter length, if a run that starts with it from the state, or with the same
/// midpoint, takes a step.
#[cold]
fn first_failure<S: EnergyStepping<N, T>, const N: usize, T: Scalar>(
    failure: StepError,
    system: &S,
    node: &Node<N, T>,
    last: &Last<N, T>,
) -> StepError {
    let Ok(energy) = node.state().energy(system) else { return failure };
    let energies = [node.energy, energy - node.energy].map(T::to_f64);
    let of = ([node.t, last.h].map(T::to_f64), energies);
    let first_step = |node: Node<N, T>, lengths: &Lengths<N, T>| {
        let exists = Search { system, node: &node, lengths }.next().is_ok();
        Some(FirstStep { energy: node.energy.to_f64(), exists })
    };
    let from_state = |h: f64| {
        let mut node = Node::new(node.state(), T::zero());
        let lengths = start::from_state(system, &mut node, T::real(h)).ok()?;
        first_step(node, &lengths)
    };
    let from_midpoint = |h: f64| {
        let h = T::real(h);
        let mut start = *node;
        start.shift((last.h + h) * T::real(-0.5), &last.v);
        let After { node, lengths } = start::first_interval(system, start, h, last.v).ok()?;
        first_step(node, &lengths)
    };
    too_long(too_long(failure, of, from_state), of, from_midpoint)
}

/// Adds the expression that is not finite to a failure.
fn explained<S: EnergyStepping<N, T>, const N: usize, T: Scalar>(
    failure: StepError,
    system: &S,
    node: &Node<N, T>,
    memory: &Lengths<N, T>,
) -> StepError {
    failure.explained(system, node, memory.last.h, &memory.last.v)
}

/// Starts other than a state. Each returns a run at the end of a first interval, with p1 and E1 from its slot
/// derivatives.
impl EnergyPreserving {
    /// The midpoint start: `(t0, q0, v0)` is the *middle* of the first interval, of length `h0`. For the midpoint rule
    ///
    /// ```text
    /// t1 = t0 + h0/2      q1 = q0 + (h0/2) v0      p1 = L_v + (h0/2)(L_q + f)      E1 = H0 − (h0/2)(L_t − f·v)
    /// ```
    ///
    /// This start is explicit and avoids the paper's bias of `h0² D/8` in the energy: every midpoint lies on `H = H0`
    /// to rounding.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an h0 that is not positive and finite; [`StepError::NonFinite`] if an input is
    /// not finite or the system has no value there; [`StepError::Singular`].
    pub fn from_midpoint<S: EnergyStepping<N, T>, const N: usize, T: Scalar>(
        system: S,
        t0: T,
        q0: impl Numbers<N, T>,
        v0: impl Numbers<N, T>,
        h0: T,
    ) -> Result<Run<Self, S, N, T>, StepError> {
        check_forward("the step h0", h0)?;
        let (q, v) = (q0.vector(), v0.vector());
        let mut start = Node::new(State { t: t0, q, p: SVector::zeros() }, T::zero());
        start.shift(h0 * T::real(-0.5), &v);
        after(system, start, h0, v)
    }

    /// The paper's start: the first interval from its ends `(t0, q0)` and `(t1, q1)`, with q1 from an accurate
    /// solution. `p1 = D4 L_d + f_d⁺`, `E1 = −D3 L_d − g_d⁺`.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for a t1 − t0 that is not positive and finite; otherwise as
    /// [`EnergyPreserving::from_midpoint`].
    pub fn from_points<S: EnergyStepping<N, T>, const N: usize, T: Scalar>(
        system: S,
        (t0, q0): (T, impl Numbers<N, T>),
        (t1, q1): (T, impl Numbers<N, T>),
    ) -> Result<Run<Self, S, N, T>, StepError> {
        let (h, q, q1) = (t1 - t0, q0.vector(), q1.vector());
        check_forward("the interval t1 − t0", h)?;
        let v = (q1 - q).map(|distance| distance / h);
        let mut run = after(system, Node::new(State { t: t0, q, p: SVector::zeros() }, T::zero()), h, v)?;
        // The end is the given point; q0 + h v would add rounding errors.
        let node = &mut run.node;
        (node.t, node.t_low, node.q, node.q_low) = (t1, T::zero(), q1, SVector::zeros());
        Ok(run)
    }

    /// Resumes from a node with its discrete energy, and the length `h` and velocity `v` of the interval that led there.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an h that is not positive and finite; otherwise as [`EnergyPreserving::from_midpoint`].
    pub fn from_state<S: EnergyStepping<N, T>, const N: usize, T: Scalar>(
        system: S,
        state: State<N, T>,
        energy: T,
        h: T,
        v: impl Numbers<N, T>,
    ) -> Result<Run<Self, S, N, T>, StepError> {
        check_forward("the step h", h)?;
        let (node, v) = (Node::new(state, energy), v.vector());
        let mut start = node;
        start.shift(-h, &v);
        let mut run = after(system, start, h, v)?;
        run.node = node;
        Ok(run)
    }
}

/// The run at the end of the step `(v, h)` from `start`.
fn after<S: EnergyStepping<N, T>, const N: usize, T: Scalar>(
    system: S,
    start: Node<N, T>,
    h: T,
    v: SVector<T, N>,
) -> Result<Run<EnergyPreserving, S, N, T>, StepError> {
    start::check_density(&system)?;
    match start::first_interval(&Called(system), start, h, v) {
        Ok(After { node, lengths }) => Ok(Run::resumed(EnergyPreserving, system, (node, h, lengths))),
        Err(failure) => Err(failure.explained(&system, &start, h, &v)),
    }
}

impl<S: EnergyStepping<N, T>, const N: usize, T: Scalar> Run<EnergyPreserving, S, N, T> {
    /// Velocity `(q1 − q0)/h` of the last interval, without its cancellation.
    pub fn v(&self) -> SVector<T, N> {
        self.memory.last.v
    }

    /// Step density D of the last interval.
    pub fn density(&self) -> T {
        self.memory.last.density
    }

    /// Takes one step and returns it with its interval, its density and its kind.
    ///
    /// # Errors
    /// As [`Run::step`].
    pub fn detailed_step(&mut self) -> Result<Step<N, T>, StepError> {
        self.step().map(|_| self.last_step())
    }

    /// Iterates over [`Run::detailed_step`] without end.
    pub fn detailed_steps(&mut self) -> impl Iterator<Item = Result<Step<N, T>, StepError>> + '_ {
        core::iter::from_fn(|| Some(self.detailed_step()))
    }

    /// The last step with its interval and kind. Before the first step, the initial interval.
    pub fn last_step(&self) -> Step<N, T> {
        let Self { node, memory, .. } = self;
        let Last { v, h, density, iterations, measured, .. } = memory.last;
        let (t_mid, q_mid) = node.midpoint(-h, &v);
        let q_mid = angles::with_turns(&q_mid, &SVector::zeros(), &self.turns);
        Step {
            t: node.t,
            q: self.state().q,
            p: node.p,
            energy: memory.discrete_energy(node),
            h,
            midpoint: (t_mid, q_mid, v),
            density,
            density_next: memory.last.density_next(),
            iterations,
            residual: T::real(measured.roundings()),
            kind: memory.control.kind,
        }
    }

    /// Condition numbers of the equations of the last step. Allocates.
    #[cfg(feature = "alloc")]
    pub fn condition(&self) -> Condition {
        let Last { v, h, previous, .. } = &self.memory.last;
        let mut start = self.node;
        start.shift(-*h, v);
        Condition::of(&self.system.extended_system(&start, *h, v), *h, v, *previous)
    }
}
