//! Ball arithmetic: numbers of any precision with rigorous error bounds.
//!
//! In: balls and the precision of the result. Out: a ball that contains the result of the operation for all members of
//! its operands. Middle and radius share one exponent. A middle has the bits of the precision, a radius at most
//! [`RADIUS_BITS`].

use num_bigint::BigInt;
use num_traits::{One, Signed, ToPrimitive, Zero};

use crate::Rational;

/// Bits of a radius.
const RADIUS_BITS: u64 = 32;

/// The numbers within `radius·2^exponent` of `middle·2^exponent`.
#[derive(Clone, Debug)]
pub(crate) struct Ball {
    pub(crate) middle: BigInt,
    pub(crate) radius: BigInt,
    pub(crate) exponent: i64,
}

impl Ball {
    pub(crate) fn integer(value: impl Into<BigInt>) -> Self {
        Self { middle: value.into(), radius: BigInt::zero(), exponent: 0 }
    }

    pub(crate) fn rational(value: &Rational, bits: u64) -> Self {
        if value.is_integer() {
            return Self::integer(value.numer().clone()).rounded(bits);
        }
        let shift = (bits + 2 + value.denom().bits()).saturating_sub(value.numer().bits());
        let middle = (value.numer() << shift) / value.denom();
        Self { middle, radius: BigInt::one(), exponent: -signed(shift) }.rounded(bits)
    }

    /// Whether the ball contains only the number 0.
    pub(crate) fn is_zero(&self) -> bool {
        self.middle.is_zero() && self.radius.is_zero()
    }

    pub(crate) fn contains_zero(&self) -> bool {
        self.middle.magnitude() <= self.radius.magnitude()
    }

    /// The least `e` with `|x| < 2^e` for all members `x`; for the ball 0 a number below all others.
    pub(crate) fn magnitude(&self) -> i64 {
        if self.is_zero() { i64::MIN / 4 } else { signed((self.middle.abs() + &self.radius).bits()) + self.exponent }
    }

    /// The magnitude of the radius.
    pub(crate) fn radius_magnitude(&self) -> i64 {
        if self.radius.is_zero() { i64::MIN / 4 } else { signed(self.radius.bits()) + self.exponent }
    }

    pub(crate) fn neg(&self) -> Self {
        Self { middle: -&self.middle, ..self.clone() }
    }

    pub(crate) fn abs(&self) -> Self {
        if self.middle.is_negative() { self.neg() } else { self.clone() }
    }

    /// `x·2^power`.
    pub(crate) fn scaled(&self, power: i64) -> Self {
        Self { exponent: self.exponent + power, ..self.clone() }
    }

    /// The ball, widened by `2^magnitude`.
    pub(crate) fn widened(&self, magnitude: i64, bits: u64) -> Self {
        let error = Self { middle: BigInt::zero(), radius: BigInt::one(), exponent: magnitude };
        self.plus(&error, bits)
    }

    /// Middle and radius in units of `2^unit`, which is not far below the magnitude.
    pub(crate) fn in_units(&self, unit: i64) -> (BigInt, BigInt) {
        let shift = (self.exponent - unit).unsigned_abs();
        if self.exponent >= unit {
            (&self.middle << shift, &self.radius << shift)
        } else {
            // Both are rounded down by less than one unit.
            (&self.middle >> shift, (&self.radius >> shift) + 2)
        }
    }

    fn rounded(self, bits: u64) -> Self {
        let excess = self.middle.bits().saturating_sub(bits).max(self.radius.bits().saturating_sub(RADIUS_BITS));
        if excess == 0 {
            return self;
        }
        let exponent = self.exponent + signed(excess);
        let (middle, radius) = self.in_units(exponent);
        Self { middle, radius, exponent }
    }

    pub(crate) fn plus(&self, other: &Self, bits: u64) -> Self {
        if self.is_zero() {
            return other.clone();
        }
        if other.is_zero() {
            return self.clone();
        }
        let top = self.magnitude().max(other.magnitude());
        let exponent = self.exponent.min(other.exponent).max(top - signed(bits) - 8);
        let (left, right) = (self.in_units(exponent), other.in_units(exponent));
        Self { middle: left.0 + right.0, radius: left.1 + right.1, exponent }.rounded(bits)
    }

    pub(crate) fn minus(&self, other: &Self, bits: u64) -> Self {
        self.plus(&other.neg(), bits)
    }

    pub(crate) fn times(&self, other: &Self, bits: u64) -> Self {
        let errors = self.middle.abs() * &other.radius + other.middle.abs() * &self.radius;
        let radius = errors + &self.radius * &other.radius;
        let exponent = self.exponent + other.exponent;
        Self { middle: &self.middle * &other.middle, radius, exponent }.rounded(bits)
    }

    /// `1/x` of a ball without zero: `|1/m - 1/x| ≤ r/(|m| (|m| - r))`.
    pub(crate) fn inverse(&self, bits: u64) -> Self {
        let shift = self.middle.bits() + bits + 2;
        let (unit, size) = (BigInt::one() << shift, self.middle.abs());
        let error = (&self.radius << shift) / (&size * (&size - &self.radius)) + 2;
        Self { middle: unit / &self.middle, radius: error, exponent: -self.exponent - signed(shift) }.rounded(bits)
    }

    pub(crate) fn over(&self, other: &Self, bits: u64) -> Self {
        self.times(&other.inverse(bits), bits)
    }

    /// The square root of a positive ball: `|√m - √x| ≤ r/√m`.
    pub(crate) fn root(&self, bits: u64) -> Self {
        let mut shift = (2 * bits + 4).saturating_sub(self.middle.bits());
        shift += u64::from((self.exponent - signed(shift)) % 2 != 0);
        let middle = (&self.middle << shift).sqrt();
        let radius = (&self.radius << shift) / &middle + 2;
        Self { middle, radius, exponent: (self.exponent - signed(shift)) / 2 }.rounded(bits)
    }

    /// `x^count` by squaring.
    pub(crate) fn power(&self, count: u32, bits: u64) -> Self {
        let mut power = Self::integer(1);
        for place in (0..u32::BITS - count.leading_zeros()).rev() {
            power = power.times(&power, bits);
            if count >> place & 1 == 1 {
                power = power.times(self, bits);
            }
        }
        power
    }

    /// The `f64` nearest to all members, if there is one; infinite beyond the range. A tie goes to the even one if
    /// `exact`: then the ball is so small that it represents the midpoint itself.
    pub(crate) fn nearest(&self, exact: bool) -> Option<f64> {
        if self.magnitude() > 1100 || self.magnitude() < -1200 {
            let limit = if self.magnitude() > 0 { f64::INFINITY } else { 0.0 };
            return Some(if self.middle.is_negative() { -limit } else { limit });
        }
        let scale = BigInt::one() << self.exponent.unsigned_abs();
        let round = |member: BigInt| {
            let member =
                if self.exponent < 0 { Rational::new_raw(member, scale.clone()) } else { (member * &scale).into() };
            member.to_f64()
        };
        let (low, high) = (round(&self.middle - &self.radius)?, round(&self.middle + &self.radius)?);
        let even = if low.to_bits().is_multiple_of(2) { low } else { high };
        if low.to_bits() == high.to_bits() { Some(low) } else { exact.then_some(even) }
    }
}

/// A number of bits as an exponent.
pub(crate) fn signed(bits: u64) -> i64 {
    i64::try_from(bits).unwrap_or(i64::MAX / 4)
}
