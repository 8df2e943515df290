//! Differences between systems without and with constraints: the forms of matrices, and the functions of constraints.

use crate::code::{Code, Columns};
use crate::lines::Results;
use core::fmt::Debug;
use vi_core::kind::{Bound, Counted, Free, Kind};
use vi_core::linear::{AnyForm, AnyMatrix, AtMost, Matrix, Rectangular, Rows};
use vi_core::nalgebra::SMatrix;
use vi_core::real::Real;

/// The number of coordinates up to which mass matrices are inverted in matrices of this size. Measured for four pendula:
/// steps of four stages take 23 % less time, of eight 36 %.
const FEW: usize = 4;

/// The kind of a system whose functions are instructions.
pub(crate) trait Interpreted: Kind {
    /// The largest number of parameters.
    const PARAMETERS: usize;
    /// An array of [`Interpreted::PARAMETERS`] numbers.
    type Parameters<T: Real>: Copy + Debug + Send + Sync + AsRef<[T]> + AsMut<[T]>;
    /// The mass matrix, and the derivatives of the equations of motion.
    type Matrix<const N: usize, T: Real>: Matrix<N, T>;

    /// The array of zeros.
    fn parameters<T: Real>() -> Self::Parameters<T>;
    /// The mass matrix among the results of a function.
    fn mass<const N: usize, T: Real>(code: &Code, of: Results<'_, T>, quantity: usize) -> Self::Matrix<N, T>;
    /// Sets the entries of the inverse of the mass matrix among the results of a function.
    fn set_inverse_mass<const N: usize, T: Real>(
        code: &Code,
        of: Results<'_, T>,
        quantity: usize,
        inverse: &mut SMatrix<T, N, N>,
    ) {
        *inverse = Self::mass::<N, T>(code, of, quantity).inverse_unchecked();
    }
    /// A derivative of the equations of motion, with these entries on the diagonal of coordinates at rest.
    fn point_matrix<const N: usize, T: Real>(
        code: &Code,
        of: Results<'_, T>,
        quantity: (usize, f64),
    ) -> Self::Matrix<N, T>;
    /// One number for each constraint.
    fn multipliers<T: Real>(code: &Code, of: Results<'_, T>, quantity: usize) -> Self::Multipliers<T>;
    /// A row in these columns for each constraint.
    fn gradients<const N: usize, T: Real>(
        columns: Columns,
        of: Results<'_, T>,
        quantity: usize,
    ) -> Self::Gradients<N, T>;
    /// A row in these columns for each coordinate.
    fn reaction<const N: usize, T: Real>(
        columns: Columns,
        of: Results<'_, T>,
        quantity: usize,
    ) -> Self::ReactionMatrix<N, T>;
}

impl Interpreted for Free {
    const PARAMETERS: usize = 32;
    type Parameters<T: Real> = [T; Self::PARAMETERS];
    type Matrix<const N: usize, T: Real> = AnyMatrix<N, T>;

    #[inline(always)]
    fn parameters<T: Real>() -> Self::Parameters<T> {
        [T::zero(); Self::PARAMETERS]
    }

    #[inline(always)]
    fn mass<const N: usize, T: Real>(code: &Code, of: Results<'_, T>, quantity: usize) -> AnyMatrix<N, T> {
        matrix(code, code.mass, of, (quantity, 1.0))
    }

    #[inline(always)]
    fn set_inverse_mass<const N: usize, T: Real>(
        code: &Code,
        of: Results<'_, T>,
        quantity: usize,
        inverse: &mut SMatrix<T, N, N>,
    ) {
        let n = code.coordinates.len();
        if n > FEW || const { N <= FEW } {
            *inverse = Self::mass::<N, T>(code, of, quantity).inverse_unchecked();
            return;
        }
        // To copy a matrix of N rows a few times takes longer than the rest of an iteration.
        let few = Self::mass::<FEW, T>(code, of, quantity).inverse_unchecked();
        for column in 0..n {
            for row in 0..n {
                inverse[(row, column)] = few[(row, column)];
            }
        }
    }

    #[inline(always)]
    fn point_matrix<const N: usize, T: Real>(
        code: &Code,
        of: Results<'_, T>,
        (quantity, at_rest): (usize, f64),
    ) -> AnyMatrix<N, T> {
        matrix(code, code.point_matrix, of, (quantity, at_rest))
    }

    fn multipliers<T: Real>(_code: &Code, _of: Results<'_, T>, _quantity: usize) -> [T; 0] {
        Self::no_multipliers()
    }

    fn gradients<const N: usize, T: Real>(
        _columns: Columns,
        _of: Results<'_, T>,
        _quantity: usize,
    ) -> Self::Gradients<N, T> {
        Self::no_gradients::<N, T>()
    }

    fn reaction<const N: usize, T: Real>(
        _columns: Columns,
        _of: Results<'_, T>,
        _quantity: usize,
    ) -> Self::ReactionMatrix<N, T> {
        Self::no_reaction::<N, T>()
    }
}

impl<const K: usize> Interpreted for Bound<K, Counted> {
    // Copies of a system take little beside the elimination.
    const PARAMETERS: usize = 64;
    type Parameters<T: Real> = [T; 64];
    type Matrix<const N: usize, T: Real> = Rows<N, N, T>;

    fn parameters<T: Real>() -> Self::Parameters<T> {
        [T::zero(); 64]
    }

    fn mass<const N: usize, T: Real>(code: &Code, of: Results<'_, T>, quantity: usize) -> Rows<N, N, T> {
        square(code, code.constraints.map_or(&[], |of| of.mass), of, (quantity, 1.0))
    }

    fn point_matrix<const N: usize, T: Real>(
        code: &Code,
        of: Results<'_, T>,
        (quantity, at_rest): (usize, f64),
    ) -> Rows<N, N, T> {
        square(code, code.constraints.map_or(&[], |of| of.point_matrix), of, (quantity, at_rest))
    }

    fn multipliers<T: Real>(code: &Code, of: Results<'_, T>, quantity: usize) -> AtMost<K, T> {
        let mut multipliers = AtMost::zeros(code.constraints.map_or(0, |of| of.names.len()));
        of.each(quantity, |_, constraint, value| multipliers.as_mut()[constraint] = value);
        multipliers
    }

    fn gradients<const N: usize, T: Real>(columns: Columns, of: Results<'_, T>, quantity: usize) -> Rows<K, N, T> {
        rows::<N, K, N, T>(columns, of, quantity)
    }

    fn reaction<const N: usize, T: Real>(columns: Columns, of: Results<'_, T>, quantity: usize) -> Rows<N, N, T> {
        rows::<N, N, N, T>(columns, of, quantity)
    }
}

/// The matrix of this form among the results of a function, with these entries on the diagonal of coordinates at rest.
#[inline(always)]
pub(crate) fn matrix<const N: usize, T: Real>(
    code: &Code,
    form: AnyForm,
    of: Results<'_, T>,
    (quantity, at_rest): (usize, f64),
) -> AnyMatrix<N, T> {
    let mut matrix = AnyMatrix::zeros(form, code.coordinates.len(), T::real(at_rest));
    of.each(quantity, |row, column, value| matrix.put(row, column, value));
    matrix
}

/// The rows in these columns, which have the diagonal for coordinates at rest, with these entries there.
fn square<const N: usize, T: Real>(
    code: &Code,
    columns: Columns,
    of: Results<'_, T>,
    (quantity, at_rest): (usize, f64),
) -> Rows<N, N, T> {
    let mut matrix = rows::<N, N, N, T>(columns, of, quantity);
    for row in code.coordinates.len()..N {
        Rectangular::<N, T>::row_mut(&mut matrix, row).1[0] = T::real(at_rest);
    }
    matrix
}

/// The rows in these columns, for vectors of N numbers.
fn rows<const N: usize, const K: usize, const W: usize, T: Real>(
    columns: Columns,
    of: Results<'_, T>,
    quantity: usize,
) -> Rows<K, W, T> {
    let mut rows = Rows::zeros(columns);
    of.each(quantity, |row, place, value| Rectangular::<N, T>::row_mut(&mut rows, row).1[place] = value);
    rows
}
