//! Points at which expressions are evaluated to decide what holds everywhere.
//!
//! In: the number of a point, and how many symbols it has so far. Out: the number of the next symbol, from fixed sequences that look
//! random: the multiples of the golden ratio, and of √2 for the sign.

/// The largest power of ten by which a number of any size differs from 1.
const DECADES: f64 = 6.0;

/// A number in (0.1, 1.1), at every other point of either sign.
pub(super) fn near_one(point: u32, index: usize) -> f64 {
    let position = u32::try_from(index).map_or(0.0, f64::from).mul_add(16.0, f64::from(point) + 1.0);
    signed(0.1 + turns(position), position, point % 2 == 1)
}

/// A number of either sign from 1e-6 to 1e6, by its logarithm.
pub(super) fn of_any_size(point: u32, index: usize) -> f64 {
    let position = u32::try_from(index).map_or(0.0, f64::from).mul_add(32.0, f64::from(point) + 1.0);
    signed(10.0_f64.powf(DECADES * (2.0 * turns(position) - 1.0)), position, true)
}

/// What is left of a multiple of the golden ratio beyond whole turns.
fn turns(position: f64) -> f64 {
    (position * 0.618_033_988_749_894_9).fract()
}

/// A size with the sign of its position, if it has one.
fn signed(size: f64, position: f64, has_sign: bool) -> f64 {
    let negative = has_sign && (position * std::f64::consts::SQRT_2).fract() < 0.5;
    if negative { -size } else { size }
}
