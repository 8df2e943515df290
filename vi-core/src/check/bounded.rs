//! Numbers with a rounding-error bound: a value, and a bound of its distance from the exact result of its formula.
//!
//! A function that is generic over [`Real`] returns the same bits as in `f64`, and the bound. Each operation adds its
//! own rounding error to the propagated errors of its operands:
//!
//! ```text
//! z = x + y    δz = δx + δy + ε |z|          z = x y    δz = |x| δy + |y| δx + δx δy + ε |z|
//! z = x / y    δz = (δx + |z| δy) / (|y| − δy) + ε |z|          z = f(x)    δz = max |f'| δx + 2 ε |z|
//! ```
//!
//! ε = 2⁻⁵² is twice the rounding error of one IEEE operation, and the error that library functions may have.
//! Cancellation keeps the rounding errors in the bound. Source: Higham, Accuracy and Stability of Numerical Algorithms,
//! section 3.3 (running error analysis).

use crate::real::{Number, Real, assignments};
use crate::vector::worse;
use alloc::vec::Vec;
use core::ops::{Add, Div, Mul, Neg, Sub};
use nalgebra::SVector;

const EPSILON: f64 = f64::EPSILON;
/// A constant counts as exact if it is at most this number, and a multiple of its inverse.
const EXACT: f64 = 1_048_576.0;

/// A value and the bound of its rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounded {
    pub(super) value: f64,
    /// Not negative; infinite or NaN if there is no bound.
    pub(super) error: f64,
}

impl Bounded {
    /// An exact number.
    pub(super) fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// A number after one rounding, or two.
    pub(super) fn once(value: f64) -> Self {
        Self { value, error: EPSILON * value.abs() }
    }

    /// The result of an operation or of a function, with the propagated error `error` of its operands.
    fn after(value: f64, error: f64, roundings: f64) -> Self {
        Self { value, error: error + roundings * EPSILON * value.abs() }
    }

    /// f(self), with a bound of |f'| over the error interval.
    fn chain(self, value: f64, slope: f64) -> Self {
        // Avoids 0 · ∞ if f' has no bound.
        let error = if self.error == 0.0 { 0.0 } else { slope * self.error };
        Self::after(value, error, 2.0)
    }

    /// The smallest |x| within the bound.
    fn least(self) -> f64 {
        (self.value.abs() - self.error).max(0.0)
    }

    /// The largest |x| within the bound.
    pub(super) fn most(self) -> f64 {
        self.value.abs() + self.error
    }

    /// This bound with a value that the same formula gave elsewhere.
    pub(super) fn of(self, value: f64) -> Self {
        Self { value, ..self }
    }

    /// Whether the number is nonzero beyond its rounding error.
    pub(super) fn is_seen(self) -> bool {
        self.value.abs() > self.error
    }
}

/// An exact vector.
pub(super) fn exact<const N: usize>(vector: &SVector<f64, N>) -> SVector<Bounded, N> {
    vector.map(Bounded::exact)
}

/// These bounds with a vector that the same formula gave elsewhere.
pub(super) fn vector_of<const N: usize>(value: &SVector<f64, N>, again: &SVector<Bounded, N>) -> SVector<Bounded, N> {
    again.zip_map(value, Bounded::of)
}

/// Up to this number of unknowns running error analysis bounds the errors of an elimination.
const FEW: usize = 24;
/// Roundings of the largest entry of a solution, for each unknown.
const STABLE: f64 = 8.0;

/// The solution of linear equations, with error bounds for their residual. `again` has the bounds of the elimination.
///
/// Bounds by running error analysis double with each unknown. The residual of many unknowns has the size of that of an
/// exact solution whose entries have a few roundings of the largest one for each unknown (Higham, section 9.3).
#[allow(clippy::cast_precision_loss, reason = "a few hundred unknowns")]
pub(super) fn solution(value: &[f64], again: &[Bounded], unknowns: usize) -> Vec<Bounded> {
    let largest = value.iter().fold(0.0, |largest, entry| worse(largest, entry.abs()));
    let stable = if unknowns <= FEW { f64::INFINITY } else { STABLE * unknowns as f64 * EPSILON * largest };
    let entries = value.iter().zip(again);
    entries.map(|(value, again)| Bounded { value: *value, error: again.error.min(stable) }).collect()
}

/// A vector after one rounding per entry, or two.
pub(super) fn once<const N: usize>(vector: &SVector<f64, N>) -> SVector<Bounded, N> {
    vector.map(Bounded::once)
}

impl Add for Bounded {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        // The sum with zero is exact.
        let roundings = if self.value == 0.0 || other.value == 0.0 { 0.0 } else { 1.0 };
        Self::after(self.value + other.value, self.error + other.error, roundings)
    }
}

impl Sub for Bounded {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Bounded {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let error = self.value.abs() * other.error + self.error * other.most();
        Self::after(self.value * other.value, error, 1.0)
    }
}

impl Div for Bounded {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let error = (self.error + value.abs() * other.error) / other.least();
        Self::after(value, error, 1.0)
    }
}

impl Neg for Bounded {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, error: self.error }
    }
}

assignments!(Bounded);

impl num_traits::Zero for Bounded {
    fn zero() -> Self {
        Self::exact(0.0)
    }
    fn is_zero(&self) -> bool {
        self.most() == 0.0
    }
}

impl num_traits::One for Bounded {
    fn one() -> Self {
        Self::exact(1.0)
    }
}

impl Number for Bounded {
    /// A constant of a formula: rounded once, unless it is an exact fraction.
    fn real(value: f64) -> Self {
        let is_exact = value.abs() <= EXACT && value * EXACT % 1.0 == 0.0;
        if is_exact { Self::exact(value) } else { Self::once(value) }
    }
    fn recip(self) -> Self {
        Self::exact(1.0) / self
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        if root == 0.0 { Self::after(root, self.error.sqrt(), 0.0) } else { self.chain(root, root.recip()) }
    }
    fn exp(self) -> Self {
        let value = self.value.exp();
        Self::after(value, value * num_traits::Float::exp_m1(self.error), 2.0)
    }
    fn ln(self) -> Self {
        self.chain(self.value.ln(), self.least().recip())
    }
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = Number::sin_cos(self.value);
        // The reduced angle is rounded at a distance from zero.
        let (error, reduced) = (self.error.min(2.0), EPSILON * EPSILON * self.value.abs());
        let bound = |value: f64, slope: f64| Self::after(value, (slope.abs() + error) * error + reduced, 2.0);
        (bound(sin, cos), bound(cos, sin))
    }
    fn tan(self) -> Self {
        let (sin, cos) = self.sin_cos();
        Self { value: self.value.tan(), error: (sin / cos).error }
    }
    fn asin(self) -> Self {
        self.chain(self.value.asin(), (1.0 - self.most() * self.most()).max(0.0).sqrt().recip())
    }
    fn acos(self) -> Self {
        self.chain(self.value.acos(), (1.0 - self.most() * self.most()).max(0.0).sqrt().recip())
    }
    fn atan(self) -> Self {
        self.chain(self.value.atan(), (1.0 + self.least() * self.least()).recip())
    }
    fn atan2(self, other: Self) -> Self {
        let distance = self.least() * self.least() + other.least() * other.least();
        let across = self.error * other.most() + other.error * self.most();
        // The error interval may cross the negative axis, where the angle jumps by a turn.
        let may_jump = self.error > 0.0 && self.least() == 0.0 && other.value <= other.error;
        let error = if across == 0.0 { 0.0 } else { across / distance };
        Self::after(self.value.atan2(other.value), if may_jump { core::f64::consts::TAU } else { error }, 2.0)
    }
    fn sinh(self) -> Self {
        self.chain(self.value.sinh(), self.most().cosh())
    }
    fn cosh(self) -> Self {
        self.chain(self.value.cosh(), self.most().sinh())
    }
    fn tanh(self) -> Self {
        let least = self.least().tanh();
        self.chain(self.value.tanh(), 1.0 - least * least)
    }
    fn abs(self) -> Self {
        Self { value: self.value.abs(), error: self.error }
    }
    fn sign(self) -> Self {
        Self { value: Number::sign(self.value), error: if self.is_seen() || self.error == 0.0 { 0.0 } else { 2.0 } }
    }
    fn hypot(self, other: Self) -> Self {
        Self::after(self.value.hypot(other.value), self.error + other.error, 2.0)
    }
    fn pow(self, exponent: Self) -> Self {
        let value = self.value.pow(exponent.value);
        if self.value == 0.0 {
            return Self { value, error: if self.error == 0.0 { 0.0 } else { self.error.pow(exponent.value) } };
        }
        // The bound of ln z = y ln x. An exact exponent needs no ln x, which does not exist for a negative base.
        let by_base = if self.error == 0.0 { 0.0 } else { exponent.most() * self.error / self.least() };
        let by_exponent = if exponent.error == 0.0 { 0.0 } else { self.value.ln().abs() * exponent.error };
        Self::after(value, value.abs() * num_traits::Float::exp_m1(by_base + by_exponent), 2.0)
    }
    /// Without bound if the base may be zero.
    fn zero_where(self, base: Self, _derivatives: u8) -> Self {
        let value = if base.value == 0.0 { 0.0 } else { self.value };
        let error = match (base.value == 0.0, base.is_seen()) {
            (true, _) if base.error == 0.0 => 0.0,
            (false, true) => self.error,
            _ => f64::INFINITY,
        };
        Self { value, error }
    }
    /// With the distance to the other arm if either may be selected.
    fn if_positive(self, then: Self, otherwise: Self) -> Self {
        if self.value.is_nan() {
            return self;
        }
        let (arm, other) = if self.value > 0.0 { (then, otherwise) } else { (otherwise, then) };
        let is_known = self.error == 0.0 || self.is_seen();
        let farthest = if is_known { 0.0 } else { (arm.value - other.value).abs() + other.error };
        Self { error: worse(arm.error, farthest), ..arm }
    }
    /// The constants of the piece at the value. Neighbouring pieces agree at their common border.
    fn lookup<const A: usize, const C: usize>(arguments: [Self; A], find: impl Fn([f64; A]) -> [f64; C]) -> [Self; C] {
        find(arguments.map(|argument| argument.value)).map(Self::once)
    }
    fn presence(self) -> Self {
        Self::exact(if self.most() == 0.0 { 0.0 } else { 1.0 })
    }
}

impl Real for Bounded {
    const EPSILON: f64 = EPSILON;

    fn max(self, other: Self) -> Self {
        let larger = if self.value >= other.value { self } else { other };
        Self { error: self.error.max(other.error), ..larger }
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
    use super::*;

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
        assert_eq!(Bounded::once(0.1).zero_where(Bounded::once(0.3), 0), Bounded::once(0.1));
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
