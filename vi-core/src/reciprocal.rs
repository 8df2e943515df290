//! The reciprocal of a determinant, foretold from the last three steps.
//!
//! In: 1/det A of the last steps. Out: that of the next one with an error of the third order in h, before its determinant is
//! there: in a step that waits for the one before, a quotient is a third of the time.
//!
//! ```text
//! next     3 (a − b) + c,  a the newest
//! trusted  |next det − 1| |δ| below a share of one rounding: the Newton step δ is off by that part of itself
//! ```

use crate::Scalar;
use core::hint::black_box;

/// Part of a rounding that a Newton step may be off by.
const SHARE: f64 = 1.0 / 16.0;

/// 1/det A over the last three steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Reciprocal<T> {
    last: [T; 3],
    /// Whether it was good enough since the last lesson.
    foretold: bool,
}

impl<T: Scalar> Reciprocal<T> {
    /// Before the first step, when nothing is trusted.
    pub(crate) fn new() -> Self {
        Self { last: [T::zero(); 3], foretold: false }
    }

    /// The same, each number stored for itself: see the rare path of [`FixedStep::step`](crate::FixedStep::step).
    pub(crate) fn apart(mut self) -> Self {
        self.last = self.last.map(black_box);
        self
    }

    /// Whether the next one is worth a try.
    #[inline]
    pub(crate) fn is_foretold(&self) -> bool {
        self.foretold
    }

    /// The next one.
    #[inline]
    pub(crate) fn next(&self) -> T {
        let [a, b, c] = self.last;
        (a - b) * T::real(3.0) + c
    }

    /// Whether a Newton step of |δ|² = `length` is good, where `product` is the foretold reciprocal times the determinant and
    /// `rounding` is |δ|² of a step that is all rounding.
    #[inline]
    pub(crate) fn is_good(product: T, length: T, rounding: T) -> bool {
        let error = product - T::one();
        error * error * length <= rounding * T::real(SHARE * SHARE)
    }

    /// Tries again.
    pub(crate) fn hope(&mut self) {
        self.foretold = true;
    }

    /// Takes that of the last step, and whether it was good enough there.
    #[inline]
    pub(crate) fn push(&mut self, reciprocal: T, good: bool) {
        let [a, b, _] = self.last;
        self.last = [reciprocal, a, b];
        if !good {
            self.foretold = false;
        }
    }
}
