//! The mass matrix M = ∂²L/∂v², which every method inverts.
//!
//! In: L. Out: nothing, or the message that M is singular for every state. M is evaluated at points drawn from a fixed sequence;
//! where a pivot is zero but for rounding at all of them, M is singular everywhere, but for a chance of nothing. Sizes do not
//! matter: rows and columns are scaled to entries of about 1, so that masses of 1 and 1e-12 are as good as two of 1, and the points
//! are of several sizes, so that an angle of 1e15 times a coordinate is known to its digits at one of them.

use super::Coordinate;
use crate::messages::{Massless, Message, error};
use crate::symbol::{Symbol, Variable};
use proc_macro2::Span;
use std::collections::BTreeMap;
use syn::Result;
use vi_expr::{Expr, Pool, Rounded};

/// Sizes of the points at which the matrix is evaluated; every other point is one of positive symbols, the others are of both signs.
const PROBES: [f64; 10] = [1.0, 1.0, 1.0, 1.0, 1e-8, 1e-8, 1e-16, 1e-16, 1e-40, 1e-40];
/// How many times the rounding of the entries, per row, a pivot may be that is zero.
const MARGIN: f64 = 64.0;
/// Rounds of scaling, each of which takes the square root of how far a row is from its size: ratios of 1e300 become ratios of 1.2.
const ROUNDS: usize = 12;

/// Checks that M is not singular for every state.
pub(super) fn check(pool: &mut Pool<Symbol>, coordinates: &[Coordinate], lagrangian: Expr, span: Span) -> Result<()> {
    let dimension = coordinates.len();
    let mass = mass(pool, lagrangian, dimension);
    let empty = mass.chunks(dimension).position(|row| row.iter().all(|entry| pool.is_zero(*entry)));
    if empty.is_none() && !is_singular(pool, &mass, dimension) {
        return Ok(());
    }
    let missing = empty.map(|row| (coordinates[row].text(), massless(pool, lagrangian, row)));
    let span = empty.map_or(span, |row| coordinates[row].name.span());
    Err(error(span, &Message::SingularMass { missing }))
}

/// How a coordinate stands in L whose row of M is zero. One of Lagrange's multipliers it is where L is λ g(t, q) and terms without λ.
fn massless(pool: &mut Pool<Symbol>, lagrangian: Expr, row: usize) -> Massless {
    let multiplier = Symbol::Continuous(Variable::Coordinate(row));
    let velocity = Symbol::Continuous(Variable::Velocity(row));
    let constraint = pool.derivative(lagrangian, &mut |pool, symbol| {
        if *symbol == multiplier { pool.one() } else { pool.zero() }
    });
    let of_state = |symbol: &Symbol| matches!(symbol, Symbol::Continuous(Variable::Coordinate(_)));
    let is_itself = |symbol: &Symbol| *symbol == multiplier;
    let moves = |symbol: &Symbol| *symbol == velocity;
    if pool.depends_on(lagrangian, &moves) {
        Massless::Linear
    } else if pool.depends_on(constraint, &of_state) && !pool.depends_on(constraint, &is_itself) {
        Massless::Multiplier
    } else {
        Massless::Absent
    }
}

/// M, row by row.
fn mass(pool: &mut Pool<Symbol>, lagrangian: Expr, dimension: usize) -> Vec<Expr> {
    let velocity = |index| Symbol::Continuous(Variable::Velocity(index));
    let by_velocity = |pool: &mut Pool<Symbol>, expr: Expr, index: usize| {
        let velocity = velocity(index);
        pool.derivative(expr, &mut |pool, symbol| if *symbol == velocity { pool.one() } else { pool.zero() })
    };
    let mut mass = vec![pool.zero(); dimension * dimension];
    for row in 0..dimension {
        let momentum = by_velocity(pool, lagrangian, row);
        let symbols = pool.symbols(momentum);
        for column in (row..dimension).filter(|column| symbols.contains(&velocity(*column))) {
            let entry = by_velocity(pool, momentum, column);
            mass[row * dimension + column] = entry;
            mass[column * dimension + row] = entry;
        }
    }
    pool.collect_constants(&mass)
}

/// Whether M is singular at every probe at which it has a value, and has one at some.
fn is_singular(pool: &Pool<Symbol>, mass: &[Expr], dimension: usize) -> bool {
    let mut singular_somewhere = false;
    for (probe, size) in (0..).zip(PROBES) {
        let mut values = BTreeMap::new();
        let entries = pool.evaluate_rounded(mass, &mut |symbol| {
            let drawn = size * draw(probe, values.len());
            *values.entry(symbol.clone()).or_insert(drawn)
        });
        if entries.iter().any(|entry| entry.value.is_nan()) {
            continue;
        }
        if is_regular(&entries, dimension) {
            return false;
        }
        singular_somewhere = true;
    }
    singular_somewhere
}

/// The entry `index` of a fixed sequence in (0.1, 1.1) that looks random, the multiples of the golden ratio; at every other probe the
/// sign is that of another one.
fn draw(probe: u32, index: usize) -> f64 {
    let position = u32::try_from(index).map_or(0.0, f64::from).mul_add(16.0, f64::from(probe) + 1.0);
    let size = 0.1 + (position * 0.618_033_988_749_894_9).fract();
    let negative = probe % 2 == 1 && (position * std::f64::consts::SQRT_2).fract() < 0.5;
    if negative { -size } else { size }
}

/// Elimination with row pivoting of the matrix, scaled.
fn is_regular(entries: &[Rounded], dimension: usize) -> bool {
    let scales = scales(entries, dimension);
    let scaled = |place: usize, number: f64| number * scales[place / dimension] * scales[place % dimension];
    let mut matrix: Vec<f64> = entries.iter().enumerate().map(|(place, entry)| scaled(place, entry.value)).collect();
    let errors = entries.iter().enumerate().map(|(place, entry)| scaled(place, entry.error));
    let rows = u32::try_from(dimension).map_or(f64::INFINITY, f64::from);
    let zero = MARGIN * rows * errors.fold(f64::EPSILON, f64::max);
    for column in 0..dimension {
        let at = |row: usize| row * dimension + column;
        let pivot = (column..dimension).max_by(|a, b| matrix[at(*a)].abs().total_cmp(&matrix[at(*b)].abs()));
        let Some(pivot) = pivot.filter(|row| matrix[at(*row)].abs() > zero) else {
            return false;
        };
        for entry in column..dimension {
            matrix.swap(pivot * dimension + entry, column * dimension + entry);
        }
        for row in column + 1..dimension {
            let factor = matrix[at(row)] / matrix[at(column)];
            if factor == 0.0 {
                continue;
            }
            for entry in column..dimension {
                matrix[row * dimension + entry] -= factor * matrix[column * dimension + entry];
            }
        }
    }
    true
}

/// What each row, and the column of its number, is multiplied by so that its largest entry is about 1.
fn scales(entries: &[Rounded], dimension: usize) -> Vec<f64> {
    let mut scales = vec![1.0; dimension];
    for _ in 0..ROUNDS {
        let largest: Vec<f64> = (0..dimension)
            .map(|row| {
                let sizes = (0..dimension).map(|column| entries[row * dimension + column].value.abs() * scales[column]);
                sizes.fold(0.0, f64::max) * scales[row]
            })
            .collect();
        for (scale, largest) in scales.iter_mut().zip(largest).filter(|(_, largest)| *largest > 0.0) {
            *scale /= largest.sqrt();
        }
    }
    scales
}
