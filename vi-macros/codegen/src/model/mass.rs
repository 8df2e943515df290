//! Checks that the mass matrix M = ∂²L/∂v², which every method inverts, is regular; with constraints A v + a = 0, that
//! the bordered matrix is:
//!
//! ```text
//! M  Aᵀ
//! A  0
//! ```
//!
//! In: L and A. Out: nothing, or a message that M is singular in every state.

use super::probe::{MARGIN, POINTS, values};
use super::singular::is_singular;
use super::{Coordinate, Parameter, first_order};
use crate::messages::{Massless, Message, Singular, error};
use crate::symbol::{Symbol, Variable};
use proc_macro2::Span;
use syn::Result;
use vi_expr::{Expr, Pool};

/// Reports an M that is singular in every state. An M with an entry without a value in any state is left to the check
/// of its derivatives. If M is zero, returns which coordinates have no velocity in L.
pub(super) fn check(
    pool: &mut Pool<Symbol>,
    (coordinates, parameters): (&[Coordinate], &[Parameter]),
    (lagrangian, span): (Expr, Span),
    rows: &[Vec<Expr>],
) -> Result<Vec<bool>> {
    let dimension = coordinates.len();
    let regular = Ok(Vec::new());
    let Some((momenta, mass)) = mass(pool, lagrangian, dimension) else { return regular };
    if rows.len() >= dimension {
        // Where they are independent, they allow no direction.
        return regular;
    }
    if !rows.is_empty() {
        check_bordered(pool, (coordinates, parameters), (lagrangian, &mass), rows)?;
        return regular;
    }
    let is_empty = |row: &[Expr]| row.iter().all(|entry| pool.is_zero(*entry));
    let rows_of_zeros = || (0..dimension).filter(|row| is_empty(&mass[row * dimension..(row + 1) * dimension]));
    // A velocity without a square says more than a coordinate without a velocity.
    let empty = rows_of_zeros().find(|row| !pool.is_zero(momenta[*row])).or_else(|| rows_of_zeros().next());
    if empty.is_none() && !is_singular(pool, &mass, dimension, parameters) {
        return regular;
    }
    if is_empty(&mass) {
        let found = first_order::without_velocity(pool, &momenta, parameters);
        return found.map_err(|why| error(span, &Message::FirstOrder { why }));
    }
    let (why, span) = match empty {
        Some(row) => {
            let why = Singular::Massless(coordinates[row].text(), massless(pool, lagrangian, row));
            (why, coordinates[row].name.span())
        }
        None if is_homogeneous(pool, lagrangian, &momenta, parameters) => (Singular::Homogeneous, span),
        None => (Singular::Dependent, span),
    };
    Err(error(span, &Message::SingularMass { why }))
}

/// Reports a bordered matrix that is singular in every state. Its rows A are independent, so that M is singular in a
/// direction that they allow.
fn check_bordered(
    pool: &mut Pool<Symbol>,
    (coordinates, parameters): (&[Coordinate], &[Parameter]),
    (lagrangian, mass): (Expr, &[Expr]),
    rows: &[Vec<Expr>],
) -> Result<()> {
    let (dimension, size) = (coordinates.len(), coordinates.len() + rows.len());
    let whole = bordered(pool, mass, rows, dimension);
    if !is_singular(pool, &whole, size, parameters) {
        return Ok(());
    }
    let is_free =
        |place: usize| whole.chunks(size).nth(place).unwrap_or_default().iter().all(|entry| pool.is_zero(*entry));
    let free = (0..dimension).find(|place| is_free(*place));
    // The matrix with masses on the coordinates up to one that moves in such a direction is regular.
    let mut heavier = whole.clone();
    let mut with_mass = |pool: &mut Pool<Symbol>, place: usize| {
        let (entry, one) = (heavier[place * size + place], pool.one());
        heavier[place * size + place] = pool.add(entry, one);
        !is_singular(pool, &heavier, size, parameters)
    };
    let place = free.or_else(|| (0..dimension).find(|place| with_mass(pool, *place)));
    let name = place.map(|place| coordinates[place].text());
    let why = match (free, name) {
        (Some(row), Some(name)) => Singular::Massless(name, massless(pool, lagrangian, row)),
        (_, name) => Singular::Allowed(name),
    };
    let span = coordinates[place.unwrap_or(0)].name.span();
    Err(error(span, &Message::SingularMass { why }))
}

/// The matrix M, row by row, with the rows A below it and on its right.
pub(super) fn bordered(pool: &Pool<Symbol>, mass: &[Expr], rows: &[Vec<Expr>], dimension: usize) -> Vec<Expr> {
    let size = dimension + rows.len();
    pool.spend(size * size);
    let mut whole = vec![pool.zero(); size * size];
    for row in 0..dimension {
        whole[row * size..row * size + dimension].copy_from_slice(&mass[row * dimension..(row + 1) * dimension]);
        for (place, of) in rows.iter().enumerate() {
            whole[row * size + dimension + place] = of[row];
            whole[(dimension + place) * size + row] = of[row];
        }
    }
    whole
}

/// Whether v·L_v = L to rounding at every point with values, and at one such point at least.
fn is_homogeneous(pool: &mut Pool<Symbol>, lagrangian: Expr, momenta: &[Expr], parameters: &[Parameter]) -> bool {
    let product = |(index, momentum): (usize, &Expr)| {
        let velocity = pool.symbol(Symbol::Continuous(Variable::Velocity(index)));
        pool.mul(velocity, *momentum)
    };
    let products: Vec<Expr> = momenta.iter().enumerate().map(product).collect();
    let sum = pool.sum(&products);
    let energy = pool.sub(sum, lagrangian);
    let mut energies = Vec::new();
    for point in 0..POINTS {
        energies.extend(values(pool, &[energy], point, parameters));
    }
    let mut known = energies.iter().filter(|energy| !energy.value.is_nan()).peekable();
    known.peek().is_some() && known.all(|energy| energy.value.abs() <= MARGIN * energy.error)
}

/// How L depends on a coordinate whose row of M is zero. A Lagrange multiplier has L = λ g(t, q) + terms without λ.
fn massless(pool: &mut Pool<Symbol>, lagrangian: Expr, row: usize) -> Massless {
    let multiplier = Symbol::Continuous(Variable::Coordinate(row));
    let velocity = Symbol::Continuous(Variable::Velocity(row));
    let constraint = pool.partial_derivative(lagrangian, &multiplier);
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

/// L_v, and M row by row; `None` if an entry has no value in any state.
fn mass(pool: &mut Pool<Symbol>, lagrangian: Expr, dimension: usize) -> Option<(Vec<Expr>, Vec<Expr>)> {
    let velocity = |index| Symbol::Continuous(Variable::Velocity(index));
    let mut mass = vec![pool.zero(); dimension * dimension];
    let mut momenta = Vec::with_capacity(dimension);
    for row in 0..dimension {
        let momentum = pool.partial_derivative(lagrangian, &velocity(row));
        let symbols = pool.symbols(momentum);
        for column in (row..dimension).filter(|column| symbols.contains(&velocity(*column))) {
            let entry = pool.partial_derivative(momentum, &velocity(column));
            mass[row * dimension + column] = entry;
            mass[column * dimension + row] = entry;
        }
        momenta.push(momentum);
    }
    let mass = pool.collect_constants(&mass);
    let is_defined = !momenta.iter().chain(&mass).any(|entry| pool.is_undefined(*entry));
    is_defined.then_some((momenta, mass))
}
