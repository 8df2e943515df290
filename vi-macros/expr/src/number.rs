//! Exact powers of numbers, bounded in size.
//!
//! In: a rational base and a rational exponent. Out: [`Power`], a coefficient times roots that are not exact,
//! `(a/b)^e = c · a^r · b^s` with `0 < r, s < 1`. A fractional power of a negative number is undefined, as in
//! `f64::powf`.

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, ToPrimitive, Zero};

use crate::Rational;

/// Maximum bits of a folded number, numerator plus denominator; larger products stay unevaluated.
pub(crate) const MAX_BITS: u64 = 4096;

/// Base and exponent.
pub(crate) type Root = (Rational, Rational);

/// A power of a number.
pub(crate) enum Power {
    /// `coefficient · Π base^exponent`, the bases integers above 1, the exponents between 0 and 1.
    Folded { coefficient: Rational, roots: Vec<Root> },
    /// More than [`MAX_BITS`] bits.
    TooLarge,
    /// No real value: `0^-1`, `(-1)^(1/2)`.
    Undefined,
}

/// The nearest `f64`.
pub(crate) fn nearest(number: &Rational) -> f64 {
    number.to_f64().unwrap_or(f64::NAN)
}

/// Bits of numerator and denominator together; the denominator of an integer has none.
pub(crate) fn bits(number: &Rational) -> u64 {
    number.numer().bits() + number.denom().bits() - 1
}

/// `left + right`. Integers, the frequent case, skip the common divisor, whose cost is quadratic in the bits.
pub(crate) fn sum(left: &Rational, right: &Rational) -> Rational {
    if left.is_integer() && right.is_integer() {
        Rational::from_integer(left.numer() + right.numer())
    } else {
        left + right
    }
}

/// `left·right`. Integers and a factor 1 skip the common divisor.
pub(crate) fn product(left: &Rational, right: &Rational) -> Rational {
    if left.is_one() {
        right.clone()
    } else if right.is_one() {
        left.clone()
    } else if left.is_integer() && right.is_integer() {
        Rational::from_integer(left.numer() * right.numer())
    } else {
        left * right
    }
}

/// `base^exponent`.
pub(crate) fn power(base: &Rational, exponent: &Rational) -> Power {
    if exponent.is_integer() {
        return match integer_power(base, exponent.numer()) {
            _ if base.is_zero() && exponent.is_negative() => Power::Undefined,
            Some(coefficient) => Power::Folded { coefficient, roots: Vec::new() },
            None => Power::TooLarge,
        };
    }
    if base.is_negative() || (base.is_zero() && exponent.is_negative()) {
        return Power::Undefined;
    }
    if base.is_zero() {
        return Power::Folded { coefficient: Rational::zero(), roots: Vec::new() };
    }
    let mut coefficient = Rational::one();
    let mut roots = Vec::new();
    for (integer, exponent) in [(base.numer(), exponent.clone()), (base.denom(), -exponent)] {
        let Some((exact, root)) = integer_root(integer, exponent) else { return Power::TooLarge };
        coefficient = product(&coefficient, &exact);
        roots.extend(root);
    }
    Power::Folded { coefficient, roots }
}

/// The power, if it is exact and not too large.
pub(crate) fn exact_power(base: &Rational, exponent: &Rational) -> Option<Rational> {
    match power(base, exponent) {
        Power::Folded { coefficient, roots } if roots.is_empty() => Some(coefficient),
        _ => None,
    }
}

fn integer_power(base: &Rational, exponent: &BigInt) -> Option<Rational> {
    if base.is_one() || exponent.is_zero() {
        return Some(Rational::one());
    }
    if base.is_zero() {
        return exponent.is_positive().then(Rational::zero);
    }
    if (-base).is_one() {
        return Some(if exponent.is_odd() { base.clone() } else { Rational::one() });
    }
    let exponent = exponent.to_i32()?;
    let fits = exponent.unsigned_abs() == 1 || bits(base).checked_mul(exponent.unsigned_abs().into())? <= MAX_BITS;
    fits.then(|| base.pow(exponent))
}

/// A positive integer to a fractional exponent, as an exact part and possibly a root; `None` if it is too large.
fn integer_root(integer: &BigInt, exponent: Rational) -> Option<(Rational, Option<Root>)> {
    let base = Rational::from_integer(integer.clone());
    if base.is_one() {
        return Some((base, None));
    }
    // A root whose degree exceeds the bits of the number lies strictly between 1 and 2.
    let bits = integer.bits();
    if let Some(degree) = exponent.denom().to_u32().filter(|degree| bits <= MAX_BITS && u64::from(*degree) <= bits) {
        let root = integer.nth_root(degree);
        if root.pow(degree) == *integer {
            return Some((integer_power(&Rational::from_integer(root), exponent.numer())?, None));
        }
    }
    let whole = exponent.floor();
    let exact = integer_power(&base, whole.numer())?;
    Some((exact, Some((base, exponent - whole))))
}
