//! Points at which expressions are evaluated to decide identities.
//!
//! In: expressions, and the number of a point. Out: their values with their rounding errors, where each symbol has a
//! number of fixed pseudo-random sequences: multiples of the golden ratio, and of √2 for the sign. The points have several
//! sizes: at one of them an angle of 1e15 times a coordinate keeps its digits, and at some of them a root such as
//! sqrt(c^2*dot(T)^2 - dot(x)^2) has a value.

use super::Parameter;
use crate::symbol::Symbol;
use std::collections::BTreeMap;
use vi_expr::{Expr, Pool, Rounded};

/// The number of points: most that are used while expressions have no value, or are zero.
pub(super) const POINTS: u32 = 42;
/// Sizes of the first points. Symbols are positive at every other point, and of both signs at the rest.
const SIZES: [f64; 10] = [1.0, 1.0, 1.0, 1.0, 1e-8, 1e-8, 1e-16, 1e-16, 1e-40, 1e-40];
/// A value below this multiple of its rounding error counts as zero.
pub(super) const MARGIN: f64 = 64.0;
/// Largest power of ten by which a value of any size differs from 1.
const DECADES: f64 = 6.0;

/// The values of expressions at a point.
pub(super) fn values(pool: &Pool<Symbol>, exprs: &[Expr], point: u32, parameters: &[Parameter]) -> Vec<Rounded> {
    let mut values = BTreeMap::new();
    pool.evaluate_rounded(exprs, &mut |symbol| {
        let drawn = number(point, values.len(), symbol, parameters);
        *values.entry(symbol.clone()).or_insert(drawn)
    })
}

/// Whether expressions are zero to rounding at every point with values, and at one such point at least.
pub(super) fn vanish(pool: &Pool<Symbol>, exprs: &[Expr], parameters: &[Parameter]) -> bool {
    let mut is_known = exprs.is_empty();
    for point in 0..POINTS {
        let values = values(pool, exprs, point, parameters);
        if values.iter().any(|value| value.value.is_nan()) {
            continue;
        }
        if values.iter().any(|value| value.value.abs() > MARGIN * value.error) {
            return false;
        }
        is_known = true;
    }
    is_known
}

/// The number of a symbol at a point. At the first points all numbers have one size; at the others each has its own
/// size, and at every other of these the parameters have their defaults.
fn number(point: u32, index: usize, symbol: &Symbol, parameters: &[Parameter]) -> f64 {
    if let Some(size) = usize::try_from(point).ok().and_then(|point| SIZES.get(point)) {
        return size * near_one(point, index);
    }
    let default = match symbol {
        Symbol::Parameter { index, .. } if point.is_multiple_of(2) => {
            parameters.get(*index).map(|parameter| parameter.default)
        }
        _ => None,
    };
    default.filter(|default| *default != 0.0).unwrap_or_else(|| of_any_size(point, index))
}

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
