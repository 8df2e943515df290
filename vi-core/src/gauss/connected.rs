//! Whether a Gauss step continues those of short lengths.
//!
//! A step has one solution near its start if its fixed-point iteration contracts fast, or if its stages are resolved. In
//! curvilinear coordinates only an iteration that does not follow momenta proves a step by its contraction.
//! Other steps are continued from short ones by [`branch::follow`].

use super::branch::{self, EQUAL, FAST, NEAR, Shorter, StepsFromNode, distance, is_resolved, noise};
use super::fixed_point::{Convergence, Equations as _, FEW};
use super::general::equations;
use super::linearization::LinearizationPoint;
use super::newton::Buffer;
use super::points::{AnyDerivatives, EquationForm, ErasedSystem, Points, follows_momenta};
use super::polynomial::{polynomials, sum};
use super::solve::{StageSolution, Start, Step, constant};
use super::stages::{EXACT, Stages, at, coefficients, maximum, stage, time};
use crate::error::StepError;
use crate::motion::Point;
use crate::node::Node;
use crate::stepping::Convertible;
use crate::vector;
use nalgebra::SMatrix;
use vi_dispatch::Instructions;

/// Relative change of the derivatives over a step up to which its equations count as linear, with one solution.
const LINEAR: f64 = 0.05;

/// Whether the equations of a step are nearly linear: their derivatives at its stages are those at its start.
fn is_linear<const N: usize, const S: usize>(system: &ErasedSystem<'_, N>, node: &Node<N>, step: &Step<N, S>) -> bool {
    let equations = equations(system, node, step.h, step.stages);
    let (q, v) = (equations.start(), equations.velocity());
    let at = |i: usize| system.derivatives(time::<N, S, false, f64>(node, step.h, i), &stage(&q, i), &stage(&v, i));
    let first = at(0);
    let is_near = |a: &SMatrix<f64, N, N>, b: &SMatrix<f64, N, N>| (a - b).amax() <= LINEAR * a.amax();
    let is_equal = |other: AnyDerivatives<N>| {
        is_near(&first.mass, &other.mass)
            && is_near(&first.momentum_dq, &other.momentum_dq)
            && is_near(&first.force_dq, &other.force_dq)
            && is_near(&first.force_dv, &other.force_dv)
    };
    (1..S).all(|i| is_equal(at(i))) && is_equal(system.derivatives(node.t, &node.q, &stage(&v, 0)))
}

/// Weights of the stages of each coordinate: velocities are comparable by their kinetic energies, and forces of a
/// separable system by those that they add.
fn weights<const N: usize, const S: usize>(
    system: &ErasedSystem<'_, N>,
    node: &Node<N>,
    step: &Step<N, S>,
) -> [f64; N] {
    let v = stage(&equations(system, node, step.h, step.stages).velocity(), 0);
    let roots = vector::weights(&Points::<N, f64>::at(system, node.t, &node.q, &v).mass.diagonal());
    let are_forces = Points::<N, f64>::form(system) == EquationForm::Separable;
    roots.map(|root| if are_forces { root.recip() } else { root }).into()
}

/// The largest difference between the momenta of a node and those at the start of the polynomials of its step, relative to
/// the larger ones. Of 160 000 steps in polar coordinates all 2154 with an error of more than a tenth of their way exceeded
/// it.
const MISSED: f64 = 0.3;

/// Whether the polynomials of the velocities begin with the momenta of the node. Smooth stages miss what happens before the
/// first one, such as the turn of a particle that passes closely by a pole of its coordinates.
fn begins_at_node<const N: usize, const S: usize>(
    system: &ErasedSystem<'_, N>,
    node: &Node<N>,
    stages: &Stages<N, S>,
) -> bool {
    let v = sum(&coefficients(stages), &polynomials(0.0));
    let Point { momentum, mass, .. } = Points::<N, f64>::at(system, node.t, &node.q, &v);
    let roots = vector::weights(&mass.diagonal());
    let rounding = noise([stages], &roots.into());
    let is_near = |i: usize| {
        let (missed, fastest) = ((momentum[i] - node.p[i]).abs(), maximum(&stages[i].map(f64::abs)));
        let most = node.p[i].abs().max(momentum[i].abs()).max(fastest * roots[i] * roots[i]);
        missed <= MISSED * most || missed <= rounding * roots[i]
    };
    (0..N).all(is_near)
}

/// Whether the contraction of its iteration, its stages, or its equations prove that a step continues short ones.
fn is_proven<const N: usize, const S: usize>(
    system: &ErasedSystem<'_, N>,
    Start { node, accuracy, .. }: &Start<'_, N, S>,
    step: &Step<N, S>,
) -> bool {
    let convergence = &step.convergence;
    let follows_momenta = follows_momenta::<_, f64, N, S>(system);
    let is_fast = if step.by_newton {
        convergence.contraction <= FAST
    } else {
        convergence.is_fast(*accuracy) && !follows_momenta
    };
    is_fast || is_resolved(&step.stages, &weights(system, node, step)) || is_linear(system, node, step)
}

/// The largest distance between two results for one solution, in units of the accuracy of its stages.
const ROUGHLY: f64 = 64.0;

/// The step of a part of the length, from stages equal to the node and with forces at the velocities of the last iteration,
/// whose contraction may prove it; in curvilinear coordinates, since other iterations do so anyway. From rest a velocity
/// may grow as t², t³ or later, so that its stages are not resolved in a step of any length.
fn lagging<const N: usize, const S: usize>(
    system: &ErasedSystem<'_, N>,
    start: &Start<'_, N, S>,
    (part, stages): (f64, &Stages<N, S>),
) -> Option<Step<N, S>> {
    if !follows_momenta::<_, f64, N, S>(system) {
        return None;
    }
    let (h, before, accuracy) = (part * start.h, &Convergence::NONE, EXACT);
    let step = Start { h, stages, are_last: false, before, accuracy, ..*start }.without_momenta(system)?;
    begins_at_node(system, start.node, &step.stages).then_some(step)
}

impl<const N: usize, const S: usize> Start<'_, N, S> {
    /// The step, if fixed-point iteration failed, contracted slowly or was skipped. `last` is the linearization of the
    /// previous step, if that had the same length. If the guess `continues` short steps, since it is the stages of a step
    /// of nearly this length that does, a solution close to it continues them, too.
    ///
    /// # Errors
    /// [`StepError::StagesNotConverged`], [`StepError::TooLong`], or the reason why the stages have no value.
    #[cold]
    pub(crate) fn recover<Y>(
        &self,
        system: &Y,
        instructions: Instructions,
        left: (Option<&StageSolution<N, S>>, Option<LinearizationPoint<N>>),
        continues: bool,
        cache: &mut Buffer<N, S>,
    ) -> Result<Step<N, S>, StepError>
    where
        Y: Convertible<N>,
    {
        let step = match self.recovered(system, instructions, left, cache) {
            Ok(step) => step,
            // Velocities of first order are functions of the coordinates, so that iterations may leave the domain of L.
            Err(failure) if system.is_first_order() => {
                return self.continued(system, instructions, None, cache).map_err(|_| failure);
            }
            Err(failure) => return Err(failure),
        };
        let erased = &ErasedSystem::of(system);
        let is_near = || distance([self.stages, &step.stages], self.stages, &weights(erased, self.node, &step)) <= NEAR;
        let is_proven = continues && is_near() || is_proven(erased, self, &step);
        if is_proven { Ok(step) } else { self.continued(system, instructions, Some(step), cache) }
    }

    /// The step, if its fixed-point iteration came to its end, and no continuation is needed to prove it.
    #[cold]
    pub(crate) fn quickly<Y>(
        &self,
        system: &Y,
        instructions: Instructions,
        left: &StageSolution<N, S>,
        cache: &mut Buffer<N, S>,
    ) -> Option<Step<N, S>>
    where
        Y: Convertible<N>,
    {
        if !left.is_near() {
            return None;
        }
        let step = self.recovered(system, instructions, (Some(left), None), cache).ok()?;
        is_proven(&ErasedSystem::of(system), self, &step).then_some(step)
    }

    /// The step of this length that continues those of short lengths: `taken` itself, bit for bit, if it does.
    ///
    /// # Errors
    /// [`StepError::TooLong`] if the branch ends at a shorter length, or has not been followed to this one.
    #[cold]
    #[inline(never)]
    fn continued<Y>(
        &self,
        system: &Y,
        instructions: Instructions,
        taken: Option<Step<N, S>>,
        cache: &mut Buffer<N, S>,
    ) -> Result<Step<N, S>, StepError>
    where
        Y: Convertible<N>,
    {
        let from = constant(system, self.node)?;
        let erased = ErasedSystem::of(system);
        let is_certain = |step: &Step<N, S>| step.convergence.iterations <= FEW || step.convergence.contraction <= FAST;
        // A step that its own iteration does not prove may be proven by this one, which is shorter than a continuation.
        if let Some(step) = &taken
            && let Some(found) = lagging(&erased, self, (1.0, &from)).filter(is_certain)
        {
            return Ok(Step { pause: step.pause, ..found });
        }
        let weights = taken.as_ref().map_or([1.0; N], |step| weights(&erased, self.node, step));
        let steps = &mut StepsFrom { start: self, system, instructions, cache, from: &from, weights, taken };
        let too_long = |part: f64| StepError::TooLong { t: self.node.t, h: self.h, longest: (part * self.h).abs() };
        let found = branch::follow(steps).map_err(too_long)?;
        let equal = EQUAL.max(ROUGHLY * self.accuracy * f64::EPSILON);
        let is_same = |step: &Step<N, S>| distance([&step.stages, &found.stages], &from, &weights) <= equal;
        Ok(taken.filter(is_same).unwrap_or(Step { linearization: None, ..found }))
    }
}

/// Steps of parts of the length.
struct StepsFrom<'a, Y, const N: usize, const S: usize> {
    start: &'a Start<'a, N, S>,
    system: &'a Y,
    instructions: Instructions,
    cache: &'a mut Buffer<N, S>,
    /// The stages equal to the node.
    from: &'a Stages<N, S>,
    weights: [f64; N],
    /// The solved step of the whole length, if there is one.
    taken: Option<Step<N, S>>,
}

impl<Y, const N: usize, const S: usize> StepsFrom<'_, Y, N, S>
where
    Y: Convertible<N>,
{
    fn solved(&mut self, part: f64, stages: &Stages<N, S>) -> Option<Step<N, S>> {
        let (h, before, accuracy) = (part * self.start.h, &Convergence::NONE, EXACT);
        let start = Start { h, stages, are_last: false, before, accuracy, ..*self.start };
        start.unproven(self.system, self.instructions, self.cache).ok()
    }
}

impl<Y, const N: usize, const S: usize> StepsFromNode for StepsFrom<'_, Y, N, S>
where
    Y: Convertible<N>,
{
    type Solution = Step<N, S>;

    fn short(&mut self, part: f64) -> Option<Step<N, S>> {
        let step = self.solved(part, self.from)?;
        let erased = ErasedSystem::of(self.system);
        if is_proven(&erased, self.start, &step) {
            return Some(step);
        }
        lagging(&erased, self.start, (part, self.from)).filter(|step| step.convergence.is_fast(EXACT))
    }

    fn longer(&mut self, part: f64, shorter: [&Shorter<Step<N, S>>; 2]) -> Option<Step<N, S>> {
        let [before, last] = shorter.map(|shorter| &shorter.step.stages);
        let guess = if shorter[0].part < shorter[1].part {
            let ahead = branch::ahead(part, shorter);
            core::array::from_fn(|k| core::array::from_fn(|i| last[k][i] + ahead * (last[k][i] - before[k][i])))
        } else {
            at(last, |c| part / shorter[1].part * c)
        };
        let found = self.solved(part, &guess).or_else(|| self.taken.filter(|_| part >= 1.0));
        found.filter(|step| distance([&guess, &step.stages], self.from, &self.weights) <= NEAR)
    }
}
