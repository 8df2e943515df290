//! Whether a matrix of expressions is singular in every state.
//!
//! In: its entries. Out: yes or no. If a pivot vanishes to rounding at all points of a fixed sequence, the matrix is
//! singular everywhere, except with negligible probability. Scaling rows and columns to entries of about 1 makes the test
//! independent of units: masses of 1 and 1e-12 are as good as two of 1.

use super::Parameter;
use super::probe::{MARGIN, POINTS, values};
use crate::symbol::Symbol;
use vi_expr::{Expr, Pool, Rounded};

/// Rounds of scaling. Each takes the square root of the distance of a row from its size: ratios of 1e300 become 1.2.
const ROUNDS: usize = 12;

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
