//! Whether a step continues those of short lengths.
//!
//! The stage equations of a long step have further solutions, which satisfy them to rounding but lie on no branch from
//! h → 0: a step through a pole, or past a fold. A step whose fixed-point iteration contracts fast, or whose stages are
//! resolved, has one solution near its start. The others are continued:
//!
//! ```text
//! h θ0 … h θ … h        each guess is extrapolated from the stages of shorter steps, and close to its solution
//! ```
//!
//! The step at the end of the branch is the one to take. If the branch ends before, the step is too long.

use super::fixed_point::{Convergence, Equations as _};
use super::general::equations;
use super::linearization::Linearization;
use super::newton::Buffer;
use super::points::{AnyDerivatives, ErasedSystem};
use super::solve::{StageSolution, Start, Step, constant};
use super::stages::{Stages, at, stage, time};
use super::tableau::{Tableau, real};
use crate::collocation::Collocation;
use crate::error::StepError;
use crate::node::Node;
use crate::stepping::Convertible;
use nalgebra::SMatrix;
use vi_dispatch::Instructions;

/// The contraction of Newton iteration up to which its solution needs no proof. It finds solutions farther away than
/// fixed-point iteration: with 0.25 another branch was taken in ten of 517 plunging orbits.
const FAST_NEWTON: f64 = 0.05;
/// The last coefficients of resolved stages, relative to the largest one. Measured on Kepler's problem: up to 0.09 for
/// e = 0.6, 1.0 in a step that loses a plunging orbit.
const RESOLVED: f64 = 0.1;
/// Relative change of the derivatives over a step whose equations count as linear, and then have one solution.
const LINEAR: f64 = 0.05;
/// Fewer stages have too few coefficients.
const FEWEST: usize = 3;
/// Most solved steps of a continuation.
const SOLVES: u32 = 192;
/// Halvings of h until the stages are resolved.
const HALVINGS: u32 = 12;
/// The least relative increase of the length. A branch that does not continue so far ends there.
const LEAST: f64 = 1e-4;
/// The largest distance from a guess to its solution, relative to the range of the stages.
const NEAR: f64 = 0.25;
/// The largest such distance between two numbers of one solution.
const EQUAL: f64 = 1e-6;

/// The last two Legendre coefficients of the stages, relative to the largest one: of the worst coordinate.
fn decay<const N: usize, const S: usize>(stages: &Stages<N, S>) -> f64 {
    let Tableau { b, legendre, .. } = const { &Tableau::<S>::VALUES };
    let coefficient = |row: &[f64; S], k: usize| {
        let sum: f64 = (0..S).map(|i| b[i] * legendre[k][i] * row[i]).sum();
        (real(2 * k + 1) * sum).abs()
    };
    let of_row = |row: &[f64; S]| {
        let largest = (0..S).map(|k| coefficient(row, k)).fold(0.0, f64::max);
        let last = coefficient(row, S - 1).max(coefficient(row, S.saturating_sub(2)));
        if last > 64.0 * f64::EPSILON * largest { last / largest } else { 0.0 }
    };
    stages.iter().map(of_row).fold(0.0, f64::max)
}

/// Entry by entry.
fn combined<const N: usize, const S: usize>(
    a: &Stages<N, S>,
    b: &Stages<N, S>,
    of: impl Fn(f64, f64) -> f64,
) -> Stages<N, S> {
    core::array::from_fn(|k| core::array::from_fn(|i| of(a[k][i], b[k][i])))
}

/// The largest distance of stages, relative to the range of their row and of the value `from`.
fn distance<const N: usize, const S: usize>(a: &Stages<N, S>, b: &Stages<N, S>, from: &Stages<N, S>) -> f64 {
    let of_row = |((a, b), from): ((&[f64; S], &[f64; S]), &[f64; S])| {
        let values = || a.iter().chain(b).chain(&from[..1]).copied();
        let range = values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min);
        let size = a.iter().chain(b).map(|entry| entry.abs()).fold(0.0, f64::max);
        let distance = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        if distance > 64.0 * f64::EPSILON * size { distance / range } else { 0.0 }
    };
    a.iter().zip(b).zip(from).map(of_row).fold(0.0, f64::max)
}

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

/// Whether the contraction of its iteration, its stages, or its equations prove that a step continues short ones.
fn is_proven<const N: usize, const S: usize>(system: &ErasedSystem<'_, N>, node: &Node<N>, step: &Step<N, S>) -> bool {
    let convergence = &step.convergence;
    let is_fast = if step.by_newton { convergence.contraction <= FAST_NEWTON } else { convergence.is_fast() };
    is_fast || S >= FEWEST && decay(&step.stages) <= RESOLVED || is_linear(system, node, step)
}

impl<const N: usize, const S: usize> Start<'_, N, S> {
    /// The step, if fixed-point iteration failed, contracted slowly or was skipped. `last` is the linearization of the
    /// previous step, if that had the same length.
    ///
    /// # Errors
    /// [`StepError::StagesUnsettled`], [`StepError::TooLong`], or the reason why the stages have no value.
    #[cold]
    pub(crate) fn recover<Y>(
        &self,
        system: &Y,
        instructions: Instructions,
        left: (Option<&StageSolution<N, S>>, Option<Linearization<N>>),
        cache: &mut Buffer<N, S>,
    ) -> Result<Step<N, S>, StepError>
    where
        Y: Collocation<N> + Convertible<N>,
    {
        let step = self.recovered(system, instructions, left, cache)?;
        let is_proven = is_proven(&ErasedSystem::of(system), self.node, &step);
        if is_proven { Ok(step) } else { self.continued(system, instructions, step, cache) }
    }

    /// The step of this length that continues those of short lengths: `step` itself, bit for bit, if it does.
    ///
    /// # Errors
    /// [`StepError::TooLong`] if the branch ends at a shorter length, or has not been followed to this one.
    #[cold]
    #[inline(never)]
    fn continued<Y>(
        &self,
        system: &Y,
        instructions: Instructions,
        step: Step<N, S>,
        cache: &mut Buffer<N, S>,
    ) -> Result<Step<N, S>, StepError>
    where
        Y: Collocation<N> + Convertible<N>,
    {
        let from = constant(system, self.node)?;
        let too_long =
            |longest: f64| StepError::TooLong { t: self.node.t, h: self.h, longest: (longest * self.h).abs() };
        let mut solved = |part: f64, stages: &Stages<N, S>| {
            let Self { node, h, pause, .. } = *self;
            let start = Start { node, h: part * h, stages, are_last: false, before: &Convergence::NONE, pause };
            start.unproven(system, instructions, cache).ok()
        };
        let mut solves = 0;
        let mut part = 1.0;
        let mut found = loop {
            part *= 0.5;
            solves += 1;
            if solves > HALVINGS {
                return Err(too_long(part));
            }
            let is_proven = |short: &Step<N, S>| is_proven(&ErasedSystem::of(system), self.node, short);
            if let Some(short) = solved(part, &from).filter(is_proven) {
                break short;
            }
        };
        let mut before: Option<(f64, Stages<N, S>)> = None;
        let mut increase: f64 = 0.5;
        while part < 1.0 {
            solves += 1;
            if increase < LEAST || solves > SOLVES {
                return Err(too_long(0.8 * part));
            }
            let last = &found.stages;
            let next = 1.0_f64.min(part * (1.0 + increase));
            let guess = match &before {
                Some((part_before, before)) => {
                    let ratio = (next - part) / (part - part_before);
                    combined(last, before, |last, before| last + ratio * (last - before))
                }
                None => at(last, |c| next / part * c),
            };
            match solved(next, &guess) {
                Some(longer) if distance(&guess, &longer.stages, &from) <= NEAR => {
                    before = Some((part, found.stages));
                    (part, found) = (next, longer);
                    increase = 0.5_f64.min(1.5 * increase);
                }
                _ => increase *= 0.5,
            }
        }
        let is_same = distance(&step.stages, &found.stages, &from) <= EQUAL;
        Ok(if is_same { step } else { Step { linearization: None, ..found } })
    }
}
