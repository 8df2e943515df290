//! Fixed-point iteration of the stages to convergence.
//!
//! From the stage equations and initial positions, the iteration computes stages that satisfy the equations to
//! rounding:
//!
//! ```text
//! iterate    x' = positions by the equations at the forces, masses and momenta of x
//! accept x   if |x' − x| ≤ 4 ε |q|, or |v' − v| ≤ 64 ε Σ |M⁻¹ p| if positions follow from velocities, with the largest values so far of
//!            each coordinate, and the error of a step from x is below a thousandth of a rounding
//! ```
//!
//! The change from x to x' is the residual at x, the same x whose forces the step uses. The iteration does not stop at
//! the first small change, but when the remaining error is negligible. An error of the stages with the same sign in
//! every step would let the energy drift. Rounding hides that error in the change, so the iteration predicts it: each
//! iteration multiplies it by the contraction, which is measured while changes exceed rounding. Stages of a tolerance are
//! measured in larger units than ulps, with the same bounds.

use super::stages::{EXACT, Stages};
use crate::error::StepError;
use crate::newton::FLOOR;
use nalgebra::SVector;

/// Most iterations.
const ITERATIONS: u32 = 60;
/// Iterations after which slow convergence ends the iteration, if Newton iteration is available.
const PATIENCE: u32 = 5;
/// Contraction of slow convergence. Slower iterations of steps that are too long end at wrong solutions more often.
const SLOW: f64 = 0.5;
/// Change, in ulps of q, above which an iteration is far from convergence.
pub(crate) const FAR: f64 = 1e3;
/// Smallest change, in ulps of q, that measures the contraction together with a change at the floor; one or two ulps
/// are noise.
pub(crate) const NOISE: f64 = 64.0;
/// Contraction up to which a solution is the only one near the guess, and so continues those of short steps. On 180
/// plunging orbits with 2, 3, 4 and 8 stages, an independent continuation found the same branch for all steps.
const FAST: f64 = 0.25;
/// Number of iterations in which only a guess close to its solution converges, so that no contraction is needed.
pub(crate) const FEW: u32 = 3;
/// Iterations without a smaller change, after which the iteration has stalled.
const STALLS: u32 = 4;
/// Ulps of q that an ulp of the terms of v counts as, because the mass matrix solves for velocities.
pub(crate) const VELOCITY: f64 = 1.0 / 16.0;
/// Accepted stage error of a step, in ulps of q.
const NEGLIGIBLE: f64 = 1.0 / 1024.0;
/// Change, in ulps, after which the ulps are recomputed: a sixteenth of the number itself.
const COARSE: f64 = 0.0625 / f64::EPSILON;

/// The stage equations of a step.
pub(crate) trait Equations<const N: usize, const S: usize> {
    /// Whether Newton iteration is available for slow convergence.
    fn has_another_way(&self) -> bool;
    /// The accuracy to which the stages are solved, in ulps.
    fn accuracy(&self) -> f64 {
        EXACT
    }
    /// The initial positions, from the guess of the step.
    fn start(&self) -> Stages<N, S>;
    /// Evaluates the equations at the positions x, and writes the resulting positions to y. `before` has the change of
    /// the iteration before, infinite in the first one, and the contraction that was measured last, in this step or an
    /// earlier one.
    fn iterate(&mut self, x: &Stages<N, S>, y: &mut Stages<N, S>, before: &Convergence);
    /// The increment of the node, from the last evaluation.
    fn increment(&self) -> StageIncrement<N>;
    /// The stage values that the next step extrapolates.
    fn guess(&self) -> Stages<N, S>;
    /// The velocities of the last evaluation; `None` if nothing depends on them.
    fn velocities(&self) -> Option<Stages<N, S>>;
    /// Recomputes the ulps for changes, after an iteration that led to the positions x. Returns the largest factor by
    /// which changes grow in the new units.
    fn take_roundings(&mut self, x: &Stages<N, S>) -> f64;
    /// The change of the last iteration from x to y, in the current ulps of positions. Sets x to y.
    fn change(&self, x: &mut Stages<N, S>, y: &Stages<N, S>) -> f64;
    /// Part of the relative stage error that enters the increment, if an iteration contracts by `contraction`.
    fn passed_on(&self, contraction: f64) -> f64;
}

/// Increment from a node to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StageIncrement<const N: usize> {
    /// `(q1 − q0)/h`.
    pub(crate) velocity: SVector<f64, N>,
    /// `p1 − p0`.
    pub(crate) momentum: SVector<f64, N>,
}

impl<const N: usize> StageIncrement<N> {
    /// Whether the increment is finite; a stage that is not finite makes it NaN or infinite.
    pub(crate) fn is_finite(&self) -> bool {
        self.velocity.iter().chain(&self.momentum).all(|entry| entry.is_finite())
    }
}

/// The pause of fixed-point iteration after it failed to converge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Pause {
    /// Remaining steps by Newton iteration.
    left: u32,
    /// Length of the next pause, in steps.
    next: u32,
}

/// Longest pause, in steps by Newton iteration.
const LONGEST_PAUSE: u32 = 64;

impl Pause {
    /// No pause: fixed-point iteration converges.
    pub(crate) const NONE: Self = Self { left: 0, next: 1 };

    /// Whether to try fixed-point iteration.
    pub(crate) fn is_over(self) -> bool {
        self.left == 0
    }

    /// Whether Newton iteration solved one of the last steps.
    pub(crate) fn has_been(self) -> bool {
        self.next > 1
    }

    /// No pause until fixed-point iteration converges: it stalls above rounding, and so does Newton iteration.
    pub(crate) const USELESS: Self = Self { left: 0, next: 0 };

    /// Half the pause after a step by fixed-point iteration.
    #[inline(always)]
    pub(crate) fn after_fixed_point(self) -> Self {
        Self { left: 0, next: (self.next / 2).max(1) }
    }

    /// The pause after a step by Newton iteration; twice the last one if fixed-point iteration failed.
    pub(crate) fn after_newton(self) -> Self {
        match self.left.checked_sub(1) {
            Some(left) => Self { left, ..self },
            None => Self { left: self.next, next: LONGEST_PAUSE.min(2 * self.next) },
        }
    }
}

/// The outcome of a fixed-point iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Convergence {
    /// Number of iterations.
    #[cfg_attr(feature = "serde", serde(rename = "sweeps"))]
    pub(crate) iterations: u32,
    /// The last change, in ulps of q, or in sixteenths of the ulps of the terms of v.
    pub(crate) change: f64,
    /// The last ratio of two changes above rounding.
    pub(crate) contraction: f64,
}

impl Convergence {
    /// The outcome before the first step.
    pub(crate) const NONE: Self = Self { iterations: 0, change: 0.0, contraction: 1.0 };

    /// Whether the run has taken a step.
    pub(crate) fn has_begun(&self) -> bool {
        self.iterations > 0
    }

    /// The error of stages that did not converge, in the step of length h from the time t with this increment.
    pub(crate) fn not_converged<const N: usize>(
        &self,
        increment: &StageIncrement<N>,
        [t, h]: [f64; 2],
        stiffness: f64,
    ) -> StepError {
        let Self { iterations, change, contraction } = *self;
        // NaN counts as divergence: two infinite values have no finite change.
        let is_beyond = |ratio: f64| ratio.is_nan() || !increment.is_finite();
        let [change, contraction] =
            [change, contraction].map(|ratio| if is_beyond(ratio) { f64::INFINITY } else { ratio });
        StepError::StagesNotConverged { t, h, iterations, change, contraction, stiffness }
    }

    /// Whether the iteration contracted so fast that its solution is the only one near the guess. A guess is close to
    /// it after few iterations to rounding, not to a larger `accuracy`.
    #[inline(always)]
    pub(crate) fn is_fast(&self, accuracy: f64) -> bool {
        self.contraction <= FAST || accuracy <= EXACT && self.iterations <= FEW
    }

    /// Whether the stages are at the rounding floor of their positions.
    pub(crate) fn is_at_floor(&self) -> bool {
        self.change <= FLOOR
    }
}

/// Stages that begin at a cache line. A vector of eight numbers that lies across two lines takes longer to load.
#[repr(align(64))]
struct AtLine<T>(T);

/// Iterates until the stages converge or stall. `before` is the outcome of the previous step.
#[inline(always)]
pub(crate) fn solve<E: Equations<N, S>, const N: usize, const S: usize>(
    equations: &mut E,
    before: &Convergence,
) -> FixedPointResult<N, S> {
    let [x, y] = &mut [AtLine(equations.start()), AtLine([[0.0; S]; N])];
    let (AtLine(x), AtLine(y)) = (x, y);
    let mut state = Convergence { iterations: 0, change: f64::INFINITY, ..*before };
    // Residual at x, without the rounding error of the change.
    let mut error = f64::INFINITY;
    // Error of a step from x.
    let mut left = f64::INFINITY;
    let mut least = f64::INFINITY;
    let mut stalls = 0;
    let mut is_last = false;
    let accuracy = equations.accuracy();
    let are_given_up = loop {
        equations.iterate(x, y, &state);
        state.iterations += 1;
        if is_last {
            break false;
        }
        let last = state.change;
        if last * accuracy > COARSE {
            equations.take_roundings(y);
        }
        let mut change = equations.change(x, y);
        if accuracy > EXACT && state.iterations > 1 {
            // These steps take few iterations: without this the contraction may be that of an earlier step.
            state.contraction = state.contraction.max(change / last);
        }
        let is_small = |change, left| change <= FLOOR && (left <= NEGLIGIBLE || change == 0.0);
        if is_small(change, left) || change >= least {
            // Convergence is judged in ulps of the new stages.
            let growth = equations.take_roundings(x);
            change *= growth;
            left *= growth;
            error *= growth;
        }
        state.change = change;
        if is_small(change, left) {
            break false;
        }
        let stands_out = change > FLOOR || last > NOISE;
        // The first change of a step has no predecessor.
        if stands_out && state.iterations > 1 {
            state.contraction = change / last;
        }
        error = state.contraction * if stands_out || change < error { change } else { error };
        left = equations.passed_on(state.contraction) * error;
        if change < least {
            least = change;
            stalls = 0;
        } else {
            stalls += 1;
        }
        let is_slow = || state.contraction > SLOW && change > FAR && equations.has_another_way();
        if state.iterations >= PATIENCE && is_slow() {
            break true;
        }
        // The decision then depends on the residual at x.
        is_last = stalls == STALLS || state.iterations == ITERATIONS;
    };
    FixedPointResult { convergence: state, positions: *x, are_given_up }
}

/// The last iteration of a step.
pub(crate) struct FixedPointResult<const N: usize, const S: usize> {
    pub(crate) convergence: Convergence,
    /// The resulting positions, or those of the evaluation if the stages did not converge.
    pub(crate) positions: Stages<N, S>,
    /// Whether further iterations would converge, but slowly.
    pub(crate) are_given_up: bool,
}
