//! The side of zero on which a function of the motion is at a node.
//!
//! In: a node and a function g. Out: the sign that g has next along the motion, and from which length on. Steps from the node of the lengths
//! δ, 2δ, 4δ, … give g after it; δ is the resolution of time.
//!
//! ```text
//! rounding    Σ |g(x (1 + ε)) − g(x)| over t, q, v
//! zero        |g| ≤ rounding, or g has another sign at δ: it passes zero at this instant
//! side        the sign of g if g is not zero, else that of the first g(2^k δ) beyond its rounding: of the first derivative that is not zero
//! ```
//!
//! THE SIDE DEPENDS ON THE NODE ALONE: two searches that meet at a node agree on it.

use super::events::{Event, Moment};
use super::search::Motion;
use super::times::LONGER;
use crate::error::StepError;

/// Part of a number that rounding may have taken from it: the end of a step is known to a few roundings.
pub(super) const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Part of a step up to which a function is looked at after a node.
const LAST: f64 = 0.125;

/// Lengths of steps from a time that differ by less are one: a run carries its time with twice the digits of a number.
pub(super) fn resolution(t: f64, h: f64) -> f64 {
    f64::EPSILON * f64::EPSILON * t.abs().max(h.abs())
}

/// Where a function is at a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    /// The sign that the function has next; positive if it stays at its rounding.
    pub(super) is_positive: bool,
    /// Length after the node from which on it has that sign.
    pub(super) after: f64,
    /// Whether the function is zero at the node, to its rounding.
    pub(super) is_zero: bool,
    /// Whether the function was on the same side before the node.
    pub(super) is_turned: bool,
    /// The function at the node.
    pub(super) value: f64,
}

/// A node, and the motion shortly after it.
pub(super) struct Node<'a, const N: usize> {
    motion: &'a dyn Motion<N>,
    pub(super) moment: Moment<N>,
    /// Length of a step of the run.
    h: f64,
    /// The difference of two times that are one instant.
    instant: f64,
    /// Ends of the steps of the lengths `instant · 2^k`; none where a step failed.
    ends: Vec<Option<Moment<N>>>,
}

impl<'a, const N: usize> Node<'a, N> {
    pub(super) fn of(motion: &'a dyn Motion<N>) -> Result<Self, StepError> {
        let moment = motion.reached(0.0)?.moment();
        let h = motion.step_length();
        let instant = (ROUNDING * moment.t.abs()).min(LONGER * h.abs()).max(resolution(moment.t, h));
        Ok(Self { motion, moment, h, instant, ends: Vec::new() })
    }

    /// The length of a step after the node.
    fn length(&self, k: usize) -> f64 {
        #[allow(clippy::cast_possible_truncation, clippy::cast_possible_wrap)]
        let factor = 2.0_f64.powi(k as i32);
        self.instant * factor
    }

    /// The end of that step.
    fn end(&mut self, k: usize) -> Option<Moment<N>> {
        while self.ends.len() <= k {
            let length = self.length(self.ends.len()).copysign(self.h);
            self.ends.push(self.motion.reached(length).ok().map(|reached| reached.moment()));
        }
        self.ends[k]
    }

    /// On which side of zero a function is.
    ///
    /// # Errors
    /// [`StepError::NonFinite`] if it is not finite at the node.
    pub(super) fn side(&mut self, event: &Event<N>) -> Result<Side, StepError> {
        let value = event.value(&self.moment)?;
        let mut side = Side { is_positive: value >= 0.0, after: 0.0, is_zero: false, is_turned: false, value };
        let next = self.end(0).map_or(value, |end| event.at(&end));
        let passes = next.is_finite() && (next >= 0.0) != side.is_positive;
        if !passes && value.abs() > event.rounding(&self.moment, value) {
            return Ok(side);
        }
        side = Side { is_positive: true, is_zero: true, ..side };
        let last = LAST * self.h.abs();
        for k in 0.. {
            side.after = self.length(k);
            let Some(end) = self.end(k).filter(|_| side.after <= last) else { break };
            let later = event.at(&end);
            if !later.is_finite() {
                break;
            }
            if later.abs() > event.rounding(&end, later) {
                side.is_positive = later > 0.0;
                let before = event.at(&self.before(&end, side.after));
                side.is_turned = before.is_finite() && before != 0.0 && (before > 0.0) == side.is_positive;
                break;
            }
        }
        Ok(side)
    }

    /// The motion as long before the node as `after` is after it, to the second order.
    fn before(&self, after: &Moment<N>, length: f64) -> Moment<N> {
        let Moment { t, v, .. } = self.moment;
        let passed = length.copysign(self.h);
        Moment { t: t - passed, q: after.q - v * (2.0 * passed), v: v * 2.0 - after.v }
    }
}
