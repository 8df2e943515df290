//! Numbers that carry a rounding-error bound: running error analysis.
//!
//! A formula generic over [`Real`] returns its value and a first-order bound of its rounding error. The bound is in
//! units of half an ulp of 1, and holds for any number type of the steppers. With `z = x ∘ y`,
//!
//! ```text
//! e(x ± y) = e(x) + e(y) + |z|          e(x y) = |x| e(y) + |y| e(x) + |z|          e(f(x)) = |f'(x)| e(x) + 2 |z|
//! ```
//!
//! so that cancellation inside a formula stays in the bound: a residual below it is zero to rounding. Library functions
//! are assumed accurate to an ulp. A kink or a jump (`abs`, `sign`, `if_positive`) uses the side of the value. The type
//! is for cold paths: each operation is a call, which keeps the compiled formulas of a system small.
//!
//! Source: Higham, Accuracy and Stability of Numerical Algorithms, section 3.3.

use super::{Number, Real};
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number with a rounding-error bound, by running error analysis (Higham, Accuracy and Stability of Numerical
/// Algorithms, section 3.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded {
    value: f64,
    /// The bound, in units of half an ulp of 1.
    error: f64,
}

impl Rounded {
    /// An exact number.
    #[must_use]
    pub fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// The nearest representable number to an exact one.
    #[must_use]
    pub fn nearest(value: f64) -> Self {
        Self { value, error: value.abs() }
    }

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

    /// The result of an operation whose operands contribute the error `carried`.
    fn rounding(value: f64, carried: f64, ulps: f64) -> Self {
        // Subnormal numbers have the rounding error of the smallest normal one.
        Self { value, error: carried + ulps * value.abs() + f64::MIN_POSITIVE }
    }

    /// A library function with this slope.
    #[inline(never)]
    fn function(self, value: f64, slope: f64) -> Self {
        Self::rounding(value, product(slope.abs(), self.error), 2.0)
    }
}

/// `a b`, and 0 if one factor is 0, even if the other one is infinite.
fn product(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

/// Largest error of an angle, in radians, for which its sine keeps most of its digits.
const HARDLY_KNOWN: f64 = 1e-6;
/// Half an ulp of 1.
const UNIT: f64 = 0.5 * f64::EPSILON;

impl Add for Rounded {
    type Output = Self;
    #[inline(never)]
    fn add(self, other: Self) -> Self {
        Self::rounding(self.value + other.value, self.error + other.error, 1.0)
    }
}

impl Sub for Rounded {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Rounded {
    type Output = Self;
    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        let carried = product(self.value.abs(), other.error) + product(other.value.abs(), self.error);
        Self::rounding(self.value * other.value, carried, 1.0)
    }
}

impl Div for Rounded {
    type Output = Self;
    #[inline(never)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let carried = (self.error + product(value.abs(), other.error)) / other.value.abs();
        Self::rounding(value, carried, 1.0)
    }
}

impl Neg for Rounded {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, error: self.error }
    }
}

assignments!(Rounded);

impl num_traits::Zero for Rounded {
    fn zero() -> Self {
        Self::exact(0.0)
    }
    fn is_zero(&self) -> bool {
        self.value == 0.0
    }
}

impl num_traits::One for Rounded {
    fn one() -> Self {
        Self::exact(1.0)
    }
}

impl Number for Rounded {
    /// A constant or a parameter counts as exact.
    fn real(value: f64) -> Self {
        Self::exact(value)
    }
    fn recip(self) -> Self {
        Self::exact(1.0) / self
    }
    /// The slope is infinite at zero, but the change is finite: `√(x + e) − √x = e/(√(x + e) + √x)`.
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        let farthest = (self.value + UNIT * self.error).sqrt();
        Self::rounding(root, product((root + farthest).recip(), self.error), 2.0)
    }
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.function(value, value)
    }
    fn ln(self) -> Self {
        self.function(self.value.ln(), self.value.recip())
    }
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    /// The bound is NaN for an angle with a large error. Otherwise the residual of diverged stages would count as
    /// rounding.
    fn sin_cos(self) -> (Self, Self) {
        if UNIT * self.error > HARDLY_KNOWN {
            return [self.value.sin(), self.value.cos()].map(|value| Self { value, error: f64::NAN }).into();
        }
        let (sine, cosine) = self.value.sin_cos();
        (self.function(sine, cosine), self.function(cosine, sine))
    }
    fn tan(self) -> Self {
        let value = self.value.tan();
        self.function(value, 1.0 + value * value)
    }
    fn asin(self) -> Self {
        self.function(self.value.asin(), (1.0 - self.value * self.value).sqrt().recip())
    }
    fn acos(self) -> Self {
        self.function(self.value.acos(), (1.0 - self.value * self.value).sqrt().recip())
    }
    fn atan(self) -> Self {
        self.function(self.value.atan(), (1.0 + self.value * self.value).recip())
    }
    fn atan2(self, other: Self) -> Self {
        let square = self.value * self.value + other.value * other.value;
        let carried = product(self.value.abs(), other.error) + product(other.value.abs(), self.error);
        Self::rounding(self.value.atan2(other.value), product(square.recip(), carried), 2.0)
    }
    fn sinh(self) -> Self {
        self.function(self.value.sinh(), self.value.cosh())
    }
    fn cosh(self) -> Self {
        self.function(self.value.cosh(), self.value.sinh())
    }
    fn tanh(self) -> Self {
        let value = self.value.tanh();
        self.function(value, 1.0 - value * value)
    }
    fn abs(self) -> Self {
        Self { value: self.value.abs(), error: self.error }
    }
    fn sign(self) -> Self {
        Self::exact(Number::sign(self.value))
    }
    fn hypot(self, other: Self) -> Self {
        Self::rounding(self.value.hypot(other.value), self.error + other.error, 2.0)
    }
    fn pow(self, exponent: Self) -> Self {
        let value = self.value.pow(exponent.value);
        if self.value == 0.0 {
            // The slope is infinite, but the function has a largest value within the error.
            let farthest = (UNIT * self.error).pow(exponent.value);
            return Self::rounding(value, if self.error == 0.0 { 0.0 } else { farthest / UNIT }, 2.0);
        }
        let by_base = product((exponent.value / self.value * value).abs(), self.error);
        let by_exponent = product((self.value.ln() * value).abs(), exponent.error);
        Self::rounding(value, by_base + by_exponent, 2.0)
    }
    fn if_positive(self, then: Self, otherwise: Self) -> Self {
        let arm = if self.value > 0.0 { then } else { otherwise };
        if self.value.is_nan() { self } else { arm }
    }
    /// The constants count as rounded once.
    fn lookup<const A: usize, const C: usize>(arguments: [Self; A], find: impl Fn([f64; A]) -> [f64; C]) -> [Self; C] {
        find(arguments.map(|argument| argument.value)).map(Self::nearest)
    }
}

impl Real for Rounded {
    const EPSILON: f64 = f64::EPSILON;

    fn max(self, other: Self) -> Self {
        if other.value > self.value { other } else { self }
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
