//! A matrix whose form and number of rows are known at run time.

use super::{Matrix, Symmetric, Tridiagonal, dense, tridiagonal};
use crate::real::Real;
use core::cmp::Ordering;
use nalgebra::{SMatrix, SVector};

/// The form of an [`AnyMatrix`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AnyForm {
    /// Entries on the diagonal.
    Diagonal,
    /// [`Tridiagonal`].
    Tridiagonal,
    /// [`Symmetric`].
    Symmetric,
    /// Any entries.
    #[default]
    Dense,
}

/// A matrix of up to N rows and columns. Those after them belong to coordinates at rest: they have one number on the
/// diagonal, and no step eliminates them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnyMatrix<const N: usize, T> {
    rows: usize,
    /// The entries of the diagonal after these rows.
    at_rest: T,
    entries: Entries<N, T>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "no step allocates")]
enum Entries<const N: usize, T> {
    Diagonal([T; N]),
    Tridiagonal(Tridiagonal<N, T>),
    Symmetric(Symmetric<N, T>),
    Dense(SMatrix<T, N, N>),
}

/// The factors of one.
#[derive(Clone, Copy, Debug)]
pub struct AnyInverse<const N: usize, T> {
    rows: usize,
    factors: Factors<N, T>,
}

#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant, reason = "no step allocates")]
enum Factors<const N: usize, T> {
    /// The reciprocals of the diagonal.
    Diagonal([T; N]),
    Tridiagonal(tridiagonal::Factors<N, T>),
    Dense(SMatrix<T, N, N>),
}

impl<const N: usize, T: Real> AnyMatrix<N, T> {
    /// The zero matrix of this number of rows, at most N, with these entries on the diagonal of the others.
    #[inline(always)]
    #[must_use]
    pub fn zeros(form: AnyForm, rows: usize, at_rest: T) -> Self {
        let zeros = [T::zero(); N];
        let entries = match form {
            AnyForm::Diagonal => Entries::Diagonal(zeros),
            AnyForm::Tridiagonal => Entries::Tridiagonal(Tridiagonal { lower: zeros, diagonal: zeros, upper: zeros }),
            AnyForm::Symmetric => Entries::Symmetric(Symmetric(SMatrix::zeros())),
            AnyForm::Dense => Entries::Dense(SMatrix::zeros()),
        };
        Self { rows, at_rest, entries }
    }

    /// Sets an entry of its form.
    #[inline(always)]
    pub fn put(&mut self, row: usize, column: usize, value: T) {
        match &mut self.entries {
            Entries::Diagonal(of) => of[row] = value,
            Entries::Tridiagonal(of) => {
                let side = match row.cmp(&column) {
                    Ordering::Less => &mut of.upper,
                    Ordering::Equal => &mut of.diagonal,
                    Ordering::Greater => &mut of.lower,
                };
                side[row] = value;
            }
            Entries::Symmetric(of) => of.0[(row, column)] = value,
            Entries::Dense(of) => of[(row, column)] = value,
        }
    }

    /// The solution for the first m right-hand sides.
    #[inline(always)]
    fn solve_first<const M: usize>(&self, m: usize, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        match &self.entries {
            Entries::Diagonal(of) => {
                let mut x = *rhs;
                for row in 0..self.rows {
                    let reciprocal = of[row].recip();
                    for column in 0..m {
                        x[(row, column)] *= reciprocal;
                    }
                }
                x
            }
            Entries::Tridiagonal(of) => of.solve_first(self.rows, rhs),
            Entries::Symmetric(of) => of.solve_first([self.rows, m], rhs),
            Entries::Dense(of) => dense::solve([self.rows, m], of, rhs),
        }
    }
}

impl<const N: usize, T: Real> Matrix<N, T> for AnyMatrix<N, T> {
    type Inverse = AnyInverse<N, T>;

    #[inline]
    fn solve<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        self.solve_first(M, rhs)
    }

    #[inline]
    fn quotient<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> (SMatrix<T, N, M>, T) {
        match &self.entries {
            Entries::Dense(of) => dense::quotient([self.rows, M], of, rhs),
            _ => (self.solve(rhs), T::one()),
        }
    }

    #[inline(always)]
    fn inverse_unchecked(&self) -> SMatrix<T, N, N> {
        let identity = SMatrix::identity();
        match &self.entries {
            Entries::Dense(of) => {
                let (mut numerators, determinant) = dense::quotient([self.rows; 2], of, &identity);
                let reciprocal = determinant.recip();
                for column in 0..self.rows {
                    for row in 0..self.rows {
                        numerators[(row, column)] *= reciprocal;
                    }
                }
                numerators
            }
            _ => self.solve_first(self.rows, &identity),
        }
    }

    #[inline]
    fn inverse(&self) -> AnyInverse<N, T> {
        let factors = match &self.entries {
            Entries::Diagonal(of) => {
                let mut reciprocals = [T::zero(); N];
                for row in 0..self.rows {
                    reciprocals[row] = of[row].recip();
                }
                Factors::Diagonal(reciprocals)
            }
            Entries::Tridiagonal(of) => Factors::Tridiagonal(of.inverse_of_first(self.rows)),
            Entries::Symmetric(Symmetric(of)) | Entries::Dense(of) => {
                Factors::Dense(dense::eliminate([self.rows; 2], *of, SMatrix::identity()))
            }
        };
        AnyInverse { rows: self.rows, factors }
    }

    #[inline]
    fn apply(inverse: &AnyInverse<N, T>, rhs: &SVector<T, N>) -> SVector<T, N> {
        let mut rows = [[T::zero()]; N];
        for (row, entry) in rows.iter_mut().zip(rhs.iter()) {
            *row = [*entry];
        }
        Self::apply_to_rows(inverse, &mut rows);
        SVector::from_fn(|row, _| rows[row][0])
    }

    #[inline(always)]
    fn apply_to_rows<const S: usize>(inverse: &AnyInverse<N, T>, rows: &mut [[T; S]; N]) {
        match &inverse.factors {
            Factors::Diagonal(of) => {
                for (row, reciprocal) in rows[..inverse.rows].iter_mut().zip(of) {
                    for entry in row {
                        *entry *= *reciprocal;
                    }
                }
            }
            Factors::Tridiagonal(of) => {
                for column in 0..S {
                    let rhs = SVector::from_fn(|row, _| rows[row][column]);
                    let x = Tridiagonal::apply_first(inverse.rows, of, &rhs);
                    for (row, x) in rows.iter_mut().zip(x.iter()) {
                        row[column] = *x;
                    }
                }
            }
            Factors::Dense(of) => dense::multiply_rows(inverse.rows, of, rows),
        }
    }

    #[inline]
    fn entry(&self, row: usize, column: usize) -> T {
        if row >= self.rows || column >= self.rows {
            return if row == column { self.at_rest } else { T::zero() };
        }
        match &self.entries {
            Entries::Diagonal(of) if row == column => of[row],
            Entries::Diagonal(_) => T::zero(),
            Entries::Tridiagonal(of) => of.entry(row, column),
            Entries::Symmetric(Symmetric(of)) | Entries::Dense(of) => of[(row, column)],
        }
    }

    #[inline]
    fn multiply(&self, x: &SVector<T, N>) -> SVector<T, N> {
        let mut product = SVector::zeros();
        for row in 0..self.rows {
            let columns = match &self.entries {
                Entries::Diagonal(_) => row..row + 1,
                Entries::Tridiagonal(_) => row.saturating_sub(1)..self.rows.min(row + 2),
                Entries::Symmetric(_) | Entries::Dense(_) => 0..self.rows,
            };
            product[row] = columns.fold(T::zero(), |sum, column| sum + self.entry(row, column) * x[column]);
        }
        for row in self.rows..N {
            product[row] = self.at_rest * x[row];
        }
        product
    }
}
