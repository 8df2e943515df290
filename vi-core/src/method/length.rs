//! Which length a step has: the smallest root of `φ(h) = −residual(h)/excess`, φ(0) = −1.
//!
//! In: a function that solves the step of any length, a predicted length and the last one. Out: the step whose residual is rounding: by secants in ln h,
//!
//! ```text
//! y(h) = ln(1 + φ(h))        ln h ← ln h − y/slope        slope = order + O(h), that of the step before
//! ```
//!
//! else the bracket of the smallest root and bisection. Between two lengths φ can rise above zero and fall again, if the step density is about to vanish: a maximum below
//! zero is followed to its top. Compiled once for each type of a trial, since the function is behind a pointer.

use crate::error::{Residuals, StepError};
use crate::newton::FLOOR;

/// Lengths that secants try.
const TRIALS: u32 = 8;
/// Roundings of the residual at which no better length is looked for.
const SOLVED: f64 = 0.5;
/// Largest factor between two lengths that secants try.
const FACTOR: f64 = 1.5;
/// Roundings by which two residuals differ that tell a slope to three digits.
const TOLD: f64 = 1e4;
/// Lengths at which φ is looked at for a bracket, in geometric progression: 1.15 from one to the next.
const POINTS: u32 = 32;
const BISECTIONS: u32 = 60;
/// Sections of a maximum: each leaves 0.62 of it.
const SECTIONS: u32 = 40;

/// A step of some length.
pub(crate) trait Trial: Clone {
    /// Its length.
    fn h(&self) -> f64;
    /// By how much the length is missed.
    fn residual(&self) -> f64;
    /// The size of what the residual is a sum of.
    fn size(&self) -> f64;
    /// The residual in roundings of that size.
    fn roundings(&self) -> f64 {
        self.residual().abs() / (f64::EPSILON * self.size() + f64::MIN_POSITIVE)
    }
}

/// Solves the step of a length, guessed by that of another length.
pub(crate) type Solve<'a, T> = &'a dyn Fn(f64, Option<&T>) -> Result<T, StepError>;

/// A search for a length.
pub(crate) struct Search<'a, T> {
    /// The step of length h, guessed by that of another length; by the last one where there is none.
    pub(crate) solve: Solve<'a, T>,
    /// Whether the residual of a trial is what its arithmetic loses; an error if such a residual tells no length.
    pub(crate) is_rounding: &'a dyn Fn(&T) -> Result<bool, StepError>,
    pub(crate) t: f64,
    pub(crate) predicted: f64,
    pub(crate) last: f64,
    /// The largest factor between this step and the last one.
    pub(crate) ratio: f64,
    /// The residual of a step of no length.
    pub(crate) excess: f64,
    /// Roundings of a residual that do not count as a change of its sign.
    pub(crate) noise: f64,
    /// Slope of `ln (1 + φ)` over `ln h`, and what it is to leading order.
    pub(crate) slope: f64,
    pub(crate) order: f64,
}

impl<T: Trial> Search<'_, T> {
    /// The step by secants, and the slope there; none where they do not lead to one.
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
            if (next.residual() - last).abs() > TOLD * f64::EPSILON * next.size() {
                let measured = ((-next.residual() / self.excess).ln_1p() - y) / factor.ln();
                // Beyond the smallest root energies fall again.
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

    /// φ of a trial, below zero as long as its residual may be rounding.
    fn height(&self, trial: &T) -> f64 {
        let height = -trial.residual() / self.excess;
        if trial.roundings() <= self.noise { height.min(-f64::MIN_POSITIVE) } else { height }
    }

    /// The step of the smallest length; `None` if φ stays below zero up to the square of [`Search::ratio`], which is wide enough to tell a step beyond that factor from
    /// none.
    ///
    /// # Errors
    /// [`StepError::StepRatio`], [`StepError::NotConverged`]; that of a length within the factor which has no solution.
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

    /// A step between two lengths at which φ is not negative.
    fn top(&self, earlier: &T, later: &T) -> Option<T> {
        let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
        let (mut low, mut high) = (earlier.h(), later.h());
        let beside = |other: &T, h: f64| (self.solve)(h, Some(other)).ok();
        let mut left = beside(earlier, high - golden * (high - low))?;
        let mut right = beside(earlier, low + golden * (high - low))?;
        for _ in 0..SECTIONS {
            if let Some(found) = [&left, &right].into_iter().find(|trial| self.height(trial) >= 0.0) {
                return Some(found.clone());
            }
            if self.height(&left) > self.height(&right) {
                high = right.h();
                right = left;
                left = beside(&right, high - golden * (high - low))?;
            } else {
                low = left.h();
                left = right;
                right = beside(&left, low + golden * (high - low))?;
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
        Err(StepError::NotConverged { t, h, iterations: BISECTIONS, residual, residuals })
    }
}
