//! A table at equal distances whose values are parameters.

use super::axis::{Axis, Outside, number};
use super::slopes::{Arrays, Buffers};
use super::{ascend, derivatives, distance, ends, jets, polynomial, slopes, tridiagonal, undefined_along};
use crate::function::{Gradient, Hessian, Jets, ThirdDerivatives};
use crate::lagrangian::Undefined;
use crate::real::{Number, Real};

/// A function of one number through N values at equal distances, which are given when it is evaluated.
///
/// It is linear in the values: a sum of N *cardinal functions*, each 1 at its own knot and 0 at the others. Evaluation
/// takes O(N).
///
/// ```
/// use vi_core::function::Jets;
/// use vi_core::table::Uniform;
///
/// static LIFT: Uniform<4> = Uniform::cubic(0.0, 3.0);
/// let (value, [slope]) = LIFT.of(&[0.0, 1.0, 8.0, 27.0]).jet_1([0.5]);
/// assert!((value - 0.125_f64).abs() < 1e-14 && (slope - 0.75_f64).abs() < 1e-14);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Uniform<const N: usize> {
    axis: Axis<[f64; N]>,
    /// For each knot, the slopes of all cardinal functions; `None` for straight lines.
    slopes: Option<[[f64; N]; N]>,
    /// Whether the range is not finite or does not ascend.
    is_invalid: bool,
}

impl<const N: usize> Uniform<N> {
    /// The cubic spline with continuous second derivatives, "not-a-knot" at both ends, of values at N equal distances
    /// of a range, ends included.
    #[must_use]
    pub const fn cubic(from: f64, to: f64) -> Self {
        let mut table = Self::linear(from, to);
        let mut by_knot = [[0.0; N]; N];
        let mut arrays = Arrays::new([0.0; N]);
        cardinal_slopes(&table.axis.knots, by_knot.as_flattened_mut(), &mut arrays.buffers());
        table.slopes = Some(by_knot);
        table
    }

    /// Straight lines between values at N equal distances of a range, ends included.
    #[must_use]
    pub const fn linear(from: f64, to: f64) -> Self {
        const { assert!(N >= 2, "a table needs two points") };
        let mut knots = [from; N];
        spread([from, to], N - 1, &mut knots);
        knots[N - 1] = to;
        Self { axis: Axis::new(knots, to, Outside::Undefined), slopes: None, is_invalid: !ascend(&knots) }
    }

    /// Repeats the function beyond both ends. The knots are at `from + k (to − from)/N`, so that no value is given
    /// twice: the first one is the one at `to` too.
    #[must_use]
    pub const fn periodic(self) -> Self {
        let [from, to] = self.axis.range;
        let mut knots = [from; N];
        spread([from, to], N, &mut knots);
        let mut slopes = self.slopes;
        if slopes.is_some() {
            let mut by_knot = [[0.0; N]; N];
            let mut arrays = Arrays::new([0.0; N]);
            periodic_slopes([from, to], by_knot.as_flattened_mut(), &mut arrays.buffers());
            slopes = Some(by_knot);
        }
        Self { axis: Axis::new(knots, to, Outside::Periodic), slopes, is_invalid: self.is_invalid }
    }

    ends!();

    /// The function with these values at its knots.
    #[inline]
    pub fn of<'a, T>(&'a self, values: &'a [T; N]) -> WithValues<'a, T, N> {
        WithValues { table: self, values }
    }
}

/// Sets knots at these parts of a range.
pub(super) const fn spread([from, to]: [f64; 2], parts: usize, knots: &mut [f64]) {
    knots[0] = from;
    let mut i = 1;
    while i < knots.len() {
        knots[i] = from + (to - from) * (number(i) / number(parts));
        i += 1;
    }
}

/// The slopes of all cardinal functions at each knot, row by row.
pub(super) const fn cardinal_slopes(knots: &[f64], slopes: &mut [f64], buffers: &mut Buffers) {
    let n = knots.len();
    let mut j = 0;
    while j < n {
        let mut i = 0;
        while i < n {
            buffers.values[i] = if i == j { 1.0 } else { 0.0 };
            i += 1;
        }
        buffers.spline(knots, Outside::Undefined);
        i = 0;
        while i < n {
            slopes[i * n + j] = buffers.slopes[i];
            i += 1;
        }
        j += 1;
    }
}

/// The slopes of all cardinal functions of a periodic table at each knot, row by row. The number of knots is that of
/// the buffers.
pub(super) const fn periodic_slopes([from, to]: [f64; 2], slopes: &mut [f64], buffers: &mut Buffers) {
    let n = buffers.values.len();
    let per_distance = 3.0 * number(n) / (to - from);
    let mut j = 0;
    while j < n {
        let mut i = 0;
        while i < n {
            buffers.rows[i] = [1.0, 4.0, 1.0, 0.0];
            i += 1;
        }
        buffers.rows[(j + n - 1) % n][3] += per_distance;
        buffers.rows[(j + 1) % n][3] -= per_distance;
        tridiagonal::solve(buffers.rows, n, buffers.slopes, buffers.others);
        i = 0;
        while i < n {
            slopes[i * n + j] = buffers.slopes[i];
            i += 1;
        }
        j += 1;
    }
}

/// The base of the piece at x, and the coefficients of the cardinal function j there; `slopes` are those of all cardinal
/// functions at each knot, none of straight lines.
#[inline]
fn constants(axis: &Axis<impl AsRef<[f64]>>, slopes: Option<&[f64]>, is_invalid: bool, x: f64, j: usize) -> [f64; 6] {
    let (segment, knots) = (axis.segment(x), axis.knots.as_ref());
    let (i, n) = (segment.index, knots.len());
    // The last knot is at the end of the range, unless the table is periodic.
    let (other, h) = if i + 1 < n {
        (i + 1, knots[i + 1] - knots[i])
    } else if axis.is_periodic() {
        (0, axis.range[1] - knots[i])
    } else {
        (i - 1, knots[i - 1] - knots[i])
    };
    let cardinal = |knot: usize| if knot == j { 1.0 } else { 0.0 };
    let coefficients = match slopes {
        Some(slopes) => slopes::hermite(h, [cardinal(i), slopes[i * n + j]], [cardinal(other), slopes[other * n + j]]),
        None => [cardinal(i), (cardinal(other) - cardinal(i)) / h, 0.0, 0.0],
    };
    let coefficients = if is_invalid { [f64::NAN; 4] } else { segment.kept(coefficients) };
    let [c0, c1, c2, c3] = coefficients;
    [segment.base[0], segment.base[1], c0, c1, c2, c3]
}

/// The distance from the base of a piece, and its coefficients: those of the cardinal functions times the values.
#[inline(always)]
pub(super) fn piece<T: Number>(
    axis: &Axis<impl AsRef<[f64]>>,
    (slopes, is_invalid): (Option<&[f64]>, bool),
    x: T,
    values: &[T],
) -> (T, [T; 6]) {
    let mut coefficients = [T::zero(); 6];
    let mut base = [T::zero(); 2];
    for (j, value) in values.iter().enumerate() {
        let [whole, rest, c0, c1, c2, c3] = T::lookup([x], |[x]| constants(axis, slopes, is_invalid, x, j));
        base = [whole, rest];
        for (sum, cardinal) in coefficients.iter_mut().zip([c0, c1, c2, c3]) {
            *sum += *value * cardinal;
        }
    }
    (distance(axis, x, base), coefficients)
}

/// A [`Uniform`] table with the values at its knots.
#[derive(Clone, Copy, Debug)]
pub struct WithValues<'a, T, const N: usize> {
    table: &'a Uniform<N>,
    values: &'a [T; N],
}

impl<T: Number, const N: usize> WithValues<'_, T, N> {
    /// The value at x. NaN for NaN.
    #[inline]
    pub fn at(&self, x: T) -> T {
        let (u, coefficients) = self.piece(x);
        polynomial::<_, 4>(&coefficients, u, 0)
    }

    #[inline(always)]
    fn piece(&self, x: T) -> (T, [T; 6]) {
        let Uniform { axis, slopes, is_invalid } = self.table;
        piece(axis, (slopes.as_ref().map(|of| of.as_flattened()), *is_invalid), x, self.values)
    }
}

impl<T: Real, const N: usize> Jets<T, 1> for WithValues<'_, T, N> {
    jets!(4);
}
