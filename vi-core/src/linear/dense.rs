//! Dense matrices: closed forms without a branch up to N = 3, elimination with partial pivoting beyond. N is a constant, so
//! that one of these is left in the program.

use super::Matrix;
use crate::Real;
use nalgebra::{SMatrix, SVector};

impl<const N: usize, T: Real> Matrix<N, T> for SMatrix<T, N, N> {
    type Inverse = Self;
    const QUOTIENT: bool = N <= 2;

    #[inline]
    fn quotient<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> (SMatrix<T, N, M>, T) {
        match N {
            1 => (*rhs, self[(0, 0)]),
            2 => (numerators_2(self, rhs), determinant_2(self)),
            _ => (self.solve(rhs), T::one()),
        }
    }

    #[inline]
    fn solve<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        match N {
            1 => solve_1(self, rhs),
            2 => solve_2(self, rhs),
            3 => solve_3(self, rhs),
            _ => eliminate(*self, *rhs),
        }
    }

    fn inverse(&self) -> Self {
        self.solve(&Self::identity())
    }

    #[inline]
    fn apply(inverse: &Self, rhs: &SVector<T, N>) -> SVector<T, N> {
        inverse * rhs
    }

    #[inline]
    fn dense(&self) -> Self {
        *self
    }
}

#[inline]
fn solve_1<T: Real, const N: usize, const M: usize>(a: &SMatrix<T, N, N>, b: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
    SMatrix::from_fn(|_, column| b[(0, column)] / a[(0, 0)])
}

/// Cramer's rule for two unknowns.
#[inline]
fn solve_2<T: Real, const N: usize, const M: usize>(a: &SMatrix<T, N, N>, b: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
    let determinant = determinant_2(a);
    numerators_2(a, b).map(|numerator| numerator / determinant)
}

#[inline]
fn determinant_2<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> T {
    a[(0, 0)] * a[(1, 1)] - a[(0, 1)] * a[(1, 0)]
}

#[inline]
fn numerators_2<T: Real, const N: usize, const M: usize>(
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, M>,
) -> SMatrix<T, N, M> {
    SMatrix::from_fn(|row, column| {
        let (b0, b1) = (b[(0, column)], b[(1, column)]);
        if row == 0 { a[(1, 1)] * b0 - a[(0, 1)] * b1 } else { a[(0, 0)] * b1 - a[(1, 0)] * b0 }
    })
}

/// Cramer's rule for three unknowns, by cofactors.
#[inline]
fn solve_3<T: Real, const N: usize, const M: usize>(a: &SMatrix<T, N, N>, b: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
    // Cyclic indices carry the sign of the cofactor.
    let cofactor = |i: usize, j: usize| {
        let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        a[(i1, j1)] * a[(i2, j2)] - a[(i1, j2)] * a[(i2, j1)]
    };
    let determinant = a[(0, 0)] * cofactor(0, 0) + a[(0, 1)] * cofactor(0, 1) + a[(0, 2)] * cofactor(0, 2);
    SMatrix::from_fn(|row, column| {
        let numerator =
            cofactor(0, row) * b[(0, column)] + cofactor(1, row) * b[(1, column)] + cofactor(2, row) * b[(2, column)];
        numerator / determinant
    })
}

/// Swaps the row with the largest entry of `column` onto the diagonal; which row, where it was another one.
pub(super) fn pivot<T: Real, const N: usize>(a: &mut SMatrix<T, N, N>, column: usize) -> Option<usize> {
    let mut pivot = column;
    for row in column + 1..N {
        if a[(row, column)].abs().to_f64() > a[(pivot, column)].abs().to_f64() {
            pivot = row;
        }
    }
    a.swap_rows(column, pivot);
    (pivot != column).then_some(pivot)
}

/// Gaussian elimination with partial pivoting and back substitution.
pub(super) fn eliminate<T: Real, const N: usize, const M: usize>(
    mut a: SMatrix<T, N, N>,
    mut b: SMatrix<T, N, M>,
) -> SMatrix<T, N, M> {
    for column in 0..N {
        if let Some(row) = pivot(&mut a, column) {
            b.swap_rows(column, row);
        }
        for row in column + 1..N {
            let factor = a[(row, column)] / a[(column, column)];
            for k in column + 1..N {
                let eliminated = factor * a[(column, k)];
                a[(row, k)] -= eliminated;
            }
            for k in 0..M {
                let eliminated = factor * b[(column, k)];
                b[(row, k)] -= eliminated;
            }
        }
    }
    for row in (0..N).rev() {
        for k in 0..M {
            let known = (row + 1..N).fold(T::zero(), |sum, column| sum + a[(row, column)] * b[(column, k)]);
            b[(row, k)] = (b[(row, k)] - known) / a[(row, row)];
        }
    }
    b
}
