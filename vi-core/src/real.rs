//! Number types of generated code.
//!
//! Formulas run in `f64`, in `f32`, and in lanes of an ensemble. [`Number`] has the operations of formulas, all of which
//! several lanes can perform at once. [`Real`] adds the functions that read a number, and [`Scalar`] the order that the
//! control flow of a stepper needs.

/// Implements the assigning operators by the others, for a type with parameters if they are given.
macro_rules! assignments {
    ([$($parameters:tt)*] $number:ty: $operator:ident $function:ident $operation:tt) => {
        impl<$($parameters)*> core::ops::$operator for $number {
            fn $function(&mut self, other: Self) {
                *self = *self $operation other;
            }
        }
    };
    ($number:ty $(, $($parameters:tt)*)?) => {
        $crate::real::assignments! { [$($($parameters)*)?] $number: AddAssign add_assign + }
        $crate::real::assignments! { [$($($parameters)*)?] $number: SubAssign sub_assign - }
        $crate::real::assignments! { [$($($parameters)*)?] $number: MulAssign mul_assign * }
    };
}
pub(crate) use assignments;

pub(crate) mod dual;
mod lane;
mod lanes;
mod rounded;
mod series;
pub mod sine;

pub use dual::{Dual, Slope, Slopes};
pub use lane::Lane;
pub use lanes::Lanes;
pub use rounded::{Rounded, Running};
pub use series::Series;

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};
use num_traits::Float;

/// A number, or several side by side, for formulas: a function `fn cl<T: Number>(a: T) -> T` runs in every number type.
///
/// It has no comparison, because several numbers may compare differently. [`if_positive`](Number::if_positive) selects
/// for each of them, and a [`Table`](crate::table::Table) finds the piece of each.
pub trait Number:
    Copy
    + Debug
    + PartialEq
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + num_traits::Zero
    + num_traits::One
{
    /// The constant `value`, rounded to this type.
    fn real(value: f64) -> Self;
    /// 1/x.
    #[must_use]
    fn recip(self) -> Self;
    /// Square root.
    #[must_use]
    fn sqrt(self) -> Self;
    /// e^x.
    #[must_use]
    fn exp(self) -> Self;
    /// Natural logarithm.
    #[must_use]
    fn ln(self) -> Self;
    /// Sine of an angle in radians.
    #[must_use]
    fn sin(self) -> Self;
    /// Cosine of an angle in radians.
    #[must_use]
    fn cos(self) -> Self;
    /// Sine and cosine of one angle in radians, in this order.
    fn sin_cos(self) -> (Self, Self);
    /// Sine and cosine of several independent angles, at once if that is faster.
    #[inline(always)]
    fn sin_cos_each<const K: usize>(angles: [Self; K]) -> [(Self, Self); K] {
        // A loop, because `map` is a call for large K.
        let mut pairs = [(Self::zero(), Self::zero()); K];
        for (pair, angle) in pairs.iter_mut().zip(angles) {
            *pair = angle.sin_cos();
        }
        pairs
    }
    /// Tangent of an angle in radians.
    #[must_use]
    fn tan(self) -> Self;
    /// Arc sine, in [−π/2, π/2].
    #[must_use]
    fn asin(self) -> Self;
    /// Arc cosine, in [0, π].
    #[must_use]
    fn acos(self) -> Self;
    /// Arc tangent, in [−π/2, π/2].
    #[must_use]
    fn atan(self) -> Self;
    /// Angle of the point (x = `other`, y = `self`), in [−π, π].
    #[must_use]
    fn atan2(self, other: Self) -> Self;
    /// Hyperbolic sine.
    #[must_use]
    fn sinh(self) -> Self;
    /// Hyperbolic cosine.
    #[must_use]
    fn cosh(self) -> Self;
    /// Hyperbolic tangent.
    #[must_use]
    fn tanh(self) -> Self;
    /// Absolute value.
    #[must_use]
    fn abs(self) -> Self;
    /// −1, 0 or 1; `sign(0) = 0`, unlike `signum`.
    #[must_use]
    fn sign(self) -> Self;
    /// √(x² + y²) without overflow.
    #[must_use]
    fn hypot(self, other: Self) -> Self;
    /// x^y for a real exponent.
    #[must_use]
    fn pow(self, exponent: Self) -> Self;
    /// The number itself, or 0 if `base` is zero: the limit of a product whose factors are zero and infinite there. The
    /// first `derivatives` derivatives have the limit 0 too; number types with derivatives do not know higher ones.
    #[must_use]
    #[inline(always)]
    fn zero_where(self, base: Self, _derivatives: u8) -> Self {
        if base.is_zero() { Self::zero() } else { self }
    }
    /// `then` if the number is above zero, `otherwise` if it is not, and NaN if it is NaN; for each lane by itself.
    ///
    /// Both arms are computed. Derivatives are those of the selected arm, without any trace of the other one.
    #[must_use]
    fn if_positive(self, then: Self, otherwise: Self) -> Self;
    /// Constants that depend on the interval of the arguments, as the coefficients of a piece of a table: `find` at the
    /// values of the arguments, for each lane by itself. Derivatives of the constants are zero.
    fn lookup<const A: usize, const C: usize>(arguments: [Self; A], find: impl Fn([f64; A]) -> [f64; C]) -> [Self; C];
    /// 0 if the number and all its derivatives are zero, otherwise 1; for each lane by itself.
    #[doc(hidden)]
    #[must_use]
    #[inline(always)]
    fn presence(self) -> Self {
        Self::one().zero_where(self, 0)
    }
}

/// A number type of generated formulas.
pub trait Real: Number {
    /// Distance from 1 to the next larger number.
    const EPSILON: f64;

    /// The larger of two numbers.
    #[must_use]
    fn max(self, other: Self) -> Self;
    /// Whether the number is finite.
    fn is_finite(self) -> bool;
    /// Whether the number is above zero.
    fn is_positive(self) -> bool;
    /// Whether `self ≤ bound`. False for NaN.
    fn is_at_most(self, bound: Self) -> bool;
    /// The value as `f64`, for errors and tables.
    fn to_f64(self) -> f64;
}

/// A single number, with the order that the control flow of a stepper needs.
pub trait Scalar: Real + PartialOrd {}

/// Sines and cosines, in this order. One branch serves all angles, and typical ones do not take it: the compiler
/// vectorizes the code between branches.
#[inline]
fn sin_cos<const K: usize>(angles: [f64; K]) -> [(f64, f64); K] {
    if angles.iter().fold(true, |all, x| all & (x.abs() <= sine::LARGEST)) {
        sine::sin_cos_each::<K, { cfg!(target_feature = "fma") }>(angles)
    } else {
        large_sin_cos(angles)
    }
}

/// Sines and cosines in single precision, in this order. Small processors call functions for double precision, which
/// took 36 800 instructions of a Cortex-M4 instead of 5900 in a period of `examples/controller`.
#[allow(clippy::cast_possible_truncation)] // rounded
#[inline]
fn sin_cos_single<const K: usize>(angles: [f32; K]) -> [(f32, f32); K] {
    angles.map(|x| {
        if x.abs() <= sine::LARGEST_SINGLE {
            sine::sin_cos::<f32, { cfg!(target_feature = "fma") }>(x)
        } else {
            let [(sine, cosine)] = sin_cos([f64::from(x)]);
            (sine as f32, cosine as f32)
        }
    })
}

/// Sine and cosine if an angle has many turns or is NaN.
#[cold]
fn large_sin_cos<const K: usize>(angles: [f64; K]) -> [(f64, f64); K] {
    angles.map(Float::sin_cos)
}

macro_rules! impl_real {
    ($($float:ident $sin_cos:ident),*) => {$(
        impl Number for $float {
            // A constant of a formula is rounded to the evaluating type, as `real` documents.
            #[allow(clippy::cast_possible_truncation, clippy::cast_lossless)]
            #[inline]
            fn real(value: f64) -> Self { value as $float }
            #[inline]
            fn recip(self) -> Self { $float::recip(self) }
            #[inline]
            fn sqrt(self) -> Self { Float::sqrt(self) }
            #[inline]
            fn exp(self) -> Self { Float::exp(self) }
            #[inline]
            fn ln(self) -> Self { Float::ln(self) }
            #[inline]
            fn sin(self) -> Self { Number::sin_cos(self).0 }
            #[inline]
            fn cos(self) -> Self { Number::sin_cos(self).1 }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                let [pair] = Number::sin_cos_each([self]);
                pair
            }
            #[inline]
            fn sin_cos_each<const K: usize>(angles: [Self; K]) -> [(Self, Self); K] { $sin_cos(angles) }
            #[inline]
            fn tan(self) -> Self { Float::tan(self) }
            #[inline]
            fn asin(self) -> Self { Float::asin(self) }
            #[inline]
            fn acos(self) -> Self { Float::acos(self) }
            #[inline]
            fn atan(self) -> Self { Float::atan(self) }
            #[inline]
            fn atan2(self, other: Self) -> Self { Float::atan2(self, other) }
            #[inline]
            fn sinh(self) -> Self { Float::sinh(self) }
            #[inline]
            fn cosh(self) -> Self { Float::cosh(self) }
            #[inline]
            fn tanh(self) -> Self { Float::tanh(self) }
            #[inline]
            fn abs(self) -> Self { $float::abs(self) }
            #[inline]
            fn sign(self) -> Self { if self == 0.0 { 0.0 } else { $float::signum(self) } }
            #[inline]
            fn hypot(self, other: Self) -> Self { Float::hypot(self, other) }
            #[inline]
            fn pow(self, exponent: Self) -> Self { Float::powf(self, exponent) }
            #[inline(always)]
            fn if_positive(self, then: Self, otherwise: Self) -> Self {
                let arm = if self > 0.0 { then } else { otherwise };
                if self.is_nan() { self } else { arm }
            }
            #[allow(clippy::cast_possible_truncation, clippy::cast_lossless)]
            #[inline(always)]
            fn lookup<const A: usize, const C: usize>(
                arguments: [Self; A],
                find: impl Fn([f64; A]) -> [f64; C],
            ) -> [Self; C] {
                find(arguments.map(|argument| argument as f64)).map(|constant| constant as $float)
            }
        }

        impl Real for $float {
            #[allow(clippy::cast_lossless)]
            const EPSILON: f64 = $float::EPSILON as f64;

            #[inline]
            fn max(self, other: Self) -> Self { $float::max(self, other) }
            #[inline]
            fn is_finite(self) -> bool { $float::is_finite(self) }
            #[inline]
            fn is_positive(self) -> bool { self > 0.0 }
            #[inline]
            fn is_at_most(self, bound: Self) -> bool { self <= bound }
            #[allow(clippy::cast_lossless)]
            #[inline]
            fn to_f64(self) -> f64 { self as f64 }
        }

        impl Scalar for $float {}
    )*};
}

impl_real!(f64 sin_cos, f32 sin_cos_single);
