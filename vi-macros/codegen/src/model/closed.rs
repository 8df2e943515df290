//! Arrays of `let`s whose entries stay symbols.
//!
//! In: an expression with symbols of entries. Out: the same by time, coordinates and velocities.

use crate::symbol::{Symbol, Variable};
use vi_expr::{Expr, Pool};

/// An array of `let`s whose entries stay symbols.
pub struct LetArray {
    /// Its name.
    pub name: String,
    /// Numbers in one entry: 1, or the length of a vector.
    pub width: usize,
    /// The definitions of the numbers, in order; they contain symbols of earlier ones.
    pub definitions: Vec<Expr>,
}

/// The derivative of an expression of time, coordinates and `let`s with respect to time.
pub fn rate(pool: &mut Pool<Symbol>, expr: Expr) -> Expr {
    pool.derivative(expr, &mut |pool, symbol| match symbol {
        Symbol::Continuous(Variable::Time) => pool.one(),
        Symbol::Continuous(Variable::Coordinate(index)) => pool.symbol(Symbol::Continuous(Variable::Velocity(*index))),
        Symbol::Let(entry) => pool.symbol(Symbol::LetRate(*entry)),
        _ => pool.zero(),
    })
}

/// The numbers of arrays that stay symbols, by coordinates.
pub(super) struct Closed(Vec<Vec<Expr>>);

impl Closed {
    pub(super) fn of(pool: &mut Pool<Symbol>, arrays: &[LetArray]) -> Self {
        let mut closed = Self(Vec::new());
        for (place, LetArray { definitions, .. }) in arrays.iter().enumerate() {
            closed.0.push(Vec::with_capacity(definitions.len()));
            for definition in definitions {
                let number = closed.expression(pool, *definition);
                closed.0[place].push(number);
            }
        }
        closed
    }

    /// An expression by coordinates.
    pub(super) fn expression(&self, pool: &mut Pool<Symbol>, expr: Expr) -> Expr {
        if self.0.is_empty() {
            return expr;
        }
        pool.substitute(expr, &mut |pool, symbol| {
            let (Symbol::Let(entry) | Symbol::LetRate(entry)) = symbol else { return None };
            let number = *self.0.get(entry.array)?.get(entry.entry)?;
            Some(if matches!(symbol, Symbol::Let(_)) { number } else { rate(pool, number) })
        })
    }
}
