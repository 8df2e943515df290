//! Dual numbers a + b ε with ε² = 0: automatic differentiation, independent of the symbolic derivatives.
//!
//! For a function that is generic over [`Real`] and `x = a + b ε`, the result is `f(x) = f(a) + f'(a) b ε`,
//! differentiated operation by operation. b is a number, or several ([`Slopes`]) for derivatives in several directions
//! by one evaluation. `Dual<Dual<f64>>` gives second derivatives. Source: Griewank and Walther, Evaluating Derivatives,
//! chapter 3.

use crate::real::{Number, Real};
use core::array;
use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};
use nalgebra::SVector;

/// A value and its derivative with respect to one variable, or to several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T, D = T> {
    /// The value.
    pub value: T,
    /// Its derivative.
    pub slope: D,
}

/// W derivatives of a number T.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slopes<T, const W: usize>(pub [T; W]);

/// Derivatives of numbers T, which add and multiply by such numbers.
pub trait Slope<T>:
    Copy + Debug + PartialEq + Send + Sync + 'static + Add<Output = Self> + Sub<Output = Self> + Neg<Output = Self>
{
    /// The derivative of a constant.
    fn zero() -> Self;
    /// Whether all derivatives are zero.
    fn is_zero(&self) -> bool;
    /// Whether all derivatives are finite.
    fn is_finite(self) -> bool;
    /// `factor · self`.
    #[must_use]
    fn times(self, factor: T) -> Self;
    /// `self / divisor`.
    #[must_use]
    fn over(self, divisor: T) -> Self;
    /// `derivative · self`; zero if self is zero: a constant has no slope, not even through a function with an infinite
    /// one.
    #[must_use]
    fn chain(self, derivative: T) -> Self;
    /// A function of each derivative.
    #[must_use]
    fn each(self, function: impl Fn(T) -> T) -> Self;
    /// `then` if `condition` is above zero, `otherwise` if it is not, as [`Number::if_positive`].
    #[must_use]
    fn select(condition: T, then: Self, otherwise: Self) -> Self;
    /// 0 if all derivatives are zero, otherwise 1; for each lane by itself.
    fn presence(self) -> T;
}

impl<T: Real> Slope<T> for T {
    #[inline(always)]
    fn zero() -> Self {
        num_traits::Zero::zero()
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        num_traits::Zero::is_zero(self)
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        Real::is_finite(self)
    }
    #[inline(always)]
    fn times(self, factor: T) -> Self {
        self * factor
    }
    #[inline(always)]
    fn over(self, divisor: T) -> Self {
        self / divisor
    }
    #[inline(always)]
    fn chain(self, derivative: T) -> Self {
        (derivative * self).zero_where(Number::presence(self), u8::MAX)
    }
    #[inline(always)]
    fn each(self, function: impl Fn(T) -> T) -> Self {
        function(self)
    }
    #[inline(always)]
    fn select(condition: T, then: Self, otherwise: Self) -> Self {
        condition.if_positive(then, otherwise)
    }
    #[inline(always)]
    fn presence(self) -> T {
        Number::presence(self)
    }
}

impl<T: Real, const W: usize> Slope<T> for Slopes<T, W> {
    #[inline(always)]
    fn zero() -> Self {
        Self([T::zero(); W])
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.0.iter().all(num_traits::Zero::is_zero)
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        self.0.into_iter().all(Real::is_finite)
    }
    #[inline(always)]
    fn times(self, factor: T) -> Self {
        self.each(|slope| slope * factor)
    }
    #[inline(always)]
    fn over(self, divisor: T) -> Self {
        self.each(|slope| slope / divisor)
    }
    #[inline(always)]
    fn chain(self, derivative: T) -> Self {
        self.each(|slope| slope.chain(derivative))
    }
    #[inline(always)]
    fn each(self, function: impl Fn(T) -> T) -> Self {
        // A loop, because `map` is a call for large numbers.
        let mut slopes = self.0;
        for slope in &mut slopes {
            *slope = function(*slope);
        }
        Self(slopes)
    }
    #[inline(always)]
    fn select(condition: T, then: Self, otherwise: Self) -> Self {
        Self(array::from_fn(|k| condition.if_positive(then.0[k], otherwise.0[k])))
    }
    #[inline(always)]
    fn presence(self) -> T {
        let either = |a: T, b: T| a + b - a * b;
        self.0.into_iter().map(Number::presence).fold(T::zero(), either)
    }
}

impl<T: Real, const W: usize> Add for Slopes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl<T: Real, const W: usize> Sub for Slopes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(array::from_fn(|k| self.0[k] - other.0[k]))
    }
}

impl<T: Real, const W: usize> Neg for Slopes<T, W> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(Neg::neg))
    }
}

impl<T: Real> Dual<T> {
    /// The variable itself, with slope one.
    #[must_use]
    pub fn variable(value: T) -> Self {
        Self { value, slope: T::one() }
    }
}

impl<T: Real, D: Slope<T>> Dual<T, D> {
    /// A constant.
    #[must_use]
    pub fn fixed(value: T) -> Self {
        Self { value, slope: D::zero() }
    }

    /// f(self), with f' at self.
    fn chain(self, value: T, derivative: T) -> Self {
        Self { value, slope: self.slope.chain(derivative) }
    }
}

/// A constant vector.
pub(crate) fn lift<T: Real, const N: usize>(vector: &SVector<T, N>) -> SVector<Dual<T>, N> {
    vector.map(Dual::fixed)
}

/// A vector with derivatives along a direction.
pub(crate) fn along<T: Real, const N: usize>(vector: &SVector<T, N>, direction: &SVector<T, N>) -> SVector<Dual<T>, N> {
    vector.zip_map(direction, |value, slope| Dual { value, slope })
}

/// The direction of one entry.
pub(crate) fn unit<T: Real, const N: usize>(index: usize) -> SVector<T, N> {
    SVector::from_fn(|row, _| if row == index { T::one() } else { T::zero() })
}

/// Derivatives of each entry.
pub(crate) fn slopes<T: Real, const N: usize>(vector: &SVector<Dual<T>, N>) -> SVector<T, N> {
    vector.map(|entry| entry.slope)
}

impl<T: Real, D: Slope<T>> Add for Dual<T, D> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: self.slope + other.slope }
    }
}

impl<T: Real, D: Slope<T>> Sub for Dual<T, D> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slope: self.slope - other.slope }
    }
}

impl<T: Real, D: Slope<T>> Mul for Dual<T, D> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self { value: self.value * other.value, slope: self.slope.times(other.value) + other.slope.times(self.value) }
    }
}

impl<T: Real, D: Slope<T>> Div for Dual<T, D> {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self { value, slope: (self.slope - other.slope.times(value)).over(other.value) }
    }
}

impl<T: Real, D: Slope<T>> Neg for Dual<T, D> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope }
    }
}

assignments!(Dual<T, D>, T: Real, D: Slope<T>);

impl<T: Real, D: Slope<T>> num_traits::Zero for Dual<T, D> {
    fn zero() -> Self {
        Self::fixed(T::zero())
    }
    fn is_zero(&self) -> bool {
        self.value.is_zero() && self.slope.is_zero()
    }
}

impl<T: Real, D: Slope<T>> num_traits::One for Dual<T, D> {
    fn one() -> Self {
        Self::fixed(T::one())
    }
}

impl<T: Real, D: Slope<T>> Number for Dual<T, D> {
    fn real(value: f64) -> Self {
        Self::fixed(T::real(value))
    }
    fn recip(self) -> Self {
        Self::fixed(T::one()) / self
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, T::real(0.5) / root)
    }
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }
    fn ln(self) -> Self {
        self.chain(self.value.ln(), self.value.recip())
    }
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value.sin_cos();
        (self.chain(sine, cosine), self.chain(cosine, -sine))
    }
    fn tan(self) -> Self {
        let (sine, cosine) = self.sin_cos();
        sine / cosine
    }
    fn asin(self) -> Self {
        let slope = (T::one() - self.value * self.value).sqrt().recip();
        self.chain(self.value.asin(), slope)
    }
    fn acos(self) -> Self {
        let slope = -(T::one() - self.value * self.value).sqrt().recip();
        self.chain(self.value.acos(), slope)
    }
    fn atan(self) -> Self {
        let slope = (T::one() + self.value * self.value).recip();
        self.chain(self.value.atan(), slope)
    }
    fn atan2(self, other: Self) -> Self {
        let square = self.value * self.value + other.value * other.value;
        let slope = (self.slope.times(other.value) - other.slope.times(self.value)).over(square);
        Self { value: self.value.atan2(other.value), slope }
    }
    fn sinh(self) -> Self {
        self.chain(self.value.sinh(), self.value.cosh())
    }
    fn cosh(self) -> Self {
        self.chain(self.value.cosh(), self.value.sinh())
    }
    fn tanh(self) -> Self {
        let value = self.value.tanh();
        self.chain(value, T::one() - value * value)
    }
    fn abs(self) -> Self {
        self.chain(self.value.abs(), self.value.sign())
    }
    fn sign(self) -> Self {
        Self::fixed(self.value.sign())
    }
    fn hypot(self, other: Self) -> Self {
        (self * self + other * other).sqrt()
    }
    fn pow(self, exponent: Self) -> Self {
        let value = self.value.pow(exponent.value);
        let by_base = self.slope.chain(exponent.value * self.value.pow(exponent.value - T::one()));
        // A fixed exponent needs no logarithm, which does not exist for a negative base.
        if exponent.slope.is_zero() {
            return Self { value, slope: by_base };
        }
        // At x = 0, x^y ln x is 0 like x^y.
        let by_exponent = (value * self.value.ln()).zero_where(Number::presence(value), u8::MAX);
        Self { value, slope: by_base + exponent.slope.chain(by_exponent) }
    }
    fn zero_where(self, base: Self, derivatives: u8) -> Self {
        // 0, or NaN if the base is zero.
        let unknown = || T::zero() / T::one().zero_where(base.value, u8::MAX);
        let slope = self.slope.each(|slope| match derivatives.checked_sub(1) {
            Some(others) => slope.zero_where(base.value, others),
            None => slope - unknown(),
        });
        Self { value: self.value.zero_where(base.value, derivatives), slope }
    }
    fn if_positive(self, then: Self, otherwise: Self) -> Self {
        Self {
            value: self.value.if_positive(then.value, otherwise.value),
            slope: D::select(self.value, then.slope, otherwise.slope),
        }
    }
    fn lookup<const A: usize, const C: usize>(arguments: [Self; A], find: impl Fn([f64; A]) -> [f64; C]) -> [Self; C] {
        T::lookup(arguments.map(|argument| argument.value), find).map(Self::fixed)
    }
    fn presence(self) -> Self {
        let (of_value, of_slope) = (Number::presence(self.value), Slope::presence(self.slope));
        Self::fixed(of_value + of_slope - of_value * of_slope)
    }
}

impl<T: Real, D: Slope<T>> Real for Dual<T, D> {
    const EPSILON: f64 = T::EPSILON;

    fn max(self, other: Self) -> Self {
        if self.value.to_f64() >= other.value.to_f64() { self } else { other }
    }
    fn is_positive(self) -> bool {
        self.value.is_positive()
    }
    fn is_at_most(self, bound: Self) -> bool {
        self.value.is_at_most(bound.value)
    }
    fn is_finite(self) -> bool {
        self.value.is_finite() && self.slope.is_finite()
    }
    fn to_f64(self) -> f64 {
        self.value.to_f64()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::{Lane, Lanes, Rounded, Series};

    /// Value, slope and second derivative of an expression that is zero if a base is.
    fn parts(derivatives: u8, base: f64) -> [f64; 3] {
        type Second = Dual<Dual<f64>>;
        let number = |value| Second { value: Dual { value, slope: 2.0 }, slope: Dual { value: 3.0, slope: 4.0 } };
        let limit = number(f64::NAN).zero_where(number(base), derivatives);
        [limit.value.value, limit.slope.value, limit.slope.slope]
    }

    #[test]
    fn a_limit_has_the_derivatives_that_vanish_with_it() {
        let known = |derivatives| parts(derivatives, 0.0).map(|part| part == 0.0);
        assert_eq!(known(0), [true, false, false]);
        assert_eq!(known(1), [true, true, false]);
        assert_eq!([known(2), known(u8::MAX)], [[true; 3]; 2]);
        assert!(parts(2, 1e-300)[0].is_nan());
        assert!(Dual::variable(f64::NAN).zero_where(Dual::variable(0.0), 0).slope.is_nan());
    }

    #[test]
    fn every_number_takes_the_limit() {
        let infinite = Rounded::exact(f64::INFINITY).zero_where(Rounded::nearest(0.0), 0);
        assert_eq!((infinite.to_f64(), infinite.error()), (0.0, 0.0));
        let series = Series::variable(f64::NAN);
        assert_eq!(series.zero_where(Series::fixed(0.0), 0), Series::fixed(0.0));
        let limit = series.zero_where(Series::variable(0.0), 2);
        assert_eq!(limit.truncated(2), Series::fixed(0.0));
        assert!(limit.derivative(3).is_nan());
        assert_eq!(Lane::<true>::new(f64::NAN).zero_where(Lane::new(-0.0), 0), Lane::new(0.0));
        assert_eq!(Lanes::<2, false>([f64::NAN, 3.0]).zero_where(Lanes([0.0, 1.0]), 0), Lanes([0.0, 3.0]));
        assert_eq!(f32::NAN.zero_where(0.0, 0).to_bits(), 0);
    }

    #[test]
    fn a_power_of_zero_does_not_change_with_its_exponent() {
        let power = Dual::fixed(0.0).pow(Dual::variable(1.5));
        assert_eq!((power.value, power.slope), (0.0, 0.0));
        assert!(!Real::is_finite(Dual::fixed(0.0).pow(Dual::variable(-0.5))));
    }
}
