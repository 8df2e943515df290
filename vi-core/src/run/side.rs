//! The sign of an event function just after a node, its side.
//!
//! This module finds the next sign of a function g after a node, and the length from which it holds. It evaluates g at
//! the ends of steps of the lengths δ, 2δ, 4δ, … from the node; δ is the time resolution.
//!
//! ```text
//! rounding    Σ |g(x (1 + ε)) − g(x)| over t, q, v
//! zero        |g| ≤ rounding, or g has another sign at δ: it passes zero at this instant
//! side        the sign of g if g is not zero, otherwise that of the first g(2^k δ) beyond its rounding: of the first nonzero derivative
//! ```
//!
//! The side depends on the node alone, so that two searches that meet at a node agree on it.

use super::event::{Event, Moment, ROUNDING};
use super::reached::ErasedRun;
use super::times::LONGER;
use crate::error::StepError;
use alloc::vec::Vec;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Fraction of a step up to which the search for a side extends.
const LAST: f64 = 0.125;

/// The time resolution. Step lengths that differ by less count as equal; a run carries its time with twice the digits
/// of a number.
pub(super) fn resolution(t: f64, h: f64) -> f64 {
    f64::EPSILON * f64::EPSILON * t.abs().max(h.abs())
}

/// The side of a function at a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    /// Whether the function is positive next. True if it stays within its rounding error.
    pub(super) is_positive: bool,
    /// Length after the node from which it has that sign.
    pub(super) after: f64,
    /// Whether the function is zero at the node, to rounding.
    pub(super) is_zero: bool,
    /// Whether the function was on the same side before the node.
    pub(super) is_turned: bool,
    /// The function at the node.
    pub(super) value: f64,
}

/// A node, and the moments shortly after it.
pub(super) struct NodeAndAfter<'a, const N: usize> {
    motion: &'a dyn ErasedRun<N>,
    pub(super) moment: Moment<N>,
    /// Length of a step of the run.
    h: f64,
    /// Largest difference of two times of one instant.
    instant: f64,
    /// Ends of the steps of the lengths `instant · 2^k`; `None` for a failed step.
    ends: Vec<Option<Moment<N>>>,
}

impl<'a, const N: usize> NodeAndAfter<'a, N> {
    pub(super) fn of(motion: &'a dyn ErasedRun<N>) -> Result<Self, StepError> {
        let moment = motion.reached(0.0)?.moment();
        let h = motion.step_length();
        let instant = (ROUNDING * moment.t.abs()).min(LONGER * h.abs()).max(resolution(moment.t, h));
        Ok(Self { motion, moment, h, instant, ends: Vec::new() })
    }

    /// The k-th length.
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

    /// The side of a function.
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

    /// The moment mirrored to the time before the node, to second order.
    fn before(&self, after: &Moment<N>, length: f64) -> Moment<N> {
        let Moment { t, v, .. } = self.moment;
        let passed = length.copysign(self.h);
        Moment { t: t - passed, q: after.q - v * (2.0 * passed), v: v * 2.0 - after.v }
    }
}
