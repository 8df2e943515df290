//! Arrays of `let`s of a large system.
//!
//! In: their definitions, in which entries of arrays are symbols. Out: the arrays that stay, each entry by earlier ones,
//! and expressions without the others. An array stays if its entries use each other, or if an entry minus the previous
//! one is shorter than the entry itself: `sum(j in 0..i + 1, …)` becomes a recursion.

use super::body::Read;
use crate::model::{LetArray, Model, rate};
use crate::symbol::{LetEntry, Symbol, Variable};
use num_traits::{One, Zero};
use std::collections::BTreeSet;
use vi_expr::{Expr, Function, Node, Pool, Rational};

/// Shortest array that is a recursion.
const LEAST: usize = 3;

/// The arrays.
pub(super) struct Lets {
    arrays: Vec<Array>,
}

struct Array {
    width: usize,
    /// Whether the array becomes a recursion.
    stays: bool,
    definitions: Vec<Expr>,
}

impl Lets {
    /// Decides which arrays stay. `None` if an array reads one that is declared later, if a rate would be an acceleration,
    /// or if the limits of a root depend on the definition of an entry: straight lines compute or report these.
    pub(super) fn of(pool: &mut Pool<Symbol>, model: &Model) -> Option<Self> {
        let mut lets = Self { arrays: Vec::new() };
        let used = model.expressions().map(|(_, expr)| expr);
        let defined = model.lets.iter().flat_map(|array| array.definitions.iter().copied());
        let all: Vec<Expr> = used.chain(defined).collect();
        let with_rates = reads(pool, &all);
        let mut moves: Vec<bool> = Vec::new();
        for (place, LetArray { width, definitions, .. }) in model.lets.iter().enumerate() {
            let is_later =
                |symbol: &Symbol| matches!(symbol, Symbol::Let(entry) | Symbol::LetRate(entry) if entry.array > place);
            let is_moving = |symbol: &Symbol| match symbol {
                Symbol::Continuous(Variable::Velocity(_)) | Symbol::LetRate(_) => true,
                Symbol::Let(entry) => moves.get(entry.array).copied().unwrap_or(false),
                _ => false,
            };
            let has_jumps = |expr: Expr| {
                matches!(
                    pool.node(expr),
                    Node::Call(Function::Abs | Function::Sign, _) | Node::Select(_) | Node::Opaque(..)
                )
            };
            let is_wrong = definitions.iter().any(|definition| pool.depends_on(*definition, &is_later))
                || pool.reachable(definitions).into_iter().any(has_jumps);
            let moving = definitions.iter().any(|definition| pool.depends_on(*definition, &is_moving));
            if is_wrong || moving && with_rates.contains(&Read::LetRate(place)) {
                return None;
            }
            moves.push(moving);
            let own = |symbol: &Symbol| matches!(symbol, Symbol::Let(entry) if entry.array == place);
            let opened: Vec<Expr> = definitions.iter().map(|definition| lets.opened(pool, *definition)).collect();
            let is_recursive = opened.iter().any(|definition| pool.depends_on(*definition, &own));
            let by_differences = if is_recursive { None } else { differences(pool, place, *width, &opened) };
            let stays = is_recursive || by_differences.is_some();
            lets.arrays.push(Array { width: *width, stays, definitions: by_differences.unwrap_or(opened) });
        }
        Some(lets)
    }

    /// An expression without entries of the arrays that do not stay.
    pub(super) fn opened(&self, pool: &mut Pool<Symbol>, expr: Expr) -> Expr {
        pool.substitute(expr, &mut |pool, symbol| {
            let (Symbol::Let(entry) | Symbol::LetRate(entry)) = symbol else { return None };
            let array = self.arrays.get(entry.array).filter(|array| !array.stays)?;
            let definition = *array.definitions.get(entry.entry)?;
            Some(if matches!(symbol, Symbol::Let(_)) { definition } else { rate(pool, definition) })
        })
    }

    /// The arrays that stay and that these expressions read, directly or not: width and definitions, in the order of
    /// evaluation.
    pub(super) fn used(&self, pool: &mut Pool<Symbol>, exprs: &[Expr]) -> Vec<(Read, usize, Vec<Expr>)> {
        let mut wanted: BTreeSet<Read> = reads(pool, exprs);
        let mut found = Vec::new();
        for (place, array) in self.arrays.iter().enumerate().rev().filter(|(_, array)| array.stays) {
            if wanted.contains(&Read::LetRate(place)) {
                let rates: Vec<Expr> = array.definitions.iter().map(|definition| rate(pool, *definition)).collect();
                wanted.extend(reads(pool, &rates));
                found.push((Read::LetRate(place), array.width, rates));
            }
            if wanted.contains(&Read::Let(place)) {
                wanted.extend(reads(pool, &array.definitions));
                found.push((Read::Let(place), array.width, array.definitions.clone()));
            }
        }
        found.reverse();
        found
    }
}

/// The arrays of `let`s that expressions read.
fn reads(pool: &Pool<Symbol>, exprs: &[Expr]) -> BTreeSet<Read> {
    let symbols = pool.symbols_of(exprs);
    let read = |symbol: Symbol| match symbol {
        Symbol::Let(entry) => Some(Read::Let(entry.array)),
        Symbol::LetRate(entry) => Some(Read::LetRate(entry.array)),
        _ => None,
    };
    symbols.into_iter().filter_map(read).collect()
}

/// The definitions as entries of the previous row plus further terms. `None` if they are not sums that grow, or are not
/// shorter that way. A sum that loses terms would be a difference of large numbers.
fn differences(pool: &mut Pool<Symbol>, array: usize, width: usize, definitions: &[Expr]) -> Option<Vec<Expr>> {
    if definitions.len() < LEAST * width {
        return None;
    }
    let mut made = definitions[..width].to_vec();
    let (mut before, mut after) = (0, 0);
    for entry in width..definitions.len() {
        let difference = pool.sub(definitions[entry], definitions[entry - width]);
        if !adds(pool, definitions[entry], difference) {
            return None;
        }
        before = pool.reachable(&[definitions[entry]]).len();
        after = pool.reachable(&[difference]).len() + 2;
        let last = pool.symbol(Symbol::Let(LetEntry { array, entry: entry - width }));
        made.push(pool.add(last, difference));
    }
    (after < before).then_some(made)
}

/// Whether every term of a difference is a term of the sum.
fn adds(pool: &Pool<Symbol>, sum: Expr, difference: Expr) -> bool {
    let terms = |expr: Expr| match pool.node(expr) {
        Node::Sum(sum) => (sum.constant.clone(), sum.terms.clone()),
        Node::Number(number) => (number.clone(), Vec::new()),
        _ => (Rational::zero(), vec![(expr, Rational::one())]),
    };
    let ((_, all), (constant, further)) = (terms(sum), terms(difference));
    constant.is_zero() && further.iter().all(|term| all.contains(term))
}
