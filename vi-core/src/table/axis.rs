//! The knots of an argument, and the piece to which a value of it belongs.

#[cfg(feature = "alloc")]
use alloc::vec::Vec;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// The continuation of a table outside of its range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outside {
    /// NaN: a run reports that the argument has left the range.
    Undefined,
    /// The value at the end of the range.
    Hold,
    /// The straight line with the slope at the end of the range.
    Extend,
    /// The range again: its length is the period.
    Periodic,
}

/// Ascending knots: an array, or a list of any length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis<X> {
    pub(super) knots: X,
    /// Both ends of the range.
    pub(super) range: [f64; 2],
    /// Inverse distance of the knots if all are near equal distances, otherwise 0.
    inverse: f64,
    pub(super) outside: Outside,
    /// The period as a sum: 26 bits, 27 bits, and the rounding error of `to − from`.
    period: [f64; 3],
}

/// The segment between two knots, on which functions are polynomials in `u = x − base[0] − base[1]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    /// Index of the last knot that is not above x; 0 below all of them.
    pub(super) index: usize,
    /// The whole periods before x, and the knot with the rest of them. The first is 0 in the range itself.
    pub(super) base: [f64; 2],
    /// Number of coefficients that hold at x.
    pub(super) kept: usize,
}

impl<const N: usize> Axis<[f64; N]> {
    /// The axis of these knots, up to `to`.
    pub(super) const fn new(knots: [f64; N], to: f64, outside: Outside) -> Self {
        let Axis { range, inverse, period, .. } = Axis::measured(&knots, to, outside);
        Self { knots, range, inverse, outside, period }
    }
}

impl<'a> Axis<&'a [f64]> {
    /// The axis of a list of knots.
    pub(super) const fn measured(knots: &'a [f64], to: f64, outside: Outside) -> Self {
        let from = knots[0];
        let length = to - from;
        // The rounding error of a difference (Knuth).
        let of_from = to - length;
        let low = (of_from - from) + (to - (length + of_from));
        // The upper half of the digits (Veltkamp), times a whole number below 2²⁷ is exact.
        let wide = length * 134_217_729.0;
        let high = wide - (wide - length);
        Self { knots, range: [from, to], inverse: inverse(knots), outside, period: [high, length - high, low] }
    }
}

#[cfg(feature = "alloc")]
impl Axis<&[f64]> {
    /// The axis with a copy of its knots.
    pub(super) fn owned(&self) -> Axis<Vec<f64>> {
        let Self { range, inverse, outside, period, .. } = *self;
        Axis { knots: self.knots.to_vec(), range, inverse, outside, period }
    }
}

impl<X> Axis<X> {
    /// Whether the argument is periodic.
    pub(super) const fn is_periodic(&self) -> bool {
        matches!(self.outside, Outside::Periodic)
    }
}

impl<X: Copy> Axis<X> {
    /// The axis with another continuation beyond both ends; a periodic one stays.
    pub(super) const fn continued(mut self, outside: Outside) -> Self {
        if !self.is_periodic() {
            self.outside = outside;
        }
        self
    }
}

impl<X: AsRef<[f64]>> Axis<X> {
    /// Whether a function is defined at x.
    pub(super) fn covers(&self, x: f64) -> bool {
        let [from, to] = self.range;
        self.outside != Outside::Undefined || from <= x && x <= to
    }

    /// The segment at x.
    #[inline]
    pub(super) fn segment(&self, x: f64) -> Segment {
        let [from, to] = self.range;
        let knots = self.knots.as_ref();
        if self.is_periodic() {
            let [high, middle, low] = self.period;
            let turns = ((x - from) / (to - from)).floor();
            let (whole, rest) = (turns * high, turns * low);
            let index = self.index(x - whole - (turns * middle + rest));
            return Segment { index, base: [whole, turns * middle + (rest + knots[index])], kept: usize::MAX };
        }
        let index = self.index(x);
        // NaN belongs to the first segment, which is NaN there.
        let kept = match self.outside {
            _ if !(x < from || x > to) => usize::MAX,
            Outside::Hold => 1,
            Outside::Extend => 2,
            Outside::Undefined | Outside::Periodic => 0,
        };
        Segment { index, base: [0.0, knots[index]], kept }
    }

    /// Index of the last knot that is not above x; 0 below all of them and for NaN.
    #[inline]
    fn index(&self, x: f64) -> usize {
        let knots = self.knots.as_ref();
        if self.inverse == 0.0 {
            return knots.partition_point(|knot| *knot <= x).saturating_sub(1);
        }
        // Near equal distances this index is off by at most one. The cast is 0 below the range and for NaN.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let guess = (((x - knots[0]) * self.inverse) as usize).min(knots.len() - 1);
        if x < knots[guess] {
            guess.saturating_sub(1)
        } else if guess + 1 < knots.len() && knots[guess + 1] <= x {
            guess + 1
        } else {
            guess
        }
    }
}

impl Segment {
    /// The coefficients that hold at x; NaN for an x outside of the range of a function that is undefined there.
    #[inline]
    pub(super) fn kept<const C: usize>(&self, coefficients: [f64; C]) -> [f64; C] {
        let mut kept = coefficients;
        for (k, coefficient) in kept.iter_mut().enumerate() {
            if self.kept == 0 {
                *coefficient = f64::NAN;
            } else if k >= self.kept {
                *coefficient = 0.0;
            }
        }
        kept
    }
}

/// Inverse mean distance of knots that are within a sixteenth of it of equal distances, otherwise 0.
const fn inverse(knots: &[f64]) -> f64 {
    let last = knots.len() - 1;
    if last == 0 {
        return 0.0;
    }
    let distance = (knots[last] - knots[0]) / number(last);
    let mut i = 0;
    while i <= last {
        let off = knots[i] - (knots[0] + number(i) * distance);
        if !(-distance <= 16.0 * off && 16.0 * off <= distance) {
            return 0.0;
        }
        i += 1;
    }
    let inverse = 1.0 / distance;
    if inverse.is_finite() { inverse } else { 0.0 }
}

/// An index as a number.
#[allow(clippy::cast_precision_loss)]
pub(super) const fn number(index: usize) -> f64 {
    index as f64
}
