//! The stage equations of a step in transformed time, and their solver.
//! [`InTransformedTime`](crate::method::InTransformedTime) is the method.
//!
//! | file | part of a step |
//! |---|---|
//! | `equations` | the stage equations, for fixed-point iteration and simplified Newton iteration |
//! | `rates` | memory of the last step, for the guess of the next one |
//! | `polynomial` | dense output |
//! | `rounding` | residuals of stalled stages, by running error analysis |
//! | `variation` | derivatives of a step |

mod equations;
mod polynomial;
mod rates;
mod rounding;
#[cfg(feature = "alloc")]
mod variation;

use super::fixed_point::{self, Equations, FixedPointResult, StageIncrement};
use super::linearization::LinearizationPoint;
use super::newton::{Buffer, Newton};
use super::points::ErasedSystem;
use super::solve::lost_force;
use super::stages::{Stages, stage};
use crate::error::StepError;
use crate::motion::{Motion, TimeScale};
use crate::node::Node;
use crate::real::{Lane, Real, Rounded};
use crate::stepping::Convertible;
use equations::{Clock, Rates, Scaled};
pub use polynomial::TransformedPolynomial;
pub(crate) use rates::time_scale;
pub use rates::{After, LastRates};
use vi_dispatch::{Instructions, Loop};

/// Initial data of a step of the length Δτ.
#[derive(Debug)]
pub(crate) struct Start<'a, Y, const N: usize, const S: usize> {
    pub(crate) system: &'a Y,
    pub(crate) node: &'a Node<N>,
    pub(crate) dtau: f64,
    pub(crate) last: &'a LastRates<N, S>,
}

impl<Y, const N: usize, const S: usize> Clone for Start<'_, Y, N, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<Y, const N: usize, const S: usize> Copy for Start<'_, Y, N, S> {}

impl<Y, const N: usize, const S: usize> Start<'_, Y, N, S>
where
    Y: TimeScale<N> + Convertible<N>,
{
    /// The run after the step by fixed-point iteration.
    ///
    /// # Errors
    /// The stages of the failed iteration.
    #[inline(always)]
    pub(crate) fn by_fixed_point(self, instructions: Instructions) -> Result<After<N, S>, TransformedStages<N, S>> {
        let solved = if Y::SIDE_BY_SIDE { instructions.run(FixedPoint(self)) } else { self.in_scalars(None) };
        let after = self.last.after(self.node, self.dtau, &solved);
        let is_step =
            solved.is_at_floor() && after.is_sound(self.system) && after.can_continue((self.node, self.last), &solved);
        if is_step { Ok(after) } else { Err(solved) }
    }

    /// The run after a step, if fixed-point iteration failed or was skipped, or g is not positive.
    ///
    /// # Errors
    /// [`StepError::StagesNotConverged`], [`StepError::TimeScale`], [`StepError::NonFinite`].
    #[cold]
    pub(crate) fn recover(
        self,
        by_fixed_point: Option<&TransformedStages<N, S>>,
        cache: &mut Buffer<N, S>,
    ) -> Result<After<N, S>, StepError> {
        if let Some(by_fixed_point) = by_fixed_point {
            // Scalar numbers have sines and cosines of every angle; SIMD lanes reject large ones.
            let plain;
            let solved = if by_fixed_point.increment.is_finite() {
                by_fixed_point
            } else {
                plain = self.in_scalars(None);
                &plain
            };
            if let Some(after) = self.accepted(solved, self.last.after(self.node, self.dtau, solved)) {
                return Ok(after);
            }
        }
        let (system, at) = (&ErasedSystem::of(self.system), self.middle());
        let mut newton = cache.newton();
        if let Some(newton) = &mut newton {
            newton.linearize(system, at);
        }
        let solved = self.in_scalars(newton.as_deref());
        let mut after = self.last.after(self.node, self.dtau, &solved);
        after.rates.pause = self.last.pause.after_newton();
        self.accepted(&solved, after).ok_or_else(|| self.failure_of(&solved, &after, at.stiffness(system)))
    }

    /// The run after a solved step, with its acceptance criterion: the last change of its stages or, if that stalls,
    /// their residual by running error analysis. `None` if that exceeds rounding, or the run cannot continue.
    fn accepted(&self, solved: &TransformedStages<N, S>, mut after: After<N, S>) -> Option<After<N, S>> {
        let Self { system, node, dtau, last } = *self;
        if !solved.is_at_floor() && !solved.iteration.are_given_up {
            after.rates.convergence.change = rounding::residual(&system.convert::<Rounded>(), node, dtau, solved);
        }
        let is_step = after.rates.convergence.is_at_floor() && after.is_sound(system);
        (is_step && after.can_continue((node, last), solved)).then_some(after)
    }

    /// The reason why a step failed.
    fn failure_of(&self, solved: &TransformedStages<N, S>, after: &After<N, S>, stiffness: f64) -> StepError {
        let Self { system, node, dtau, last } = *self;
        let stages = (0..S).map(|i| (solved.clock.time[i], stage(&solved.iteration.positions, i)));
        for (t, q) in stages.chain([(after.node.t, after.node.q)]) {
            let is_known = t.is_finite() && q.iter().all(|q: &f64| q.is_finite());
            if is_known && let Err(failure) = check_time_scale(t, time_scale(system, t, &q)) {
                return failure;
            }
        }
        if let Some(failure) = lost_force(system, node, last.h) {
            return failure;
        }
        let g = solved.rates.g[0];
        if g.is_finite() && after.rates.convergence.is_at_floor() && !after.can_continue((node, last), solved) {
            return StepError::TimeScale { t: node.t, g };
        }
        let h = time_scale(system, node.t, &node.q) * dtau;
        solved.iteration.convergence.not_converged(&solved.increment, [node.t, h], stiffness)
    }

    /// The linearization point at the middle of the step.
    fn middle(&self) -> LinearizationPoint<N> {
        let Self { system, node, dtau, last } = *self;
        let rates = last.guess::<false>(dtau);
        let equations = Scaled::<f64, Y, N, S, false>::new(system, node, dtau, rates, None);
        let middle = S / 2;
        let h = dtau * rates.g[middle];
        let q = stage(&equations.start(), middle);
        let v = stage(&rates.velocity, middle);
        LinearizationPoint { h, t: node.t + 0.5 * h, q, v, iterations: None, by_velocity: true }
    }

    /// The stages in scalar numbers. Not inlined: speed does not matter after SIMD iteration has failed.
    #[inline(never)]
    fn in_scalars(&self, newton: Option<&Newton<N, S>>) -> TransformedStages<N, S> {
        let Self { system, node, dtau, last } = *self;
        solved::<f64, Y, N, S, false>(system, node, dtau, last, newton)
    }
}

/// A solved step.
pub struct TransformedStages<const N: usize, const S: usize> {
    pub(crate) increment: StageIncrement<N>,
    /// Increments of time and energy.
    gains: [f64; 2],
    /// The largest `|H − E|` at its stages, and the size of the terms of H.
    excess: [f64; 2],
    /// Rates for the extrapolation of the next step.
    rates: Rates<N, S>,
    /// Velocities, times and energies of the last evaluation.
    velocity: Stages<N, S>,
    clock: Clock<S>,
    iteration: FixedPointResult<N, S>,
}

impl<const N: usize, const S: usize> TransformedStages<N, S> {
    /// Whether the stages are at the rounding floor of their positions.
    fn is_at_floor(&self) -> bool {
        self.iteration.convergence.is_at_floor()
    }
}

/// Iterates the stages with SIMD dispatch.
struct FixedPoint<'a, Y, const N: usize, const S: usize>(Start<'a, Y, N, S>);

impl<Y: Convertible<N>, const N: usize, const S: usize> Loop for FixedPoint<'_, Y, N, S> {
    type Output = TransformedStages<N, S>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> TransformedStages<N, S> {
        let Self(Start { system, node, dtau, last }) = self;
        solved::<Lane<FUSED>, _, N, S, FUSED>(&system.convert::<Lane<FUSED>>(), node, dtau, last, None)
    }
}

/// The stages, with equations evaluated over the numbers T, by fixed-point iteration, then by Newton iteration.
#[inline(always)]
fn solved<T, Y, const N: usize, const S: usize, const FUSED: bool>(
    system: &Y,
    node: &Node<N>,
    dtau: f64,
    last: &LastRates<N, S>,
    newton: Option<&Newton<N, S>>,
) -> TransformedStages<N, S>
where
    T: Real,
    Y: Motion<N, T>,
{
    let rates = last.guess::<FUSED>(dtau);
    let mut equations = Scaled::<T, Y, N, S, FUSED>::new(system, node, dtau, rates, newton);
    let iteration = fixed_point::solve(&mut equations, &last.convergence);
    TransformedStages {
        increment: equations.increment(),
        gains: equations.gains(),
        excess: equations.excess(),
        rates: equations.rates(),
        velocity: equations.velocity(),
        clock: equations.evaluated(),
        iteration,
    }
}

/// Rejects a g that is not positive and finite: time must advance.
///
/// # Errors
/// [`StepError::TimeScale`].
pub(crate) fn check_time_scale(t: f64, g: f64) -> Result<(), StepError> {
    if g > 0.0 && g.is_finite() { Ok(()) } else { Err(StepError::TimeScale { t, g }) }
}
