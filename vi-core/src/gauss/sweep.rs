//! Sweeps over the stages of a step until they no longer move.
//!
//! In: the equations of the stages, and positions to start from. Out: stages that satisfy them to rounding, measured:
//!
//! ```text
//! sweep      x' = what the equations give at the forces, masses and momenta of x
//! accept x   where |x' − x| ≤ 4 ε |q|, or |v' − v| ≤ 64 ε Σ |M⁻¹ p| where positions follow from velocities, the largest on the way of
//!            each coordinate, and a step from x has a thousandth of a rounding of the error that sweeps before left
//! ```
//!
//! The change from x to x' is what x leaves of its equations: it is measured at the very x whose forces the step uses.
//! A step is not ended at the first change that is small enough, but where the error left is negligible: an error of the stages that is
//! left after every step has a sign, and the energy would drift by it. Rounding hides that error in the change, so it is predicted: each
//! sweep multiplies it by the contraction, which is measured as long as changes stand out of rounding.

use super::stages::Stages;
use crate::error::StepError;
use crate::newton::FLOOR;
use nalgebra::SVector;

/// Sweeps that are tried.
const SWEEPS: u32 = 60;
/// Sweeps after which slow ones are given up, where there is another way.
const PATIENCE: u32 = 5;
/// The contraction of slow sweeps.
const SLOW: f64 = 0.5;
/// Roundings of q from which a change is slow to vanish.
const FAR: f64 = 1e3;
/// Roundings of q that a change must have for the next one at the floor to say by how much it is smaller: a rounding or two are noise.
const NOISE: f64 = 64.0;
/// Sweeps without a smaller change, after which no further one comes closer.
const STALLS: u32 = 4;
/// Part of a rounding of q that a rounding of the terms of v counts as: velocities are solved for by the mass matrix.
pub(crate) const VELOCITY: f64 = 1.0 / 16.0;
/// Roundings of q that a step may leave of the error of its stages.
const NEGLIGIBLE: f64 = 1.0 / 1024.0;
/// Roundings of a change after which roundings are taken anew: a sixteenth of the number that they are roundings of.
const COARSE: f64 = 0.0625 / f64::EPSILON;

/// The equations of the stages of a step.
pub(crate) trait Equations<const N: usize, const S: usize> {
    /// Whether there is another way to solve them, where sweeps are slow.
    fn has_another_way(&self) -> bool;
    /// The positions that the guess of the step leads to.
    fn start(&self) -> Stages<N, S>;
    /// Evaluates the equations at the positions x, and sets y to those that follow from it.
    fn sweep(&mut self, x: &Stages<N, S>, y: &mut Stages<N, S>);
    /// What moves the node, by the evaluation of the last sweep.
    fn increment(&self) -> Increment<N>;
    /// What the stages are found from: what is extrapolated to the next step.
    fn guess(&self) -> Stages<N, S>;
    /// The velocities at which the last sweep evaluated; none where nothing depends on them.
    fn velocities(&self) -> Option<Stages<N, S>>;
    /// Takes the roundings in which changes are measured, after a sweep that led to the positions x, and returns by how much changes are larger in them
    /// than in those taken before, at most.
    fn take_roundings(&mut self, x: &Stages<N, S>) -> f64;
    /// The change by the last sweep, which led from x to y, in the roundings taken last, those of positions; then x is y.
    fn change(&self, x: &mut Stages<N, S>, y: &Stages<N, S>) -> f64;
    /// What of the error of the stages, relative, the increment has, where a sweep leaves `contraction` of it.
    fn passed_on(&self, contraction: f64) -> f64;
}

/// What moves a step from its node to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Increment<const N: usize> {
    /// `(q1 − q0)/h`.
    pub(crate) velocity: SVector<f64, N>,
    /// `p1 − p0`.
    pub(crate) momentum: SVector<f64, N>,
}

impl<const N: usize> Increment<N> {
    /// Whether it leads anywhere; not where a stage was not finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.velocity.iter().chain(&self.momentum).all(|entry| entry.is_finite())
    }
}

/// How long sweeps are not tried, since the last ones did not converge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Pause {
    /// Steps that are left to Newton's iteration.
    left: u32,
    /// Steps of the next pause.
    next: u32,
}

/// Steps by Newton's iteration after which sweeps are tried again, at most.
const LONGEST_PAUSE: u32 = 64;

impl Pause {
    /// Where sweeps converge.
    pub(crate) const NONE: Self = Self { left: 0, next: 1 };

    /// Whether sweeps are to be tried.
    pub(crate) fn is_over(self) -> bool {
        self.left == 0
    }

    /// The pause after a step by Newton's iteration: where sweeps were tried in vain, twice as long as the last one.
    pub(crate) fn after_newton(self) -> Self {
        match self.left.checked_sub(1) {
            Some(left) => Self { left, ..self },
            None => Self { left: self.next, next: LONGEST_PAUSE.min(2 * self.next) },
        }
    }
}

/// How sweeps ended.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Convergence {
    /// How many there were.
    pub(crate) sweeps: u32,
    /// The last change, in roundings of q, or in sixteens of those of the terms of v.
    pub(crate) change: f64,
    /// The ratio of a change to the one before, the last that stood out of rounding.
    pub(crate) contraction: f64,
}

impl Convergence {
    /// Before the first step.
    pub(crate) const NONE: Self = Self { sweeps: 0, change: 0.0, contraction: 1.0 };

    /// Whether there was a step.
    pub(crate) fn has_begun(&self) -> bool {
        self.sweeps > 0
    }

    /// The error of stages that did not come to rest, in the step of length h from the time t, and led to this increment.
    pub(crate) fn unsettled<const N: usize>(
        &self,
        increment: &Increment<N>,
        [t, h]: [f64; 2],
        stiffness: f64,
    ) -> StepError {
        let Self { sweeps, change, contraction } = *self;
        // What is not a number was beyond all: of two infinite numbers the change is none.
        let is_beyond = |ratio: f64| ratio.is_nan() || !increment.is_finite();
        let [change, contraction] =
            [change, contraction].map(|ratio| if is_beyond(ratio) { f64::INFINITY } else { ratio });
        StepError::StagesUnsettled { t, h, iterations: sweeps, change, contraction, stiffness }
    }

    /// Whether the stages are at the rounding of their positions.
    pub(crate) fn is_at_floor(&self) -> bool {
        self.change <= FLOOR
    }
}

/// Sweeps until the stages no longer move, or no longer come closer. `before` is how the step before ended.
#[inline(always)]
pub(crate) fn solve<E: Equations<N, S>, const N: usize, const S: usize>(
    equations: &mut E,
    before: &Convergence,
) -> Sweeps<N, S> {
    let mut x = equations.start();
    let mut y = [[0.0; S]; N];
    let mut state = Convergence { sweeps: 0, change: f64::INFINITY, ..*before };
    // What x leaves, without the rounding of its change.
    let mut error = f64::INFINITY;
    // What a step from x would have of it.
    let mut left = f64::INFINITY;
    let mut least = f64::INFINITY;
    let mut stalls = 0;
    let mut is_last = false;
    let are_given_up = loop {
        equations.sweep(&x, &mut y);
        state.sweeps += 1;
        if is_last {
            break false;
        }
        let last = state.change;
        if last > COARSE {
            equations.take_roundings(&y);
        }
        let mut change = equations.change(&mut x, &y);
        let is_small = |change, left| change <= FLOOR && (left <= NEGLIGIBLE || change == 0.0);
        if is_small(change, left) || change >= least {
            // What ends sweeps is measured in roundings of the stages that they lead to: those taken before may be of other numbers.
            let growth = equations.take_roundings(&x);
            change *= growth;
            left *= growth;
            error *= growth;
        }
        state.change = change;
        if is_small(change, left) {
            break false;
        }
        let stands_out = change > FLOOR || last > NOISE;
        // Of the first sweep the step before says nothing.
        if stands_out && state.sweeps > 1 {
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
        if state.sweeps >= PATIENCE && is_slow() {
            break true;
        }
        // What is judged then is what the stages leave at x.
        is_last = stalls == STALLS || state.sweeps == SWEEPS;
    };
    Sweeps { convergence: state, positions: x, are_given_up }
}

/// The last of the sweeps of a step.
pub(crate) struct Sweeps<const N: usize, const S: usize> {
    pub(crate) convergence: Convergence,
    /// Positions that it led to; those at which it evaluated, where they do not rest.
    pub(crate) positions: Stages<N, S>,
    /// Whether further sweeps would come closer, but slowly.
    pub(crate) are_given_up: bool,
}
