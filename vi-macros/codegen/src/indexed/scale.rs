//! The time scale of a large system: a function of a few sums.
//!
//! In: g. Out: a [`Scale`]. For `g = V^(-3/2)` with a sum V over all pairs it has one part, the sum `g_1 = V`, and the
//! whole `g_1^(-3/2)`.

use super::body::{Body, Read};
use super::{NUMBERS, Nest, STATES, Sum, summands, sums_of_each};
use crate::symbol::Symbol;
use num_traits::One;
use vi_expr::{Expr, Node, Pool};

/// The time scale g.
pub struct Scale {
    /// The terms of the parts; the first number of an instance is the part.
    pub parts: Vec<Sum>,
    /// Number of parts.
    pub count: usize,
    /// g from its parts and few other numbers, in one row.
    pub whole: Sum,
}

impl Scale {
    /// The time scale g as parts and a whole; `None` if terms do not repeat, or g is no function of a few sums.
    pub(super) fn of(pool: &mut Pool<Symbol>, g: Expr) -> Option<Self> {
        let mut found = Vec::new();
        let whole = folded(pool, g, &mut found);
        let symbols = pool.symbols(whole).into_iter();
        let mut others: Vec<((Read, usize), Symbol)> =
            symbols.filter_map(|symbol| Some((Read::of(&symbol)?, symbol))).collect();
        others.sort_unstable();
        let count = found.len();
        let place = |symbol: &Symbol| others.iter().position(|(_, known)| known == symbol).map(|at| count + at);
        let whole = pool.substitute(whole, &mut |pool, symbol| {
            let place = place(symbol)?;
            Some(pool.symbol(Symbol::Access(place)))
        });
        let reads: Vec<Read> =
            (0..count).map(|_| Read::Part).chain(others.iter().map(|((read, _), _)| *read)).collect();
        if reads.iter().filter(|read| read.is_of_state()).count() > STATES {
            return None;
        }
        let row: Vec<usize> = (0..count).chain(others.iter().map(|((_, column), _)| *column)).collect();
        let parts = sums_of_each(pool, &found, false)?;
        let whole = Sum { body: Body::of(pool, reads, &[whole], false)?, nests: vec![Nest::single(&[row])?] };
        Some(Self { parts, count, whole })
    }
}

/// The expression in which each long sum of short terms is replaced by its place among the sums found.
fn folded(pool: &mut Pool<Symbol>, expr: Expr, found: &mut Vec<Expr>) -> Expr {
    if states(pool, expr) <= NUMBERS {
        return expr;
    }
    match pool.node(expr).clone() {
        Node::Sum(sum) => {
            if summands(pool, expr).into_iter().all(|term| is_short(pool, term)) {
                let place = found.iter().position(|known| *known == expr).unwrap_or(found.len());
                if place == found.len() {
                    found.push(expr);
                }
                return pool.symbol(Symbol::Access(place));
            }
            let mut terms = vec![pool.number(sum.constant)];
            for (term, coefficient) in sum.terms {
                let term = folded(pool, term, found);
                terms.push(pool.scale(term, &coefficient));
            }
            pool.sum(&terms)
        }
        Node::Product(product) => {
            let mut factors = Vec::with_capacity(product.factors.len());
            for (base, exponent) in product.factors {
                let base = folded(pool, base, found);
                factors.push(if exponent.is_one() { base } else { pool.power(base, &exponent) });
            }
            pool.product(&factors)
        }
        Node::Call(function, arguments) => {
            let arguments: Vec<Expr> = arguments.into_iter().map(|argument| folded(pool, argument, found)).collect();
            pool.call(function, &arguments)
        }
        _ => expr,
    }
}

/// Whether a term is a row of a loop: it contains no long sum.
fn is_short(pool: &Pool<Symbol>, term: Expr) -> bool {
    let is_long = |part: Expr| matches!(pool.node(part), Node::Sum(_)) && states(pool, part) > NUMBERS;
    states(pool, term) <= STATES && !pool.reachable(&[term]).into_iter().any(is_long)
}

/// The number of coordinates and velocities that an expression contains.
fn states(pool: &Pool<Symbol>, expr: Expr) -> usize {
    let of_state = |symbol: &Symbol| Read::of(symbol).is_some_and(|(read, _)| read.is_of_state());
    pool.symbols(expr).iter().filter(|symbol| of_state(symbol)).count()
}
