//! Dense symmetric matrices by `A = L D Lᵀ`, half the products of an elimination.

use super::{Matrix, dense};
use crate::real::Real;
use nalgebra::{SMatrix, SVector};

/// A symmetric matrix with all its entries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Symmetric<const N: usize, T>(pub SMatrix<T, N, N>);

/// L below the diagonal, the reciprocals of D on it.
type Factors<const N: usize, T> = SMatrix<T, N, N>;

impl<const N: usize, T: Real> Symmetric<N, T> {
    /// The factors of the first n rows and columns; `None` if a pivot is not positive, so that elimination without
    /// pivoting is unstable.
    #[inline(always)]
    fn factors(&self, n: usize) -> Option<Factors<N, T>> {
        let mut a = self.0;
        let mut positive = true;
        for column in 0..n {
            let pivot = a[(column, column)];
            positive &= pivot.is_positive();
            let reciprocal = pivot.recip();
            a[(column, column)] = reciprocal;
            for row in column + 1..n {
                a[(column, row)] = a[(row, column)];
                a[(row, column)] *= reciprocal;
            }
            // Column by column, so that the rows inside one column are independent.
            for k in column + 1..n {
                let above = a[(column, k)];
                for row in k..n {
                    let eliminated = a[(row, column)] * above;
                    a[(row, k)] -= eliminated;
                }
            }
        }
        positive.then_some(a)
    }

    /// [`Matrix::solve`] for the first n rows and columns, and the first m right-hand sides.
    #[inline(always)]
    pub(super) fn solve_first<const M: usize>(&self, [n, m]: [usize; 2], rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        match self.factors(n) {
            Some(factors) => substitute([n, m], &factors, *rhs),
            None => dense::eliminate([n, m], self.0, *rhs),
        }
    }
}

/// Solves with the factors.
#[inline(always)]
fn substitute<const N: usize, const M: usize, T: Real>(
    [n, m]: [usize; 2],
    factors: &Factors<N, T>,
    mut x: SMatrix<T, N, M>,
) -> SMatrix<T, N, M> {
    for k in 0..m {
        for column in 0..n {
            let known = x[(column, k)];
            for row in column + 1..n {
                let eliminated = factors[(row, column)] * known;
                x[(row, k)] -= eliminated;
            }
        }
        for row in (0..n).rev() {
            let below = (row + 1..n).fold(T::zero(), |sum, below| sum + factors[(below, row)] * x[(below, k)]);
            x[(row, k)] = x[(row, k)] * factors[(row, row)] - below;
        }
    }
    x
}

impl<const N: usize, T: Real> Matrix<N, T> for Symmetric<N, T> {
    type Inverse = SMatrix<T, N, N>;

    #[inline]
    fn solve<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        self.solve_first([N, M], rhs)
    }

    fn inverse(&self) -> Self::Inverse {
        self.0.inverse()
    }

    #[inline]
    fn apply(inverse: &Self::Inverse, rhs: &SVector<T, N>) -> SVector<T, N> {
        inverse * rhs
    }

    #[inline(always)]
    fn apply_to_rows<const S: usize>(inverse: &Self::Inverse, rows: &mut [[T; S]; N]) {
        SMatrix::apply_to_rows(inverse, rows);
    }

    #[inline]
    fn entry(&self, row: usize, column: usize) -> T {
        self.0[(row, column)]
    }

    #[inline]
    fn multiply(&self, x: &SVector<T, N>) -> SVector<T, N> {
        self.0 * x
    }

    #[inline]
    fn dense(&self) -> SMatrix<T, N, N> {
        self.0
    }
}
