//! Newton iteration to the rounding floor.
//!
//! This module solves `r(u) = 0` with the Jacobian J from a guess. At the root every residual is at its floor: at most
//! one rounding, or within [`FLOOR`] roundings and no longer reduced by a Newton step. One
//! rounding is the bound of the evaluation error of the row by running error analysis, with u the numbers nearest to
//! the root.
//!
//! ```text
//! u ← u − J⁻¹ r(u)        halved until the residuals decrease and u is in the domain
//! ```
//!
//! There is no absolute tolerance. J is regular at every accepted root.

use crate::error::{Residuals, StepError};
use crate::real::{Real, Scalar};
use crate::vector::{Vector, worse};
use nalgebra::SVector;

/// Residual, in roundings, below which a stalled iteration counts as converged.
pub(crate) const FLOOR: f64 = 4.0;
const ITERATIONS: u32 = 40;
const HALVINGS: u32 = 12;

/// Equations in unknowns U.
pub(crate) trait Equations<T: Real> {
    /// The unknowns, and corrections of them.
    type Unknowns: Vector<T>;
    /// Residuals, Jacobian and rounding scales at some u.
    type Evaluation;

    /// Evaluates the equations at u.
    fn at(&self, u: &Self::Unknowns) -> Self::Evaluation;
    /// The largest residual of each of two groups of rows, in roundings by the scales of `scales`. Each group converges
    /// to its own floor. NaN if a residual is not finite.
    fn roundings(&self, of: &Self::Evaluation, scales: &Self::Evaluation) -> [f64; 2];
    /// `J⁻¹ r`, with J and r at different u.
    ///
    /// # Errors
    /// [`Failure::Singular`] or [`Failure::InfiniteJacobian`] if it does not exist.
    fn correction(&self, jacobian: &Self::Evaluation, residual: &Self::Evaluation) -> Result<Self::Unknowns, Failure>;
    /// The correction with pivoting, if [`Equations::correction`] does not pivot.
    fn pivoted(&self, _: &Self::Evaluation) -> Option<Self::Unknowns> {
        None
    }
    /// Whether u is in the domain of trials.
    fn admits(&self, _: &Self::Unknowns) -> bool {
        true
    }
}

/// A root.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Root<U, E> {
    pub(crate) u: U,
    /// The equations at the root.
    pub(crate) at: E,
    pub(crate) iterations: u32,
    /// Number of iterations with a residual above the floor.
    pub(crate) above_floor: u32,
    pub(crate) residuals: Residuals,
}

/// The reason why no root was found.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Failure {
    Singular,
    NonFinite,
    /// The equations are finite, but their Jacobian is not.
    InfiniteJacobian,
    Stalled {
        iterations: u32,
        residual: f64,
        residuals: Residuals,
    },
}

impl Failure {
    /// The error of the step h from time t.
    pub(crate) fn at(self, t: f64, h: f64, matrix: &'static str) -> StepError {
        match self {
            Self::Singular => StepError::Singular { t, matrix },
            Self::NonFinite => StepError::NonFinite { t, quantity: "momentum equation", expression: None },
            Self::InfiniteJacobian => StepError::NonFinite { t, quantity: matrix, expression: None },
            Self::Stalled { iterations, residual, residuals } => {
                StepError::NotConverged { t, h, iterations, residual, residuals, turn: 0.0 }
            }
        }
    }
}

/// Solves `equations` from a guess.
pub(crate) fn solve<T: Real, E: Equations<T>>(
    equations: &E,
    guess: E::Unknowns,
) -> Result<Root<E::Unknowns, E::Evaluation>, Failure> {
    let mut u = guess;
    let mut at = equations.at(&u);
    let (mut iterations, mut above_floor, mut residuals) = (0, 0, Residuals::new());
    loop {
        let residual = largest(equations.roundings(&at, &at));
        residuals.push(residual);
        above_floor += u32::from(residual > FLOOR);
        if !residual.is_finite() {
            return Err(Failure::NonFinite);
        }
        let correction = equations.correction(&at, &at)?;
        let is_spent = iterations == ITERATIONS && residual <= FLOOR;
        if residual <= 1.0 || is_spent {
            return Ok(Root { u, at, iterations, above_floor, residuals });
        }
        if iterations == ITERATIONS {
            return Err(Failure::Stalled { iterations, residual, residuals });
        }
        iterations += 1;
        match damped(equations, &u, &at, correction) {
            Some(next) => (u, at) = next,
            None if residual <= FLOOR => return Ok(Root { u, at, iterations, above_floor, residuals }),
            None => return Err(Failure::Stalled { iterations, residual, residuals }),
        }
    }
}

/// Damped Newton step: halves the correction until the residuals decrease; `None` if they never do.
fn damped<T: Real, E: Equations<T>>(
    equations: &E,
    u: &E::Unknowns,
    last: &E::Evaluation,
    mut correction: E::Unknowns,
) -> Option<(E::Unknowns, E::Evaluation)> {
    let before = equations.roundings(last, last);
    let (mut halvings, mut pivoted) = (0, false);
    loop {
        let next = u.zip_map(&correction, |u, correction| u - correction);
        if equations.admits(&next) {
            let at = equations.at(&next);
            // In units of the scales at u: larger scales at a trial far away would make its residual look small. The
            // sum decides, so that one group at its floor does not hide progress of the other. Within the floor, either
            // group must halve.
            let [momentum, energy] = equations.roundings(&at, last);
            let is_finite = largest(equations.roundings(&at, &at)).is_finite();
            let halves_one = momentum < 0.5 * before[0] || energy < 0.5 * before[1];
            let is_less = momentum + energy < before[0] + before[1];
            if is_finite && (is_less || halves_one && largest([momentum, energy]) <= FLOOR) {
                return Some((next, at));
            }
            if largest(before) <= FLOOR {
                return None;
            }
            if halvings == 0 && is_finite && contracts(equations, last, &at, &correction) {
                return Some((next, at));
            }
        }
        if halvings == HALVINGS {
            return None;
        }
        // A lost pivot is checked before the step counts as too long.
        match if pivoted { None } else { equations.pivoted(last) } {
            Some(other) if other != correction => correction = other,
            _ => {
                halvings += 1;
                correction = correction.map(|entry| entry * T::real(0.5));
            }
        }
        pivoted = true;
    }
}

/// Whether the next correction, by the same matrix, is less than half as long: Newton's natural measure (Deuflhard,
/// Newton Methods for Nonlinear Problems, section 3.3). It decides if a row has no terms at u, and therefore no scale:
/// for example at rest at the bottom of a potential.
#[cold]
fn contracts<T: Real, E: Equations<T>>(
    equations: &E,
    last: &E::Evaluation,
    at: &E::Evaluation,
    correction: &E::Unknowns,
) -> bool {
    let next = equations.correction(last, at);
    next.is_ok_and(|next| next.longest() < 0.5 * correction.longest())
}

/// Whether each row is within [`FLOOR`] roundings of its scale, and within `remaining` ones including its carried
/// remainder.
#[inline(always)]
pub(crate) fn are_at_floor<T: Scalar, const N: usize>(
    residual: &SVector<T, N>,
    carried: &SVector<T, N>,
    scale: &SVector<T, N>,
    remaining: f64,
) -> bool {
    // A bit mask, because loops over booleans do not vectorize.
    let mut above = 0_u64;
    for i in 0..N {
        let bound = scale[i] * T::real(FLOOR * T::EPSILON);
        let sum = (residual[i] + carried[i]) * T::real(FLOOR / remaining);
        // A scale that overflows proves nothing.
        let is_below = residual[i].abs() <= bound && sum.abs() <= bound && bound.is_finite();
        above |= if is_below { 0 } else { u64::MAX };
    }
    above == 0
}

/// `|residual|` in units of one ulp of `scale`. NaN if either is not finite.
#[inline]
pub(crate) fn roundings<T: Real>(residual: T, scale: T) -> f64 {
    let (residual, scale) = (residual.to_f64().abs(), scale.to_f64());
    if residual == 0.0 && scale.is_finite() {
        return 0.0;
    }
    // Both ∞/∞ and x/∞ return NaN: a scale that overflows proves nothing about x.
    if scale.is_finite() { residual / scale / T::EPSILON } else { f64::NAN }
}

/// The larger of two groups.
fn largest([momentum, energy]: [f64; 2]) -> f64 {
    worse(momentum, energy)
}

/// The largest residual in units of one ulp of its scale.
#[inline]
pub(crate) fn worst<T: Real, const N: usize>(residual: &SVector<T, N>, scale: &SVector<T, N>) -> f64 {
    residual.iter().zip(scale.iter()).fold(0.0, |worst, (r, s)| worse(roundings(*r, *s), worst))
}
