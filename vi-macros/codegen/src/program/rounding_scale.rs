//! The rounding scale of a residual: the sum of its absolute terms.
//!
//! In: a residual r. Out: Σ |coefficient|·|term|. A sum inside a term counts term by term too, down to [`DEPTH`]
//! levels. A residual below `eps` times this scale is zero to rounding. Low parts are even smaller and are omitted. A
//! product that has a limit although a factor is infinite counts as one term.

use super::vanishing::Known;
use crate::symbol::Symbol;
use num_traits::{One, Signed, Zero};
use vi_expr::{Expr, Function, Node, Pool, Product, Rational, Sum};

/// Levels of nested sums that count term by term.
const DEPTH: u32 = 4;

/// The sum of the absolute values of the terms of an expression.
pub(super) fn rounding_scale(pool: &mut Pool<Symbol>, known: &mut Known, expr: Expr) -> Expr {
    term_by_term(pool, known, expr, DEPTH)
}

fn term_by_term(pool: &mut Pool<Symbol>, known: &mut Known, expr: Expr, depth: u32) -> Expr {
    match pool.node(expr).clone() {
        Node::Sum(sum) if depth > 0 => terms(pool, known, &sum, depth - 1),
        Node::Product(product) if known.limits(pool, &product.factors).is_none() => {
            factors(pool, known, &product, depth)
        }
        _ => absolute(pool, expr),
    }
}

fn terms(pool: &mut Pool<Symbol>, known: &mut Known, sum: &Sum, depth: u32) -> Expr {
    let mut found = vec![pool.number(sum.constant.abs())];
    for (expr, coefficient) in &sum.terms {
        if is_low(pool, *expr) {
            continue;
        }
        let absolute = term_by_term(pool, known, *expr, depth);
        found.push(pool.scale(absolute, &coefficient.abs()));
    }
    pool.sum(&found)
}

/// The product of the scales of its factors. For s^n this is `n |s|^(n−1)` times the scale of s, by the chain rule.
fn factors(pool: &mut Pool<Symbol>, known: &mut Known, product: &Product, depth: u32) -> Expr {
    let (mut sums, mut others) = (Vec::new(), Vec::new());
    for (base, exponent) in &product.factors {
        let is_power_of_sum =
            matches!(pool.node(*base), Node::Sum(_)) && exponent.is_integer() && exponent.is_positive();
        if is_power_of_sum {
            let scale = term_by_term(pool, known, *base, depth);
            sums.push(pool.scale(scale, exponent));
            others.push(pool.power(*base, &(exponent - Rational::one())));
        } else {
            others.push(pool.power(*base, exponent));
        }
    }
    let others = pool.product(&others);
    sums.push(absolute(pool, others));
    pool.product(&sums)
}

/// Whether it is a low part, or a product with one.
fn is_low(pool: &Pool<Symbol>, expr: Expr) -> bool {
    let low = |expr: Expr| matches!(pool.node(expr), Node::Symbol(Symbol::Low(_)));
    match pool.node(expr) {
        Node::Product(product) => product.factors.iter().any(|(base, _)| low(*base)),
        _ => low(expr),
    }
}

/// |expr|; an expression that is never negative stays unchanged.
fn absolute(pool: &mut Pool<Symbol>, expr: Expr) -> Expr {
    let never_negative = match pool.node(expr) {
        Node::Number(number) => !number.is_negative(),
        Node::Product(product) => product.factors.iter().all(|(_, exponent)| {
            (exponent / Rational::from_integer(2.into())).is_integer() || *exponent.denom() == 2.into()
        }),
        Node::Sum(sum) => sum.terms.is_empty() && sum.constant.is_zero(),
        _ => false,
    };
    if never_negative { expr } else { pool.call(Function::Abs, &[expr]) }
}
