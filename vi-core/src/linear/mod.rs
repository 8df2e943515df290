//! Small linear systems `A X = B`, each solved by the structure of A.
//!
//! In: a matrix A of N × N in one of the forms below and M right-hand sides as the columns of B. Out: X, whose entries are
//! not finite where A is singular. The generator knows the zero pattern of A and chooses the form:
//!
//! | form | A | by |
//! |---|---|---|
//! | `SMatrix` | dense | closed form for N ≤ 3; else elimination, with pivoting where digits would be lost |
//! | [`Symmetric`] | dense and symmetric, N ≥ 4 | `L D Lᵀ`; where a pivot is not positive, elimination as of dense ones |
//! | [`Tridiagonal`] | neighbours only | elimination of two rows at a time, from both ends at once |
//! | [`Banded`] | up to a few places from the diagonal | elimination inside the band |
//! | [`Blocks`] | blocks that do not touch each other | each block for itself |
//!
//! The matrices are mass matrices plus terms of order h: elimination in the order of the rows is stable for almost all of them,
//! in whatever units their rows and columns are. Where a pivot is lost nevertheless, the solution by [`Tridiagonal`] and [`Banded`]
//! is not a number, nor is that in closed form where the determinant leaves the range of the numbers; [`solve`] then pivots.

mod banded;
mod blocks;
mod dense;
mod pivoted;
mod symmetric;
mod tridiagonal;

pub use banded::Banded;
pub use blocks::Blocks;
pub(crate) use pivoted::Pivoted;
pub use symmetric::Symmetric;
pub use tridiagonal::Tridiagonal;

use crate::real::Real;
use core::fmt::Debug;
use nalgebra::{SMatrix, SVector};

/// Keeps the compiler from making vectors across the rows of a loop: it would gather their numbers from memory, one by one. Those of a row stand side by side.
#[inline(always)]
pub(crate) fn row_by_row() {
    core::hint::black_box(());
}

/// A square matrix in the form that its zero pattern allows.
pub trait Matrix<const N: usize, T: Real>: Copy + Debug + PartialEq {
    /// What is kept of A to solve with it many times.
    type Inverse: Copy + Debug + Send + Sync;

    /// The X with `A X = rhs`; not finite where A is singular.
    fn solve<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M>;
    /// The solution as numerators and one denominator, the determinant where A is solved by Cramer's rule, else 1.
    #[inline]
    fn quotient<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> (SMatrix<T, N, M>, T) {
        (self.solve(rhs), T::one())
    }
    /// The X with `A X = rhs` for a caller who measures what it leaves: where A is singular, or its determinant out of range, X is
    /// anything.
    #[inline(always)]
    fn solve_unchecked<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        let (numerators, determinant) = self.quotient(rhs);
        numerators * determinant.recip()
    }
    /// A, ready to solve with many times.
    fn inverse(&self) -> Self::Inverse;
    /// The x with `A x = rhs`, from the inverse of A.
    fn apply(inverse: &Self::Inverse, rhs: &SVector<T, N>) -> SVector<T, N>;
    /// The same for S right-hand sides side by side: row i holds entry i of each, and becomes that of their solutions.
    #[inline(always)]
    fn apply_to_rows<const S: usize>(inverse: &Self::Inverse, rows: &mut [[T; S]; N]) {
        for column in 0..S {
            let x = Self::apply(inverse, &SVector::from_fn(|i, _| rows[i][column]));
            for (row, x) in rows.iter_mut().zip(x.iter()) {
                row[column] = *x;
            }
        }
    }
    /// The entry of a row and a column.
    fn entry(&self, row: usize, column: usize) -> T;
    /// `A x`.
    fn multiply(&self, x: &SVector<T, N>) -> SVector<T, N>;
    /// A with its zeros.
    #[inline]
    fn dense(&self) -> SMatrix<T, N, N> {
        SMatrix::from_fn(|row, column| self.entry(row, column))
    }
}

/// The X with `matrix · X = rhs`; `None` where it is not finite. Where elimination without pivoting loses a matrix that is
/// regular, or digits of X, elimination with pivoting gives X.
#[inline]
#[must_use]
pub fn solve<T: Real, const N: usize, const M: usize>(
    matrix: &impl Matrix<N, T>,
    rhs: &SMatrix<T, N, M>,
) -> Option<SMatrix<T, N, M>> {
    let solution = matrix.solve(rhs);
    if is_finite(&solution) { Some(solution) } else { Some(dense::pivoted(matrix.dense(), *rhs)).filter(is_finite) }
}

fn is_finite<T: Real, const N: usize, const M: usize>(solution: &SMatrix<T, N, M>) -> bool {
    solution.iter().all(|entry| entry.is_finite())
}

/// How many times what an elimination takes from an entry of the diagonal may be larger than that entry, or the products in a
/// determinant larger than the determinant: so many roundings are lost. Both are ratios that no units of rows and columns change,
/// and that stay below 1 in a positive definite matrix.
const GROWTH: f64 = 1024.0;

/// Whether an entry of the diagonal keeps its digits when `eliminated` is taken from it.
#[inline(always)]
fn is_kept<T: Real>(entry: T, eliminated: T) -> bool {
    eliminated.abs().is_at_most(entry.abs() * T::real(GROWTH))
}

/// Sign of the determinant, by elimination with partial pivoting: −1, 0 or 1; 0 where an entry is not a number.
#[must_use]
pub fn determinant_sign<T: Real, const N: usize>(matrix: &SMatrix<T, N, N>) -> i8 {
    let mut a = *matrix;
    let mut weights = dense::weights(&a);
    let mut sign = 1;
    for column in 0..N {
        if dense::pivot(&mut a, &mut weights, column).is_some() {
            sign = -sign;
        }
        match a[(column, column)].to_f64() {
            pivot if pivot > 0.0 => {}
            pivot if pivot < 0.0 => sign = -sign,
            _ => return 0,
        }
        for row in column + 1..N {
            let factor = a[(row, column)] / a[(column, column)];
            for k in column..N {
                let eliminated = factor * a[(column, k)];
                a[(row, k)] -= eliminated;
            }
        }
    }
    sign
}

#[cfg(test)]
mod tests;
