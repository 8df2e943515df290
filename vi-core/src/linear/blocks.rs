//! Block-diagonal matrices: bodies without mutual coupling within a step.

use super::{Matrix, dense};
use crate::real::Real;
use nalgebra::{SMatrix, SVector};

/// A matrix of blocks of at most B rows, which need not be contiguous.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blocks<const N: usize, const B: usize, T> {
    /// The rows of each block, ascending.
    pub members: &'static [&'static [usize]],
    /// Row i, column `members[…][k]` of its block at `[i][k]`; the rest is zero.
    pub rows: [[T; B]; N],
}

impl<const N: usize, const B: usize, T: Real> Blocks<N, B, T> {
    /// A block, extended to B rows by those of the unit matrix.
    #[inline]
    fn block(&self, members: &[usize]) -> SMatrix<T, B, B> {
        SMatrix::from_fn(|i, j| match members.get(i) {
            Some(row) => self.rows[*row][j],
            None if i == j => T::one(),
            None => T::zero(),
        })
    }

    #[inline]
    fn each<const M: usize>(
        &self,
        rhs: &SMatrix<T, N, M>,
        solve: impl Fn(usize, &SMatrix<T, B, M>) -> SMatrix<T, B, M>,
    ) -> SMatrix<T, N, M> {
        let mut x = *rhs;
        for (index, members) in self.members.iter().enumerate() {
            let part = SMatrix::from_fn(|i, k| members.get(i).map_or_else(T::zero, |row| rhs[(*row, k)]));
            let part = solve(index, &part);
            for (i, row) in members.iter().enumerate() {
                for k in 0..M {
                    x[(*row, k)] = part[(i, k)];
                }
            }
        }
        x
    }
}

impl<const N: usize, const B: usize, T: Real> Matrix<N, T> for Blocks<N, B, T> {
    /// The inverse of each block, in the layout of the blocks.
    type Inverse = Self;

    #[inline]
    fn solve<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        self.each(rhs, |index, part| Matrix::solve(&self.block(self.members[index]), part))
    }

    fn inverse(&self) -> Self {
        let mut inverse = *self;
        for members in self.members {
            let block = dense::eliminate([B, B], self.block(members), SMatrix::<T, B, B>::identity());
            for (i, row) in members.iter().enumerate() {
                inverse.rows[*row] = core::array::from_fn(|j| block[(i, j)]);
            }
        }
        inverse
    }

    #[inline]
    fn apply(inverse: &Self, rhs: &SVector<T, N>) -> SVector<T, N> {
        inverse.each(rhs, |index, part| inverse.block(inverse.members[index]) * part)
    }

    fn entry(&self, row: usize, column: usize) -> T {
        let block = self.members.iter().find(|members| members.contains(&row));
        let place = block.and_then(|members| members.iter().position(|member| *member == column));
        place.map_or_else(T::zero, |place| self.rows[row][place])
    }

    #[inline]
    fn each_entry(&self, mut f: impl FnMut(usize, usize, T)) {
        for members in self.members {
            for row in *members {
                for (column, value) in members.iter().zip(&self.rows[*row]) {
                    f(*row, *column, *value);
                }
            }
        }
    }

    #[inline]
    fn multiply(&self, x: &SVector<T, N>) -> SVector<T, N> {
        let mut product = SVector::zeros();
        for members in self.members {
            for row in *members {
                for (place, column) in members.iter().enumerate() {
                    product[*row] += self.rows[*row][place] * x[*column];
                }
            }
        }
        product
    }
}
