//! Units do not matter: metres beside radians, masses of 1 and 1e-12. A matrix `D A D` with a diagonal D of any sizes is solved as
//! A is, entry by entry.

use super::super::{Banded, Blocks, Matrix, Symmetric, Tridiagonal, dense, determinant_sign, solve};
use super::forms::{banded, blocks, dominant, next, tridiagonal};
use nalgebra::{SMatrix, SVector};
use std::vec::Vec;

/// Units of the rows and columns, powers of two so that nothing is rounded: 1, 1e-12, 1e30, 3e-8, 1e-30, 1e6.
const EXPONENTS: [i32; 6] = [0, -40, 100, -25, -100, 20];

fn unit(row: usize) -> f64 {
    2.0_f64.powi(EXPONENTS[row % EXPONENTS.len()])
}

/// `D A D`.
fn in_units<const N: usize>(a: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    SMatrix::from_fn(|i, j| unit(i) * a[(i, j)] * unit(j))
}

/// How far the solution in units is from the one without, x = D⁻¹ y where A y = b, relative to y.
fn off<const N: usize>(a: &SMatrix<f64, N, N>, solve: impl Fn(&SVector<f64, N>) -> SVector<f64, N>) -> f64 {
    let mut seed = 7;
    let y = SVector::<f64, N>::from_fn(|_, _| 1.5 + next(&mut seed) / 2.0);
    let b = a * y;
    let x = solve(&SVector::from_fn(|i, _| unit(i) * b[i]));
    let off = SVector::<f64, N>::from_fn(|i, _| (x[i] * unit(i) - y[i]).abs() / y[i]);
    off.iter().fold(0.0, |worst, off| if off.is_nan() || *off > worst { *off } else { worst })
}

/// The worst of a form: by itself, by its inverse, and with pivots.
fn worst<const N: usize, F: Matrix<N, f64>>(a: &SMatrix<f64, N, N>, form: &F) -> f64 {
    let alone = off(a, |b| form.solve(b));
    let by_inverse = off(a, |b| F::apply(&form.inverse(), b));
    let with_pivots = off(a, |b| dense::pivoted([N, 1], form.dense(), *b));
    println!("{} of {N}: {alone:.1e} {by_inverse:.1e} {with_pivots:.1e}", core::any::type_name::<F>());
    [alone, by_inverse, with_pivots].into_iter().fold(0.0, f64::max)
}

#[test]
fn every_form_is_solved_in_any_units() {
    let mut seed = 1;
    let mut all = Vec::new();
    for _ in 0..20 {
        let a = dominant::<5>(&mut seed, true, |_, _| true);
        all.push(worst(&a, &Symmetric(in_units(&a))));
        let a = dominant::<5>(&mut seed, false, |_, _| true);
        all.push(worst(&a, &in_units(&a)));
        let a = dominant::<2>(&mut seed, false, |_, _| true);
        all.push(worst(&a, &in_units(&a)));
        let a = dominant::<3>(&mut seed, false, |_, _| true);
        all.push(worst(&a, &in_units(&a)));
        let a = dominant::<6>(&mut seed, true, |i, j| i.abs_diff(j) == 1);
        let form: Tridiagonal<6, f64> = tridiagonal(&in_units(&a));
        all.push(worst(&a, &form));
        let a = dominant::<5>(&mut seed, true, |i, j| i.abs_diff(j) == 1);
        let form: Tridiagonal<5, f64> = tridiagonal(&in_units(&a));
        all.push(worst(&a, &form));
        let a = dominant::<6>(&mut seed, true, |i, j| i.abs_diff(j) <= 2);
        let form: Banded<6, 5, f64> = banded(&in_units(&a));
        all.push(worst(&a, &form));
        let members: &[&[usize]] = &[&[0, 2, 4, 5], &[1, 3]];
        let together = |i: usize, j: usize| members.iter().any(|block| block.contains(&i) && block.contains(&j));
        let a = dominant::<6>(&mut seed, true, together);
        let form: Blocks<6, 4, f64> = blocks(&in_units(&a), members);
        all.push(worst(&a, &form));
    }
    let worst = all.into_iter().fold(0.0, |worst, off| if off.is_nan() || off > worst { off } else { worst });
    // Measured: 5.4e-16.
    assert!(worst <= 2e-15, "{worst:e}");
}

/// A weak coupling between units far apart: the largest entry of the first column is its worst pivot.
#[test]
fn a_large_unit_is_no_reason_for_a_pivot() {
    let a = SMatrix::<f64, 4, 4>::from([
        [1.0, 1e-8, 0.0, 0.5],
        [1e-8, 1.0, 1e-8, 0.0],
        [0.0, 1e-8, 1.0, 1e-8],
        [-0.5, 0.0, 1e-8, 1.0],
    ]);
    let worst = worst(&a, &in_units(&a));
    // Measured: 2.3e-16.
    assert!(worst <= 5e-16, "{worst:e}");
}

#[test]
fn pivots_are_found_in_any_units() {
    // Nothing on the diagonal: no order but another one works.
    let a = SMatrix::<f64, 4, 4>::from([
        [0.0, 1.0, 0.5, 0.0],
        [1.0, 0.0, 0.0, 0.25],
        [0.5, 0.0, 0.0, 1.0],
        [0.0, 0.25, 1.0, 0.0],
    ]);
    let worst = worst(&a, &in_units(&a));
    // Measured: 1.8e-16.
    assert!(worst <= 5e-16, "{worst:e}");
    let mut seed = 3;
    for _ in 0..50 {
        let a = SMatrix::<f64, 5, 5>::from_fn(|_, _| next(&mut seed));
        let sign = determinant_sign(&a);
        assert_eq!(sign, if a.determinant() > 0.0 { 1 } else { -1 });
        assert_eq!(determinant_sign(&in_units(&a)), sign, "D A D, and D is positive");
    }
}

/// In single precision a product of three masses of 1e-20, or of 1e25, is no number; the masses are.
#[test]
fn a_determinant_out_of_range_is_not_needed() {
    fn off<const N: usize>(size: f32) -> f32 {
        let a = SMatrix::<f32, N, N>::from_fn(|i, j| if i == j { 2.0 * size } else { size });
        let y = SVector::<f32, N>::from_fn(|i, _| if i == 0 { 3.0 } else { -1.0 });
        let found = solve(&a, &(a * y)).unwrap_or_else(|| panic!("{N} masses of {size:e} are regular"));
        (found - y).amax()
    }
    // In the last of each three the determinant still has some digits.
    for off in [
        off::<2>(1e-30),
        off::<2>(1e30),
        off::<2>(3e-22),
        off::<3>(1e-20),
        off::<3>(1e25),
        off::<3>(3e-15),
        off::<3>(1e-14),
    ] {
        // Measured: 2.4e-7.
        assert!(off <= 5e-7, "{off:e}");
    }
}
