//! Gauss steps of systems without constraints.
//!
//! With the tableau a, b, c of Gauss collocation and the stages `T_i = t0 + c_i h`, a step solves
//!
//! ```text
//! Q_i = q0 + h Σ a_ij V_j        L_v(T_i, Q_i, V_i) = p0 + h Σ a_ij (L_q + f)_j
//! q1  = q0 + h Σ b_i V_i         p1 = p0 + h Σ b_i (L_q + f)_i        E1 = Σ b_i En_i − h Σ b_i c_i (L_t − f·v)_i
//! ```
//!
//! with En_i the energy at a stage. The step preserves momenta of cyclic coordinates bit for bit. [`crate::gauss`] solves
//! the stage equations.
//!
//! The stages of every accepted step satisfy their equations to rounding. Adaptive steps of a tolerance may ask for less.

use super::{Gauss, StageSolver};
#[cfg(feature = "alloc")]
use crate::derivatives::{Covector, Variation, not_last};
use crate::error::StepError;
use crate::first_order;
#[cfg(feature = "alloc")]
use crate::gauss::curvature::curvature;
use crate::gauss::energies::energies;
use crate::gauss::fixed_point::{Convergence, Pause, StageIncrement};
use crate::gauss::general::General;
use crate::gauss::linearization::LinearizationPoint;
use crate::gauss::newton::Buffer;
use crate::gauss::points::{ErasedSystem, follows_momenta};
use crate::gauss::solve::{StageSolution, Start, Step, constant, iterated, long};
use crate::gauss::stages::{EXACT, LOOPED, Stages, at, constant_mass};
#[cfg(feature = "alloc")]
use crate::gauss::variation::vary;
use crate::gauss::{CollocationPolynomial, Slots};
use crate::kind::Free;
use crate::method::{Change, Facts, Memory, Method, Problem, Status};
use crate::motion::Motion;
use crate::node::Node;
use crate::run::{DenseOutput, Hermite, Run};
use crate::state::State;
use crate::stepping::Convertible;
#[cfg(feature = "alloc")]
use nalgebra::DMatrix;
use nalgebra::{ArrayStorage, SMatrix, SVector};
use vi_dispatch::{Instructions, Loop};

/// The solver of [`Gauss`] steps without constraints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeGauss<const STAGES: usize> {
    /// The accuracy of the stages, in ulps.
    accuracy: f64,
}

impl<const STAGES: usize> Default for FreeGauss<STAGES> {
    /// Stages that are solved to rounding.
    fn default() -> Self {
        Self { accuracy: EXACT }
    }
}

/// The unit of the stages of a step with a tolerance ε, in units of ε. The last change of velocities is at most 64 units,
/// and the error that the contraction predicts for the step is below a thousandth of a unit.
const PART: f64 = 1.0 / 64.0;

/// The stages of the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(C, align(64))]
pub struct LastStages<const N: usize, const S: usize> {
    /// Velocities at the stages of the last step, or the forces there for a separable system; one column per
    /// coordinate. Before the first step, values at the node. The first field is aligned, so that a vector of eight
    /// numbers fits one cache line.
    pub(crate) stages: SMatrix<f64, S, N>,
    /// The start node of the last step, or the current node if the parameters have changed since.
    pub(crate) before: Node<N>,
    /// Length of the last step.
    pub(crate) h: f64,
    pub(crate) convergence: Convergence,
    pub(crate) pause: Pause,
    /// Linearization point of the next stiff step; `None` if it linearizes anew.
    pub(crate) linearization: Option<LinearizationPoint<N>>,
}

impl<const N: usize, const S: usize> Memory for LastStages<N, S> {}

impl<const N: usize, const S: usize> LastStages<N, S> {
    /// Stages equal to the node, before the first step of the length h.
    ///
    /// # Errors
    /// As [`State::velocity`].
    pub(crate) fn constant<Y: Motion<N>>(system: &Y, node: &Node<N>, h: f64) -> Result<Self, StepError> {
        let stages = SMatrix::from_array_storage(ArrayStorage(constant(system, node)?));
        let (convergence, pause) = (Convergence::NONE, Pause::NONE);
        Ok(Self { stages, before: *node, h, convergence, pause, linearization: None })
    }

    /// Stages for a change of the step to the length h: those of a step of that length before the node, with the same
    /// polynomials.
    fn resized<Y: Motion<N>>(&self, system: &Y, node: &Node<N>, h: f64) -> Result<Self, StepError> {
        let ratio = h / self.h;
        if !(self.has_step(node) && ratio > 0.0) {
            return Self::constant(system, node, h);
        }
        let stages = at(&self.stages.data.0, |c| 1.0 - ratio * (1.0 - c));
        Ok(Self { stages: SMatrix::from_array_storage(ArrayStorage(stages)), h, linearization: None, ..*self })
    }

    /// Whether the stages belong to the step that led to the node. After a change of parameters they do not.
    pub(crate) fn has_step(&self, node: &Node<N>) -> bool {
        self.convergence.has_begun() && self.before != *node
    }

    /// The step that led to the node, if it began at `before`.
    ///
    /// # Errors
    /// [`StepError::NoDerivative`] otherwise.
    #[cfg(feature = "alloc")]
    fn last<'a>(
        &'a self,
        node: &Node<N>,
        before: &'a Node<N>,
    ) -> Result<(&'a Node<N>, f64, &'a Stages<N, S>), StepError> {
        let is_last = self.has_step(node) && self.before == *before;
        if is_last { Ok((before, self.h, &self.stages.data.0)) } else { Err(not_last(before.t)) }
    }

    /// The initial data of the next step of equal length.
    #[inline(always)]
    fn start<'a>(&'a self, node: &'a Node<N>, accuracy: f64) -> Start<'a, N, S> {
        let (before, pause) = (&self.convergence, self.pause);
        Start { node, h: self.h, stages: &self.stages.data.0, are_last: before.has_begun(), before, pause, accuracy }
    }

    /// Advances to the end of a step.
    #[inline(always)]
    pub(crate) fn take(&mut self, node: &mut Node<N>, step: &Step<N, S>) {
        self.keep(node, step);
        node.advance(step.h, &step.increment.velocity, &step.increment.momentum);
    }

    /// Keeps a step from the node `before`.
    #[inline(always)]
    pub(crate) fn keep(&mut self, before: &Node<N>, step: &Step<N, S>) {
        self.h = step.h;
        self.before = *before;
        self.stages = SMatrix::from_array_storage(ArrayStorage(step.stages));
        self.convergence = step.convergence;
        self.pause = step.pause;
        self.linearization = step.linearization;
    }

    /// Advances to the end of a step that fixed-point iteration solved.
    #[inline(always)]
    fn take_solved(&mut self, node: &mut Node<N>, solved: &StageSolution<N, S>) {
        let StageIncrement { velocity, momentum } = &solved.increment;
        self.before = *node;
        node.advance(self.h, velocity, momentum);
        self.stages = SMatrix::from_array_storage(ArrayStorage(solved.stages));
        self.convergence = solved.iteration.convergence;
        self.pause = self.pause.after_fixed_point();
        self.linearization = None;
    }

    /// Discrete energy of the last step, if its stages are stored and it is finite.
    fn discrete_energy<Y: Convertible<N>>(&self, system: &Y, node: &Node<N>) -> Option<f64> {
        let energy = energies(system, &self.before, self.h, self.stages.data.0, 0.0).end;
        (self.has_step(node) && energy.is_finite()).then_some(energy)
    }

    /// Dense output of the last step, or of a step of the length h without stored stages.
    pub(crate) fn dense_output<Y: Convertible<N>>(
        &self,
        system: &Y,
        before: &State<N>,
        node: &Node<N>,
        h: f64,
    ) -> Result<GaussOutput<N, S>, StepError> {
        if self.has_step(node) {
            let motion = CollocationPolynomial::over(
                &ErasedSystem::of(system),
                &self.before,
                self.h,
                self.stages.data.0,
                *before,
                &node.q,
            );
            Ok(GaussOutput::Collocation(motion))
        } else {
            Hermite::between(system, before, &node.state(), h).map(GaussOutput::Hermite)
        }
    }

    /// Checks that the stored stages are finite.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub(crate) fn check(&self, t: f64) -> Result<(), StepError> {
        self.before.check_finite(t)?;
        let lost = |quantity| StepError::NonFinite { t, quantity, expression: None };
        if !self.stages.iter().all(|entry| entry.is_finite()) {
            return Err(lost("last stages"));
        }
        if self.linearization.is_some_and(|at| !at.is_finite()) {
            return Err(lost("point of linearization"));
        }
        Ok(())
    }
}

/// Takes the next step of a run inside the dispatched function.
struct Advancing<'a, Y, const N: usize, const S: usize> {
    system: &'a Y,
    node: &'a mut Node<N>,
    memory: &'a mut LastStages<N, S>,
}

impl<Y: Convertible<N>, const N: usize, const S: usize> Loop for Advancing<'_, Y, N, S> {
    type Output = Result<(), Option<StageSolution<N, S>>>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Self::Output {
        let Self { system, node, memory } = self;
        // Steps of another accuracy are attempts: with a constant the compiler omits it.
        let start = memory.start(node, EXACT);
        let solved = iterated::<_, N, S, FUSED, false>(system, &start, None);
        if solved.is_step(follows_momenta::<_, f64, N, S>(system), &start) {
            memory.take_solved(node, &solved);
            return Ok(());
        }
        Err(Some(solved))
    }
}

impl<S, const N: usize, const STAGES: usize> Method<S, N> for FreeGauss<STAGES>
where
    S: Convertible<N>,
{
    type Prepared = Instructions;
    type Memory = LastStages<N, STAGES>;
    type Cache = Buffer<N, STAGES>;
    type Step = Step<N, STAGES>;
    type Left = Option<StageSolution<N, STAGES>>;
    type DenseOutput = GaussOutput<N, STAGES>;

    fn facts(&self) -> Facts {
        Facts::of_order(2 * STAGES)
    }

    fn prepare(&self, _system: &S, _h: f64) -> Instructions {
        Instructions::detected()
    }

    fn begin(&self, system: &S, node: &mut Node<N>, h: f64) -> Result<Self::Memory, StepError> {
        first_order::check_momenta(system, node)?;
        LastStages::constant(system, node, h)
    }

    fn attempt(
        &self,
        at: Problem<'_, S, Instructions, N>,
        memory: &Self::Memory,
        _cache: &mut Self::Cache,
    ) -> Result<Step<N, STAGES>, Self::Left> {
        if !memory.pause.is_over() {
            return Err(None);
        }
        memory.start(at.node, self.accuracy).by_fixed_point(at.system, *at.prepared).map_err(Some)
    }

    #[inline(always)]
    fn advance(
        &self,
        system: &S,
        prepared: &Instructions,
        h: f64,
        (node, memory): (&mut Node<N>, &mut Self::Memory),
        cache: &mut Self::Cache,
    ) -> Result<(), Self::Left> {
        if S::INTERPRETED {
            let step = self.attempt(Problem { system, prepared, node, h }, memory, cache)?;
            self.take(system, h, (node, memory), cache, step);
            return Ok(());
        }
        if !memory.pause.is_over() {
            return Err(None);
        }
        if !S::SIDE_BY_SIDE {
            let start = memory.start(node, EXACT);
            let solved = start.in_scalars(&ErasedSystem::of(system), None);
            if !solved.is_step(follows_momenta::<_, f64, N, STAGES>(system), &start) {
                return Err(Some(solved));
            }
            memory.take_solved(node, &solved);
            Ok(())
        } else if const { N > LOOPED } {
            long(*prepared, Advancing { system, node, memory })
        } else {
            prepared.run(Advancing { system, node, memory })
        }
    }

    fn recover(
        &self,
        at: Problem<'_, S, Instructions, N>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
        left: Self::Left,
    ) -> Result<Step<N, STAGES>, StepError> {
        let last = memory.linearization;
        memory.start(at.node, self.accuracy).recover(at.system, *at.prepared, (left.as_ref(), last), false, cache)
    }

    fn take(
        &self,
        _system: &S,
        _h: f64,
        (node, memory): (&mut Node<N>, &mut Self::Memory),
        _cache: &mut Self::Cache,
        step: Step<N, STAGES>,
    ) {
        memory.take(node, &step);
    }

    fn restarted(
        &self,
        system: &S,
        change: &Change<'_, S, N>,
        node: &mut Node<N>,
        h: f64,
        memory: &Self::Memory,
    ) -> Result<Self::Memory, StepError> {
        match change {
            Change::NewLength => LastStages::constant(system, node, h),
            Change::NewSystem(before) => {
                if system.is_first_order() {
                    // The momenta follow from the coordinates, which stay.
                    let momentum = |of: &S| of.momentum(node.t, &node.q, &SVector::zeros());
                    let change = momentum(system) - momentum(before);
                    node.add_momentum(&change);
                }
                node.state().velocity(system)?;
                Ok(LastStages { before: *node, linearization: None, ..*memory })
            }
            Change::NewState(..) => change.begun(self, system, node, h),
        }
    }

    fn dense_output(
        &self,
        system: &S,
        before: &State<N>,
        node: &Node<N>,
        h: f64,
        memory: &Self::Memory,
    ) -> Result<GaussOutput<N, STAGES>, StepError> {
        memory.dense_output(system, before, node, h)
    }

    fn status(&self, h: f64, memory: &Self::Memory) -> Status {
        let Convergence { change: residual, iterations, .. } = memory.convergence;
        Status { residual, iterations, ..Status::of_length(h) }
    }

    fn discrete_energy(&self, system: &S, node: &Node<N>, _h: f64, memory: &Self::Memory) -> Option<f64> {
        memory.discrete_energy(system, node)
    }

    fn check(&self, _system: &S, (node, memory): (&Node<N>, &Self::Memory), h: f64) -> Result<(), StepError> {
        if memory.h.to_bits() != h.to_bits() {
            let (input, allowed) = ("the step of a checkpoint", "that of its run");
            return Err(StepError::InvalidInput { input, allowed, value: memory.h });
        }
        memory.check(node.t)
    }
}

impl<S, const N: usize, const STAGES: usize> StageSolver<S, N, STAGES> for FreeGauss<STAGES>
where
    S: Convertible<N>,
{
    fn within(tolerance: f64) -> Self {
        Self { accuracy: (PART * tolerance / f64::EPSILON).max(EXACT) }
    }

    fn resized(
        system: &S,
        memory: &LastStages<N, STAGES>,
        node: &Node<N>,
        h: f64,
    ) -> Result<LastStages<N, STAGES>, StepError> {
        memory.resized(system, node, h)
    }

    fn again(
        _system: &S,
        memory: &LastStages<N, STAGES>,
        node: &Node<N>,
        h: f64,
    ) -> Result<LastStages<N, STAGES>, StepError> {
        let ratio = h / memory.h;
        let stages = SMatrix::from_array_storage(ArrayStorage(at(&memory.stages.data.0, |c| ratio * c)));
        Ok(LastStages { stages, before: *node, h, convergence: Convergence::NONE, linearization: None, ..*memory })
    }

    fn quickly(
        &self,
        at: Problem<'_, S, Instructions, N>,
        memory: &LastStages<N, STAGES>,
        cache: &mut Buffer<N, STAGES>,
    ) -> Result<Option<Step<N, STAGES>>, StepError> {
        match self.attempt(at, memory, cache) {
            Ok(step) => Ok(Some(step)),
            Err(Some(left)) if !memory.pause.has_been() => {
                Ok(memory.start(at.node, self.accuracy).quickly(at.system, *at.prepared, &left, cache))
            }
            // The steps of a stiff system are Newton's.
            Err(left) => self.recover(at, memory, cache, left).map(Some),
        }
    }

    fn solve_near(
        &self,
        at: Problem<'_, S, Instructions, N>,
        memory: &LastStages<N, STAGES>,
        cache: &mut Buffer<N, STAGES>,
    ) -> Result<Step<N, STAGES>, StepError> {
        self.attempt(at, memory, cache).or_else(|left| {
            let last = memory.linearization;
            memory.start(at.node, self.accuracy).recover(at.system, *at.prepared, (left.as_ref(), last), true, cache)
        })
    }

    fn velocities(system: &S, memory: &LastStages<N, STAGES>) -> Stages<N, STAGES> {
        let LastStages { before, h, stages, .. } = memory;
        // In the form of the mass matrix: its dense inverse would be a sixth of a step of fourteen coordinates.
        let (erased, mass) = (ErasedSystem::of(system), constant_mass(system, before));
        General::<f64, _, _, N, STAGES, false>::new(&erased, mass.as_ref(), (before, *h), stages.data.0, None, None)
            .velocity()
    }

    #[cfg(feature = "alloc")]
    fn vary(
        system: &S,
        (node, memory): (&Node<N>, &LastStages<N, STAGES>),
        before: &Node<N>,
        variations: &mut [Variation<N>],
    ) -> Result<(), StepError> {
        vary(system, memory.last(node, before)?, variations, None)?;
        if system.is_first_order() { first_order::vary(system, node, variations) } else { Ok(()) }
    }

    #[cfg(feature = "alloc")]
    fn curvature(
        system: &S,
        (node, memory): (&Node<N>, &LastStages<N, STAGES>),
        before: &Node<N>,
        (directions, weights): (&[Variation<N>], &Covector<N>),
    ) -> Result<Option<DMatrix<f64>>, StepError> {
        if system.is_first_order() {
            return Ok(None);
        }
        curvature(system, memory.last(node, before)?, directions, weights).map(Some)
    }
}

impl<S, const N: usize, const STAGES: usize> Run<Gauss<STAGES>, S, N>
where
    S: Convertible<N, Kind = Free>,
{
    /// The discrete Lagrangian of the last step with its derivatives, discrete forces and powers, for checks: `−D2 L_d − f_d⁻ = p0`,
    /// `D4 L_d + f_d⁺ = p1`. `None` before the first step, after [`Run::set_parameters`] or [`Run::step_of`], and if one of them is not finite.
    pub fn slots(&self) -> Option<Slots<N>> {
        let LastStages { before, h, stages, .. } = &self.memory;
        let slots = self.memory.has_step(&self.node).then(|| Slots::of(&self.system, before, *h, stages.data.0));
        slots.filter(Slots::is_finite)
    }
}

/// Dense output of a Gauss step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GaussOutput<const N: usize, const S: usize> {
    /// A step with stored stages.
    Collocation(CollocationPolynomial<N, S>),
    /// A step without stored stages, of another length.
    Hermite(Hermite<N>),
}

impl<const N: usize, const S: usize> DenseOutput<N> for GaussOutput<N, S> {
    fn since_start(self) -> Self {
        match self {
            Self::Collocation(polynomial) => Self::Collocation(polynomial.since_start()),
            Self::Hermite(cubics) => Self::Hermite(cubics.since_start()),
        }
    }

    fn moved(self, by: &SVector<f64, N>) -> Self {
        match self {
            Self::Collocation(polynomial) => Self::Collocation(polynomial.moved(by)),
            Self::Hermite(cubics) => Self::Hermite(cubics.moved(by)),
        }
    }

    fn state(&self, t: f64) -> State<N> {
        match self {
            Self::Collocation(polynomial) => polynomial.state(t),
            Self::Hermite(cubics) => cubics.state(t),
        }
    }

    fn velocity(&self, t: f64) -> SVector<f64, N> {
        match self {
            Self::Collocation(polynomial) => polynomial.velocity(t),
            Self::Hermite(cubics) => cubics.velocity(t),
        }
    }
}
