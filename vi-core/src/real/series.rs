//! Truncated power series `c_0 + c_1 τ + … `: derivatives of any order of a formula along a trajectory.
//!
//! A formula generic over [`Real`], with arguments as series in τ, returns the series of its value, exact to the last
//! stored term; [`Series::derivative`] returns the derivatives at τ = 0. A function f with `f' = g` solves `u' = g x'`,
//! by as many integrations as there are terms, each of which adds one correct term:
//!
//! ```text
//! u ← f(x_0) + ∫ g(u, x) x' dτ
//! ```
//!
//! Source: Griewank and Walther, Evaluating Derivatives, chapter 13. Functions of constants are constants, even if
//! their slope is infinite.

use super::{Number, Real};
use core::ops::{Add, Div, Mul, Neg, Sub};

/// Terms of a series, including the constant: derivatives up to order six, which steps of three stages need.
const TERMS: usize = 7;

/// A truncated power series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Series {
    terms: [f64; TERMS],
}

impl Series {
    /// A constant.
    #[must_use]
    pub fn fixed(value: f64) -> Self {
        Self::from_fn(|k| if k == 0 { value } else { 0.0 })
    }

    /// `value + τ`.
    #[must_use]
    pub fn variable(value: f64) -> Self {
        Self::from_fn(|k| match k {
            0 => value,
            1 => 1.0,
            _ => 0.0,
        })
    }

    /// The derivative of order k at τ = 0; zero beyond the last term.
    #[must_use]
    pub fn derivative(&self, order: usize) -> f64 {
        (1..=order).fold(self.term(order), |product, k| product * real(k))
    }

    /// The coefficient of τ^k; zero beyond the last term.
    fn term(&self, k: usize) -> f64 {
        self.terms.get(k).copied().unwrap_or(0.0)
    }

    /// The series without its terms beyond τ^degree.
    #[must_use]
    pub fn truncated(&self, degree: usize) -> Self {
        Self::from_fn(|k| if k <= degree { self.terms[k] } else { 0.0 })
    }

    /// The integral from 0 to τ.
    #[must_use]
    pub fn integral(&self) -> Self {
        Self::from_fn(|k| if k == 0 { 0.0 } else { self.terms[k - 1] / real(k) })
    }

    /// The derivative with respect to τ; it has no last term.
    pub(crate) fn slope(&self) -> Self {
        Self::from_fn(|k| self.term(k + 1) * real(k + 1))
    }

    fn from_fn(term: impl FnMut(usize) -> f64) -> Self {
        Self { terms: core::array::from_fn(term) }
    }

    fn value(&self) -> f64 {
        self.term(0)
    }

    fn is_fixed(&self) -> bool {
        self.terms.iter().skip(1).all(|term| *term == 0.0)
    }

    /// The solution of `u' = slope(u) x'` from `value`.
    fn function(self, value: f64, slope: impl Fn(Self) -> Self) -> Self {
        let mut u = Self::fixed(value);
        if !self.is_fixed() {
            for _ in 1..TERMS {
                u = Self::fixed(value) + (slope(u) * self.slope()).integral();
            }
        }
        u
    }

    /// The solutions of `u' = w x', w' = sign u x'` from two values.
    fn functions(self, [u_start, w_start]: [f64; 2], sign: f64) -> [Self; 2] {
        let mut u = Self::fixed(u_start);
        let mut w = Self::fixed(w_start);
        for _ in 1..TERMS {
            let slope = self.slope();
            let next = Self::fixed(u_start) + (w * slope).integral();
            w = Self::fixed(w_start) + (u * slope * Self::fixed(sign)).integral();
            u = next;
        }
        [u, w]
    }
}

/// A small integer as a number.
#[allow(clippy::cast_precision_loss)]
fn real(integer: usize) -> f64 {
    integer as f64
}

impl Add for Series {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::from_fn(|k| self.terms[k] + other.terms[k])
    }
}

impl Sub for Series {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::from_fn(|k| self.terms[k] - other.terms[k])
    }
}

impl Mul for Series {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::from_fn(|k| (0..=k).map(|j| self.terms[j] * other.terms[k - j]).sum())
    }
}

impl Div for Series {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let mut quotient = [0.0; TERMS];
        for k in 0..TERMS {
            let known: f64 = (0..k).map(|j| quotient[j] * other.terms[k - j]).sum();
            quotient[k] = (self.terms[k] - known) / other.terms[0];
        }
        Self { terms: quotient }
    }
}

impl Neg for Series {
    type Output = Self;
    fn neg(self) -> Self {
        Self::from_fn(|k| -self.terms[k])
    }
}

assignments!(Series);

impl num_traits::Zero for Series {
    fn zero() -> Self {
        Self::fixed(0.0)
    }
    fn is_zero(&self) -> bool {
        self.terms.iter().all(|term| *term == 0.0)
    }
}

impl num_traits::One for Series {
    fn one() -> Self {
        Self::fixed(1.0)
    }
}

impl Number for Series {
    fn real(value: f64) -> Self {
        Self::fixed(value)
    }
    fn recip(self) -> Self {
        Self::fixed(1.0) / self
    }
    fn sqrt(self) -> Self {
        self.function(self.value().sqrt(), |u| Self::fixed(0.5) / u)
    }
    fn exp(self) -> Self {
        self.function(self.value().exp(), |u| u)
    }
    fn ln(self) -> Self {
        self.function(self.value().ln(), |_| self.recip())
    }
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = Number::sin_cos(self.value());
        let [sine, cosine] = self.functions([sine, cosine], -1.0);
        (sine, cosine)
    }
    fn tan(self) -> Self {
        self.function(self.value().tan(), |u| Self::fixed(1.0) + u * u)
    }
    fn asin(self) -> Self {
        self.function(self.value().asin(), |_| (Self::fixed(1.0) - self * self).sqrt().recip())
    }
    fn acos(self) -> Self {
        self.function(self.value().acos(), |_| -(Self::fixed(1.0) - self * self).sqrt().recip())
    }
    fn atan(self) -> Self {
        self.function(self.value().atan(), |_| (Self::fixed(1.0) + self * self).recip())
    }
    fn atan2(self, other: Self) -> Self {
        let turn = (self.slope() * other - self * other.slope()) / (self * self + other * other);
        Self::fixed(self.value().atan2(other.value())) + turn.integral()
    }
    fn sinh(self) -> Self {
        let [sine, _] = self.functions([self.value().sinh(), self.value().cosh()], 1.0);
        sine
    }
    fn cosh(self) -> Self {
        let [_, cosine] = self.functions([self.value().sinh(), self.value().cosh()], 1.0);
        cosine
    }
    fn tanh(self) -> Self {
        self.function(self.value().tanh(), |u| Self::fixed(1.0) - u * u)
    }
    fn abs(self) -> Self {
        self * self.sign()
    }
    fn sign(self) -> Self {
        Self::fixed(Number::sign(self.value()))
    }
    fn hypot(self, other: Self) -> Self {
        (self * self + other * other).sqrt()
    }
    fn pow(self, exponent: Self) -> Self {
        // A fixed exponent needs no logarithm, which does not exist for a negative base.
        if exponent.is_fixed() {
            self.function(self.value().pow(exponent.value()), |u| exponent * u / self)
        } else {
            (exponent * self.ln()).exp()
        }
    }
    /// For a constant base the limit holds along the trajectory; otherwise only the first `derivatives` terms are
    /// known.
    fn zero_where(self, base: Self, derivatives: u8) -> Self {
        if base.value() != 0.0 {
            return self;
        }
        let known = if base.is_fixed() { TERMS } else { usize::from(derivatives) };
        Self::from_fn(|k| if k <= known { 0.0 } else { f64::NAN })
    }
    fn if_positive(self, then: Self, otherwise: Self) -> Self {
        Self::from_fn(|k| self.value().if_positive(then.terms[k], otherwise.terms[k]))
    }
    fn lookup<const A: usize, const C: usize>(arguments: [Self; A], find: impl Fn([f64; A]) -> [f64; C]) -> [Self; C] {
        find(arguments.map(|argument| argument.value())).map(Self::fixed)
    }
    fn presence(self) -> Self {
        Self::fixed(if num_traits::Zero::is_zero(&self) { 0.0 } else { 1.0 })
    }
}

impl Real for Series {
    const EPSILON: f64 = f64::EPSILON;

    fn max(self, other: Self) -> Self {
        if self.value() >= other.value() { self } else { other }
    }
    fn is_finite(self) -> bool {
        self.terms.iter().all(|term| term.is_finite())
    }
    fn is_positive(self) -> bool {
        self.value() > 0.0
    }
    fn is_at_most(self, bound: Self) -> bool {
        self.value() <= bound.value()
    }
    fn to_f64(self) -> f64 {
        self.value()
    }
}
