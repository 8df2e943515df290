//! Checks that the mass matrix M = ∂²L/∂v², which every method inverts, is regular; with constraints A v + a = 0, that
//! the bordered matrix is:
//!
//! ```text
//! M  Aᵀ
//! A  0
//! ```
//!
//! In: L and A. Out: nothing, or a message that M is singular in every state. M is evaluated at points of a fixed sequence.
//! If a pivot vanishes to rounding at all of them, M is singular everywhere, except with negligible probability.
//! Scaling rows and columns to entries of about 1 makes the test independent of units: masses of 1 and 1e-12 are as
//! good as two of 1. The points have several sizes: at one of them an angle of 1e15 times a coordinate keeps its
//! digits, and at some of them a root such as sqrt(c^2*dot(T)^2 - dot(x)^2) has a value.

use super::{Coordinate, Parameter, first_order, probe};
use crate::messages::{Massless, Message, Singular, error};
use crate::symbol::{Symbol, Variable};
use proc_macro2::Span;
use std::collections::BTreeMap;
use syn::Result;
use vi_expr::{Expr, Pool, Rounded};

/// Maximum number of points, used while the matrix has no value or is singular.
pub(super) const POINTS: u32 = 42;
/// Sizes of the first points. Symbols are positive at every other point, and of both signs at the rest.
const SIZES: [f64; 10] = [1.0, 1.0, 1.0, 1.0, 1e-8, 1e-8, 1e-16, 1e-16, 1e-40, 1e-40];
/// A pivot below this multiple of the rounding of the entries, per row, counts as zero.
pub(super) const MARGIN: f64 = 64.0;
/// Rounds of scaling. Each takes the square root of the distance of a row from its size: ratios of 1e300 become 1.2.
const ROUNDS: usize = 12;

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

/// Whether a matrix is singular at every point with a value, and at one such point at least.
pub(super) fn is_singular(pool: &Pool<Symbol>, mass: &[Expr], dimension: usize, parameters: &[Parameter]) -> bool {
    let mut singular_somewhere = false;
    for point in 0..POINTS {
        let entries = values(pool, mass, point, parameters);
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

/// The values of expressions at a point.
pub(super) fn values(pool: &Pool<Symbol>, exprs: &[Expr], point: u32, parameters: &[Parameter]) -> Vec<Rounded> {
    let mut values = BTreeMap::new();
    pool.evaluate_rounded(exprs, &mut |symbol| {
        let drawn = number(point, values.len(), symbol, parameters);
        *values.entry(symbol.clone()).or_insert(drawn)
    })
}

/// The number of a symbol at a point. At the first points all numbers have one size; at the others each has its own
/// size, and at every other of these the parameters have their defaults.
fn number(point: u32, index: usize, symbol: &Symbol, parameters: &[Parameter]) -> f64 {
    if let Some(size) = usize::try_from(point).ok().and_then(|point| SIZES.get(point)) {
        return size * probe::near_one(point, index);
    }
    let default = match symbol {
        Symbol::Parameter { index, .. } if point.is_multiple_of(2) => {
            parameters.get(*index).map(|parameter| parameter.default)
        }
        _ => None,
    };
    default.filter(|default| *default != 0.0).unwrap_or_else(|| probe::of_any_size(point, index))
}

/// Elimination of the scaled matrix with complete pivoting, which keeps the growth of errors small.
fn is_regular(entries: &[Rounded], dimension: usize) -> bool {
    let scales = scales(entries, dimension);
    let scaled = |place: usize, number: f64| number * scales[place / dimension] * scales[place % dimension];
    let mut matrix: Vec<f64> = entries.iter().enumerate().map(|(place, entry)| scaled(place, entry.value)).collect();
    let errors = entries.iter().enumerate().map(|(place, entry)| scaled(place, entry.error));
    let count = u32::try_from(dimension).map_or(f64::INFINITY, f64::from);
    let zero = MARGIN * count * errors.fold(f64::EPSILON, f64::max);
    let (mut rows, mut columns): (Vec<usize>, Vec<usize>) = ((0..dimension).collect(), (0..dimension).collect());
    while !rows.is_empty() {
        let size = |row: usize, column: usize| matrix[row * dimension + column].abs();
        let places = rows.iter().flat_map(|row| columns.iter().map(|column| (*row, *column)));
        let largest = places.max_by(|left, right| size(left.0, left.1).total_cmp(&size(right.0, right.1)));
        let Some((pivot, of)) = largest.filter(|(row, column)| size(*row, *column) > zero) else {
            return false;
        };
        rows.retain(|row| *row != pivot);
        for row in &rows {
            let factor = matrix[row * dimension + of] / matrix[pivot * dimension + of];
            if factor == 0.0 {
                continue;
            }
            for column in &columns {
                matrix[row * dimension + column] -= factor * matrix[pivot * dimension + column];
            }
        }
        columns.retain(|column| *column != of);
    }
    true
}

/// Factors of rows and columns that scale the largest entry of each row to about 1.
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

/// The partial derivative with respect to a variable.
pub(crate) fn slope(pool: &mut Pool<Symbol>, expr: Expr, by: Variable) -> Expr {
    pool.partial_derivative(expr, &Symbol::Continuous(by))
}

/// Whether expressions are zero to rounding at every point with values, and at one such point at least.
pub(super) fn vanish(pool: &Pool<Symbol>, exprs: &[Expr], parameters: &[Parameter]) -> bool {
    let mut is_known = exprs.is_empty();
    for point in 0..POINTS {
        let values = values(pool, exprs, point, parameters);
        if values.iter().any(|value| value.value.is_nan()) {
            continue;
        }
        if values.iter().any(|value| value.value.abs() > MARGIN * value.error) {
            return false;
        }
        is_known = true;
    }
    is_known
}
