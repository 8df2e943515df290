//! Banded matrices, eliminated inside the band.

use super::{Matrix, is_kept, row_by_row};
use crate::real::Real;
use nalgebra::{SMatrix, SVector};

/// A matrix with entries at most W places from the diagonal; D = 2 W + 1. Diagonal matrices have D = 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Banded<const N: usize, const D: usize, T> {
    /// Row i, column i + k − W at `[i][k]`; entries outside the matrix are zero.
    pub rows: [[T; D]; N],
}

impl<const N: usize, const D: usize, T: Real> Banded<N, D, T> {
    const WIDTH: usize = D / 2;

    /// The factors in place: row multipliers below the diagonal, reciprocals of the pivots on it.
    #[inline]
    fn factors(mut self) -> Self {
        let (w, rows, mut kept) = (Self::WIDTH, &mut self.rows, true);
        for i in 0..N {
            // A NaN in the last unknown reaches all others.
            let reciprocal = if i + 1 == N && !kept { T::real(f64::NAN) } else { rows[i][w].recip() };
            rows[i][w] = reciprocal;
            let pivot_row = rows[i];
            for below in 1..=w.min(N - 1 - i) {
                let row = &mut rows[i + below];
                let factor = row[w - below] * reciprocal;
                row[w - below] = factor;
                kept &= is_kept(row[w], factor * pivot_row[w + below]);
                for k in 1..=w {
                    let eliminated = factor * pivot_row[w + k];
                    row[w - below + k] -= eliminated;
                }
            }
        }
        self
    }

    #[inline]
    fn substitute<const M: usize>(&self, mut x: SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        let (w, rows) = (Self::WIDTH, &self.rows);
        for k in 0..M {
            for i in 0..N {
                for below in 1..=w.min(N - 1 - i) {
                    let eliminated = rows[i + below][w - below] * x[(i, k)];
                    x[(i + below, k)] -= eliminated;
                }
            }
            for i in (0..N).rev() {
                let right = 1..=w.min(N - 1 - i);
                let known = right.fold(T::zero(), |sum, right| sum + rows[i][w + right] * x[(i + right, k)]);
                x[(i, k)] = (x[(i, k)] - known) * rows[i][w];
            }
        }
        x
    }
}

impl<const N: usize, const D: usize, T: Real> Matrix<N, T> for Banded<N, D, T> {
    type Inverse = Self;

    #[inline]
    fn solve<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        self.factors().substitute(*rhs)
    }

    fn inverse(&self) -> Self {
        self.factors()
    }

    #[inline]
    fn apply(inverse: &Self, rhs: &SVector<T, N>) -> SVector<T, N> {
        inverse.substitute(*rhs)
    }

    #[inline(always)]
    fn apply_to_rows<const S: usize>(inverse: &Self, rows: &mut [[T; S]; N]) {
        let (w, factors) = (Self::WIDTH, &inverse.rows);
        for i in 0..N {
            for below in 1..(w + 1).min(N - i) {
                subtract(rows, i + below, factors[i + below][w - below], i);
            }
        }
        for i in (0..N).rev() {
            for right in 1..(w + 1).min(N - i) {
                subtract(rows, i, factors[i][w + right], i + right);
            }
            row_by_row();
            for entry in &mut rows[i] {
                *entry *= factors[i][w];
            }
        }
    }

    #[inline]
    fn entry(&self, row: usize, column: usize) -> T {
        let place = (column + Self::WIDTH).checked_sub(row);
        place.and_then(|place| self.rows[row].get(place)).copied().unwrap_or_else(T::zero)
    }

    #[inline]
    fn each_entry(&self, mut f: impl FnMut(usize, usize, T)) {
        for (row, entries) in self.rows.iter().enumerate() {
            for (place, value) in entries.iter().enumerate() {
                if let Some(column) = (row + place).checked_sub(Self::WIDTH).filter(|column| *column < N) {
                    f(row, column, *value);
                }
            }
        }
    }

    #[inline]
    fn multiply(&self, x: &SVector<T, N>) -> SVector<T, N> {
        SVector::from_fn(|row, _| {
            let columns = row.saturating_sub(Self::WIDTH)..N.min(row + Self::WIDTH + 1);
            columns.fold(T::zero(), |sum, column| sum + self.rows[row][column + Self::WIDTH - row] * x[column])
        })
    }
}

/// Subtracts `factor * rows[from]` from `rows[of]`.
#[inline(always)]
fn subtract<T: Real, const S: usize, const N: usize>(rows: &mut [[T; S]; N], of: usize, factor: T, from: usize) {
    let eliminated = rows[from];
    for (entry, eliminated) in rows[of].iter_mut().zip(eliminated) {
        *entry -= factor * eliminated;
    }
}
