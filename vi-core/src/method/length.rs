//! The search for a step length: the smallest root of `φ(h) = −residual(h)/excess`, φ(0) = −1.
//!
//! The caller provides a function that solves the step of any length, a predicted length and the last one. The search
//! first uses secants in ln h,
//!
//! ```text
//! y(h) = ln(1 + φ(h))        ln h ← ln h − y/slope        slope = order + O(h), that of the step before
//! ```
//!
//! then a bracket of the smallest root and bisection. If the step density is about to vanish, φ can rise above zero and
//! fall again between two lengths. The search therefore follows a maximum below zero to its top. The function is behind
//! a pointer, so that this module is compiled once per trial type.

use crate::error::{Residuals, StepError};
use crate::newton::FLOOR;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Most lengths of the secant iteration.
const TRIALS: u32 = 8;
/// Residual, in units of its rounding-error bound, at which the iteration stops.
const SOLVED: f64 = 0.5;
/// Largest factor between two lengths of the secant iteration.
const FACTOR: f64 = 1.5;
/// Difference of two residuals, in rounding units, that determines a slope to three digits.
const DISTINCT: f64 = 1e4;
/// Sample lengths for a bracket, in geometric progression with the factor 1.15.
const POINTS: u32 = 32;
const BISECTIONS: u32 = 60;
/// Golden sections of a maximum; each leaves 0.62 of the interval.
const SECTIONS: u32 = 40;

/// A step of some length.
pub(crate) trait Trial: Clone {
    /// Its length.
    fn h(&self) -> f64;
    /// Residual of the length equation.
    fn residual(&self) -> f64;
    /// Sum of the absolute terms of the residual.
    fn size(&self) -> f64;
    /// The residual in units of the rounding error of that size.
    fn roundings(&self) -> f64 {
        self.residual().abs() / (f64::EPSILON * self.size() + f64::MIN_POSITIVE)
    }
}

/// Solves the step of a length, with another trial as a guess.
pub(crate) type Solve<'a, T> = &'a dyn Fn(f64, Option<&T>) -> Result<T, StepError>;

/// A search for a length.
pub(crate) struct Search<'a, T> {
    /// Solves the step of length h, with another trial as a guess; with the last step if there is none.
    pub(crate) solve: Solve<'a, T>,
    /// Whether the residual of a trial is within its rounding error; an error if such a residual does not determine the
    /// length.
    pub(crate) is_rounding: &'a dyn Fn(&T) -> Result<bool, StepError>,
    pub(crate) t: f64,
    pub(crate) predicted: f64,
    pub(crate) last: f64,
    /// The largest factor between this step and the last one.
    pub(crate) ratio: f64,
    /// The residual in the limit h = 0.
    pub(crate) excess: f64,
    /// Rounding units of a residual that do not count as a change of its sign.
    pub(crate) noise: f64,
    /// Slope of `ln (1 + φ)` over `ln h`, and its leading-order value.
    pub(crate) slope: f64,
    pub(crate) order: f64,
}

impl<T: Trial> Search<'_, T> {
    /// The step by secants, and its slope; `None` if they do not converge.
    pub(crate) fn root(&self) -> Option<(T, f64)> {
        let mut h = self.predicted;
        let mut best = (self.solve)(h, None).ok()?;
        let mut last = best.residual();
        let mut slope = self.slope;
        let mut has_stalled = false;
        for _ in 1..TRIALS {
            if best.roundings() <= SOLVED {
                break;
            }
            let y = (-last / self.excess).ln_1p();
            let factor = (-y / slope).exp();
            if !(1.0 / FACTOR..=FACTOR).contains(&factor) {
                return None;
            }
            let before = h;
            h *= factor;
            if h.to_bits() == before.to_bits() {
                break;
            }
            let next = (self.solve)(h, Some(&best)).ok()?;
            if (next.residual() - last).abs() > DISTINCT * f64::EPSILON * next.size() {
                let measured = ((-next.residual() / self.excess).ln_1p() - y) / factor.ln();
                // Past the smallest root the energies fall again.
                if measured.is_nan() || measured <= 0.0 {
                    return None;
                }
                slope = measured.clamp(0.5 * self.order, 2.0 * self.order);
            }
            last = next.residual();
            has_stalled = next.roundings() >= best.roundings();
            if !has_stalled {
                best = next;
            } else if best.roundings() <= 1.0 {
                break;
            }
        }
        let is_root = best.roundings() <= FLOOR || has_stalled && (self.is_rounding)(&best).unwrap_or(false);
        is_root.then_some((best, slope))
    }

    /// φ of a trial, below zero as long as its residual may be a rounding error.
    fn height(&self, trial: &T) -> f64 {
        let height = -trial.residual() / self.excess;
        if trial.roundings() <= self.noise { height.min(-f64::MIN_POSITIVE) } else { height }
    }

    /// The step of the smallest length. `None` if φ stays below zero up to the square of [`Search::ratio`]; this range
    /// separates a step beyond the ratio from no step at all.
    ///
    /// # Errors
    /// [`StepError::StepRatio`], [`StepError::NotConverged`]; the error of a length within the ratio without a
    /// solution.
    #[cold]
    pub(crate) fn smallest(&self) -> Result<Option<T>, StepError> {
        let reach = self.ratio * self.ratio;
        let factor = (reach * reach).powf(1.0 / f64::from(POINTS));
        let mut h = self.last / reach;
        let mut before = (self.solve)(h, None)?;
        if self.height(&before) >= 0.0 {
            return Err(StepError::StepRatio { t: self.t, previous: self.last, found: h });
        }
        let mut earlier = before.clone();
        for _ in 0..POINTS {
            h *= factor;
            let trial = match (self.solve)(h, Some(&before)) {
                Ok(trial) => trial,
                Err(failure) if h <= self.last * self.ratio => return Err(failure),
                Err(_) => break,
            };
            if self.height(&trial) >= 0.0 {
                return self.between(before, trial).map(Some);
            }
            let is_maximum = self.height(&before) > self.height(&earlier) && self.height(&before) > self.height(&trial);
            if is_maximum && let Some(top) = self.top(&earlier, &trial) {
                return self.between(earlier, top).map(Some);
            }
            earlier = before;
            before = trial;
        }
        Ok(None)
    }

    /// A step between two lengths with φ ≥ 0.
    fn top(&self, earlier: &T, later: &T) -> Option<T> {
        let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
        let (mut low, mut high) = (earlier.h(), later.h());
        let solve_near = |other: &T, h: f64| (self.solve)(h, Some(other)).ok();
        let mut left = solve_near(earlier, high - golden * (high - low))?;
        let mut right = solve_near(earlier, low + golden * (high - low))?;
        for _ in 0..SECTIONS {
            if let Some(found) = [&left, &right].into_iter().find(|trial| self.height(trial) >= 0.0) {
                return Some(found.clone());
            }
            if self.height(&left) > self.height(&right) {
                high = right.h();
                right = left;
                left = solve_near(&right, high - golden * (high - low))?;
            } else {
                low = left.h();
                left = right;
                right = solve_near(&left, low + golden * (high - low))?;
            }
        }
        None
    }

    /// The root between two lengths, by bisection.
    fn between(&self, mut low: T, mut high: T) -> Result<T, StepError> {
        let mut best = high.clone();
        let mut residuals = Residuals::new();
        for _ in 0..BISECTIONS {
            let h = (low.h() * high.h()).sqrt();
            if h <= low.h() || h >= high.h() {
                break;
            }
            let middle = (self.solve)(h, Some(&high))?;
            residuals.push(middle.roundings());
            if middle.roundings() < best.roundings() {
                best = middle.clone();
            }
            if self.height(&middle) >= 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        if best.roundings() <= FLOOR || (self.is_rounding)(&best)? {
            return Ok(best);
        }
        let (t, h, residual) = (self.t, best.h(), best.roundings());
        Err(StepError::NotConverged { t, h, iterations: BISECTIONS, residual, residuals, turn: 0.0 })
    }
}
