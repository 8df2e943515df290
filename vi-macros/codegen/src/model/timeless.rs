//! Explicit time that cancels.
//!
//! In: an expression in t. Out: the same expression multiplied out, if t cancels in it: a mass in a frame that turns
//! about the vertical has `(dot(x) - w*y)^2 + …` in place of sines of `w*t`. Others are unchanged.

use vi_expr::{Expr, Pool};

use super::probe;
use crate::symbol::{Symbol, Variable};

/// Number of points at which the derivative with respect to t is evaluated.
const POINTS: u32 = 3;

/// Larger values are no rounding errors of zero, at points of about 1.
const ZERO: f64 = 1e-9;

fn is_time(symbol: &Symbol) -> bool {
    *symbol == Symbol::Continuous(Variable::Time)
}

/// The expression without t, if t cancels. An expression that depends on the time leaves the pool as it is, so that the
/// order of its terms does not depend on this search.
pub(super) fn timeless(pool: &mut Pool<Symbol>, expr: Expr) -> Expr {
    if !pool.depends_on(expr, &is_time) {
        return expr;
    }
    let mut trial = pool.clone();
    let slope = trial.derivative(expr, &mut |pool, symbol| if is_time(symbol) { pool.one() } else { pool.zero() });
    let is_zero = |point: u32| {
        let mut drawn = std::collections::BTreeMap::new();
        let values = trial.evaluate_all(&[slope], &mut |symbol| {
            let index = drawn.len();
            *drawn.entry(symbol.clone()).or_insert_with(|| probe::near_one(point, index))
        });
        values.iter().all(|value| value.abs() < ZERO)
    };
    if !(0..POINTS).all(is_zero) {
        return expr;
    }
    match trial.expand(expr) {
        Ok(expanded) if !trial.depends_on(expanded, &is_time) => pool.expand(expr).unwrap_or(expr),
        _ => expr,
    }
}
