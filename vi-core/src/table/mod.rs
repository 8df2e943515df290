//! Functions given by points: piecewise polynomials.
//!
//! A [`Table`] is a function of one number, a [`Grid`] of two; the values of a [`Uniform`] table are parameters. All are
//! computed while compiling, and evaluated in every number type. Their derivatives are those of the polynomials. An
//! [`AnyTable`] is any of them, computed at run time.
//!
//! ```
//! use vi_core::function::Jets;
//! use vi_core::table::Table;
//!
//! static DRAG: Table<5, 4> = Table::cubic([0.0, 10.0, 20.0, 30.0, 40.0], [0.0, 0.1, 0.4, 0.9, 1.6]).extend();
//!
//! let (value, [slope]) = DRAG.jet_1([25.0]);
//! assert!((value - 0.625_f64).abs() < 1e-15 && (slope - 0.05_f64).abs() < 1e-15);
//! ```

#[cfg(feature = "alloc")]
mod any;
mod axis;
mod grid;
mod quintic;
mod slopes;
mod tridiagonal;
mod uniform;

#[cfg(feature = "alloc")]
pub use any::{AnyTable, Interpolation};
pub use axis::Outside;
pub use grid::Grid;
pub use uniform::{Uniform, WithValues};

use crate::function::{Gradient, Hessian, Jets, ThirdDerivatives};
use crate::lagrangian::Undefined;
use crate::real::{Number, Real};
use axis::{Axis, number};
use slopes::Arrays;

/// The interpolation of a table.
#[derive(Clone, Copy, Debug)]
enum TableKind {
    Spline,
    Monotone,
}

/// A function through N points, of pieces with C coefficients.
///
/// The knots must ascend, and all numbers must be finite; otherwise the function is NaN everywhere. Outside of its
/// range it is NaN, unless [`hold`](Table::hold), [`extend`](Table::extend) or `periodic` says otherwise. At the knots
/// it has exactly the given values.
#[derive(Clone, Copy, Debug)]
pub struct Table<const N: usize, const C: usize> {
    axis: Axis<[f64; N]>,
    /// Coefficients of each piece at its left knot, and of the last one at its right knot.
    pieces: [[f64; C]; N],
    kind: TableKind,
}

/// The functions of a table of one argument that concern its range.
macro_rules! ends {
    () => {
        /// Continues the function by its values at the ends. Has no effect on a periodic table.
        #[must_use]
        pub const fn hold(self) -> Self {
            Self { axis: self.axis.continued(Outside::Hold), ..self }
        }

        /// Continues the function by straight lines with the slopes at its ends. Has no effect on a periodic table.
        #[must_use]
        pub const fn extend(self) -> Self {
            Self { axis: self.axis.continued(Outside::Extend), ..self }
        }

        /// Both ends of the range.
        #[must_use]
        pub const fn range(&self) -> [f64; 2] {
            self.axis.range
        }

        /// The reason why the function is NaN at x: x is outside of the range. `function` is its text, as `drag(v)`.
        pub fn undefined<T: Real>(&self, function: &'static str, [x]: [T; 1]) -> Option<Undefined> {
            undefined_along(&self.axis, function, x.to_f64())
        }
    };
}
use ends;

/// The functions of `Jets` of a table of one argument whose pieces have this number of coefficients.
macro_rules! jets {
    ($count:tt) => {
        #[inline]
        fn jet_0(&self, [x]: [T; 1]) -> T {
            self.at(x)
        }

        #[inline]
        fn jet_1(&self, [x]: [T; 1]) -> (T, Gradient<T, 1>) {
            let [value, slope] = derivatives::<_, $count, 2>(self.piece(x));
            (value, [slope])
        }

        #[inline]
        fn jet_2(&self, [x]: [T; 1]) -> (T, Gradient<T, 1>, Hessian<T, 1>) {
            let [value, slope, second] = derivatives::<_, $count, 3>(self.piece(x));
            (value, [slope], [[second]])
        }

        #[inline]
        fn jet_3(&self, [x]: [T; 1]) -> (T, Gradient<T, 1>, Hessian<T, 1>, ThirdDerivatives<T, 1>) {
            let [value, slope, second, third] = derivatives::<_, $count, 4>(self.piece(x));
            (value, [slope], [[second]], [[[third]]])
        }
    };
}
use jets;

impl<const N: usize> Table<N, 2> {
    /// Straight lines between the points.
    #[must_use]
    pub const fn linear(knots: [f64; N], values: [f64; N]) -> Self {
        const { assert!(N >= 2, "a table needs two points") };
        let mut pieces = [[0.0; 2]; N];
        lines(&knots, &values, &mut pieces);
        Self::new(knots, pieces, TableKind::Spline, Outside::Undefined)
    }

    /// Repeats the function beyond both ends. The last value must be the first one.
    #[must_use]
    pub const fn periodic(mut self) -> Self {
        self.axis.outside = Outside::Periodic;
        self
    }
}

impl<const N: usize> Table<N, 4> {
    /// The cubic spline with continuous second derivatives, "not-a-knot" at both ends: it reproduces cubic polynomials.
    /// Three points give their parabola, two their line.
    #[must_use]
    pub const fn cubic(knots: [f64; N], values: [f64; N]) -> Self {
        Self::joined(knots, values, TableKind::Spline, Outside::Undefined)
    }

    /// Cubic pieces with continuous slopes, monotone between monotone values: without overshoot.
    #[must_use]
    pub const fn monotone(knots: [f64; N], values: [f64; N]) -> Self {
        Self::joined(knots, values, TableKind::Monotone, Outside::Undefined)
    }

    /// Repeats the function beyond both ends and joins them as smoothly as its pieces. The last value must be the first
    /// one.
    #[must_use]
    pub const fn periodic(self) -> Self {
        Self::joined(self.axis.knots, self.values(), self.kind, Outside::Periodic)
    }

    const fn joined(knots: [f64; N], values: [f64; N], kind: TableKind, outside: Outside) -> Self {
        const { assert!(N >= 2, "a table needs two points") };
        let mut arrays = Arrays::new(values);
        match kind {
            TableKind::Spline => arrays.buffers().spline(&knots, outside),
            TableKind::Monotone => arrays.buffers().monotone(&knots, outside),
        }
        let mut pieces = [[0.0; 4]; N];
        cubics(&knots, &values, &arrays.slopes, &mut pieces);
        Self::new(knots, pieces, kind, outside)
    }
}

impl<const N: usize> Table<N, 6> {
    /// The quintic spline with continuous fourth derivatives, "not-a-knot" at two knots of both ends: it reproduces
    /// quintic polynomials. Up to six points give the polynomial through them.
    #[must_use]
    pub const fn quintic(knots: [f64; N], values: [f64; N]) -> Self {
        const { assert!(N >= 2, "a table needs two points") };
        Self::new(knots, quintic::pieces(&knots, &values, false), TableKind::Spline, Outside::Undefined)
    }

    /// Repeats the function beyond both ends and joins them with continuous fourth derivatives. The last value must be
    /// the first one.
    #[must_use]
    pub const fn periodic(self) -> Self {
        let knots = self.axis.knots;
        Self::new(knots, quintic::pieces(&knots, &self.values(), true), TableKind::Spline, Outside::Periodic)
    }
}

impl<const N: usize, const C: usize> Table<N, C> {
    const fn new(knots: [f64; N], mut pieces: [[f64; C]; N], kind: TableKind, outside: Outside) -> Self {
        if !ascend(&knots) {
            pieces = [[f64::NAN; C]; N];
        }
        Self { axis: Axis::new(knots, knots[N - 1], outside), pieces, kind }
    }

    /// The values at the knots.
    const fn values(&self) -> [f64; N] {
        let mut values = [0.0; N];
        let mut i = 0;
        while i < N {
            values[i] = self.pieces[i][0];
            i += 1;
        }
        values
    }

    ends!();

    /// The value at x, in the numbers of a function `fn cl<T: Number>(a: T) -> T`. NaN for NaN.
    #[inline]
    pub fn at<T: Number>(&self, x: T) -> T {
        let (u, coefficients) = self.piece(x);
        polynomial::<_, C>(&coefficients, u, 0)
    }

    /// The distance from the base of a piece, and its coefficients.
    #[inline(always)]
    fn piece<T: Number>(&self, x: T) -> (T, [T; 6]) {
        piece(&self.axis, &self.pieces, x)
    }
}

/// The distance from the base of the piece at x, and its coefficients.
#[inline(always)]
fn piece<T: Number, const C: usize>(axis: &Axis<impl AsRef<[f64]>>, pieces: &[[f64; C]], x: T) -> (T, [T; 6]) {
    let [whole, rest, c0, c1, c2, c3, c4, c5] = T::lookup([x], |[x]| constants(axis, pieces, x));
    (distance(axis, x, [whole, rest]), [c0, c1, c2, c3, c4, c5])
}

/// The base of the piece at x, and its coefficients, up to six.
#[inline]
fn constants<const C: usize>(axis: &Axis<impl AsRef<[f64]>>, pieces: &[[f64; C]], x: f64) -> [f64; 8] {
    let segment = axis.segment(x);
    let coefficients = segment.kept(pieces[segment.index]);
    let mut constants = [segment.base[0], segment.base[1], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    for (constant, coefficient) in constants[2..].iter_mut().zip(coefficients) {
        *constant = coefficient;
    }
    constants
}

/// The pieces of straight lines, each at its left knot, and the last one at its right knot.
const fn lines(knots: &[f64], values: &[f64], pieces: &mut [[f64; 2]]) {
    let n = knots.len();
    let mut i = 0;
    while i < n {
        let left = if i == n - 1 { i - 1 } else { i };
        pieces[i] = [values[i], (values[left + 1] - values[left]) / (knots[left + 1] - knots[left])];
        i += 1;
    }
}

/// The cubic pieces with these slopes at the knots, as [`lines`].
const fn cubics(knots: &[f64], values: &[f64], slopes: &[f64], pieces: &mut [[f64; 4]]) {
    let n = knots.len();
    let mut i = 0;
    while i < n {
        let other = if i == n - 1 { i - 1 } else { i + 1 };
        let h = knots[other] - knots[i];
        pieces[i] = slopes::hermite(h, [values[i], slopes[i]], [values[other], slopes[other]]);
        i += 1;
    }
}

impl<T: Real, const N: usize, const C: usize> Jets<T, 1> for Table<N, C> {
    jets!(C);
}

/// A polynomial with C coefficients and its derivatives, in increasing order, at u.
#[inline(always)]
fn derivatives<T: Number, const C: usize, const D: usize>((u, coefficients): (T, [T; 6])) -> [T; D] {
    core::array::from_fn(|order| polynomial::<T, C>(&coefficients, u, order))
}

/// A derivative of the polynomial of the first C coefficients, by Horner's scheme.
#[inline(always)]
fn polynomial<T: Number, const C: usize>(coefficients: &[T], u: T, order: usize) -> T {
    if order >= C {
        return T::zero();
    }
    // k (k − 1) … of the power k.
    let term = |k: usize| {
        let factor = (0..order).fold(1.0, |product, lower| product * number(k - lower));
        if order == 0 { coefficients[k] } else { coefficients[k] * T::real(factor) }
    };
    let mut sum = term(C - 1);
    for k in (order..C - 1).rev() {
        sum = sum * u + term(k);
    }
    sum
}

/// `x − base`, without losing digits to whole periods.
#[inline(always)]
fn distance<T: Number, X>(axis: &Axis<X>, x: T, [whole, rest]: [T; 2]) -> T {
    if axis.is_periodic() { x - whole - rest } else { x - rest }
}

/// Whether finite numbers ascend.
const fn ascend(knots: &[f64]) -> bool {
    let mut i = 1;
    while i < knots.len() {
        // Also false for NaN and for an infinite distance.
        let distance = knots[i] - knots[i - 1];
        if distance <= 0.0 || !distance.is_finite() {
            return false;
        }
        i += 1;
    }
    true
}

/// The failure of a function of an argument outside of the range; `None` for NaN, which has another reason.
fn undefined_along(axis: &Axis<impl AsRef<[f64]>>, function: &'static str, x: f64) -> Option<Undefined> {
    let is_outside = !x.is_nan() && !axis.covers(x);
    is_outside.then_some(Undefined { function, argument: x, range: Some(axis.range) })
}

#[cfg(test)]
mod tests;
