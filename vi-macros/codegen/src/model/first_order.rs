//! Systems of first order: L is linear in the velocities, `L = ϑ(t, q)·q' − H(t, q)`.
//!
//! In: L, its momenta ϑ and f, of a system without kinetic energy. Out: for each coordinate, whether L does not contain its
//! velocity. The coordinates y without one have to be half of all, and ϑ_y of the others regular: then (x, ϑ) are canonical
//! variables.

use super::singular::is_singular;
use super::{Coordinate, Parameter, slope};
use crate::messages::{FirstOrder, Message, error};
use crate::symbol::{Symbol, Variable};
use crate::syntax::{Defining, System};
use proc_macro2::Span;
use syn::Result;
use vi_expr::{Expr, Pool};

/// Which coordinates have no velocity in L.
///
/// # Errors
/// Why L has no such form.
pub(super) fn without_velocity(
    pool: &mut Pool<Symbol>,
    momenta: &[Expr],
    parameters: &[Parameter],
) -> core::result::Result<Vec<bool>, FirstOrder> {
    let without: Vec<bool> = momenta.iter().map(|momentum| pool.is_zero(*momentum)).collect();
    let dimension = momenta.len();
    let count = without.iter().filter(|without| **without).count();
    if dimension % 2 == 1 {
        return Err(FirstOrder::Odd);
    }
    if 2 * count != dimension {
        return Err(FirstOrder::Halves);
    }
    // ϑ_y and its transpose: the symmetric matrix is regular if ϑ_y is.
    let mut matrix = vec![pool.zero(); dimension * dimension];
    for row in (0..dimension).filter(|row| !without[*row]) {
        for column in (0..dimension).filter(|column| without[*column]) {
            let entry = slope(pool, momenta[row], Variable::Coordinate(column));
            matrix[row * dimension + column] = entry;
            matrix[column * dimension + row] = entry;
        }
    }
    if is_singular(pool, &matrix, dimension, parameters) { Err(FirstOrder::Singular) } else { Ok(without) }
}

/// Checks the clauses of a system of first order.
///
/// # Errors
/// A clause that such a system cannot have.
pub(super) fn check(
    pool: &Pool<Symbol>,
    system: &System,
    coordinates: &[Coordinate],
    (without_velocity, forces): (&[bool], &[Expr]),
) -> Result<()> {
    let is_refused = |(clause, _): &(&str, Span)| *clause != "discretize" || system.rules() != 0;
    if let Some((clause, span)) = system.of_free_systems().find(is_refused) {
        return Err(error(span, &Message::FirstOrder { why: FirstOrder::Clause(clause) }));
    }
    let moves =
        |symbol: &Symbol| matches!(symbol, Symbol::Continuous(Variable::Velocity(index)) if without_velocity[*index]);
    match forces.iter().position(|force| pool.depends_on(*force, &moves)) {
        Some(of) => {
            let line = system.all(Defining::Force).iter().find(|line| line.name == coordinates[of].name);
            let span = line.map_or_else(|| coordinates[of].name.span(), |line| line.name.span());
            Err(error(span, &Message::FirstOrder { why: FirstOrder::Force(coordinates[of].text()) }))
        }
        None => Ok(()),
    }
}
