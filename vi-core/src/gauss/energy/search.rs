//! The smallest length of the next step, where secants have not found one.
//!
//! In: the node and its excess `H − E`. Out: the root of `φ(h) = (E − E0(h))/(H − E)` with the smallest h > 0; or why there is none. Since
//!
//! ```text
//! φ(0) = −1        φ(h) = C_s h^2s D_s/(H − E) − 1 to leading order,
//! ```
//!
//! the step is where φ first becomes positive. Between two lengths that are looked at it can rise above zero and fall again, where D_s is
//! about to vanish: a maximum below zero is followed to its top.

use super::stepper::Stepper;
use super::trial::Trial;
use crate::energy_preserving::interval::RATIO;
use crate::error::{Residuals, StepError};
use crate::newton::FLOOR;

/// φ is looked at from `h_last/REACH` to `REACH · h_last`: wide enough to tell a step beyond the factor from none.
const REACH: f64 = RATIO * RATIO;
/// Lengths at which φ is looked at, in geometric progression: 1.15 from one to the next.
const POINTS: u32 = 32;
const BISECTIONS: u32 = 60;
/// Sections of a maximum: each leaves 0.62 of it.
const SECTIONS: u32 = 40;

impl<const N: usize, const S: usize> Stepper<'_, N, S> {
    /// φ; see the [module](self).
    fn height(&self, trial: &Trial<N, S>) -> f64 {
        -trial.residual / self.course.excess
    }

    /// The step with the smallest length.
    ///
    /// # Errors
    /// [`StepError::NoForwardGaussStep`], [`StepError::StepRatio`], [`StepError::DegenerateStep`], [`StepError::NotConverged`]; those of
    /// [`Gauss::step`](crate::Gauss::step) where the stages have no solution at a length that is allowed.
    #[cold]
    pub(super) fn smallest_root(&mut self) -> Result<Trial<N, S>, StepError> {
        let t = self.gauss.run().node.t;
        let last = self.course.h();
        let factor = (REACH * REACH).powf(1.0 / f64::from(POINTS));
        let mut h = last / REACH;
        let mut before = self.trial_of(h)?;
        if self.height(&before) >= 0.0 {
            return Err(StepError::StepRatio { t, previous: last, found: h });
        }
        let mut earlier = before;
        for _ in 0..POINTS {
            h *= factor;
            let trial = match self.trial(h, before.stages_for(h)) {
                Ok(trial) => trial,
                Err(failure) if h <= last * RATIO => return Err(failure),
                Err(_) => break,
            };
            if self.height(&trial) >= 0.0 {
                return self.between(before, trial);
            }
            let is_maximum = self.height(&before) > self.height(&earlier) && self.height(&before) > self.height(&trial);
            if is_maximum && let Some(top) = self.top(earlier, trial) {
                return self.between(earlier, top);
            }
            earlier = before;
            before = trial;
        }
        Err(self.no_step())
    }

    /// A step between two lengths at which φ is not negative, by golden sections towards its maximum; none where it is negative there.
    fn top(&mut self, earlier: Trial<N, S>, later: Trial<N, S>) -> Option<Trial<N, S>> {
        let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
        let mut low = earlier.h();
        let mut high = later.h();
        let mut left = self.trial_beside(&earlier, high - golden * (high - low))?;
        let mut right = self.trial_beside(&earlier, low + golden * (high - low))?;
        for _ in 0..SECTIONS {
            if let Some(found) = [left, right].into_iter().find(|trial| self.height(trial) >= 0.0) {
                return Some(found);
            }
            if self.height(&left) > self.height(&right) {
                high = right.h();
                right = left;
                left = self.trial_beside(&right, high - golden * (high - low))?;
            } else {
                low = left.h();
                left = right;
                right = self.trial_beside(&left, low + golden * (high - low))?;
            }
        }
        None
    }

    /// The step of length h, from the stages of another.
    fn trial_beside(&mut self, other: &Trial<N, S>, h: f64) -> Option<Trial<N, S>> {
        self.trial(h, other.stages_for(h)).ok()
    }

    /// The root between two lengths, by bisection to the rounding of the energy.
    fn between(&mut self, mut low: Trial<N, S>, mut high: Trial<N, S>) -> Result<Trial<N, S>, StepError> {
        let mut best = high;
        let mut residuals = Residuals::new();
        for _ in 0..BISECTIONS {
            let h = (low.h() * high.h()).sqrt();
            if h <= low.h() || h >= high.h() {
                break;
            }
            let middle = self.trial(h, high.stages_for(h))?;
            residuals.push(middle.roundings());
            if middle.roundings() < best.roundings() {
                best = middle;
            }
            if self.height(&middle) >= 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        if best.roundings() <= FLOOR || self.is_preserved(&best)? {
            return Ok(best);
        }
        let t = self.gauss.run().node.t;
        let h = best.h();
        let residual = best.roundings();
        Err(StepError::NotConverged { t, h, iterations: BISECTIONS, residual, residuals })
    }

    /// The error where no step leads forward.
    pub(super) fn no_step(&self) -> StepError {
        let course = &self.course;
        let state = self.gauss.run().node.state();
        let density = self.gauss.step_density(&state).unwrap_or_else(|_| course.told_density::<S>() - course.shift);
        StepError::NoForwardGaussStep {
            t: state.t,
            h: course.h(),
            stages: S,
            excess: course.excess,
            density,
            shift: course.shift,
            largest: course.largest.max(density.abs()),
        }
    }
}
