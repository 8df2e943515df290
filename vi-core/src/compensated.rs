//! Compensated summation.
//!
//! A number is the unevaluated sum of `value` and `low`. Adding an increment returns the new sum in the same form, by
//! Knuth's two-sum or Kahan's algorithm. There is no branch, so that it works for every [`Real`].

use crate::real::Real;
use nalgebra::SVector;

/// `a + b` as (rounded sum, rounding error).
#[inline(always)]
pub fn two_sum<T: Real>(a: T, b: T) -> (T, T) {
    let sum = a + b;
    let b_seen = sum - a;
    (sum, (a - (sum - b_seen)) + (b - b_seen))
}

/// Adds `increment`, exact to ε² of the sum, for repeated equal increments.
#[inline]
pub(crate) fn add<T: Real>(value: &mut T, low: &mut T, increment: T) {
    let (sum, lost) = two_sum(*value, increment);
    (*value, *low) = two_sum(sum, lost + *low);
}

/// The new `value` of [`add_rounded`].
#[inline(always)]
pub(crate) fn sum<T: Real>(value: T, low: T, increment: T) -> T {
    value + (increment + low)
}

/// Adds `increment`, exact to an ulp of the increment: Kahan's sum, a third of the operations.
#[inline(always)]
pub(crate) fn add_rounded<T: Real>(value: &mut T, low: &mut T, increment: T) {
    let sum = sum(*value, *low, increment);
    (*value, *low) = (sum, (increment + *low) - (sum - *value));
}

/// [`add_rounded`] bit for bit, by other operations: sums of both kinds do not share a SIMD register.
#[inline(always)]
fn add_rounded_apart<T: Real>(value: &mut T, low: &mut T, increment: T) {
    let sum = sum(*value, *low, increment);
    (*value, *low) = (sum, (*value - sum) + (increment + *low));
}

/// Adds vectors entry by entry.
#[inline(always)]
pub(crate) fn add_vector<T: Real, const N: usize>(
    value: &mut SVector<T, N>,
    low: &mut SVector<T, N>,
    increment: &SVector<T, N>,
) {
    add_each(value, low, increment, add_rounded);
}

/// [`add_vector`] bit for bit, for sums that are known later than those of [`add_vector`]. Otherwise the compiler packs
/// a momentum with its coordinate into one register, and the coordinate waits for it (double well: 22.3 ns a step
/// instead of 15.8).
#[inline(always)]
pub(crate) fn add_vector_apart<T: Real, const N: usize>(
    value: &mut SVector<T, N>,
    low: &mut SVector<T, N>,
    increment: &SVector<T, N>,
) {
    add_each(value, low, increment, add_rounded_apart);
}

#[inline(always)]
fn add_each<T: Real, const N: usize>(
    value: &mut SVector<T, N>,
    low: &mut SVector<T, N>,
    increment: &SVector<T, N>,
    add: impl Fn(&mut T, &mut T, T),
) {
    // Loops over slices vectorize, those over matrix iterators do not.
    let (value, low, increment) = (value.as_mut_slice(), low.as_mut_slice(), increment.as_slice());
    for ((value, low), increment) in value.iter_mut().zip(low).zip(increment) {
        add(value, low, *increment);
    }
}

#[cfg(test)]
mod tests {
    use super::add;

    #[test]
    fn a_million_tenths_lose_nothing() {
        let (mut value, mut low) = (0.0_f64, 0.0_f64);
        for _ in 0..1_000_000 {
            add(&mut value, &mut low, 0.1);
        }
        // The double 0.1 is 0.1 + 5.55e-18: a million of them sum to 100000 + 5.55e-12. A plain sum is wrong by 1.3e-6.
        assert!((value - 100_000.0 + low - 5.551_115_123_125_783e-12).abs() < 1e-24);
    }

    #[test]
    fn an_increment_too_small_to_see_is_kept() {
        let (mut value, mut low) = (1.0_f64, 0.0_f64);
        for _ in 0..1024 {
            add(&mut value, &mut low, f64::EPSILON / 4.0);
        }
        assert!((value - 1.0 - 256.0 * f64::EPSILON).abs() + low.abs() == 0.0);
    }
}
