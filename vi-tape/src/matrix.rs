//! A matrix whose form is known at run time.

use crate::code::Form;
use crate::lines::Results;
use core::cmp::Ordering;
use vi_core::SVector;
use vi_core::linear::{Banded, Matrix, Symmetric, Tridiagonal};
use vi_core::nalgebra::SMatrix;
use vi_core::real::Real;

/// A matrix in one of these forms.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)]
pub(crate) enum AnyMatrix<const N: usize, T> {
    Diagonal(Banded<N, 1, T>),
    Tridiagonal(Tridiagonal<N, T>),
    Symmetric(Symmetric<N, T>),
    Dense(SMatrix<T, N, N>),
}

/// The factors of one.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant)]
pub(crate) enum Inverse<const N: usize, T: Real> {
    Diagonal(<Banded<N, 1, T> as Matrix<N, T>>::Inverse),
    Tridiagonal(<Tridiagonal<N, T> as Matrix<N, T>>::Inverse),
    Symmetric(<Symmetric<N, T> as Matrix<N, T>>::Inverse),
    Dense(<SMatrix<T, N, N> as Matrix<N, T>>::Inverse),
}

impl<const N: usize, T: Real> AnyMatrix<N, T> {
    /// The zero matrix.
    #[inline(always)]
    fn zeros(form: Form) -> Self {
        let zeros = [T::zero(); N];
        match form {
            Form::Diagonal => Self::Diagonal(Banded { rows: [[T::zero()]; N] }),
            Form::Tridiagonal => Self::Tridiagonal(Tridiagonal { lower: zeros, diagonal: zeros, upper: zeros }),
            Form::Symmetric => Self::Symmetric(Symmetric(SMatrix::zeros())),
            Form::Dense => Self::Dense(SMatrix::zeros()),
        }
    }

    /// The matrix of this form among the results of a function.
    #[inline(always)]
    pub(crate) fn of(form: Form, of: Results<'_, T>, quantity: usize) -> Self {
        let mut matrix = Self::zeros(form);
        of.each(quantity, |row, column, value| matrix.put(row, column, value));
        matrix
    }

    /// Sets an entry.
    #[inline(always)]
    fn put(&mut self, row: usize, column: usize, value: T) {
        match self {
            Self::Diagonal(of) => of.rows[row][0] = value,
            Self::Tridiagonal(of) => {
                let side = match row.cmp(&column) {
                    Ordering::Less => &mut of.upper,
                    Ordering::Equal => &mut of.diagonal,
                    Ordering::Greater => &mut of.lower,
                };
                side[row] = value;
            }
            Self::Symmetric(of) => of.0[(row, column)] = value,
            Self::Dense(of) => of[(row, column)] = value,
        }
    }
}

macro_rules! each {
    ($on:expr, $of:ident => $value:expr) => {
        match $on {
            AnyMatrix::Diagonal($of) => $value,
            AnyMatrix::Tridiagonal($of) => $value,
            AnyMatrix::Symmetric($of) => $value,
            AnyMatrix::Dense($of) => $value,
        }
    };
}

macro_rules! with_form {
    ($on:expr, $form:ident, $of:ident => $value:expr) => {
        match $on {
            Inverse::Diagonal($of) => {
                type $form<const N: usize, T> = Banded<N, 1, T>;
                $value
            }
            Inverse::Tridiagonal($of) => {
                type $form<const N: usize, T> = Tridiagonal<N, T>;
                $value
            }
            Inverse::Symmetric($of) => {
                type $form<const N: usize, T> = Symmetric<N, T>;
                $value
            }
            Inverse::Dense($of) => {
                type $form<const N: usize, T> = SMatrix<T, N, N>;
                $value
            }
        }
    };
}

impl<const N: usize, T: Real> Matrix<N, T> for AnyMatrix<N, T> {
    type Inverse = Inverse<N, T>;

    #[inline]
    fn solve<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        each!(self, of => of.solve(rhs))
    }

    #[inline]
    fn quotient<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> (SMatrix<T, N, M>, T) {
        each!(self, of => of.quotient(rhs))
    }

    #[inline(always)]
    fn solve_unchecked<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        each!(self, of => of.solve_unchecked(rhs))
    }

    #[inline]
    fn inverse(&self) -> Inverse<N, T> {
        match self {
            Self::Diagonal(of) => Inverse::Diagonal(of.inverse()),
            Self::Tridiagonal(of) => Inverse::Tridiagonal(of.inverse()),
            Self::Symmetric(of) => Inverse::Symmetric(of.inverse()),
            Self::Dense(of) => Inverse::Dense(Matrix::inverse(of)),
        }
    }

    #[inline]
    fn apply(inverse: &Inverse<N, T>, rhs: &SVector<T, N>) -> SVector<T, N> {
        with_form!(inverse, Form, of => <Form<N, T> as Matrix<N, T>>::apply(of, rhs))
    }

    #[inline(always)]
    fn apply_to_rows<const S: usize>(inverse: &Inverse<N, T>, rows: &mut [[T; S]; N]) {
        with_form!(inverse, Form, of => <Form<N, T> as Matrix<N, T>>::apply_to_rows(of, rows));
    }

    #[inline]
    fn entry(&self, row: usize, column: usize) -> T {
        each!(self, of => Matrix::entry(of, row, column))
    }

    #[inline]
    fn each_entry(&self, f: impl FnMut(usize, usize, T)) {
        each!(self, of => of.each_entry(f));
    }

    #[inline]
    fn multiply(&self, x: &SVector<T, N>) -> SVector<T, N> {
        each!(self, of => Matrix::multiply(of, x))
    }
}
