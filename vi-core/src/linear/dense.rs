//! Dense matrices: closed forms without a branch up to N = 3, elimination with partial pivoting beyond. N is a constant, so
//! that one of these is left in the program.

use super::Matrix;
use crate::Real;
use nalgebra::{SMatrix, SVector};

impl<const N: usize, T: Real> Matrix<N, T> for SMatrix<T, N, N> {
    type Inverse = Self;

    #[inline(always)]
    fn quotient<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> (SMatrix<T, N, M>, T) {
        match N {
            1 => (*rhs, self[(0, 0)]),
            2 => cramer_2(self, rhs),
            3 => cramer_3(self, rhs),
            _ => (eliminate(*self, *rhs), T::one()),
        }
    }

    #[inline(always)]
    fn solve<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        let (mut x, determinant) = self.quotient(rhs);
        if N <= 3 {
            let reciprocal = determinant.recip();
            for column in 0..M {
                for row in 0..N {
                    x[(row, column)] *= reciprocal;
                }
            }
        }
        x
    }

    fn inverse(&self) -> Self {
        self.solve(&Self::identity())
    }

    #[inline(always)]
    fn apply(inverse: &Self, rhs: &SVector<T, N>) -> SVector<T, N> {
        inverse * rhs
    }

    #[inline(always)]
    fn dense(&self) -> Self {
        *self
    }
}

/// Numerators and determinant of Cramer's rule for two unknowns.
#[inline(always)]
fn cramer_2<T: Real, const N: usize, const M: usize>(
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, M>,
) -> (SMatrix<T, N, M>, T) {
    let mut x = *b;
    for column in 0..M {
        let (b0, b1) = (b[(0, column)], b[(1, column)]);
        x[(0, column)] = a[(1, 1)] * b0 - a[(0, 1)] * b1;
        x[(1, column)] = a[(0, 0)] * b1 - a[(1, 0)] * b0;
    }
    (x, a[(0, 0)] * a[(1, 1)] - a[(0, 1)] * a[(1, 0)])
}

/// The same for three unknowns, by cofactors.
#[inline(always)]
fn cramer_3<T: Real, const N: usize, const M: usize>(
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, M>,
) -> (SMatrix<T, N, M>, T) {
    let mut cofactors = [[T::zero(); 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            // Cyclic indices carry the sign of the cofactor.
            let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            cofactors[i][j] = a[(i1, j1)] * a[(i2, j2)] - a[(i1, j2)] * a[(i2, j1)];
        }
    }
    let mut x = *b;
    for column in 0..M {
        for row in 0..3 {
            let [c0, c1, c2] = [0, 1, 2].map(|i| cofactors[i][row]);
            x[(row, column)] = c0 * b[(0, column)] + c1 * b[(1, column)] + c2 * b[(2, column)];
        }
    }
    let [c0, c1, c2] = cofactors[0];
    (x, a[(0, 0)] * c0 + a[(0, 1)] * c1 + a[(0, 2)] * c2)
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
