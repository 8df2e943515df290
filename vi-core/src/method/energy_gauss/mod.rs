//! Energy-preserving steps of order 2S: Gauss steps whose length preserves the discrete energy.
//!
//! One step solves, for the stages and h > 0,
//!
//! ```text
//! Q_i = q0 + h Σ a_ij V_j        L_v(T_i, Q_i, V_i) = p0 + h Σ a_ij (L_q + f)_j        E0(h) = E
//! E0(h) = Σ b_i En_i − h Σ b_i (1 − c_i) (f·v − L_t)_i        E ← E + h Σ b_i (f·v − L_t)_i
//! ```
//!
//! The discrete energy of every step is then that of the first one, plus the work done since. The length follows from
//! `H − E0(h) = C_s h^2s D_s` with the step density D_s ([`crate::gauss::density`]). Without force `h D_s^(1/(2s+1))`
//! is constant up to O(h²), and a step exists while D_s keeps its sign. A shift D_* adds `C_s D_* h^(2s+1)/(2s+1)` to
//! L_d. Then D_s + D_* must keep its sign, and the run preserves
//!
//! ```text
//! E' = E − C_s h^2s D_*
//! ```
//!
//! The unknown is ln h: `ln[(H − E0(h))/(H − E)]` is nearly a line of slope 2s in it. It also excludes the last step
//! backwards, which solves the same equations. A step is one `Search` over the solutions of Gauss steps of any length.
//!
//! If no step exists, a run with `Fallback::FixedSteps` takes fixed Gauss steps of the last length until an
//! energy-preserving one exists again. E changes by the work only. Fixed steps end when the step law `h |D|^(1/(2s+1))
//! = C` requires their length or a shorter one. With D_0 the density at their start,
//!
//! ```text
//! H − E = C_s h_f^2s (2s D_0 + D)/(2s + 1)        D = D_s + D_*
//! ```
//!
//! to leading order without force, with the sign of D if D has that of D_0. If no step has the previous energy, E
//! becomes the discrete energy of the last fixed step.
//!
//! With constraints the same holds for the steps of [`Gauss`] with impulses, with
//!
//! ```text
//! E0(h) = Σ b_i En_i − h Σ b_i (1 − c_i) (f·v − L_t)_i + Σ_{j<S} (1 − c̃_j) λ_j·a_j
//! ```
//!
//! E then changes by the work of the force, of an explicit time and of moving constraints only. The constraints hold at
//! every node. D_s depends on L beside the constraints, and in Cartesian coordinates it changes its sign in most motions: in
//! every oscillation of a pendulum. Therefore start with a shift, [`Run::with_shift_from`]. Nonholonomic systems do not have
//! the law of `h D_s^(1/(2s+1))`: h returns if the motion is reversible, otherwise it may drift.
//!
//! The stages and the energy of every accepted step are at the rounding floor. Theory and measurements:
//! `docs/theory.md`.

#[cfg(feature = "alloc")]
mod bound;
pub(crate) mod free;

#[cfg(feature = "alloc")]
pub use bound::BoundLengths;
pub use free::FreeLengths;

use super::bounds::{Control, Controlled, FORWARD, FixedPhase, check_forward};
use super::gauss::Gauss;
use super::preserving::{PreservingStep, StepsOfAnyLength, check_power, failed, measured, order};
use super::shift::{Shiftable, StepPower};
use super::{Change, Facts, Memory, Method, Problem, Status, Storable};
#[cfg(feature = "alloc")]
use crate::derivatives::{Sought, Variation};
use crate::energy_preserving::start::check_density;
use crate::error::StepError;
use crate::gauss::density::power;
use crate::gauss::history::StepHistory;
use crate::kind::Kind;
use crate::lagrangian::Lagrangian;
use crate::method::length::Trial;
use crate::motion::Motion;
use crate::node::Node;
use crate::run::{DenseOutput, Run};
use crate::state::State;
use crate::stepping::Convertible;
use core::fmt::Debug;
use vi_dispatch::Instructions;

/// Energy-preserving steps of order 2 STAGES, with 1 to 3 stages: `EnergyPreservingGauss::<2>`. See the [module](self).
///
/// A run from a state starts with a step of the length h, and preserves the discrete energy of that step. It differs
/// from H at the state by `C_s h^2s D_s`. With constraints, few runs go far without a shift: use
/// [`Run::with_shift_from`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EnergyPreservingGauss<const STAGES: usize>;

impl<const STAGES: usize> Gauss<STAGES> {
    /// Steps of one to three stages whose length preserves the discrete energy.
    #[must_use]
    pub fn preserving_energy(self) -> EnergyPreservingGauss<STAGES> {
        EnergyPreservingGauss
    }
}

/// A solver of Gauss steps of any length.
pub trait LengthSolver<S: Convertible<N>, const N: usize, const STAGES: usize> {
    /// The last steps, from which the next one is guessed.
    type Steps: Clone + Debug + Send + Sync + Storable;
    /// Reusable buffers. No result depends on them.
    type Cache: Clone + Debug + Default + Send + Sync;
    /// The data of a step that its run keeps.
    type Taken;
    /// Dense output of a step.
    type DenseOutput: DenseOutput<N> + Send + Sync + 'static;

    /// Checks that a run can begin at a node.
    ///
    /// # Errors
    /// The errors of a start with constraints.
    fn check_start(system: &S, node: &Node<N>) -> Result<(), StepError>;
    /// The last steps before the first one of about the length h.
    ///
    /// # Errors
    /// [`StepError::Singular`] and [`StepError::NonFinite`].
    fn fresh(system: &S, node: &Node<N>, h: f64) -> Result<Self::Steps, StepError>;
    /// Solves the first step, of the length h. Returns its discrete energy less that of the node, and keeps its unknowns as
    /// the guess of the next step.
    ///
    /// # Errors
    /// The errors of a step.
    fn first(system: &S, node: &Node<N>, h: f64, steps: &mut Self::Steps) -> Result<f64, StepError>;
    /// Solves the next energy-preserving step.
    ///
    /// # Errors
    /// The errors of a step.
    fn next(
        system: &S,
        instructions: Instructions,
        run: (&Node<N>, &Self::Steps, &StepHistory),
        cache: &mut Self::Cache,
    ) -> Result<PreservingStep<Self::Taken>, StepError>;
    /// Solves the step of a given length.
    ///
    /// # Errors
    /// The errors of a step.
    fn given(
        system: &S,
        run: (&Node<N>, &Self::Steps, &StepHistory),
        h: f64,
    ) -> Result<GivenStep<Self::Taken>, StepError>;
    /// The end of a step, with the energy of its start.
    fn end(node: &Node<N>, taken: &Self::Taken) -> Node<N>;
    /// Adds a step from the node `before`.
    fn take(steps: &mut Self::Steps, before: &Node<N>, taken: &Self::Taken, cache: &mut Self::Cache);
    /// The last steps after a change of the system. Only the energy of the node has changed.
    ///
    /// # Errors
    /// As [`LengthSolver::fresh`].
    fn changed(system: &S, node: &Node<N>, h: f64, steps: &Self::Steps) -> Result<Self::Steps, StepError>;
    /// Largest residual of the last step, in roundings.
    fn residual(steps: &Self::Steps) -> f64;
    /// [`Method::dense_output`].
    ///
    /// # Errors
    /// As [`Method::dense_output`].
    fn dense_output(
        system: &S,
        steps: &Self::Steps,
        before: &State<N>,
        node: &Node<N>,
        h: f64,
    ) -> Result<Self::DenseOutput, StepError>;
    /// Checks a stored node, whose numbers are finite, and stored steps. A file may contain any numbers.
    ///
    /// # Errors
    /// As [`Method::check`].
    fn check(system: &S, node: &Node<N>, steps: &Self::Steps) -> Result<(), StepError>;
    /// The step density D_s at a state.
    ///
    /// # Errors
    /// The reason why it has no value.
    fn step_density(system: &S, state: &State<N>) -> Result<f64, StepError>;
    /// The discrete energies E0 and E1 of the last step of fixed steps, less `base`.
    fn energies(run: &Run<Gauss<STAGES>, S, N>, base: f64) -> [f64; 2];
    /// [`Differentiable::vary`](crate::derivatives::Differentiable::vary).
    ///
    /// # Errors
    /// As [`Differentiable::vary`](crate::derivatives::Differentiable::vary).
    #[cfg(feature = "alloc")]
    fn vary(
        run: &Run<EnergyPreservingGauss<STAGES>, S, N>,
        before: &Node<N>,
        variations: &mut [Variation<N>],
    ) -> Result<(), StepError>;
    /// Maps tangent vectors at the node of a run to those after a step of the length h, regardless of its energy.
    ///
    /// # Errors
    /// As [`LengthSolver::vary`].
    #[cfg(feature = "alloc")]
    fn vary_given(
        run: &Run<EnergyPreservingGauss<STAGES>, S, N>,
        h: f64,
        sought: Sought,
        variations: &mut [Variation<N>],
    ) -> Result<(), StepError>;
}

/// A step of a given length.
#[derive(Clone, Copy, Debug)]
pub struct GivenStep<T> {
    pub(crate) taken: T,
    /// `E0(h) − C_s h^2s D_*` less the energy of the node.
    pub(crate) residual: f64,
    /// `E1 − E0`.
    pub(crate) gain: f64,
    /// `H − E'` at its end, and the size of the terms of H.
    pub(crate) measured: [f64; 2],
}

/// The step of a given length among steps of any length.
///
/// # Errors
/// The errors of a step.
fn given<P: StepsOfAnyLength<N, K>, const N: usize, const K: usize>(
    steps: &P,
    node: &Node<N>,
    h: f64,
    shift: f64,
) -> Result<GivenStep<P::Taken>, StepError> {
    let tried = steps.tried(node, h, shift, None)?;
    let ended = steps.ended(node, &tried)?;
    Ok(GivenStep { taken: ended.taken, residual: tried.residual(), gain: ended.gain, measured: ended.measured })
}

/// The memory of a run: the last steps, and data for the prediction of lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Lengths<Steps> {
    pub(crate) steps: Steps,
    #[cfg_attr(feature = "serde", serde(alias = "course"))]
    pub(crate) history: StepHistory,
}

impl<Steps: Clone + Debug + Send + Sync> Memory for Lengths<Steps> {}

impl<Steps: Clone + Debug + Send + Sync> Controlled<f64> for Lengths<Steps> {
    fn control(&self) -> &Control {
        &self.history.control
    }

    fn control_mut(&mut self) -> &mut Control {
        &mut self.history.control
    }
}

/// The solver of the kind of a system.
pub(crate) type Solver<S, const N: usize, const STAGES: usize> =
    <<S as Motion<N>>::Kind as Kind>::Lengths<S, N, STAGES>;

/// The memory of runs of a system.
type MemoryOf<S, const N: usize, const STAGES: usize> =
    Lengths<<Solver<S, N, STAGES> as LengthSolver<S, N, STAGES>>::Steps>;

/// The memory before the first step, which preserves the energy of the node.
///
/// # Errors
/// The errors of a start.
fn begun<S, const N: usize, const STAGES: usize>(
    system: &S,
    node: &Node<N>,
    h: f64,
) -> Result<MemoryOf<S, N, STAGES>, StepError>
where
    S: Convertible<N>,
{
    Solver::<S, N, STAGES>::check_start(system, node)?;
    let mut history = StepHistory::new(h, order::<STAGES>());
    let steps = Solver::<S, N, STAGES>::fresh(system, node, h)?;
    history.set_excess(measured(system, node)?);
    Ok(Lengths { steps, history })
}

impl<S, const N: usize, const STAGES: usize> Method<S, N> for EnergyPreservingGauss<STAGES>
where
    S: Convertible<N>,
{
    type Prepared = Instructions;
    type Memory = MemoryOf<S, N, STAGES>;
    type Cache = <Solver<S, N, STAGES> as LengthSolver<S, N, STAGES>>::Cache;
    type Step = PreservingStep<<Solver<S, N, STAGES> as LengthSolver<S, N, STAGES>>::Taken>;
    type Left = StepError;
    type DenseOutput = <Solver<S, N, STAGES> as LengthSolver<S, N, STAGES>>::DenseOutput;

    fn facts(&self) -> Facts {
        Facts { finds_length: true, has_reactions: S::Kind::COUNT > 0, ..Facts::of_order(2 * STAGES) }
    }

    fn check_length(&self, _system: &S, h: f64) -> Result<(), StepError> {
        check_forward(FORWARD, h)?;
        check_power::<STAGES>(h)
    }

    fn prepare(&self, _system: &S, _h: f64) -> Instructions {
        Instructions::detected()
    }

    fn begin(&self, system: &S, node: &mut Node<N>, h: f64) -> Result<Self::Memory, StepError> {
        if system.is_first_order() {
            return Err(StepError::FirstOrder { system: system.name() });
        }
        check_density(system)?;
        node.energy = 0.0;
        let mut memory = begun(system, node, h)?;
        // The start has already solved the stages of the first step.
        node.energy = Solver::<S, N, STAGES>::first(system, node, h, &mut memory.steps)?;
        memory.history.set_excess(measured(system, node)?);
        Ok(memory)
    }

    /// The search of a step, compiled once.
    #[inline(never)]
    fn attempt(
        &self,
        at: Problem<'_, S, Instructions, N>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
    ) -> Result<Self::Step, StepError> {
        Solver::<S, N, STAGES>::next(at.system, *at.prepared, (at.node, &memory.steps, &memory.history), cache)
    }

    fn recover(
        &self,
        at: Problem<'_, S, Instructions, N>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
        left: StepError,
    ) -> Result<Self::Step, StepError> {
        Err(failed(self, at, &memory.history, cache, left))
    }

    fn take(
        &self,
        _system: &S,
        _h: f64,
        (node, memory): (&mut Node<N>, &mut Self::Memory),
        cache: &mut Self::Cache,
        PreservingStep { taken, gain, history }: Self::Step,
    ) {
        let before = *node;
        *node = Solver::<S, N, STAGES>::end(&before, &taken);
        Solver::<S, N, STAGES>::take(&mut memory.steps, &before, &taken, cache);
        node.add_energy(gain);
        memory.history = history;
    }

    fn step_of(
        &self,
        system: &S,
        (node, memory): (&Node<N>, &Self::Memory),
        [h, _]: [f64; 2],
    ) -> Result<(Node<N>, Self::Memory), StepError> {
        check_forward("the step h", h)?;
        let Lengths { steps, mut history } = memory.clone();
        let GivenStep { taken, residual, gain, measured } =
            Solver::<S, N, STAGES>::given(system, (node, &steps, &history), h)?;
        let mut after = Solver::<S, N, STAGES>::end(node, &taken);
        after.add_energy(gain);
        history.set_excess(measured);
        history.control.phase = history.control.phase.map(|phase| FixedPhase { gap: residual, ..phase });
        let steps = Solver::<S, N, STAGES>::fresh(system, &after, history.h())?;
        Ok((after, Lengths { steps, history }))
    }

    fn restarted(
        &self,
        system: &S,
        change: &Change<'_, S, N>,
        node: &mut Node<N>,
        _h: f64,
        memory: &Self::Memory,
    ) -> Result<Self::Memory, StepError> {
        if matches!(change, Change::NewLength) {
            return Ok(memory.clone());
        }
        Solver::<S, N, STAGES>::check_start(system, &change.moved(node))?;
        let changed = change.moved_with_energy(system, node)?;
        let mut history = memory.history;
        history.set_excess(measured(system, &changed)?);
        let steps = match change {
            Change::NewState(..) => Solver::<S, N, STAGES>::fresh(system, &changed, history.h())?,
            _ => Solver::<S, N, STAGES>::changed(system, &changed, history.h(), &memory.steps)?,
        };
        *node = changed;
        Ok(Lengths { steps, history })
    }

    fn dense_output(
        &self,
        system: &S,
        before: &State<N>,
        node: &Node<N>,
        h: f64,
        memory: &Self::Memory,
    ) -> Result<Self::DenseOutput, StepError> {
        Solver::<S, N, STAGES>::dense_output(system, &memory.steps, before, node, h)
    }

    fn status(&self, _h: f64, memory: &Self::Memory) -> Status {
        let Lengths { steps, history } = memory;
        Status {
            length: history.h(),
            longest: history.control.longest(history.h()),
            residual: Solver::<S, N, STAGES>::residual(steps).max(history.residual),
            iterations: history.iterations,
        }
    }

    fn discrete_energy(&self, _system: &S, node: &Node<N>, _h: f64, memory: &Self::Memory) -> Option<f64> {
        let history = &memory.history;
        Some(node.energy + history.control.gap() + power::<STAGES>(history.h()) * history.shift)
    }

    fn check(&self, system: &S, (node, memory): (&Node<N>, &Self::Memory), _h: f64) -> Result<(), StepError> {
        memory.history.check(node.t)?;
        Solver::<S, N, STAGES>::check(system, node, &memory.steps)
    }
}

impl<const STAGES: usize> EnergyPreservingGauss<STAGES> {
    /// A run of `system` from `state` that preserves `energy`, in units of L. The first step has about the length `h`,
    /// up to a factor of 3. H at the state differs from that energy by `C_s h^2s D_s`; for `E = H` itself no step
    /// length exists.
    ///
    /// # Errors
    /// As [`integrate`](crate::run::Start::integrate); [`StepError::NonFinite`] for an energy that is not finite.
    pub fn from_energy<S, const N: usize>(
        system: S,
        state: State<N>,
        energy: f64,
        h: f64,
    ) -> Result<Run<Self, S, N>, StepError>
    where
        S: Convertible<N>,
    {
        Method::<S, N>::check_length(&Self, &system, h)?;
        check_density(&system)?;
        let node = Node::new(state, energy);
        let memory = begun(&system, &node, h)?;
        Ok(Run::resumed(Self, system, (node, h, memory)))
    }
}

impl<const STAGES: usize> StepPower for EnergyPreservingGauss<STAGES> {
    fn power(h: f64) -> f64 {
        power::<STAGES>(h)
    }
}

impl<S, const N: usize, const STAGES: usize> Shiftable<S, N> for EnergyPreservingGauss<STAGES>
where
    S: Convertible<N>,
{
    type Fixed = Gauss<STAGES>;
    const FIXED: Gauss<STAGES> = Gauss;

    fn history(memory: &Self::Memory) -> &StepHistory {
        &memory.history
    }

    fn history_mut(memory: &mut Self::Memory) -> &mut StepHistory {
        &mut memory.history
    }

    fn step_density(system: &S, state: &State<N>) -> Result<f64, StepError> {
        Solver::<S, N, STAGES>::step_density(system, state)
    }

    fn energies(run: &Run<Gauss<STAGES>, S, N>, base: f64) -> [f64; 2]
    where
        S: Lagrangian<N> + Copy,
    {
        Solver::<S, N, STAGES>::energies(run, base)
    }
}
