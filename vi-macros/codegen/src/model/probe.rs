//! Points at which expressions are evaluated to decide identities.
//!
//! In: the number of a point and the number of its symbols so far. Out: the value of the next symbol, from fixed
//! pseudo-random sequences: multiples of the golden ratio, and of √2 for the sign.

/// Largest power of ten by which a value of any size differs from 1.
const DECADES: f64 = 6.0;

/// A number in (0.1, 1.1), with either sign at every other point.
pub(super) fn near_one(point: u32, index: usize) -> f64 {
    let position = u32::try_from(index).map_or(0.0, f64::from).mul_add(16.0, f64::from(point) + 1.0);
    signed(0.1 + turns(position), position, point % 2 == 1)
}

/// A number of either sign from 1e-6 to 1e6, log-uniform.
pub(super) fn of_any_size(point: u32, index: usize) -> f64 {
    let position = u32::try_from(index).map_or(0.0, f64::from).mul_add(32.0, f64::from(point) + 1.0);
    signed(10.0_f64.powf(DECADES * (2.0 * turns(position) - 1.0)), position, true)
}

/// The fractional part of a multiple of the golden ratio.
fn turns(position: f64) -> f64 {
    (position * 0.618_033_988_749_894_9).fract()
}

/// A size with the sign of its position, if `has_sign`.
fn signed(size: f64, position: f64, has_sign: bool) -> f64 {
    let negative = has_sign && (position * std::f64::consts::SQRT_2).fract() < 0.5;
    if negative { -size } else { size }
}
