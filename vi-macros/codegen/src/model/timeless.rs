//! Explicit time that cancels.
//!
//! In: an expression in t. Out: the same expression with its terms in t multiplied out, if t cancels in them: a mass in a
//! frame that turns about the vertical has `(dot(x) - w*y)^2 + …` in place of sines of `w*t`. Others are unchanged, and
//! so are terms without t: multiplied out, they might lose digits.

use vi_expr::{Expr, Node, Pool};

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
    let expanded = multiplied_out(&mut trial, expr);
    if expanded.is_some_and(|expanded| !trial.depends_on(expanded, &is_time)) {
        multiplied_out(pool, expr).unwrap_or(expr)
    } else {
        expr
    }
}

/// The expression with its terms in t multiplied out; `None` if it becomes too large.
fn multiplied_out(pool: &mut Pool<Symbol>, expr: Expr) -> Option<Expr> {
    let Node::Sum(sum) = pool.node(expr).clone() else { return pool.expand(expr).ok() };
    let (mut moving, mut fixed) = (Vec::new(), Vec::new());
    for (term, coefficient) in sum.terms {
        let of_time = pool.depends_on(term, &is_time);
        let term = pool.scale(term, &coefficient);
        if of_time { &mut moving } else { &mut fixed }.push(term);
    }
    let moving = pool.sum(&moving);
    let expanded = pool.expand(moving).ok()?;
    let constant = pool.number(sum.constant);
    fixed.extend([expanded, constant]);
    Some(pool.sum(&fixed))
}
