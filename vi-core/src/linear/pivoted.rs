//! Dense matrices of a size known at run time, factored in place.
//!
//! `P A = L U` with partial pivoting gives x with `A x = b`, not finite if A is singular. Only the constructor
//! allocates.

use crate::real::Real;
use alloc::vec::Vec;
use nalgebra::DMatrix;

/// The factors of a matrix; see the [module](self).
#[derive(Clone, Debug)]
pub(crate) struct Pivoted<T: Real = f64> {
    factors: DMatrix<T>,
    /// Pivot row of each column.
    rows: Vec<usize>,
}

impl<T: Real> Pivoted<T> {
    /// Allocates for matrices of `size` rows.
    pub(crate) fn new(size: usize) -> Self {
        Self { factors: DMatrix::zeros(size, size), rows: vec![0; size] }
    }

    /// Factors a matrix of the allocated size.
    pub(crate) fn factor(&mut self, matrix: &DMatrix<T>) {
        self.factors.copy_from(matrix);
        let size = self.rows.len();
        for column in 0..size {
            let length = |row: usize| self.factors[(row, column)].to_f64().abs();
            let larger = |pivot, row| if length(row) > length(pivot) { row } else { pivot };
            let pivot = (column + 1..size).fold(column, larger);
            self.rows[column] = pivot;
            self.factors.swap_rows(column, pivot);
            let (left, right) = self.factors.as_mut_slice().split_at_mut((column + 1) * size);
            let (upper, multipliers) = left[column * size..].split_at_mut(column + 1);
            for entry in &mut *multipliers {
                *entry = *entry / upper[column];
            }
            for next in right.chunks_exact_mut(size) {
                let (upper, below) = next.split_at_mut(column + 1);
                subtract(below, upper[column], multipliers);
            }
        }
    }

    /// Replaces b by the x with `A x = b`.
    pub(crate) fn solve(&self, b: &mut [T]) {
        let size = self.rows.len();
        for (column, row) in self.rows.iter().enumerate() {
            b.swap(column, *row);
        }
        for column in 0..size {
            let (known, rest) = b.split_at_mut(column + 1);
            subtract(rest, known[column], &self.column(column)[column + 1..]);
        }
        for column in (0..size).rev() {
            let (rest, known) = b.split_at_mut(column);
            known[0] = known[0] / self.factors[(column, column)];
            subtract(rest, known[0], &self.column(column)[..column]);
        }
    }

    fn column(&self, index: usize) -> &[T] {
        let size = self.rows.len();
        &self.factors.as_slice()[index * size..][..size]
    }
}

/// Subtracts `factor * column` from `from`.
fn subtract<T: Real>(from: &mut [T], factor: T, column: &[T]) {
    for (entry, multiplier) in from.iter_mut().zip(column) {
        *entry -= factor * *multiplier;
    }
}

#[cfg(test)]
mod tests {
    use super::Pivoted;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn what_was_multiplied_is_solved_for() {
        // The first pivot is zero, and the rows have different units.
        let matrix = DMatrix::from_row_slice(3, 3, &[0.0, 2.0, 1.0, 3.0, -1.0, 4.0, 500.0, 100.0, -700.0]);
        let x = DVector::from_row_slice(&[1.0, -2.0, 3.0]);
        let mut b = &matrix * &x;
        let mut pivoted = Pivoted::new(3);
        pivoted.factor(&matrix);
        pivoted.solve(b.as_mut_slice());
        // 4.4e-16 was measured.
        assert!((b - x).norm() < 1e-15);
    }

    #[test]
    fn a_singular_matrix_solves_nothing() {
        let mut pivoted = Pivoted::new(2);
        pivoted.factor(&DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 2.0, 4.0]));
        let mut b = [1.0_f64, 0.0];
        pivoted.solve(&mut b);
        assert!(b.iter().all(|entry| !entry.is_finite()));
    }
}
