//! The length of the next step, where the lengths before tell it nearly.
//!
//! In: the node and its excess `H − E`. Out: the step whose energy is E to rounding, by secants in ln h:
//!
//! ```text
//! y(h) = ln[(H − E0(h))/(H − E)]        ln h ← ln h − y/slope        slope = 2s + O(h), that of the step before
//! ```
//!
//! where y = 0 is the root. Two or three lengths are tried, each from the stages of the one before.

use super::stepper::Stepper;
use super::trial::Trial;
use crate::newton::FLOOR;

/// Lengths that are tried.
const TRIALS: u32 = 8;
/// Roundings of the energy at which no better length is looked for.
const SOLVED: f64 = 0.5;
/// Largest factor between two lengths that are tried.
const FACTOR: f64 = 1.5;
/// Roundings by which two energies differ that tell a slope to three digits.
const TOLD: f64 = 1e4;

impl<const N: usize, const S: usize> Stepper<'_, N, S> {
    /// The order, which is the slope of `ln (H − E0)` over ln h to leading order.
    #[allow(clippy::cast_precision_loss)]
    pub(super) const SLOPE: f64 = 2.0 * S as f64;

    /// The next step; none where secants do not lead to one.
    pub(super) fn root(&mut self) -> Option<Trial<N, S>> {
        let mut h = self.course.predicted_length();
        let mut best = self.trial_of(h).ok()?;
        let mut last = best.residual;
        let mut slope = self.course.slope;
        let mut sweeps = best.after.convergence.sweeps;
        let mut has_stalled = false;
        for _ in 1..TRIALS {
            if best.roundings() <= SOLVED {
                break;
            }
            let y = (-last / self.course.excess).ln_1p();
            let factor = (-y / slope).exp();
            if !(1.0 / FACTOR..=FACTOR).contains(&factor) {
                return None;
            }
            let before = h;
            h *= factor;
            if h.to_bits() == before.to_bits() {
                break;
            }
            let next = self.trial(h, best.stages_for(h)).ok()?;
            if (next.residual - last).abs() > TOLD * f64::EPSILON * next.size {
                let measured = ((-next.residual / self.course.excess).ln_1p() - y) / factor.ln();
                // Beyond the smallest root energies fall again.
                if measured.is_nan() || measured <= 0.0 {
                    return None;
                }
                slope = measured.clamp(0.5 * Self::SLOPE, 2.0 * Self::SLOPE);
            }
            sweeps += next.after.convergence.sweeps;
            last = next.residual;
            has_stalled = next.roundings() >= best.roundings();
            if !has_stalled {
                best = next;
            } else if best.roundings() <= 1.0 {
                break;
            }
        }
        best.after.convergence.sweeps = sweeps;
        let is_root = best.roundings() <= FLOOR || has_stalled && self.is_preserved(&best).unwrap_or(false);
        if is_root {
            self.course.slope = slope;
        }
        is_root.then_some(best)
    }
}
