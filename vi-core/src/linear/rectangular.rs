//! Matrices of N columns by the nonzeros of their rows: gradients of constraints.

use super::{Matrix, dense};
use crate::real::Real;
use nalgebra::{SMatrix, SVector};

/// A matrix of N columns by its rows, in the form of its zero pattern. The pattern is the same for all values of a type.
pub trait Rectangular<const N: usize, T: Real> {
    /// The number of rows.
    fn count(&self) -> usize;
    /// The entries of a row that may be nonzero.
    fn row(&self, row: usize) -> Row<'_, T>;
    /// The columns and the values of a row.
    fn row_mut(&mut self, row: usize) -> (&'static [usize], &mut [T]);
    /// The rows in order.
    fn rows<'a>(&'a self) -> impl Iterator<Item = Row<'a, T>>
    where
        T: 'a,
    {
        (0..self.count()).map(|row| self.row(row))
    }
}

/// The entries of a row that may be nonzero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row<'a, T> {
    /// Their columns, ascending.
    pub columns: &'static [usize],
    /// The value in each of these columns.
    pub values: &'a [T],
}

impl<'a, T: Real> Row<'a, T> {
    /// Column and value of each entry.
    #[inline(always)]
    pub fn iter(self) -> impl Iterator<Item = (usize, T)> + use<'a, T> {
        self.columns.iter().copied().zip(self.values.iter().copied())
    }

    /// The product of the row and a vector.
    #[inline(always)]
    #[must_use]
    pub fn dot<const N: usize>(self, x: &SVector<T, N>) -> T {
        self.iter().fold(T::zero(), |sum, (column, value)| sum + value * x[column])
    }

    /// The sum of the absolute values of the terms of that product.
    #[inline(always)]
    pub(crate) fn terms<const N: usize>(self, x: &SVector<T, N>) -> T {
        self.iter().fold(T::zero(), |sum, (column, value)| sum + (value * x[column]).abs())
    }

    /// The row with its zeros.
    #[must_use]
    pub fn dense<const N: usize>(self) -> SVector<T, N> {
        let mut dense = SVector::zeros();
        for (column, value) in self.iter() {
            dense[column] = value;
        }
        dense
    }
}

/// K rows with at most W nonzeros each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sparse<const K: usize, const W: usize, T> {
    /// The columns of the nonzeros of each row, ascending; at most W.
    pub columns: &'static [&'static [usize]; K],
    /// Row r, column `columns[r][k]` at `[r][k]`; entries without a column have no meaning.
    pub rows: [[T; W]; K],
}

impl<const K: usize, const W: usize, T> Sparse<K, W, T> {
    /// The entries of a row that may be nonzero.
    #[inline(always)]
    #[must_use]
    pub fn row(&self, row: usize) -> Row<'_, T> {
        let columns = self.columns[row];
        Row { columns, values: &self.rows[row][..columns.len()] }
    }
}

impl<const N: usize, const K: usize, const W: usize, T: Real> Rectangular<N, T> for Sparse<K, W, T> {
    #[inline(always)]
    fn count(&self) -> usize {
        K
    }

    #[inline(always)]
    fn row(&self, row: usize) -> Row<'_, T> {
        self.row(row)
    }

    #[inline(always)]
    fn row_mut(&mut self, row: usize) -> (&'static [usize], &mut [T]) {
        let columns = self.columns[row];
        (columns, &mut self.rows[row][..columns.len()])
    }
}

/// At most K numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtMost<const K: usize, T> {
    count: usize,
    /// The numbers, then zeros.
    values: [T; K],
}

impl<const K: usize, T: Real> AtMost<K, T> {
    /// `count` zeros, K if it is larger.
    #[must_use]
    pub fn zeros(count: usize) -> Self {
        Self { count: count.min(K), values: [T::zero(); K] }
    }
}

impl<const K: usize, T> AsRef<[T]> for AtMost<K, T> {
    fn as_ref(&self) -> &[T] {
        &self.values[..self.count]
    }
}

impl<const K: usize, T> AsMut<[T]> for AtMost<K, T> {
    fn as_mut(&mut self) -> &mut [T] {
        &mut self.values[..self.count]
    }
}

/// At most K rows with at most W nonzeros each, in columns that are known at run time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rows<const K: usize, const W: usize, T> {
    /// The columns of the nonzeros of each row, ascending; at most K rows of at most W columns.
    columns: &'static [&'static [usize]],
    /// Row r, column `columns[r][k]` at `[r][k]`; entries without a column have no meaning.
    rows: [[T; W]; K],
}

impl<const K: usize, const W: usize, T: Real> Rows<K, W, T> {
    /// Zeros in these columns of each row: at most K rows of at most W columns, ascending.
    #[must_use]
    pub fn zeros(columns: &'static [&'static [usize]]) -> Self {
        Self { columns, rows: [[T::zero(); W]; K] }
    }
}

impl<const N: usize, const K: usize, const W: usize, T: Real> Rectangular<N, T> for Rows<K, W, T> {
    #[inline(always)]
    fn count(&self) -> usize {
        self.columns.len()
    }

    #[inline(always)]
    fn row(&self, row: usize) -> Row<'_, T> {
        let columns = self.columns[row];
        Row { columns, values: &self.rows[row][..columns.len()] }
    }

    #[inline(always)]
    fn row_mut(&mut self, row: usize) -> (&'static [usize], &mut [T]) {
        let columns = self.columns[row];
        (columns, &mut self.rows[row][..columns.len()])
    }
}

/// The derivatives of equations of motion with constraints have this form; solutions with such a matrix alone are dense.
macro_rules! sparse_matrix {
    ($($form:ident),*) => {$(
        impl<const N: usize, const W: usize, T: Real> Matrix<N, T> for $form<N, W, T> {
            type Inverse = SMatrix<T, N, N>;

            fn solve<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
                dense::pivoted([N, M], self.dense(), *rhs)
            }

            fn inverse(&self) -> Self::Inverse {
                dense::pivoted([N, N], self.dense(), SMatrix::identity())
            }

            fn apply(inverse: &Self::Inverse, rhs: &SVector<T, N>) -> SVector<T, N> {
                inverse * rhs
            }

            fn entry(&self, row: usize, column: usize) -> T {
                let Row { columns, values } = Rectangular::<N, T>::row(self, row);
                columns.iter().position(|other| *other == column).map_or_else(T::zero, |place| values[place])
            }

            #[inline]
            fn each_entry(&self, mut f: impl FnMut(usize, usize, T)) {
                for (row, entries) in Rectangular::<N, T>::rows(self).enumerate() {
                    entries.iter().for_each(|(column, value)| f(row, column, value));
                }
            }

            #[inline]
            fn multiply(&self, x: &SVector<T, N>) -> SVector<T, N> {
                SVector::from_fn(|row, _| Rectangular::<N, T>::row(self, row).dot(x))
            }
        }
    )*};
}

sparse_matrix!(Sparse, Rows);

/// Dense rows: the form to write by hand.
impl<const N: usize, T: Real> Rectangular<N, T> for [SVector<T, N>] {
    #[inline(always)]
    fn count(&self) -> usize {
        self.len()
    }

    #[inline(always)]
    fn row(&self, row: usize) -> Row<'_, T> {
        Row { columns: const { &all::<N>() }, values: self[row].as_slice() }
    }

    #[inline(always)]
    fn row_mut(&mut self, row: usize) -> (&'static [usize], &mut [T]) {
        (const { &all::<N>() }, self[row].as_mut_slice())
    }
}

impl<const N: usize, const K: usize, T: Real> Rectangular<N, T> for [SVector<T, N>; K] {
    #[inline(always)]
    fn count(&self) -> usize {
        K
    }

    #[inline(always)]
    fn row(&self, row: usize) -> Row<'_, T> {
        self.as_slice().row(row)
    }

    #[inline(always)]
    fn row_mut(&mut self, row: usize) -> (&'static [usize], &mut [T]) {
        self.as_mut_slice().row_mut(row)
    }
}

/// 0 … N − 1.
const fn all<const N: usize>() -> [usize; N] {
    let mut columns = [0; N];
    let mut column = 0;
    while column < N {
        columns[column] = column;
        column += 1;
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::{Rectangular, Row, Sparse};
    use nalgebra::SVector;
    use std::vec::Vec;

    #[test]
    fn sparse_and_dense_rows_agree() {
        let sparse = Sparse { columns: &[&[1], &[0, 2]], rows: [[3.0, f64::NAN], [-1.0, 2.0]] };
        let dense = [SVector::from([0.0, 3.0, 0.0]), SVector::from([-1.0, 0.0, 2.0])];
        let x = SVector::from([5.0, 7.0, -11.0]);
        let of = |rows: &dyn Fn(usize) -> [f64; 2]| [rows(0), rows(1)];
        let [of_sparse, of_dense] = [
            of(&|r| [sparse.row(r).dot(&x), sparse.row(r).terms(&x)]),
            of(&|r| [dense.row(r).dot(&x), dense.row(r).terms(&x)]),
        ];
        assert_eq!(of_sparse, [[21.0, 21.0], [-27.0, 27.0]]);
        assert_eq!(of_dense, of_sparse);
        assert_eq!(Rectangular::<3, f64>::rows(&sparse).map(Row::dense::<3>).collect::<Vec<_>>(), dense);
    }
}
