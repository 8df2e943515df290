//! Numbers that carry a rounding-error bound: running error analysis.
//!
//! A formula generic over [`Real`] returns its value, with `Running<true>` the same bits as in `f64`, and a bound of its
//! rounding error. With `z = x ∘ y`,
//!
//! ```text
//! e(x ± y) = e(x) + e(y) + |z|          e(x y) = |x| e(y) + |y| e(x) + |z|          e(f(x)) = |f'(x)| e(x) + 2 |z|
//! ```
//!
//! so that cancellation inside a formula stays in the bound: a residual below it is zero to rounding. Library functions
//! are assumed accurate to an ulp.
//!
//! | | [`Rounded`], for steppers | `Running<true>`, for checks |
//! |---|---|---|
//! | bound | of first order: slopes at the value | rigorous: the largest slopes within the errors of the operands |
//! | kinks, jumps and limits | on the side of the value | as far as the values on both sides, if the errors reach both |
//! | one rounding | half an ulp | an ulp, the error of an operation of two roundings |
//! | constants of formulas | exact | rounded, unless they are exact fractions |
//!
//! Each operation is a call, which keeps the compiled formulas of a system small: the type is for cold paths.
//!
//! Source: Higham, Accuracy and Stability of Numerical Algorithms, section 3.3.

use super::{Number, Real};
use crate::vector::worse;
use core::f64::consts::TAU;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number with a rounding-error bound, by running error analysis (Higham, Accuracy and Stability of Numerical
/// Algorithms, section 3.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Running<const RIGOROUS: bool> {
    pub(crate) value: f64,
    /// The bound: absolute if it is rigorous, otherwise in units of half an ulp of 1. Not negative; infinite or NaN if
    /// there is no bound.
    pub(crate) error: f64,
}

/// A number with a bound of first order.
pub type Rounded = Running<false>;

impl Rounded {
    /// The rounding-error bound, in units of half an ulp of 1.
    #[must_use]
    pub fn error(self) -> f64 {
        self.error
    }

    /// The rounding-error bound, in ulps of 1: times ε it is one rounding of a residual.
    #[must_use]
    pub fn ulps(self) -> f64 {
        0.5 * self.error
    }
}

impl<const RIGOROUS: bool> Running<RIGOROUS> {
    /// The unit of a bound.
    const UNIT: f64 = if RIGOROUS { 1.0 } else { 0.5 * f64::EPSILON };
    /// One rounding of 1, in this unit.
    const ROUNDING: f64 = if RIGOROUS { f64::EPSILON } else { 1.0 };

    /// An exact number.
    #[must_use]
    pub fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// The nearest representable number to an exact one.
    #[must_use]
    pub fn nearest(value: f64) -> Self {
        Self { value, error: Self::ROUNDING * value.abs() }
    }

    /// The result of an operation whose operands contribute the error `carried`.
    fn rounding(value: f64, carried: f64, roundings: f64) -> Self {
        // Subnormal numbers have the rounding error of the smallest normal one. A rigorous zero stays exact.
        let smallest = if RIGOROUS { 0.0 } else { f64::MIN_POSITIVE };
        Self { value, error: carried + roundings * Self::ROUNDING * value.abs() + smallest }
    }

    /// What an operand with an error contributes: 0 if it is exact, even if the slope is infinite. To first order also 0
    /// if the slope is 0, even if the error is infinite.
    fn product(slope: f64, error: f64) -> f64 {
        if error == 0.0 || !RIGOROUS && slope == 0.0 { 0.0 } else { slope * error }
    }

    /// A library function with this slope.
    #[inline(never)]
    fn function(self, value: f64, slope: f64) -> Self {
        Self::rounding(value, Self::product(slope.abs(), self.error), 2.0)
    }

    /// The number within the error that is nearest to zero, without its sign; of first order, the value.
    fn least(self) -> f64 {
        if RIGOROUS { (self.value.abs() - self.error).max(0.0) } else { self.value }
    }

    /// The number within the error that is farthest from zero, without its sign; of first order, the value.
    pub(crate) fn most(self) -> f64 {
        if RIGOROUS { self.value.abs() + self.error } else { self.value }
    }

    /// Whether the number is nonzero beyond its error.
    pub(crate) fn is_seen(self) -> bool {
        self.value.abs() > Self::UNIT * self.error
    }

    /// Whether all numbers within the error count as having the sign of the value.
    fn has_sign(self) -> bool {
        !RIGOROUS || self.error == 0.0 || self.is_seen()
    }

    /// Sine and cosine. The bound of first order is NaN for an angle with a large error: otherwise the residual of
    /// diverged stages would count as rounding.
    #[inline(always)]
    fn rotated(self) -> (Self, Self) {
        if RIGOROUS {
            let (sine, cosine) = Number::sin_cos(self.value);
            // The reduced angle is rounded at a distance from zero.
            let (error, reduced) = (self.error.min(2.0), f64::EPSILON * f64::EPSILON * self.value.abs());
            let bound = |value: f64, slope: f64| Self::rounding(value, (slope.abs() + error) * error + reduced, 2.0);
            return (bound(sine, cosine), bound(cosine, sine));
        }
        if Self::UNIT * self.error > HARDLY_KNOWN {
            return [self.value.sin(), self.value.cos()].map(|value| Self { value, error: f64::NAN }).into();
        }
        let (sine, cosine) = self.value.sin_cos();
        (self.function(sine, cosine), self.function(cosine, sine))
    }

    /// The slope of arc sine, and of arc cosine without its sign.
    fn arc_slope(self) -> f64 {
        let sine = if RIGOROUS { self.most().min(1.0) } else { self.value };
        (1.0 - sine * sine).sqrt().recip()
    }
}

/// Largest error of an angle, in radians, for which its sine keeps most of its digits.
const HARDLY_KNOWN: f64 = 1e-6;
/// A constant is an exact fraction if it is at most this number, and a multiple of its inverse.
const EXACT: f64 = 1_048_576.0;

impl<const RIGOROUS: bool> Add for Running<RIGOROUS> {
    type Output = Self;
    #[inline(never)]
    fn add(self, other: Self) -> Self {
        // The sum with zero is exact.
        let is_exact = RIGOROUS && (self.value == 0.0 || other.value == 0.0);
        Self::rounding(self.value + other.value, self.error + other.error, if is_exact { 0.0 } else { 1.0 })
    }
}

impl<const RIGOROUS: bool> Sub for Running<RIGOROUS> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const RIGOROUS: bool> Mul for Running<RIGOROUS> {
    type Output = Self;
    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        let carried = Self::product(self.value.abs(), other.error) + Self::product(other.most().abs(), self.error);
        Self::rounding(self.value * other.value, carried, 1.0)
    }
}

impl<const RIGOROUS: bool> Div for Running<RIGOROUS> {
    type Output = Self;
    #[inline(never)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let carried = (self.error + Self::product(value.abs(), other.error)) / other.least().abs();
        Self::rounding(value, carried, 1.0)
    }
}

impl<const RIGOROUS: bool> Neg for Running<RIGOROUS> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, error: self.error }
    }
}

assignments!(Running<RIGOROUS>, const RIGOROUS: bool);

impl<const RIGOROUS: bool> num_traits::Zero for Running<RIGOROUS> {
    fn zero() -> Self {
        Self::exact(0.0)
    }
    fn is_zero(&self) -> bool {
        self.value == 0.0 && (!RIGOROUS || self.error == 0.0)
    }
}

impl<const RIGOROUS: bool> num_traits::One for Running<RIGOROUS> {
    fn one() -> Self {
        Self::exact(1.0)
    }
}

impl<const RIGOROUS: bool> Number for Running<RIGOROUS> {
    fn real(value: f64) -> Self {
        let is_exact = !RIGOROUS || value.abs() <= EXACT && value * EXACT % 1.0 == 0.0;
        if is_exact { Self::exact(value) } else { Self::nearest(value) }
    }
    fn recip(self) -> Self {
        Self::exact(1.0) / self
    }
    /// The slope is infinite at zero, but the change is finite: `√(x + e) − √x = e/(√(x + e) + √x)`.
    #[inline(never)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        if RIGOROUS && root != 0.0 {
            return self.function(root, root.recip());
        }
        if RIGOROUS {
            return Self { value: root, error: self.error.sqrt() };
        }
        let farthest = (self.value + Self::UNIT * self.error).sqrt();
        Self::rounding(root, Self::product((root + farthest).recip(), self.error), 2.0)
    }
    fn exp(self) -> Self {
        let value = self.value.exp();
        let error = if RIGOROUS { num_traits::Float::exp_m1(self.error) } else { self.error };
        Self { error, ..self }.function(value, value)
    }
    fn ln(self) -> Self {
        self.function(self.value.ln(), self.least().recip())
    }
    #[inline(never)]
    fn sin(self) -> Self {
        self.rotated().0
    }
    #[inline(never)]
    fn cos(self) -> Self {
        self.rotated().1
    }
    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        self.rotated()
    }
    fn tan(self) -> Self {
        let value = self.value.tan();
        if RIGOROUS {
            let (sine, cosine) = self.sin_cos();
            return Self { value, error: (sine / cosine).error };
        }
        self.function(value, 1.0 + value * value)
    }
    fn asin(self) -> Self {
        self.function(self.value.asin(), self.arc_slope())
    }
    fn acos(self) -> Self {
        self.function(self.value.acos(), self.arc_slope())
    }
    fn atan(self) -> Self {
        self.function(self.value.atan(), (1.0 + self.least() * self.least()).recip())
    }
    #[inline(never)]
    fn atan2(self, other: Self) -> Self {
        let square = self.least() * self.least() + other.least() * other.least();
        let carried = Self::product(self.most().abs(), other.error) + Self::product(other.most().abs(), self.error);
        // The error may cross the negative axis, where the angle jumps by a turn.
        let jumps = RIGOROUS && self.error > 0.0 && self.least() == 0.0 && other.value <= other.error;
        let error = if jumps { TAU } else { Self::product(square.recip(), carried) };
        Self::rounding(self.value.atan2(other.value), error, 2.0)
    }
    fn sinh(self) -> Self {
        self.function(self.value.sinh(), self.most().cosh())
    }
    fn cosh(self) -> Self {
        self.function(self.value.cosh(), self.most().sinh())
    }
    fn tanh(self) -> Self {
        let value = self.value.tanh();
        let least = if RIGOROUS { self.least().tanh() } else { value };
        self.function(value, 1.0 - least * least)
    }
    fn abs(self) -> Self {
        Self { value: self.value.abs(), error: self.error }
    }
    fn sign(self) -> Self {
        Self { value: Number::sign(self.value), error: if self.has_sign() { 0.0 } else { 2.0 } }
    }
    #[inline(never)]
    fn hypot(self, other: Self) -> Self {
        Self::rounding(self.value.hypot(other.value), self.error + other.error, 2.0)
    }
    #[inline(never)]
    fn pow(self, exponent: Self) -> Self {
        let value = self.value.pow(exponent.value);
        if self.value == 0.0 {
            // The slope is infinite, but the function has a largest value within the error.
            let farthest = (Self::UNIT * self.error).pow(exponent.value);
            return Self::rounding(value, if self.error == 0.0 { 0.0 } else { farthest / Self::UNIT }, 2.0);
        }
        // The error of ln z = y ln x; of first order, that of z.
        let size = if RIGOROUS { 1.0 } else { value };
        let by_base = Self::product((exponent.most() / self.least() * size).abs(), self.error);
        let by_exponent = Self::product((self.value.ln() * size).abs(), exponent.error);
        let carried = by_base + by_exponent;
        Self::rounding(value, if RIGOROUS { value.abs() * num_traits::Float::exp_m1(carried) } else { carried }, 2.0)
    }
    /// Without bound if the base may be zero.
    #[inline(always)]
    fn zero_where(self, base: Self, _derivatives: u8) -> Self {
        let limit = if base.value == 0.0 { Self::exact(0.0) } else { self };
        if base.has_sign() { limit } else { Self { error: f64::INFINITY, ..limit } }
    }
    /// With the distance to the other arm if either may be selected.
    fn if_positive(self, then: Self, otherwise: Self) -> Self {
        let (arm, other) = if self.value > 0.0 { (then, otherwise) } else { (otherwise, then) };
        if self.value.is_nan() {
            self
        } else if self.has_sign() {
            arm
        } else {
            Self { error: worse(arm.error, (arm.value - other.value).abs() + other.error), ..arm }
        }
    }
    /// The constants of the piece at the value count as rounded. Neighbouring pieces agree at their common border.
    fn lookup<const A: usize, const C: usize>(arguments: [Self; A], find: impl Fn([f64; A]) -> [f64; C]) -> [Self; C] {
        find(arguments.map(|argument| argument.value)).map(Self::nearest)
    }
    fn presence(self) -> Self {
        Self::exact(if num_traits::Zero::is_zero(&self) { 0.0 } else { 1.0 })
    }
}

impl<const RIGOROUS: bool> Real for Running<RIGOROUS> {
    const EPSILON: f64 = f64::EPSILON;

    fn max(self, other: Self) -> Self {
        let larger = if other.value > self.value { other } else { self };
        Self { error: if RIGOROUS { self.error.max(other.error) } else { larger.error }, ..larger }
    }
    fn is_finite(self) -> bool {
        self.value.is_finite()
    }
    fn is_positive(self) -> bool {
        self.value > 0.0
    }
    fn is_at_most(self, bound: Self) -> bool {
        self.value <= bound.value
    }
    fn to_f64(self) -> f64 {
        self.value
    }
}

#[cfg(test)]
mod tests {
    use super::{Number, Real};

    type Bounded = super::Running<true>;

    /// A unary function, in both number types.
    type Function = (&'static str, fn(f64) -> f64, fn(Bounded) -> Bounded);

    const FUNCTIONS: [Function; 16] = [
        ("recip", Number::recip, Number::recip),
        ("sqrt", Number::sqrt, Number::sqrt),
        ("exp", Number::exp, Number::exp),
        ("ln", Number::ln, Number::ln),
        ("sin", Number::sin, Number::sin),
        ("cos", Number::cos, Number::cos),
        ("tan", Number::tan, Number::tan),
        ("asin", Number::asin, Number::asin),
        ("acos", Number::acos, Number::acos),
        ("atan", Number::atan, Number::atan),
        ("sinh", Number::sinh, Number::sinh),
        ("cosh", Number::cosh, Number::cosh),
        ("tanh", Number::tanh, Number::tanh),
        ("abs", Number::abs, Number::abs),
        ("sign", Number::sign, Number::sign),
        ("x^2.5", |x| Number::pow(x, 2.5), |x| x.pow(Bounded::real(2.5))),
    ];

    /// A binary function, in both number types.
    type Pair = (&'static str, fn(f64, f64) -> f64, fn(Bounded, Bounded) -> Bounded);

    const PAIRS: [Pair; 8] = [
        ("+", |x, y| x + y, |x, y| x + y),
        ("-", |x, y| x - y, |x, y| x - y),
        ("*", |x, y| x * y, |x, y| x * y),
        ("/", |x, y| x / y, |x, y| x / y),
        ("atan2", Number::atan2, Number::atan2),
        ("hypot", Number::hypot, Number::hypot),
        ("pow", Number::pow, Number::pow),
        ("max", Real::max, Real::max),
    ];

    /// Test values, from steep bounds to absorbed terms.
    const VALUES: [f64; 10] = [-30.0, -1.5, -0.75, -1e-6, 1e-9, 0.3, 0.999, 1.0, 2.6, 40.0];
    /// Bounds of the operands.
    const ERRORS: [f64; 4] = [0.0, 1e-6, 1e-3, 0.6];

    /// Whether the bound holds for operands anywhere within theirs. A missing value has no bound.
    fn holds(result: Bounded, values: impl Iterator<Item = f64>) -> bool {
        values.filter(|value| !value.is_nan()).all(|value| {
            let distance = (value - result.value).abs();
            // At the bound, the bound and the operand may themselves be rounded.
            distance <= result.error * (1.0 + 1e-7) || result.error.is_nan() || result.value.is_nan()
        })
    }

    /// Operands within their bounds.
    fn within(value: f64, error: f64) -> impl Iterator<Item = f64> + Clone {
        [-1.0, -0.5, 0.0, 0.5, 1.0].into_iter().map(move |part| value + part * error)
    }

    #[test]
    fn bounds_hold_wherever_the_operands_are() {
        for (name, exact, rounded) in FUNCTIONS {
            for (value, error) in VALUES.into_iter().flat_map(|value| ERRORS.map(|error| (value, error))) {
                let result = rounded(Bounded { value, error });
                assert_eq!(result.value.to_bits(), exact(value).to_bits(), "{name}({value}) = {result:?}");
                assert!(holds(result, within(value, error).map(exact)), "{name}({value} ± {error}) = {result:?}");
            }
        }
        for (name, exact, rounded) in PAIRS {
            for (x, y) in VALUES.into_iter().flat_map(|x| VALUES.map(|y| (x, y))) {
                for error in ERRORS {
                    let result = rounded(Bounded { value: x, error }, Bounded { value: y, error });
                    assert_eq!(result.value.to_bits(), exact(x, y).to_bits(), "{x} {name} {y} = {result:?}");
                    let values = within(x, error).flat_map(|x| within(y, error).map(move |y| exact(x, y)));
                    assert!(holds(result, values), "{x} {name} {y} ± {error} = {result:?}");
                }
            }
        }
    }

    #[test]
    fn what_cancels_leaves_its_rounding() {
        let (large, small) = (Bounded::exact(1e16), Bounded::exact(1.0));
        let rest = large + small - large;
        assert!((rest.value - 1.0).abs() <= rest.error && rest.error <= 4.0, "{rest:?}");
        let tenth = Bounded::real(0.1);
        let nothing = tenth * Bounded::real(3.0) - Bounded::real(0.3);
        assert!(nothing.value != 0.0 && !nothing.is_seen(), "{nothing:?}");
        assert!(Bounded::real(0.5).error == 0.0 && tenth.error > 0.0);
    }

    #[test]
    fn a_limit_is_known_where_its_base_is() {
        let infinite = Bounded::exact(f64::INFINITY);
        assert_eq!(infinite.zero_where(Bounded::exact(0.0), 0), Bounded::exact(0.0));
        assert_eq!(Bounded::nearest(0.1).zero_where(Bounded::nearest(0.3), 0), Bounded::nearest(0.1));
        let doubtful = |value| Bounded { value, error: 1e-3 };
        assert!([0.0, 1e-4].into_iter().all(|value| !infinite.zero_where(doubtful(value), 0).is_seen()));
    }

    #[test]
    fn nothing_is_known_where_a_denominator_may_be_zero() {
        let doubtful = Bounded { value: 1e-3, error: 1e-3 };
        for result in [doubtful.recip(), doubtful.ln(), Bounded::exact(1.0) / doubtful] {
            assert!(!result.is_seen(), "{result:?}");
        }
    }
}
