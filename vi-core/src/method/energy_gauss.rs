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
//! The stages and the energy of every accepted step are at the rounding floor. Theory and measurements:
//! `docs/theory.md`.

use super::bounds::{Alternating, Control, Controlled, FORWARD, Phase, check_forward};
use super::gauss::{Gauss, GaussOutput, LastStages};
use super::length::Trial;
use super::preserving::{Ended, Preserving, PreservingStep, StepsOfAnyLength, check_power, failed, measured, order};
use super::shift::{Shiftable, StepPower};
use super::{Memory, Method, Problem, Report};
use crate::collocation::Collocation;
use crate::energy_preserving::start::check_density;
use crate::error::StepError;
use crate::gauss::density::{power, step_density};
use crate::gauss::energies::{Energies, bounded_energies, energies};
use crate::gauss::fixed_point::Convergence;
use crate::gauss::history::StepHistory;
use crate::gauss::newton::Buffer;
use crate::gauss::solve::{Start, Step};
use crate::gauss::stages::{Stages, at};
use crate::lagrangian::Lagrangian;
use crate::node::Node;
use crate::run::Run;
use crate::state::State;
use crate::stepping::Convertible;
use core::cell::RefCell;
use nalgebra::{ArrayStorage, SMatrix};
use vi_dispatch::Instructions;

/// Energy-preserving steps of order 2 STAGES, with 1 to 3 stages: `EnergyPreservingGauss::<2>`. See the [module](self).
///
/// A run from a state starts with a step of the length h, and preserves the discrete energy of that step. It differs
/// from H at the state by `C_s h^2s D_s`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EnergyPreservingGauss<const STAGES: usize>;

/// The memory of a run: stages, and data for the prediction of lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Lengths<const N: usize, const S: usize> {
    pub(crate) stages: LastStages<N, S>,
    pub(crate) course: StepHistory,
}

impl<const N: usize, const S: usize> Memory for Lengths<N, S> {}

impl<const N: usize, const S: usize> Controlled<f64> for Lengths<N, S> {
    fn control(&self) -> &Control {
        &self.course.control
    }

    fn control_mut(&mut self) -> &mut Control {
        &mut self.course.control
    }
}

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
struct GaussSteps<'a, S, const N: usize, const K: usize> {
    system: &'a S,
    instructions: Instructions,
    stages: &'a LastStages<N, K>,
    cache: RefCell<&'a mut Cache<N, K>>,
}

impl<S, const N: usize, const K: usize> GaussSteps<'_, S, N, K> {
    /// The stages of the step of length h, extrapolated from the last one.
    fn guess(&self, h: f64) -> Stages<N, K> {
        let LastStages { stages, convergence, h: last, .. } = self.stages;
        if convergence.has_begun() { at(&stages.data.0, |c| 1.0 + c * (h / last)) } else { stages.data.0 }
    }
}

impl<S, const N: usize, const K: usize> StepsOfAnyLength<N, K> for GaussSteps<'_, S, N, K>
where
    S: Collocation<N> + Convertible<N>,
{
    type Trial = Tried<N, K>;
    type Taken = Step<N, K>;

    fn tried(
        &self,
        node: &Node<N>,
        h: f64,
        shift: f64,
        beside: Option<&Tried<N, K>>,
    ) -> Result<Tried<N, K>, StepError> {
        let Self { system, instructions, stages: last, cache } = self;
        let (system, instructions, cache) = (*system, *instructions, &mut **cache.borrow_mut());
        let stages = beside.map_or_else(
            || self.guess(h),
            |other| {
                let ratio = h / other.h();
                at(&other.step.stages, |c| ratio * c)
            },
        );
        let before = &Convergence { iterations: 0, ..last.convergence };
        let start = Start { node, h, stages: &stages, are_last: false, before, pause: last.pause };
        let by_fixed_point =
            if last.pause.is_over() { start.by_fixed_point(system, instructions).map_err(Some) } else { Err(None) };
        // Lengths differ from step to step, so each has its own linearization.
        let step = by_fixed_point.or_else(|left| start.recover(system, instructions, (left.as_ref(), None), cache))?;
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

    fn ended(&self, node: &Node<N>, trial: &Tried<N, K>) -> Result<Ended<Step<N, K>>, StepError> {
        let step = trial.step;
        let mut after = *node;
        after.advance(step.h, &step.increment.velocity, &step.increment.momentum);
        let gain = if !S::AUTONOMOUS || S::FORCED { trial.work } else { 0.0 };
        after.add_energy(gain);
        after.check_finite(node.t)?;
        Ok(Ended { taken: step, gain, measured: measured(self.system, &after)? })
    }
}

/// The step of the length h from a node, guessed from the last step.
///
/// # Errors
/// As [`StepsOfAnyLength::tried`].
fn alone<S, const N: usize, const K: usize>(
    system: &S,
    (node, memory): (&Node<N>, &Lengths<N, K>),
    h: f64,
) -> Result<Tried<N, K>, StepError>
where
    S: Collocation<N> + Convertible<N>,
{
    let Lengths { stages, course } = memory;
    let cache = &mut Buffer::default();
    let steps = GaussSteps { system, instructions: Instructions::detected(), stages, cache: RefCell::new(cache) };
    steps.tried(node, h, course.shift, None)
}

/// The memory before the first step, which preserves the energy of the node.
fn begun<S, const N: usize, const K: usize>(system: &S, node: &Node<N>, h: f64) -> Result<Lengths<N, K>, StepError>
where
    S: Collocation<N>,
{
    let mut course = StepHistory::new(h, order::<K>());
    let stages = LastStages::constant(system, node, h)?;
    course.set_excess(measured(system, node)?);
    Ok(Lengths { stages, course })
}

impl<S, const N: usize, const STAGES: usize> Method<S, N> for EnergyPreservingGauss<STAGES>
where
    S: Collocation<N> + Convertible<N>,
{
    type Prepared = Instructions;
    type Memory = Lengths<N, STAGES>;
    type Cache = Cache<N, STAGES>;
    type Step = PreservingStep<Step<N, STAGES>>;
    type Left = StepError;
    type DenseOutput = GaussOutput<N, STAGES>;

    const FINDS_LENGTH: bool = true;

    #[allow(clippy::cast_possible_truncation)] // 16 stages at most
    fn order(&self) -> u32 {
        2 * STAGES as u32
    }

    fn check_length(&self, h: f64) -> Result<(), StepError> {
        check_forward(FORWARD, h)?;
        check_power::<STAGES>(h)
    }

    fn prepare(&self, _system: &S, _h: f64) -> Instructions {
        Instructions::detected()
    }

    fn begin(&self, system: &S, node: &mut Node<N>, h: f64) -> Result<Self::Memory, StepError> {
        check_density::<N, f64, S>()?;
        node.energy = 0.0;
        let mut memory = begun(system, node, h)?;
        let first = alone(system, (node, &memory), h)?;
        node.energy = first.residual;
        // The start has already solved the stages of the first step.
        memory.stages.stages = SMatrix::from_array_storage(ArrayStorage(first.step.stages));
        memory.course.set_excess(measured(system, node)?);
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
        let Problem { system, prepared, node, .. } = at;
        let Lengths { stages, course } = memory;
        let steps = &GaussSteps { system, instructions: *prepared, stages, cache: RefCell::new(cache) };
        Preserving { steps, node, course }.next()
    }

    fn recover(
        &self,
        at: Problem<'_, S, Instructions, N>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
        left: StepError,
    ) -> Result<Self::Step, StepError> {
        Err(failed(self, at, &memory.course, cache, left))
    }

    fn take(
        &self,
        _h: f64,
        (node, memory): (&mut Node<N>, &mut Self::Memory),
        _cache: &mut Self::Cache,
        step: Self::Step,
    ) {
        memory.stages.take(node, &step.taken);
        node.add_energy(step.gain);
        memory.course = step.course;
    }

    fn step_of(
        &self,
        system: &S,
        (node, memory): (&Node<N>, &Self::Memory),
        [h, _]: [f64; 2],
    ) -> Result<(Node<N>, Self::Memory), StepError> {
        check_forward("the step h", h)?;
        let Tried { step, residual, work, .. } = alone(system, (node, memory), h)?;
        let mut after = *node;
        after.advance(h, &step.increment.velocity, &step.increment.momentum);
        after.add_energy(work);
        after.check_finite(node.t)?;
        let mut course = memory.course;
        course.set_excess(measured(system, &after)?);
        course.control.phase = course.control.phase.map(|phase| Phase { gap: residual, ..phase });
        let stages = LastStages::constant(system, &after, course.h())?;
        Ok((after, Lengths { stages, course }))
    }

    fn with_length(
        &self,
        _system: &S,
        memory: &Self::Memory,
        _node: &Node<N>,
        _h: f64,
    ) -> Result<Self::Memory, StepError> {
        Ok(*memory)
    }

    fn with_system(
        &self,
        [before, after]: [&S; 2],
        node: &mut Node<N>,
        _h: f64,
        memory: &Self::Memory,
    ) -> Result<Self::Memory, StepError> {
        let state = node.state();
        let mut changed = *node;
        changed.add_energy(state.energy(after)? - state.energy(before)?);
        let mut memory = *memory;
        memory.course.set_excess(measured(after, &changed)?);
        memory.stages.before = changed;
        *node = changed;
        Ok(memory)
    }

    fn with_state(
        &self,
        [before, system]: [&S; 2],
        node: &mut Node<N>,
        _h: f64,
        memory: &Self::Memory,
        state: State<N>,
    ) -> Result<Self::Memory, StepError> {
        let brought = state.energy(system)? - node.state().energy(before)?;
        *node = node.with_state(state);
        node.add_energy(brought);
        let mut course = memory.course;
        course.set_excess(measured(system, node)?);
        Ok(Lengths { stages: LastStages::constant(system, node, course.h())?, course })
    }

    fn dense_output(
        &self,
        system: &S,
        before: &State<N>,
        node: &Node<N>,
        h: f64,
        memory: &Self::Memory,
    ) -> Result<GaussOutput<N, STAGES>, StepError> {
        memory.stages.dense_output(system, before, node, h)
    }

    fn length(&self, _h: f64, memory: &Self::Memory) -> f64 {
        memory.course.h()
    }

    fn longest(&self, _h: f64, memory: &Self::Memory) -> f64 {
        memory.course.control.longest(memory.course.h())
    }

    fn report(&self, memory: &Self::Memory) -> Report {
        let Lengths { stages, course } = memory;
        Report { residual: stages.convergence.change.max(course.residual), iterations: course.iterations }
    }

    fn discrete_energy(&self, _system: &S, node: &Node<N>, _h: f64, memory: &Self::Memory) -> Option<f64> {
        let course = &memory.course;
        Some(node.energy + course.control.gap() + power::<STAGES>(course.h()) * course.shift)
    }

    fn check(&self, memory: &Self::Memory, _h: f64, t: f64) -> Result<(), StepError> {
        memory.stages.check(t)?;
        memory.course.check(t)
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
        S: Collocation<N> + Convertible<N>,
    {
        Method::<S, N>::check_length(&Self, h)?;
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
    S: Collocation<N> + Convertible<N>,
{
    type Fixed = Gauss<STAGES>;
    const FIXED: Gauss<STAGES> = Gauss;

    fn course(memory: &Self::Memory) -> &StepHistory {
        &memory.course
    }

    fn course_mut(memory: &mut Self::Memory) -> &mut StepHistory {
        &mut memory.course
    }

    fn step_density(system: &S, state: &State<N>) -> Result<f64, StepError> {
        step_density::<S, N, STAGES>(system, state)
    }

    fn energies(run: &Run<Gauss<STAGES>, S, N>, base: f64) -> [f64; 2]
    where
        S: Lagrangian<N> + Copy,
    {
        let LastStages { before, stages, h, .. } = &run.memory;
        let Energies { start, end, .. } = energies(&run.system, before, *h, stages.data.0, base);
        [start, end]
    }
}

impl<S, const N: usize, const STAGES: usize> Run<EnergyPreservingGauss<STAGES>, S, N>
where
    S: Collocation<N> + Convertible<N>,
{
    /// The stages of a step of the length h from here, regardless of its energy.
    ///
    /// # Errors
    /// Those of a Gauss step; [`StepError::NonFinite`] if its energy is not finite.
    pub(crate) fn stages_of(&self, h: f64) -> Result<Stages<N, STAGES>, StepError> {
        Ok(alone(&self.system, (&self.node, &self.memory), h)?.step.stages)
    }
}
