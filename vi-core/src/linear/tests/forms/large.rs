//! Elimination of large dense matrices in blocks, against elimination column by column: every bit is the same.

use super::super::super::{dense, is_kept};
use super::next;
use crate::real::{Dual, Real};
use nalgebra::SMatrix;

/// Elimination column by column, with back substitution; `None` if a pivot is lost and `pivoting` is off.
fn column_by_column<T: Real, const N: usize, const M: usize>(
    mut a: SMatrix<T, N, N>,
    mut b: SMatrix<T, N, M>,
    pivoting: bool,
) -> Option<SMatrix<T, N, M>> {
    let mut weights = dense::weights(&a);
    let mut kept = true;
    for column in 0..N {
        if pivoting && let Some(row) = dense::pivot(&mut a, &mut weights, column) {
            b.swap_rows(column, row);
        }
        for row in column + 1..N {
            let factor = a[(row, column)] / a[(column, column)];
            kept &= is_kept(a[(row, row)], factor * a[(column, row)]);
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
    (kept || pivoting).then_some(b)
}

/// Equal bits, or NaN on both sides.
fn is_same(x: f64, y: f64) -> bool {
    x.to_bits() == y.to_bits() || x.is_nan() && y.is_nan()
}

/// Compares the solutions of one matrix, without and with pivoting; returns whether the first elimination kept its
/// pivots.
fn compare<const N: usize, const M: usize>(a: &SMatrix<f64, N, N>, seed: &mut u32) -> bool {
    let b = SMatrix::<f64, N, M>::from_fn(|_, _| next(seed));
    let with_pivots = column_by_column(*a, b, true).expect("pivoted");
    let in_order = column_by_column(*a, b, false);
    let wanted = in_order.unwrap_or(with_pivots);
    assert!(dense::eliminate([N, M], *a, b).iter().zip(&wanted).all(|(x, y)| is_same(*x, *y)), "{N} {M}");
    assert!(dense::pivoted([N, M], *a, b).iter().zip(&with_pivots).all(|(x, y)| is_same(*x, *y)), "{N} {M} pivoted");
    in_order.is_some()
}

/// Matrices of one size: a diagonal that outweighs the rest, random entries, lost pivots, NaN, and a singular matrix.
fn compare_all<const N: usize, const M: usize>() {
    let mut seed = 5;
    let random = SMatrix::<f64, N, N>::from_fn(|_, _| next(&mut seed));
    let dominant = random + SMatrix::from_diagonal_element(8.0);
    assert!(compare::<N, M>(&dominant, &mut seed));
    compare::<N, M>(&random, &mut seed);
    // The first pivot, one inside a block, the first of the second block, and one of the last, incomplete block.
    for lost in [0, 2, 4, N - 2] {
        let mut a = dominant;
        // Equal rows and columns except for 1e-9: the pivot of the second of them is lost.
        let (row, column) = (a.row(lost).into_owned(), a.column(lost).into_owned());
        a.set_row(lost + 1, &row);
        a.set_column(lost + 1, &column);
        a[(lost + 1, lost + 1)] = a[(lost, lost)] * (1.0 + 1e-9);
        a[(lost, lost + 1)] = a[(lost, lost)];
        a[(lost + 1, lost)] = a[(lost, lost)];
        compare::<N, M>(&a, &mut seed);
        let mut a = dominant;
        a[(lost, lost)] = 0.0;
        assert!(!compare::<N, M>(&a, &mut seed), "{N} {M} {lost}");
        let mut a = dominant;
        a[(N - 1, lost)] = f64::NAN;
        assert!(!compare::<N, M>(&a, &mut seed), "{N} {M} {lost}");
    }
    let mut singular = dominant;
    singular.fill_column(N / 2, 0.0);
    compare::<N, M>(&singular, &mut seed);
    compare::<N, M>(&SMatrix::zeros(), &mut seed);
}

#[test]
fn blocks_have_the_bits_of_columns() {
    compare_all::<17, 1>();
    compare_all::<17, 3>();
    compare_all::<24, 1>();
    compare_all::<24, 3>();
    compare_all::<24, 24>();
    compare_all::<40, 1>();
    compare_all::<40, 3>();
    compare_all::<63, 1>();
    compare_all::<63, 3>();
}

/// The limit of the diagonal check, at every pivot and every row: an entry just inside it, and one just outside.
#[test]
fn blocks_lose_the_pivots_that_columns_lose() {
    const N: usize = 21;
    let (mut seed, mut lost) = (9, [0; 2]);
    for pivot in 0..N - 1 {
        for row in pivot + 1..N {
            for (ratio, lost) in [1023.999, 1024.001].into_iter().zip(&mut lost) {
                let mut a = SMatrix::<f64, N, N>::identity();
                a[(row, pivot)] = ratio;
                a[(pivot, row)] = 1.0;
                *lost += usize::from(!compare::<N, 1>(&a, &mut seed));
            }
        }
    }
    assert_eq!(lost, [0, N * (N - 1) / 2]);
}

#[test]
fn blocks_of_other_numbers_have_the_bits_of_columns() {
    let mut seed = 3;
    let a = SMatrix::<f64, 18, 18>::from_fn(|i, j| next(&mut seed) + if i == j { 8.0 } else { 0.0 });
    let b = SMatrix::<f64, 18, 2>::from_fn(|_, _| next(&mut seed));
    #[allow(clippy::cast_possible_truncation)]
    let single = |x: f64| x as f32;
    let (a_single, b_single) = (a.map(single), b.map(single));
    assert_eq!(Some(dense::eliminate([18, 2], a_single, b_single)), column_by_column(a_single, b_single, false));
    let dual = |x: f64| Dual { value: x, slope: 1.0 - x };
    let (a_dual, b_dual) = (a.map(dual), b.map(dual));
    assert_eq!(Some(dense::eliminate([18, 2], a_dual, b_dual)), column_by_column(a_dual, b_dual, false));
}
