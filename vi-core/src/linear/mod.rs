//! Small linear systems `A X = B`, solved by the structure of A.
//!
//! A is an N × N matrix in one of the forms below, and the columns of B are M right-hand sides. The entries of X are
//! not finite if A is singular. The generator knows the zero pattern of A and chooses the form:
//!
//! | form | A | solver |
//! |---|---|---|
//! | `SMatrix` | dense | closed form for N ≤ 3; beyond, elimination, with pivoting to avoid loss of digits |
//! | [`Symmetric`] | dense and symmetric, N ≥ 4 | `L D Lᵀ`; if a pivot is not positive, dense elimination |
//! | [`Tridiagonal`] | neighbours only | elimination of two rows at a time, from both ends at once |
//! | [`Banded`] | entries near the diagonal | elimination inside the band |
//! | [`Blocks`] | disjoint blocks | each block separately |
//! | [`Sparse`], [`Rows`] | any nonzeros, in columns that are known while compiling, or at run time | dense elimination |
//!
//! Gradients of constraints have N columns and the form [`Sparse`], [`Rows`] or that of dense rows ([`Rectangular`]). `factored` solves
//! for coordinates and multipliers together, by the [`Block`]s of their graph.
//!
//! The matrices are mass matrices plus terms of order h. Elimination in the order of the rows is stable for almost all
//! of them, in any units of their rows and columns. If it loses a pivot, the solution by [`Tridiagonal`] and [`Banded`]
//! is NaN, as is the closed form if the determinant is out of range; [`solve`] then pivots.

mod any;
mod banded;
mod blocks;
#[cfg(feature = "alloc")]
mod bordered;
mod dense;
#[cfg(feature = "alloc")]
mod factored;
mod rectangular;
#[cfg(feature = "alloc")]
mod scales;
mod symmetric;
mod tridiagonal;

pub use any::{AnyForm, AnyInverse, AnyMatrix};
pub use banded::Banded;
pub use blocks::Blocks;
#[cfg(feature = "alloc")]
pub(crate) use bordered::{Bordered, Unsolvable, scale};
#[cfg(feature = "alloc")]
pub(crate) use factored::{Assemble, Entries, Factored};
pub use rectangular::{AtMost, Rectangular, Row, Rows, Sparse};
#[cfg(feature = "alloc")]
pub(crate) use scales::{reciprocal_power, reciprocal_root};
pub use symmetric::Symmetric;
pub use tridiagonal::Tridiagonal;

use crate::real::Real;
use core::fmt::Debug;
use nalgebra::{SMatrix, SVector};

/// Prevents vectorization across the rows of a loop, which would gather numbers from memory one by one. The numbers of
/// a row are contiguous.
#[inline(always)]
pub(crate) fn row_by_row() {
    core::hint::black_box(());
}

/// A square matrix in the form of its zero pattern.
pub trait Matrix<const N: usize, T: Real>: Copy + Send + Sync + Debug + PartialEq {
    /// Factors of A for repeated solves.
    type Inverse: Copy + Debug + Send + Sync;

    /// Solves `A X = rhs`; not finite if A is singular.
    fn solve<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M>;
    /// The solution as numerators and one denominator: the determinant if A is solved by Cramer's rule, otherwise 1.
    #[inline]
    fn quotient<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> (SMatrix<T, N, M>, T) {
        (self.solve(rhs), T::one())
    }
    /// Solves `A X = rhs` for a caller who checks the residual: if A is singular, or its determinant out of range, X is
    /// unspecified.
    #[inline(always)]
    fn solve_unchecked<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        let (numerators, determinant) = self.quotient(rhs);
        numerators * determinant.recip()
    }
    /// The inverse of A, with the conditions of [`Matrix::solve_unchecked`].
    #[inline(always)]
    fn inverse_unchecked(&self) -> SMatrix<T, N, N> {
        self.solve_unchecked(&SMatrix::identity())
    }
    /// Factors A for repeated solves.
    fn inverse(&self) -> Self::Inverse;
    /// Solves `A x = rhs` by the factors of A.
    fn apply(inverse: &Self::Inverse, rhs: &SVector<T, N>) -> SVector<T, N>;
    /// The same for S right-hand sides at once: row i holds entry i of each. Overwrites them by the solutions.
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
    /// Calls `f` with row, column and value of each entry that may be nonzero, always in the same order.
    #[inline]
    fn each_entry(&self, mut f: impl FnMut(usize, usize, T)) {
        for row in 0..N {
            for column in 0..N {
                f(row, column, self.entry(row, column));
            }
        }
    }
    /// `A x`.
    fn multiply(&self, x: &SVector<T, N>) -> SVector<T, N>;
    /// A as a dense matrix.
    #[inline]
    fn dense(&self) -> SMatrix<T, N, N> {
        SMatrix::from_fn(|row, column| self.entry(row, column))
    }
}

/// Solves `matrix · X = rhs`; `None` if the solution is not finite. If elimination without pivoting fails for a regular
/// matrix, or loses digits of X, elimination with pivoting solves it.
#[inline]
#[must_use]
pub fn solve<T: Real, const N: usize, const M: usize>(
    matrix: &impl Matrix<N, T>,
    rhs: &SMatrix<T, N, M>,
) -> Option<SMatrix<T, N, M>> {
    let solution = matrix.solve(rhs);
    if is_finite(&solution) {
        Some(solution)
    } else {
        Some(dense::pivoted([N, M], matrix.dense(), *rhs)).filter(is_finite)
    }
}

fn is_finite<T: Real, const N: usize, const M: usize>(solution: &SMatrix<T, N, M>) -> bool {
    solution.as_slice().iter().all(|entry| entry.is_finite())
}

/// Largest allowed ratio of the subtracted terms to a diagonal entry, or of the products in a determinant to the
/// determinant: the number of roundings lost. Both ratios are independent of the units of rows and columns, and stay
/// below 1 in a positive definite matrix.
const GROWTH: f64 = 1024.0;

/// Whether a diagonal entry keeps its digits when `eliminated` is subtracted from it.
#[inline(always)]
fn is_kept<T: Real>(entry: T, eliminated: T) -> bool {
    eliminated.abs().is_at_most(entry.abs() * T::real(GROWTH))
}

/// Scale factors of the rows and of the columns that make its entries comparable, in any units.
pub(crate) fn weights<const N: usize>(matrix: &SMatrix<f64, N, N>) -> [[f64; N]; 2] {
    [dense::weights(matrix), dense::weights(&matrix.transpose())]
}

/// Sign of the determinant, by elimination with partial pivoting: −1, 0 or 1; 0 if an entry is NaN.
#[must_use]
pub fn determinant_sign<T: Real, const N: usize>(matrix: &SMatrix<T, N, N>) -> i8 {
    if let Some(sign) = dense::sign_of_few(matrix) {
        return sign;
    }
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

/// Unknowns that are eliminated together, and the later ones that they are coupled to at their elimination.
///
/// Unknowns are the coordinates 0 … N − 1, then the multipliers N … N + K − 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    /// The unknowns of the block.
    pub own: &'static [usize],
    /// The unknowns of the border, in the order of their elimination.
    pub border: &'static [usize],
}

#[cfg(test)]
mod tests;
