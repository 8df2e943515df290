//! Small dense linear systems `A X = B`.
//!
//! In: a matrix A of N × N and M right-hand sides as the columns of B. Out: X, or `None` when any entry of X is not
//! finite, which is how a singular matrix shows. N = 1, 2 and 3 are solved in closed form without a branch; larger
//! ones by elimination with partial pivoting. N is a constant, so that one of these is left in the program.

use crate::{Real, StepError};
use nalgebra::{SMatrix, SVector};

/// The X with `matrix · X = rhs`; `None` where it is not finite.
#[inline]
#[must_use]
pub fn solve<T: Real, const N: usize, const M: usize>(
    matrix: &SMatrix<T, N, N>,
    rhs: &SMatrix<T, N, M>,
) -> Option<SMatrix<T, N, M>> {
    let solution = match N {
        1 => solve_1(matrix, rhs),
        2 => solve_2(matrix, rhs),
        3 => solve_3(matrix, rhs),
        _ => eliminate(*matrix, *rhs),
    };
    solution.iter().all(|entry| entry.is_finite()).then_some(solution)
}

/// The acceleration a with `mass · a = applied`, as generated code asks for it.
///
/// # Errors
/// [`StepError::Singular`] where the mass matrix cannot be inverted at the time `t`.
#[inline]
pub fn acceleration<T: Real, const N: usize>(
    t: T,
    mass: &SMatrix<T, N, N>,
    applied: &SVector<T, N>,
) -> Result<SVector<T, N>, StepError> {
    solve(mass, applied).ok_or(StepError::Singular { t: t.to_f64(), matrix: "mass matrix" })
}

/// Sign of the determinant, by elimination with partial pivoting: −1, 0 or 1; 0 where an entry is not a number.
#[must_use]
pub fn determinant_sign<T: Real, const N: usize>(matrix: &SMatrix<T, N, N>) -> i8 {
    let mut a = *matrix;
    let mut sign = 1;
    for column in 0..N {
        let mut pivot = column;
        for row in column + 1..N {
            if a[(row, column)].least_magnitude() > a[(pivot, column)].least_magnitude() {
                pivot = row;
            }
        }
        if pivot != column {
            a.swap_rows(column, pivot);
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

#[inline]
fn solve_1<T: Real, const N: usize, const M: usize>(a: &SMatrix<T, N, N>, b: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
    let pivot = a[(0, 0)];
    SMatrix::from_fn(|_, column| b[(0, column)] / pivot)
}

/// Cramer's rule for two unknowns.
#[inline]
fn solve_2<T: Real, const N: usize, const M: usize>(a: &SMatrix<T, N, N>, b: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
    let determinant = a[(0, 0)] * a[(1, 1)] - a[(0, 1)] * a[(1, 0)];
    SMatrix::from_fn(|row, column| {
        let (b0, b1) = (b[(0, column)], b[(1, column)]);
        let numerator = if row == 0 { a[(1, 1)] * b0 - a[(0, 1)] * b1 } else { a[(0, 0)] * b1 - a[(1, 0)] * b0 };
        numerator / determinant
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

/// Gaussian elimination with partial pivoting and back substitution.
fn eliminate<T: Real, const N: usize, const M: usize>(
    mut a: SMatrix<T, N, N>,
    mut b: SMatrix<T, N, M>,
) -> SMatrix<T, N, M> {
    for column in 0..N {
        let mut pivot = column;
        for row in column + 1..N {
            if a[(row, column)].least_magnitude() > a[(pivot, column)].least_magnitude() {
                pivot = row;
            }
        }
        a.swap_rows(column, pivot);
        b.swap_rows(column, pivot);
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

#[cfg(test)]
mod tests {
    use super::{determinant_sign, solve};
    use nalgebra::{SMatrix, SVector};

    /// Entries of no pattern, in [−1, 1], with a zero in the corner so that closed forms and pivoting are both needed.
    fn matrix<const N: usize>() -> SMatrix<f64, N, N> {
        let mut seed = 1_u32;
        let mut matrix = SMatrix::from_fn(|_, _| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1_u32 << 23) - 1.0
        });
        if N > 1 {
            matrix[(0, 0)] = 0.0;
        }
        matrix
    }

    /// Largest entry of `A x − b`, against nalgebra's own product.
    fn defect<const N: usize>() -> f64 {
        let a = matrix::<N>();
        let b = SMatrix::<f64, N, 2>::from_fn(|row, column| if row % 2 == column { 1.0 } else { -0.5 });
        solve(&a, &b).map_or(f64::NAN, |x| (a * x - b).abs().max())
    }

    #[test]
    fn every_size_solves_two_right_hand_sides() {
        // Measured: at most 6.7e-16.
        for defect in [defect::<1>(), defect::<2>(), defect::<3>(), defect::<4>(), defect::<5>(), defect::<8>()] {
            assert!(defect < 2e-15, "{defect:e}");
        }
    }

    #[test]
    fn the_sign_of_the_determinant_is_that_of_nalgebra() {
        let sign = |determinant: f64| if determinant > 0.0 { 1 } else { -1 };
        assert_eq!(determinant_sign(&matrix::<1>()), sign(matrix::<1>().determinant()));
        assert_eq!(determinant_sign(&matrix::<2>()), sign(matrix::<2>().determinant()));
        assert_eq!(determinant_sign(&matrix::<3>()), sign(matrix::<3>().determinant()));
        assert_eq!(determinant_sign(&matrix::<5>()), sign(matrix::<5>().determinant()));
        assert_eq!(determinant_sign(&-matrix::<5>()), -sign(matrix::<5>().determinant()));
        assert_eq!(determinant_sign(&SMatrix::<f64, 3, 3>::repeat(2.0)), 0);
        assert_eq!(determinant_sign(&SMatrix::<f64, 2, 2>::repeat(f64::NAN)), 0);
    }

    #[test]
    fn a_singular_matrix_has_no_solution() {
        assert_eq!(solve(&SMatrix::<f64, 1, 1>::zeros(), &SVector::<f64, 1>::repeat(1.0)), None);
        assert_eq!(solve(&SMatrix::<f64, 2, 2>::repeat(2.0), &SVector::<f64, 2>::repeat(1.0)), None);
        assert_eq!(solve(&SMatrix::<f64, 3, 3>::repeat(2.0), &SVector::<f64, 3>::repeat(1.0)), None);
        assert_eq!(solve(&SMatrix::<f64, 4, 4>::repeat(2.0), &SVector::<f64, 4>::repeat(1.0)), None);
    }
}
