//! What rounding is measured in.
//!
//! In: a residual r. Out: Σ |coefficient|·|term|, where a factor of a term that is itself a sum counts term by term, and
//! what the rounding of the arguments of L and f does to it,
//!
//! ```text
//! Σ |∂r/∂q_i|·|q_i| + |∂r/∂t|·|t|      at the points of the rule
//! ```
//!
//! A pendulum that turns at θ = π/2 shows why: there cos θ and all terms of its energy vanish, but not the rounding of
//! θ. A residual below `eps` times this is zero as far as the arithmetic can tell. Low parts are below it, and left out.

use crate::symbol::{Symbol, Variable};
use num_traits::{Signed, Zero};
use vi_expr::{Expr, Function, Node, Pool, Product, Rational, Sum};

/// The magnitude of an expression.
pub(super) fn magnitude(pool: &mut Pool<Symbol>, expr: Expr) -> Expr {
    let own = match pool.node(expr).clone() {
        Node::Sum(sum) => terms(pool, &sum, term),
        _ => term(pool, expr),
    };
    let mut found = vec![own];
    for symbol in pool.symbols(expr) {
        if let Symbol::AtPoint(_, Variable::Time | Variable::Coordinate(_)) = symbol {
            let slope =
                pool.derivative(expr, &mut |pool, other| if *other == symbol { pool.one() } else { pool.zero() });
            let argument = pool.symbol(symbol);
            let change = pool.mul(slope, argument);
            found.push(absolute(pool, change));
        }
    }
    pool.sum(&found)
}

fn terms(pool: &mut Pool<Symbol>, sum: &Sum, of: fn(&mut Pool<Symbol>, Expr) -> Expr) -> Expr {
    let mut found = vec![pool.number(sum.constant.abs())];
    for (expr, coefficient) in &sum.terms {
        if is_low(pool, *expr) {
            continue;
        }
        let absolute = of(pool, *expr);
        found.push(pool.scale(absolute, &coefficient.abs()));
    }
    pool.sum(&found)
}

/// A low part, or a product with one.
fn is_low(pool: &Pool<Symbol>, expr: Expr) -> bool {
    let low = |expr: Expr| matches!(pool.node(expr), Node::Symbol(Symbol::Low(_)));
    match pool.node(expr) {
        Node::Product(product) => product.factors.iter().any(|(base, _)| low(*base)),
        _ => low(expr),
    }
}

/// One term: the product of the magnitudes of its factors.
fn term(pool: &mut Pool<Symbol>, expr: Expr) -> Expr {
    let Node::Product(Product { factors }) = pool.node(expr).clone() else {
        return absolute(pool, expr);
    };
    let (mut sums, mut others) = (Vec::new(), Vec::new());
    for (base, exponent) in factors {
        let node = pool.node(base).clone();
        match node {
            Node::Sum(sum) if exponent == Rational::from_integer(1.into()) => sums.push(terms(pool, &sum, absolute)),
            _ => others.push(pool.power(base, &exponent)),
        }
    }
    let others = pool.product(&others);
    sums.push(absolute(pool, others));
    pool.product(&sums)
}

/// |expr|; what is never negative stays.
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
