//! The solution of a step.
//!
//! In: a run. Out: the run at the next node, its stages solved by sweeps in vectors, by the instructions of the processor; what sweeps led to, where they did not
//! solve it; and the same in plain numbers, by sweeps or by Newton's iteration. WHAT IS TAKEN was measured to leave rounding of the equations.

use super::general::{General, equations};
use super::newton::{Linearization, Newton};
use super::points::{Form, Points, Rare};
use super::rounding;
use super::run::Run;
use super::separable::Separable;
use super::stages::{AtStages, LOOPED, Stages, constant_mass, mass, stage};
use super::sweep::{self, Equations, Increment, Pause, Sweeps};
use crate::collocation::{Collocation, Point};
use crate::error::StepError;
use crate::node::Node;
use crate::real::{Lane, Lanes};
use crate::stepping::Convertible;
use nalgebra::SMatrix;
use vi_dispatch::{Instructions, Loop};

/// A solved step.
pub(super) struct Solved<const N: usize, const S: usize> {
    pub(super) increment: Increment<N>,
    pub(super) stages: Stages<N, S>,
    pub(super) velocities: Option<Stages<N, S>>,
    pub(super) sweeps: Sweeps<N, S>,
}

impl<const N: usize, const S: usize> Solved<N, S> {
    /// Whether the stages are at the rounding of their positions.
    fn is_at_floor(&self) -> bool {
        self.sweeps.convergence.is_at_floor()
    }
}

impl<const N: usize, const S: usize> Run<N, S> {
    /// Moves to the end of a step, after which sweeps are tried or not.
    #[inline(always)]
    fn take(&mut self, solved: &Solved<N, S>, pause: Pause) {
        self.before = self.node;
        self.node.advance(self.h, &solved.increment.velocity, &solved.increment.momentum);
        self.stages = SMatrix::from_array_storage(nalgebra::ArrayStorage(solved.stages));
        self.convergence = solved.sweeps.convergence;
        self.pause = pause;
    }

    /// Moves to the end of a step that sweeps solved to the rounding of its positions; else what they led to.
    #[inline(always)]
    pub(super) fn swept(&mut self, solved: Solved<N, S>) -> Option<Solved<N, S>> {
        let Increment { velocity, momentum } = &solved.increment;
        if solved.is_at_floor() && self.node.stays_finite(self.h, velocity, momentum) {
            self.take(&solved, Pause::NONE);
            return None;
        }
        Some(solved)
    }

    /// The run after a step that sweeps, or Newton's iteration, solved to rounding; none where they did not.
    pub(super) fn accepted(
        &self,
        system: &Rare<'_, N>,
        solved: &Solved<N, S>,
        newton: Option<&Newton<N, S>>,
    ) -> Option<Self> {
        // Plain numbers have sines and cosines of every angle; lanes lose what is not near.
        let plain;
        let solved = if solved.increment.is_finite() {
            solved
        } else {
            plain = self.solved_plainly(system, newton);
            &plain
        };
        let pause = if newton.is_some() { self.pause.after_newton() } else { Pause::NONE };
        let mut run = *self;
        run.take(solved, pause);
        run.convergence.change = self.residual(system, solved);
        (run.node.is_finite() && run.convergence.is_at_floor()).then_some(run)
    }

    /// The next step in plain numbers. Not inlined: one copy serves all systems of N coordinates.
    #[inline(never)]
    pub(super) fn solved_plainly(&self, system: &Rare<'_, N>, newton: Option<&Newton<N, S>>) -> Solved<N, S> {
        solved::<f64, _, _, N, S, false>(system, system, self, newton)
    }

    /// Linearizes the equations about the middle of the next step.
    pub(super) fn linearize(&self, system: &Rare<'_, N>, newton: &mut Newton<N, S>) {
        let equations = equations(system, &self.node, self.h, self.guess::<false>());
        let middle = S / 2;
        let q = stage(&equations.start(), middle);
        let v = stage(&equations.velocity(), middle);
        let t = self.node.t + 0.5 * self.h;
        newton.linearize(system, Linearization { h: self.h, t, q, v, iterations: None });
    }

    /// The number by which a step is judged: the last change of its stages, or, where that stalls, what they leave of their equations by
    /// running error analysis.
    fn residual(&self, system: &Rare<'_, N>, solved: &Solved<N, S>) -> f64 {
        let Solved { sweeps, velocities, .. } = solved;
        if solved.is_at_floor() || sweeps.are_given_up {
            return sweeps.convergence.change;
        }
        rounding::residual(system, &self.node, self.h, &sweeps.positions, velocities.as_ref())
    }
}

/// Whether every processor of this architecture has vectors that are worth a copy of long equations. Those of x86-64 without AVX2 hold two
/// numbers, and are of before 2013 or of the simplest machines: they evaluate one stage after another.
pub(super) const WIDE: bool = !cfg!(target_arch = "x86_64");

/// The next step of a run, by the instructions of the processor: taken where sweeps solve it, else what they, or Newton's iteration, lead to. None, and
/// nothing taken, where Newton's iteration is that of all systems.
pub(super) struct Solve<'a, Y, const N: usize, const S: usize> {
    pub(super) system: &'a Y,
    pub(super) run: &'a mut Run<N, S>,
    pub(super) newton: Option<&'a Newton<N, S>>,
}

impl<Y: Collocation<N> + Convertible<N>, const N: usize, const S: usize> Loop for Solve<'_, Y, N, S> {
    type Output = Option<Solved<N, S>>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Option<Solved<N, S>> {
        let Self { system, run, newton } = self;
        if const { N > LOOPED && (FUSED || WIDE) } {
            let lanes = system.convert::<Lanes<S, FUSED>>();
            // Separable systems are not asked for Newton's iteration here: the compiler need not build it.
            let newton = if const { Y::SEPARABLE } { None } else { newton };
            let solved = solved::<Lanes<S, FUSED>, _, _, N, S, FUSED>(&lanes, system, run, newton);
            return if newton.is_some() { Some(solved) } else { run.swept(solved) };
        }
        if newton.is_some() {
            return None;
        }
        let lane = system.convert::<Lane<FUSED>>();
        run.swept(solved::<Lane<FUSED>, _, _, N, S, FUSED>(&lane, system, run, None))
    }
}

/// The next step of a run, its equations long. Not inlined: sweeps and Newton's iteration take one copy for each set of instructions.
#[inline(never)]
pub(super) fn long_step<Y, const N: usize, const S: usize>(
    instructions: Instructions,
    step: Solve<'_, Y, N, S>,
) -> Option<Solved<N, S>>
where
    Y: Collocation<N> + Convertible<N>,
{
    instructions.run(step)
}

/// The next step of a run, the equations evaluated in the numbers T; `plain` is the same system in plain ones. By sweeps, else by Newton's iteration.
#[inline(always)]
fn solved<T, Y, P, const N: usize, const S: usize, const FUSED: bool>(
    system: &Y,
    plain: &P,
    run: &Run<N, S>,
    newton: Option<&Newton<N, S>>,
) -> Solved<N, S>
where
    T: AtStages<S>,
    Y: Points<N, T>,
    P: Points<N, f64>,
{
    let Run { node, h, .. } = run;
    // Of a known type the compiler sees one of the two. Newton's iteration corrects velocities: of stiff steps they are known better than forces.
    let is_separable =
        const { Form::Separable.is_known(Y::FORM) } || const { Y::FORM.is_none() } && system.form() == Form::Separable;
    if is_separable && newton.is_none() {
        let mass = mass(plain, node);
        let last = run.stages.data.0;
        let are_last = run.convergence.has_begun();
        finished(Separable::<T, Y, P::Mass, N, S, FUSED>::new(system, &mass, node, *h, last, are_last), run)
    } else {
        let mass = constant_mass(plain, node);
        let guess = run.guess::<FUSED>();
        finished(General::<T, Y, P::Mass, N, S, FUSED>::new(system, mass.as_ref(), node, *h, guess, newton), run)
    }
}

#[inline(always)]
fn finished<const N: usize, const S: usize>(mut equations: impl Equations<N, S>, run: &Run<N, S>) -> Solved<N, S> {
    let sweeps = sweep::solve(&mut equations, &run.convergence);
    Solved { increment: equations.increment(), stages: equations.guess(), velocities: equations.velocities(), sweeps }
}

/// Why stages cannot be evaluated about the step of length h from `node`: no velocity belongs to its momenta, or L, f or a slope of L is not
/// finite at the node or half a step from it; the system names the part of L or f. None where they can.
#[cold]
pub(super) fn lost_force<S: Collocation<N>, const N: usize>(system: &S, node: &Node<N>, h: f64) -> Option<StepError> {
    let v = match node.state().velocity(system) {
        Ok(v) => v,
        Err(failure) => return Some(failure),
    };
    let lost = StepError::NonFinite { t: node.t, quantity: "force at a stage", expression: None };
    let explained = lost.explained(system, node, h, &v);
    let is_named = matches!(explained, StepError::NonFinite { expression: Some(_), .. });
    let has_slopes = |h: f64| {
        let (t, q) = node.midpoint(h, &v);
        let Point { momentum, force, .. } = system.point(t, &q, &v);
        momentum.iter().chain(&force).all(|entry| entry.is_finite())
    };
    (is_named || !has_slopes(0.0) || !has_slopes(h)).then_some(explained)
}
