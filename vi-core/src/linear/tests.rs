//! Dense matrices by their defect, and the sign of the determinant; the other forms in `forms`, units of rows and columns in
//! `units`.

mod forms;
mod units;

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
