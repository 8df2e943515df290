//! The mass matrix M = ∂²L/∂v², which every method inverts.
//!
//! In: L. Out: nothing, or the message that M is singular for every state. A determinant that vanishes at
//! [`PROBES`] points drawn from a fixed sequence vanishes identically, but for a chance of nothing.

use super::Coordinate;
use crate::messages::{Message, error};
use crate::symbol::{Symbol, Variable};
use proc_macro2::Span;
use std::collections::BTreeMap;
use syn::Result;
use vi_expr::{Expr, Pool};

/// Points at which the determinant is evaluated.
const PROBES: u32 = 8;
/// A pivot below this, relative to the largest entry of the matrix, counts as zero.
const SINGULAR: f64 = 1e-11;

/// Checks that M is not singular for every state.
pub(super) fn check(pool: &mut Pool<Symbol>, coordinates: &[Coordinate], lagrangian: Expr, span: Span) -> Result<()> {
    let dimension = coordinates.len();
    let momenta: Vec<Expr> = (0..dimension).map(|index| by_velocity(pool, lagrangian, index)).collect();
    let mut entries = Vec::with_capacity(dimension * dimension);
    for momentum in momenta {
        entries.extend((0..dimension).map(|index| by_velocity(pool, momentum, index)));
    }
    let empty = (0..dimension).find(|row| entries[row * dimension..][..dimension].iter().all(|e| pool.is_zero(*e)));
    let singular = empty.is_some()
        || (0..PROBES).all(|probe| {
            let mut values = BTreeMap::new();
            let mut matrix = pool.evaluate_all(&entries, &mut |symbol| {
                let drawn = draw(probe, values.len());
                *values.entry(symbol.clone()).or_insert(drawn)
            });
            // A point where L is not defined says nothing; it is not held against the system.
            matrix.iter().all(|entry| entry.is_finite()) && !invertible(&mut matrix, dimension)
        });
    if singular {
        let missing = empty.map(|row| coordinates[row].text());
        let span = empty.map_or(span, |row| coordinates[row].name.span());
        return Err(error(span, &Message::SingularMass { missing }));
    }
    Ok(())
}

fn by_velocity(pool: &mut Pool<Symbol>, expr: Expr, index: usize) -> Expr {
    pool.derivative(expr, &mut |pool, symbol| {
        if *symbol == Symbol::Continuous(Variable::Velocity(index)) { pool.one() } else { pool.zero() }
    })
}

/// The entry `index` of a fixed sequence in (0.1, 1.1) that looks random: the golden ratio's multiples.
fn draw(probe: u32, index: usize) -> f64 {
    let position = u32::try_from(index).map_or(0.0, f64::from).mul_add(8.0, f64::from(probe) + 1.0);
    0.1 + (position * 0.618_033_988_749_894_9).fract()
}

/// Elimination with full row pivoting.
fn invertible(matrix: &mut [f64], dimension: usize) -> bool {
    let largest = matrix.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    for column in 0..dimension {
        let at = |row: usize| row * dimension + column;
        let pivot = (column..dimension).max_by(|a, b| matrix[at(*a)].abs().total_cmp(&matrix[at(*b)].abs()));
        let Some(pivot) = pivot.filter(|row| matrix[at(*row)].abs() > SINGULAR * largest) else {
            return false;
        };
        for entry in 0..dimension {
            matrix.swap(pivot * dimension + entry, column * dimension + entry);
        }
        for row in column + 1..dimension {
            let factor = matrix[row * dimension + column] / matrix[column * dimension + column];
            for entry in column..dimension {
                matrix[row * dimension + entry] -= factor * matrix[column * dimension + entry];
            }
        }
    }
    true
}
