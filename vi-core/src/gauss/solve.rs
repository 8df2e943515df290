//! The solver of a step.
//!
//! A `Start` has a node, a length, and the guess of the stages. The solver returns a [`Step`], with stages from SIMD
//! fixed-point iteration, dispatched at run time. If that fails, it uses scalar numbers or Newton iteration. It changes
//! no state. The stages of every [`Step`] satisfy their equations to rounding, or to a part of a tolerance.

use super::branch::are_smooth;
use super::first_order::FirstOrder;
use super::fixed_point::{self, Convergence, Equations, FixedPointResult, NOISE, Pause, StageIncrement};
use super::general::{General, equations};
use super::linearization::LinearizationPoint;
use super::newton::{Buffer, Newton};
use super::points::{EquationForm, ErasedSystem, MANY, Points, follows_momenta};
use super::rounding;
use super::separable::Separable;
use super::stages::{AtStages, LOOPED, Stages, constant_mass, extrapolated, mass, stage};
use crate::error::StepError;
use crate::motion::{Motion, Point};
use crate::node::Node;
use crate::real::{Lane, Lanes};
use crate::stepping::Convertible;
use vi_dispatch::{Instructions, Loop};

/// Initial data of the stage equations.
#[derive(Clone, Copy)]
pub(crate) struct Start<'a, const N: usize, const S: usize> {
    pub(crate) node: &'a Node<N>,
    pub(crate) h: f64,
    pub(crate) stages: &'a Stages<N, S>,
    /// Whether these are the stages of the previous step of equal length, so that their polynomials can be
    /// extrapolated.
    pub(crate) are_last: bool,
    /// Outcome of the previous step.
    pub(crate) before: &'a Convergence,
    pub(crate) pause: Pause,
    /// The accuracy of the stages, in ulps: [`EXACT`] but for steps of a tolerance.
    pub(crate) accuracy: f64,
}

/// Positions above this have an ulp of 2e-6, which is too large for an angle.
const HUGE: f64 = 1e10;

/// A solved step.
#[derive(Clone, Copy, Debug)]
pub struct Step<const N: usize, const S: usize> {
    pub(crate) h: f64,
    pub(crate) increment: StageIncrement<N>,
    pub(crate) stages: Stages<N, S>,
    pub(crate) convergence: Convergence,
    pub(crate) pause: Pause,
    /// The linearization for the next step, if Newton iteration solved this one.
    pub(crate) linearization: Option<LinearizationPoint<N>>,
    /// Whether Newton iteration solved this one.
    pub(crate) by_newton: bool,
}

/// The stages after an iteration.
pub struct StageSolution<const N: usize, const S: usize> {
    pub(crate) increment: StageIncrement<N>,
    pub(crate) stages: Stages<N, S>,
    velocities: Option<Stages<N, S>>,
    pub(crate) iteration: FixedPointResult<N, S>,
}

impl<const N: usize, const S: usize> StageSolution<N, S> {
    /// Whether fixed-point iteration solved the step to its accuracy, and its contraction or its stages prove the step.
    #[inline(always)]
    pub(crate) fn is_step(&self, follows_momenta: bool, start: &Start<'_, N, S>) -> bool {
        let convergence = &self.iteration.convergence;
        let is_proven = if follows_momenta { are_smooth(&self.stages) } else { convergence.is_fast(start.accuracy) };
        is_proven && self.is_solved(start)
    }

    /// Whether fixed-point iteration solved the step to its accuracy.
    #[inline(always)]
    fn is_solved(&self, start: &Start<'_, N, S>) -> bool {
        let StageIncrement { velocity, momentum } = &self.increment;
        self.iteration.convergence.is_at_floor() && start.node.stays_finite(start.h, velocity, momentum)
    }

    /// Whether the stages are finite and near a solution.
    pub(super) fn is_near(&self) -> bool {
        self.increment.is_finite() && self.iteration.convergence.change < fixed_point::FAR
    }

    /// Whether they are near a solution, but not at the rounding floor.
    fn has_stalled(&self) -> bool {
        self.is_near() && !self.iteration.convergence.is_at_floor()
    }

    /// Converts the stages to a step, after which fixed-point iteration pauses.
    #[inline(always)]
    fn step(&self, h: f64, pause: Pause) -> Step<N, S> {
        let Self { increment, stages, iteration, .. } = self;
        let convergence = iteration.convergence;
        Step { h, increment: *increment, stages: *stages, convergence, pause, linearization: None, by_newton: false }
    }
}

impl<const N: usize, const S: usize> Start<'_, N, S> {
    /// Velocities at the stages, or forces there for a separable system.
    #[inline(always)]
    fn guess<const FUSED: bool>(&self) -> Stages<N, S> {
        if self.are_last { extrapolated::<N, S, FUSED>(N, self.stages) } else { *self.stages }
    }

    /// The step, if its stages satisfy their equations to rounding.
    fn accepted(
        &self,
        system: &ErasedSystem<'_, N>,
        solved: &StageSolution<N, S>,
        newton: Option<&Newton<N, S>>,
    ) -> Option<Step<N, S>> {
        // Scalar numbers have sines and cosines of every angle; SIMD lanes reject large ones.
        let plain;
        let solved = if solved.increment.is_finite() {
            solved
        } else {
            plain = self.in_scalars(system, newton);
            &plain
        };
        let mut after = *self.node;
        after.advance(self.h, &solved.increment.velocity, &solved.increment.momentum);
        let mut step = solved.step(self.h, self.pause);
        step.by_newton = newton.is_some();
        step.convergence.change = self.residual(system, solved);
        (after.is_finite() && step.convergence.is_at_floor()).then_some(step)
    }

    /// The acceptance criterion of a step: the last change of its stages or, if that stalls, their residual by running
    /// error analysis.
    fn residual(&self, system: &ErasedSystem<'_, N>, solved: &StageSolution<N, S>) -> f64 {
        let StageSolution { iteration, velocities, .. } = solved;
        let change = iteration.convergence.change;
        if iteration.are_given_up {
            return change;
        }
        let residual = || rounding::residual(system, self.node, self.h, &iteration.positions, velocities.as_ref());
        if !iteration.convergence.is_at_floor() {
            return residual();
        }
        // The sine of a huge angle has no correct digits, although all digits of the angle are.
        let is_huge = iteration.positions.iter().flatten().any(|q| q.abs() > HUGE);
        if is_huge && residual().is_nan() { f64::NAN } else { change }
    }

    /// The stages in scalar numbers. Cold, so that one copy serves all systems of N coordinates. `inline(never)` would do
    /// that too, but a crate then takes the copy of a dependency, even one that is not optimized.
    #[cold]
    pub(crate) fn in_scalars(
        &self,
        system: &ErasedSystem<'_, N>,
        newton: Option<&Newton<N, S>>,
    ) -> StageSolution<N, S> {
        if Points::<N, f64>::form(system) == EquationForm::FirstOrder {
            let equations = FirstOrder::new(system, (self.node, self.h), self.guess::<false>(), newton);
            return finished(equations, self);
        }
        solved::<f64, _, _, N, S, false, false>(system, system, self, newton)
    }

    /// The step by an iteration that does not follow momenta. Its contraction may prove it.
    pub(super) fn without_momenta(&self, system: &ErasedSystem<'_, N>) -> Option<Step<N, S>> {
        let solved = self.in_scalars(&system.lagging(), None);
        solved.is_solved(self).then(|| solved.step(self.h, self.pause))
    }

    /// The stages with SIMD dispatch, if the system suits it.
    #[inline(never)]
    fn side_by_side<Y>(
        &self,
        system: &Y,
        instructions: Instructions,
        newton: Option<&Newton<N, S>>,
    ) -> StageSolution<N, S>
    where
        Y: Convertible<N>,
    {
        let in_scalars = || self.in_scalars(&ErasedSystem::of(system), newton);
        if !Y::SIDE_BY_SIDE || system.is_first_order() {
            return in_scalars();
        }
        let stages = SideBySide { system, start: self, newton };
        if Y::INTERPRETED {
            instructions.run_once(stages).unwrap_or_else(|_| in_scalars())
        } else {
            instructions.run(stages)
        }
    }

    /// The linearization point at the middle of the step.
    fn middle(&self, system: &ErasedSystem<'_, N>) -> LinearizationPoint<N> {
        let equations = equations(system, self.node, self.h, self.guess::<false>());
        let middle = S / 2;
        let q = stage(&equations.start(), middle);
        let v = stage(&equations.velocity(), middle);
        let t = self.node.t + 0.5 * self.h;
        LinearizationPoint { h: self.h, t, q, v, iterations: None, by_velocity: false }
    }

    /// The step by fixed-point iteration.
    ///
    /// # Errors
    /// The stages of the failed iteration.
    pub(crate) fn by_fixed_point<Y>(
        &self,
        system: &Y,
        instructions: Instructions,
    ) -> Result<Step<N, S>, StageSolution<N, S>>
    where
        Y: Convertible<N>,
    {
        let solved = self.side_by_side(system, instructions, None);
        if solved.is_step(follows_momenta::<_, f64, N, S>(system), self) {
            Ok(solved.step(self.h, self.pause.after_fixed_point()))
        } else {
            Err(solved)
        }
    }

    /// The step from a guess of its stages, whether or not it continues short ones.
    ///
    /// # Errors
    /// As [`Start::recovered`].
    pub(super) fn unproven<Y>(
        &self,
        system: &Y,
        instructions: Instructions,
        cache: &mut Buffer<N, S>,
    ) -> Result<Step<N, S>, StepError>
    where
        Y: Convertible<N>,
    {
        // Steps of other lengths do not end a pause.
        self.by_fixed_point(system, instructions)
            .map(|step| Step { pause: self.pause, ..step })
            .or_else(|left| self.recovered(system, instructions, (Some(&left), None), cache))
    }

    /// The step, if fixed-point iteration failed, contracted slowly or was skipped, whether or not it continues short ones.
    /// `last` is the linearization of the previous step, if that had the same length.
    ///
    /// # Errors
    /// [`StepError::StagesNotConverged`], or the reason why the stages have no value.
    #[cold]
    pub(super) fn recovered<Y>(
        &self,
        system: &Y,
        instructions: Instructions,
        (left, last): (Option<&StageSolution<N, S>>, Option<LinearizationPoint<N>>),
        cache: &mut Buffer<N, S>,
    ) -> Result<Step<N, S>, StepError>
    where
        Y: Convertible<N>,
    {
        let erased = &ErasedSystem::of(system);
        let mut after = self.pause;
        if let Some(left) = left.filter(|left| left.has_stalled() && self.pause != Pause::USELESS)
            && let Some(newton) = cache.newton()
        {
            // Newton iteration is faster than running error analysis, and may converge to rounding.
            let near = Start { stages: &left.stages, are_last: false, ..*self };
            let at = last.unwrap_or_else(|| near.middle(erased));
            let (solved, at) = near.newton_stages(system, instructions, at, newton);
            if solved.iteration.convergence.is_at_floor()
                && let Some(step) = near.accepted(erased, &solved, Some(newton))
            {
                // These iterations began near the solution: their number does not show whether a new linearization pays
                // off.
                let linearization = Some(LinearizationPoint { iterations: None, ..at });
                return Ok(Step { pause: self.pause.after_newton(), linearization, ..step });
            }
            after = Pause::USELESS;
        }
        if let Some(step) = left.and_then(|left| self.accepted(erased, left, None)) {
            return Ok(Step { pause: after, ..step });
        }
        // First the last linearization, then a new one, then stages equal to the node, because extrapolated polynomials
        // may be far off.
        if let Some(at) = last
            && let Ok(step) = self.by_newton(system, instructions, at, cache)
        {
            return Ok(step);
        }
        let by_velocity = last.is_some_and(|last| last.by_velocity);
        let at = LinearizationPoint { by_velocity, ..self.middle(erased) };
        let extrapolated = self.by_newton(system, instructions, at, cache);
        if extrapolated.is_ok() || !self.are_last {
            return extrapolated;
        }
        let Ok(constant) = constant(system, self.node) else { return extrapolated };
        let start = Start { stages: &constant, are_last: false, before: &Convergence::NONE, ..*self };
        // Start as in the first step of a run: fixed-point iteration may converge although the linearization in the
        // middle of a long step is poor.
        let first = start
            .by_fixed_point(system, instructions)
            .or_else(|left| start.recovered(system, instructions, (Some(&left), None), cache));
        first.or(extrapolated)
    }

    /// The step by Newton iteration, or in scalar numbers if there is none.
    fn by_newton<Y>(
        &self,
        system: &Y,
        instructions: Instructions,
        at: LinearizationPoint<N>,
        cache: &mut Buffer<N, S>,
    ) -> Result<Step<N, S>, StepError>
    where
        Y: Convertible<N>,
    {
        let erased = &ErasedSystem::of(system);
        let mut newton = cache.newton();
        let (solved, at) = match &mut newton {
            Some(newton) => self.newton_stages(system, instructions, at, newton),
            None => (self.in_scalars(erased, None), at),
        };
        let StageSolution { increment, iteration, .. } = &solved;
        let not_converged = || {
            let Convergence { change, .. } = iteration.convergence;
            let in_ulps = Convergence { change: change * self.accuracy, ..iteration.convergence };
            in_ulps.not_converged(increment, [self.node.t, self.h], at.stiffness(erased))
        };
        let accepted = self.accepted(erased, &solved, newton.as_deref());
        let step = accepted.ok_or_else(|| lost_force(system, self.node, self.h).unwrap_or_else(not_converged))?;
        let linearization = at.after(step.convergence.iterations);
        Ok(Step { pause: self.pause.after_newton(), linearization, ..step })
    }

    /// The stages by Newton iteration, and the linearization of the iteration.
    fn newton_stages<Y>(
        &self,
        system: &Y,
        instructions: Instructions,
        at: LinearizationPoint<N>,
        newton: &mut Newton<N, S>,
    ) -> (StageSolution<N, S>, LinearizationPoint<N>)
    where
        Y: Convertible<N>,
    {
        let erased = &ErasedSystem::of(system);
        newton.linearize(erased, at);
        let mut by_velocity = at.by_velocity;
        if !by_velocity {
            let solved = self.side_by_side(system, instructions, Some(newton));
            let has_positions = system.is_separable() && Y::SIDE_BY_SIDE;
            if solved.iteration.convergence.is_at_floor() || !has_positions {
                return (solved, at);
            }
            // After a change of few ulps the next step may reach rounding again by positions.
            by_velocity = solved.iteration.convergence.change > NOISE;
        }
        // The velocities of very stiff steps are more accurate than positions by forces.
        (self.in_scalars(erased, Some(newton)), LinearizationPoint { by_velocity, ..at })
    }
}

/// Stages equal to a node: velocities, or forces of a separable system.
///
/// # Errors
/// As [`State::velocity`](crate::State::velocity).
pub(crate) fn constant<Y: Motion<N>, const N: usize, const S: usize>(
    system: &Y,
    node: &Node<N>,
) -> Result<Stages<N, S>, StepError> {
    let flow = node.state().raw_flow(system)?;
    let start = if system.is_separable() { flow.force } else { flow.v };
    Ok(start.data.0[0].map(|entry| [entry; S]))
}

/// Whether every processor of this architecture has vectors that justify a copy of long equations. Processors of x86-64
/// without AVX2, mostly older than 2013, have vectors of two numbers: they evaluate one stage after another.
pub(crate) const WIDE: bool = !cfg!(target_arch = "x86_64");

/// The stages, with SIMD dispatch.
struct SideBySide<'a, Y, const N: usize, const S: usize> {
    system: &'a Y,
    start: &'a Start<'a, N, S>,
    newton: Option<&'a Newton<N, S>>,
}

impl<Y: Convertible<N>, const N: usize, const S: usize> Loop for SideBySide<'_, Y, N, S> {
    type Output = StageSolution<N, S>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> StageSolution<N, S> {
        iterated::<_, N, S, FUSED, true>(self.system, self.start, self.newton)
    }
}

/// Iterates in the number type that suits the instructions best.
#[inline(always)]
pub(crate) fn iterated<Y, const N: usize, const S: usize, const FUSED: bool, const CORRECTED: bool>(
    system: &Y,
    start: &Start<'_, N, S>,
    newton: Option<&Newton<N, S>>,
) -> StageSolution<N, S>
where
    Y: Convertible<N>,
{
    if const { Y::INTERPRETED || N > LOOPED && (FUSED || WIDE) } {
        let lanes = system.convert::<Lanes<S, FUSED>>();
        solved::<Lanes<S, FUSED>, _, _, N, S, FUSED, CORRECTED>(&lanes, system, start, newton)
    } else {
        let lane = system.convert::<Lane<FUSED>>();
        solved::<Lane<FUSED>, _, _, N, S, FUSED, CORRECTED>(&lane, system, start, newton)
    }
}

/// A loop over long equations. Not inlined: one copy per instruction set.
#[inline(never)]
pub(crate) fn long<L: Loop>(instructions: Instructions, step: L) -> L::Output {
    instructions.run(step)
}

/// The stages, with equations evaluated over the numbers T; `plain` is the same system over scalars. The unknowns are
/// velocities; those of a separable system are forces, in Newton iteration only if CORRECTED.
#[inline(always)]
fn solved<T, Y, P, const N: usize, const S: usize, const FUSED: bool, const CORRECTED: bool>(
    system: &Y,
    plain: &P,
    start: &Start<'_, N, S>,
    newton: Option<&Newton<N, S>>,
) -> StageSolution<N, S>
where
    T: AtStages<S>,
    Y: Points<N, T>,
    P: Points<N, f64>,
{
    let Start { node, h, stages, are_last, accuracy, .. } = *start;
    // For a known form the compiler sees one branch.
    let is_separable = const { EquationForm::Separable.is_known(Y::FORM) }
        || const { Y::FORM.is_none() } && system.form() == EquationForm::Separable;
    if is_separable && (CORRECTED || newton.is_none()) {
        let mass = mass(plain, node);
        let guess = (*stages, are_last);
        let mut equations =
            Separable::<T, Y, P::Mass, N, S, FUSED, CORRECTED>::new(system, &mass, node, h, guess, newton);
        equations.accuracy = accuracy;
        finished(equations, start)
    } else {
        let mass = constant_mass(plain, node);
        let guess = start.guess::<FUSED>();
        let mut masses = None;
        let kept = (system.moving() >= MANY).then_some(&mut masses);
        let mut equations =
            General::<T, Y, P::Mass, N, S, FUSED>::new(system, mass.as_ref(), (node, h), guess, newton, kept);
        equations.accuracy = accuracy;
        finished(equations, start)
    }
}

#[inline(always)]
fn finished<const N: usize, const S: usize>(
    mut equations: impl Equations<N, S>,
    start: &Start<'_, N, S>,
) -> StageSolution<N, S> {
    let iteration = fixed_point::solve(&mut equations, start.before);
    StageSolution {
        increment: equations.increment(),
        stages: equations.guess(),
        velocities: equations.velocities(),
        iteration,
    }
}

/// The reason why stages cannot be evaluated in the step of length h from `node`: no velocity has its momenta, or L, f
/// or a derivative of L is not finite at the node or half a step from it. The system names the part of L or f. `None`
/// if evaluation succeeds.
#[cold]
pub(crate) fn lost_force<S: Motion<N>, const N: usize>(system: &S, node: &Node<N>, h: f64) -> Option<StepError> {
    let v = match node.state().velocity(system) {
        Ok(v) => v,
        Err(failure) => return Some(failure),
    };
    let lost = StepError::NonFinite { t: node.t, quantity: "force at a stage", expression: None };
    let explained = lost.explained(system, node, h, &v);
    let is_named = matches!(explained, StepError::NonFinite { expression: Some(_), .. } | StepError::Undefined { .. });
    let has_slopes = |h: f64| {
        let (t, q) = node.midpoint(h, &v);
        let Point { momentum, force, .. } = system.point(t, &q, &v);
        momentum.iter().chain(&force).all(|entry| entry.is_finite())
    };
    (is_named || !has_slopes(0.0) || !has_slopes(h)).then_some(explained)
}
