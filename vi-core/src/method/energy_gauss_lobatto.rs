//! Energy-preserving steps of order 2S with constraints: Gauss–Lobatto steps whose length preserves the discrete energy.
//!
//! One step solves, for velocities, impulses and h > 0, the equations of a step of
//! [`GaussLobatto`] and
//!
//! ```text
//! E = E0(h) = Σ b_i En_i − h Σ b_i (1 − c_i) (f·v − L_t)_i + Σ_{j<S} (1 − c̃_j) λ_j·a_j
//! ```
//!
//! E then changes by the work of the force, of an explicit time and of moving constraints only. The constraints hold at
//! every node. The length follows from `H − E0(h) = C_s h^2s D_s` with the step density D_s
//! ([`step_density`]), as in
//! [`energy_gauss`](crate::method::energy_gauss): the same search, shift, bounds and fallback.
//!
//! With holonomic constraints and without force `h (D_s + D_*)^(1/(2s+1))` is constant up to O(h²). Nonholonomic
//! systems do not have this law: h returns where the motion is reversible, otherwise it may drift.
//!
//! D_s depends on L beside the constraints, and in Cartesian coordinates it changes its sign in most motions: in every
//! oscillation of a pendulum. Therefore start with a shift, [`Run::with_shift_from`].

use super::bounds::{Alternating, Control, Controlled, FORWARD, Phase, check_forward};
use super::gauss_lobatto::{ConstrainedSteps, GaussLobatto, Impulses};
use super::length::Trial;
use super::preserving::{Preserving, PreservingStep, StepsOfAnyLength, check_power, failed, measured, order};
use super::shift::{Shiftable, StepPower};
use super::{Memory, Method, Problem, Report};
use crate::constrained::guess::from_node;
use crate::constrained::lengths::{ConstrainedLengths, TakenLength, TriedLength};
use crate::constrained::solve::Workspace;
use crate::constrained::{Constrained, ConvertibleConstrained, bordered, energies, start, step_density, unknowns};
use crate::energy_preserving::start::check_density;
use crate::error::StepError;
use crate::gauss::density::power;
use crate::gauss::history::StepHistory;
use crate::lagrangian::Lagrangian;
use crate::linear::Bordered;
use crate::node::Node;
use crate::run::{Hermite, Run};
use crate::state::State;
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::cell::RefCell;
use nalgebra::SVector;

/// Energy-preserving steps of order 2 STAGES of a system with constraints, with 1 to 3 stages:
/// `EnergyPreservingGaussLobatto::<2>`. See the [module](self).
///
/// A run from a state starts with a step of the length h, and preserves the discrete energy of that step. It differs
/// from H at the state by `C_s h^2s D_s`. Few runs go far without a shift: use [`Run::with_shift_from`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EnergyPreservingGaussLobatto<const STAGES: usize>;

/// The memory of a run: the last steps, and data for the prediction of lengths.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EnergyPreservingSteps<const N: usize> {
    steps: ConstrainedSteps<N>,
    course: StepHistory,
}

impl<const N: usize> Memory for EnergyPreservingSteps<N> {}

impl<const N: usize> Controlled<f64> for EnergyPreservingSteps<N> {
    fn control(&self) -> &Control {
        &self.course.control
    }

    fn control_mut(&mut self) -> &mut Control {
        &mut self.course.control
    }
}

/// The last steps before the first one of about the length h, from a node with the velocity v.
///
/// # Errors
/// [`StepError::Singular`] and [`StepError::NonFinite`].
fn fresh<S: Constrained<N>, const N: usize, const STAGES: usize>(
    system: &S,
    (node, h, v): (&Node<N>, f64, &SVector<f64, N>),
    bordered: &mut Bordered,
) -> Result<ConstrainedSteps<N>, StepError> {
    let mut guess = from_node::<S, N, STAGES>(system, (node, h, v), bordered)?;
    guess.push(h);
    Ok(ConstrainedSteps::new::<S>((node, h), &guess, bordered.determinant_sign()))
}

/// The memory before the first step, which preserves the energy of the node.
///
/// # Errors
/// Those of a start with constraints.
fn begun<S, const N: usize, const STAGES: usize>(
    system: &S,
    node: &Node<N>,
    h: f64,
) -> Result<EnergyPreservingSteps<N>, StepError>
where
    S: Constrained<N> + ConvertibleConstrained<N>,
{
    let bordered = &mut bordered::<S, N, f64>();
    let v = start::checked(system, node, bordered)?;
    let steps = fresh::<S, N, STAGES>(system, (node, h, &v), bordered)?;
    let mut course = StepHistory::new(h, order::<STAGES>());
    course.set_excess(measured(system, node)?);
    Ok(EnergyPreservingSteps { steps, course })
}

/// The steps of any length after those of a run.
fn lengths<'a, S: Constrained<N>, const N: usize, const STAGES: usize>(
    system: &'a S,
    steps: &'a ConstrainedSteps<N>,
    cache: &'a mut Option<Box<Workspace>>,
) -> ConstrainedLengths<'a, S, N> {
    let workspace = cache.get_or_insert_with(|| Box::new(Workspace::new::<S, N, STAGES>()));
    ConstrainedLengths { system, last: &steps.unknowns, sign: steps.sign, workspace: RefCell::new(workspace) }
}

impl<S, const N: usize, const STAGES: usize> Method<S, N> for EnergyPreservingGaussLobatto<STAGES>
where
    S: Constrained<N> + ConvertibleConstrained<N>,
{
    type Prepared = ();
    type Memory = EnergyPreservingSteps<N>;
    type Cache = Option<Box<Workspace>>;
    type Step = PreservingStep<TakenLength<N, STAGES, S::Multipliers>>;
    type Left = StepError;
    type DenseOutput = Hermite<N>;

    const FINDS_LENGTH: bool = true;
    const HAS_REACTIONS: bool = true;

    #[allow(clippy::cast_possible_truncation)] // 3 stages at most
    fn order(&self) -> u32 {
        2 * STAGES as u32
    }

    fn check_length(&self, h: f64) -> Result<(), StepError> {
        check_forward(FORWARD, h)?;
        check_power::<STAGES>(h)
    }

    fn prepare(&self, _system: &S, _h: f64) {}

    fn begin(&self, system: &S, node: &mut Node<N>, h: f64) -> Result<Self::Memory, StepError> {
        check_density::<N, f64, S>()?;
        node.energy = 0.0;
        let mut memory = begun::<S, N, STAGES>(system, node, h)?;
        let cache = &mut None;
        let steps = lengths::<S, N, STAGES>(system, &memory.steps, cache);
        let first: TriedLength<N, STAGES, S::Multipliers> = steps.tried(node, h, 0.0, None)?;
        node.energy = first.residual();
        // The start has already solved the first step.
        let mut unknowns = Vec::new();
        first.write(&mut unknowns);
        unknowns.push(h);
        memory.steps = ConstrainedSteps::new::<S>((node, h), &unknowns, memory.steps.sign);
        memory.course.set_excess(measured(system, node)?);
        Ok(memory)
    }

    fn attempt(
        &self,
        at: Problem<'_, S, (), N>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
    ) -> Result<Self::Step, StepError> {
        let Problem { system, node, .. } = at;
        let EnergyPreservingSteps { steps, course } = memory;
        let steps = &lengths::<S, N, STAGES>(system, steps, cache);
        Preserving::<_, N, STAGES> { steps, node, course }.next()
    }

    fn recover(
        &self,
        at: Problem<'_, S, (), N>,
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
        cache: &mut Self::Cache,
        step: Self::Step,
    ) {
        let PreservingStep { taken: TakenLength { end, tried, mu, residual }, gain, course } = step;
        let before = *node;
        *node = Node { energy: before.energy, energy_low: before.energy_low, ..end };
        node.add_energy(gain);
        // The buffer is that of the solver, which has solved this step.
        if let Some(workspace) = cache {
            tried.write(&mut workspace.unknowns);
            workspace.unknowns.push(tried.h);
            memory.steps.take((&before, tried.h), &workspace.unknowns, mu.as_ref(), residual);
        }
        memory.course = course;
    }

    fn step_of(
        &self,
        system: &S,
        (node, memory): (&Node<N>, &Self::Memory),
        [h, _]: [f64; 2],
    ) -> Result<(Node<N>, Self::Memory), StepError> {
        check_forward("the step h", h)?;
        let EnergyPreservingSteps { steps, course } = memory;
        let cache = &mut None;
        let lengths = lengths::<S, N, STAGES>(system, steps, cache);
        let tried: TriedLength<N, STAGES, S::Multipliers> = lengths.tried(node, h, course.shift, None)?;
        let ended = lengths.ended(node, &tried)?;
        let after = ended.taken.end;
        let mut course = *course;
        course.set_excess(ended.measured);
        course.control.phase = course.control.phase.map(|phase| Phase { gap: tried.residual(), ..phase });
        let v = after.state().velocity(system)?;
        let bordered = &mut bordered::<S, N, f64>();
        let steps = fresh::<S, N, STAGES>(system, (&after, course.h(), &v), bordered)?;
        Ok((after, EnergyPreservingSteps { steps, course }))
    }

    fn with_length(
        &self,
        _system: &S,
        memory: &Self::Memory,
        _node: &Node<N>,
        _h: f64,
    ) -> Result<Self::Memory, StepError> {
        Ok(memory.clone())
    }

    fn with_system(
        &self,
        [before, after]: [&S; 2],
        node: &mut Node<N>,
        _h: f64,
        memory: &Self::Memory,
    ) -> Result<Self::Memory, StepError> {
        let bordered = &mut bordered::<S, N, f64>();
        let v = start::checked(after, node, bordered)?;
        let state = node.state();
        let mut changed = *node;
        changed.add_energy(state.energy(after)? - state.energy(before)?);
        let mut course = memory.course;
        course.set_excess(measured(after, &changed)?);
        let steps = fresh::<S, N, STAGES>(after, (&changed, course.h(), &v), bordered)?;
        *node = changed;
        Ok(EnergyPreservingSteps { steps, course })
    }

    fn with_state(
        &self,
        [before, system]: [&S; 2],
        node: &mut Node<N>,
        _h: f64,
        memory: &Self::Memory,
        state: State<N>,
    ) -> Result<Self::Memory, StepError> {
        let bordered = &mut bordered::<S, N, f64>();
        let mut changed = node.with_state(state);
        let v = start::checked(system, &changed, bordered)?;
        changed.add_energy(state.energy(system)? - node.state().energy(before)?);
        let mut course = memory.course;
        course.set_excess(measured(system, &changed)?);
        let steps = fresh::<S, N, STAGES>(system, (&changed, course.h(), &v), bordered)?;
        *node = changed;
        Ok(EnergyPreservingSteps { steps, course })
    }

    fn dense_output(
        &self,
        system: &S,
        before: &State<N>,
        node: &Node<N>,
        h: f64,
        _memory: &Self::Memory,
    ) -> Result<Hermite<N>, StepError> {
        Hermite::between(system, before, &node.state(), h)
    }

    fn length(&self, _h: f64, memory: &Self::Memory) -> f64 {
        memory.course.h()
    }

    fn longest(&self, _h: f64, memory: &Self::Memory) -> f64 {
        memory.course.control.longest(memory.course.h())
    }

    fn report(&self, memory: &Self::Memory) -> Report {
        let EnergyPreservingSteps { steps, course } = memory;
        Report { residual: steps.residual.max(course.residual), iterations: course.iterations }
    }

    fn discrete_energy(&self, _system: &S, node: &Node<N>, _h: f64, memory: &Self::Memory) -> Option<f64> {
        let course = &memory.course;
        Some(node.energy + course.control.gap() + power::<STAGES>(course.h()) * course.shift)
    }

    fn check(&self, memory: &Self::Memory, _h: f64, t: f64) -> Result<(), StepError> {
        let constraints = S::CONSTRAINTS.len();
        memory.steps.check([unknowns::<N, STAGES>(constraints) + 1, constraints], t)?;
        memory.course.check(t)
    }

    fn check_node(&self, system: &S, node: &Node<N>) -> Result<(), StepError> {
        start::check_stored(system, node)
    }
}

impl<const STAGES: usize> StepPower for EnergyPreservingGaussLobatto<STAGES> {
    fn power(h: f64) -> f64 {
        power::<STAGES>(h)
    }
}

impl<S, const N: usize, const STAGES: usize> Shiftable<S, N> for EnergyPreservingGaussLobatto<STAGES>
where
    S: Constrained<N> + ConvertibleConstrained<N>,
{
    type Fixed = GaussLobatto<STAGES>;
    const FIXED: GaussLobatto<STAGES> = GaussLobatto;

    fn course(memory: &Self::Memory) -> &StepHistory {
        &memory.course
    }

    fn course_mut(memory: &mut Self::Memory) -> &mut StepHistory {
        &mut memory.course
    }

    fn step_density(system: &S, state: &State<N>) -> Result<f64, StepError> {
        step_density::<S, N, STAGES>(system, state)
    }

    fn energies(run: &Run<GaussLobatto<STAGES>, S, N>, base: f64) -> [f64; 2]
    where
        S: Lagrangian<N> + Copy,
    {
        let ConstrainedSteps { before, h, unknowns, mu, .. } = &run.memory;
        let found = energies::energies::<S, N, STAGES, f64>(&run.system, (before, *h), unknowns.newest(), base);
        let State { t, q, .. } = run.node.state();
        [found.start, found.end - energies::power_of::<S, N, f64>(&run.system, (t, &q), mu)]
    }
}

impl<const STAGES: usize> EnergyPreservingGaussLobatto<STAGES> {
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
        S: Constrained<N> + ConvertibleConstrained<N>,
    {
        Method::<S, N>::check_length(&Self, h)?;
        check_density::<N, f64, S>()?;
        let node = Node::new(state, energy);
        let memory = begun::<S, N, STAGES>(&system, &node, h)?;
        Ok(Run::resumed(Self, system, (node, h, memory)))
    }
}

impl<S, const N: usize, const STAGES: usize> Run<EnergyPreservingGaussLobatto<STAGES>, S, N>
where
    S: Constrained<N> + ConvertibleConstrained<N>,
{
    /// The impulses λ and μ of the constraints in the last step, as for [`GaussLobatto`]. `None` before the first step,
    /// and after [`Run::set_parameters`], [`Run::set_state`] or [`Run::step_of`].
    pub fn impulses(&self) -> Option<Impulses<S::Multipliers, STAGES>> {
        self.memory.steps.impulses(&self.system, &self.node)
    }
}
