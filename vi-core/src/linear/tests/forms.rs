//! The forms against elimination with partial pivoting of the same matrices.

mod large;

use super::super::{AnyForm, AnyMatrix, Banded, Blocks, Matrix, Symmetric, Tridiagonal, dense, solve};

use nalgebra::{SMatrix, SVector};

/// Matrices of one size and form.
const MATRICES: usize = 20;

/// The next entry of a fixed sequence in [−1, 1) that looks random.
pub(super) fn next(seed: &mut u32) -> f64 {
    *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    f64::from(*seed >> 8) / f64::from(1_u32 << 23) - 1.0
}

/// M + h² K: masses of 1 to 2, and entries of either sign beside the diagonal that it outweighs in each row; symmetric, it
/// is positive definite.
pub(super) fn dominant<const N: usize>(
    seed: &mut u32,
    symmetric: bool,
    touching: impl Fn(usize, usize) -> bool,
) -> SMatrix<f64, N, N> {
    let mut a = SMatrix::<f64, N, N>::from_fn(|i, j| if i != j && touching(i, j) { next(seed) } else { 0.0 });
    if symmetric {
        a += a.transpose();
    }
    for i in 0..N {
        a[(i, i)] = 1.5 + next(seed) / 2.0 + a.row(i).iter().map(|entry| entry.abs()).sum::<f64>();
    }
    a
}

pub(super) fn tridiagonal<const N: usize>(a: &SMatrix<f64, N, N>) -> Tridiagonal<N, f64> {
    let at = |i: usize, j: usize| a.get((i, j)).copied().unwrap_or(0.0);
    Tridiagonal {
        lower: core::array::from_fn(|i| at(i, i.wrapping_sub(1))),
        diagonal: core::array::from_fn(|i| at(i, i)),
        upper: core::array::from_fn(|i| at(i, i + 1)),
    }
}

pub(super) fn banded<const N: usize, const D: usize>(a: &SMatrix<f64, N, N>) -> Banded<N, D, f64> {
    let at = |i: usize, place: usize| a.get((i, (i + place).wrapping_sub(D / 2))).copied().unwrap_or(0.0);
    Banded { rows: core::array::from_fn(|i| core::array::from_fn(|place| at(i, place))) }
}

pub(super) fn blocks<const N: usize, const B: usize>(
    a: &SMatrix<f64, N, N>,
    members: &'static [&'static [usize]],
) -> Blocks<N, B, f64> {
    let block = |i: usize| members.iter().find(|members| members.contains(&i)).expect("every row is in a block");
    let at = |i: usize, place: usize| block(i).get(place).map_or(0.0, |j| a[(i, *j)]);
    Blocks { members, rows: core::array::from_fn(|i| core::array::from_fn(|place| at(i, place))) }
}

/// Largest difference of the solutions by a form of `a` from those of `a` by elimination with pivoting. Covers one and
/// two right-hand sides, directly and by the inverse, and the product with a vector against nalgebra.
fn off<const N: usize, F: Matrix<N, f64>>(a: &SMatrix<f64, N, N>, form: &F, seed: &mut u32) -> f64 {
    assert_eq!(form.dense(), *a);
    let two = SMatrix::<f64, N, 2>::from_fn(|_, _| next(seed));
    let one: SVector<f64, N> = two.column(1).into_owned();
    let (by_two, by_one) = (form.solve(&two), form.solve(&one));
    let by_inverse = F::apply(&form.inverse(), &one);
    assert_eq!(by_two.column(1), by_one, "a right-hand side is solved for itself");
    assert!(by_two.iter().chain(by_inverse.iter()).all(|entry| entry.is_finite()), "{form:?}");
    let wanted = dense::eliminate([N, 2], *a, two);
    // An error that both share would show here: A x is nalgebra's.
    let defect = (a * by_two - two).amax();
    let mut rows: [[f64; 2]; N] = core::array::from_fn(|i| [two[(i, 0)], two[(i, 1)]]);
    F::apply_to_rows(&form.inverse(), &mut rows);
    let by_rows = SMatrix::<f64, N, 2>::from_fn(|i, k| rows[i][k]);
    let by_rows = (by_rows - wanted).amax();
    let product = (form.multiply(&one) - a * one).amax();
    let solved = [(by_two - wanted).amax(), (by_inverse - wanted.column(1)).amax(), by_rows, defect];
    solved.into_iter().fold(product, f64::max)
}

/// The worst of many matrices, each made into a form.
fn worst<const N: usize, F: Matrix<N, f64>>(
    touching: impl Fn(usize, usize) -> bool,
    symmetric: bool,
    form: impl Fn(&SMatrix<f64, N, N>) -> F,
) -> f64 {
    let mut seed = 1;
    let worst = (0..MATRICES).fold(0.0_f64, |worst, _| {
        let a = dominant::<N>(&mut seed, symmetric, &touching);
        worst.max(off(&a, &form(&a), &mut seed))
    });
    println!("{} of {N} rows: off by {worst:.1e}", core::any::type_name::<F>());
    worst
}

#[test]
fn symmetric_matrices() {
    fn of<const N: usize>() -> f64 {
        worst::<N, _>(|_, _| true, true, |a| Symmetric(*a))
    }
    for off in [of::<1>(), of::<2>(), of::<4>(), of::<5>(), of::<16>()] {
        // Measured: at most 5.6e-16.
        assert!(off <= 1e-15, "{off:e}");
    }
}

#[test]
fn tridiagonal_matrices() {
    fn of<const N: usize>() -> f64 {
        worst::<N, _>(|i, j| i.abs_diff(j) == 1, false, tridiagonal)
    }
    for off in [of::<1>(), of::<2>(), of::<3>(), of::<4>(), of::<5>(), of::<16>(), of::<17>()] {
        // Measured: at most 5.6e-16.
        assert!(off <= 1e-15, "{off:e}");
    }
}

#[test]
fn what_stands_outside_a_tridiagonal_matrix_is_not_taken() {
    fn off<const N: usize>(outside: f64) -> f64 {
        let mut seed = 1;
        let a = dominant::<N>(&mut seed, false, |i, j| i.abs_diff(j) == 1);
        let rhs = SMatrix::<f64, N, 2>::from_fn(|_, _| next(&mut seed));
        let mut form = tridiagonal(&a);
        (form.lower[0], form.upper[N - 1]) = (outside, -outside);
        (solve(&form, &rhs).expect("regular") - dense::eliminate([N, 2], a, rhs)).amax()
    }
    for outside in [7.0, f64::INFINITY, f64::NAN] {
        for off in [off::<2>(outside), off::<4>(outside), off::<5>(outside), off::<16>(outside)] {
            println!("{outside} outside: off by {off:.1e}");
            // Measured: at most 1.1e-16.
            assert!(off <= 5e-16, "{outside}: {off:e}");
        }
    }
}

#[test]
fn banded_matrices() {
    fn of<const N: usize, const D: usize>() -> f64 {
        worst::<N, _>(|i, j| i.abs_diff(j) <= D / 2, false, banded::<N, D>)
    }
    let narrow = [of::<1, 1>(), of::<2, 1>(), of::<5, 1>(), of::<16, 1>(), of::<4, 3>(), of::<5, 3>()];
    // Bands of 5 and 7 places that are wider than the matrix, too.
    let wide = [of::<1, 3>(), of::<2, 5>(), of::<4, 5>(), of::<5, 5>(), of::<16, 5>(), of::<16, 7>()];
    for off in narrow.into_iter().chain(wide) {
        // Measured: at most 4.4e-16.
        assert!(off <= 5e-16, "{off:e}");
    }
}

#[test]
fn block_diagonal_matrices() {
    fn of<const N: usize, const B: usize>(members: &'static [&'static [usize]]) -> f64 {
        let together = |i: usize, j: usize| members.iter().any(|block| block.contains(&i) && block.contains(&j));
        worst::<N, _>(together, false, |a| blocks::<N, B>(a, members))
    }
    // Blocks in closed form and by elimination, filled up or not, of contiguous rows or not.
    for off in [
        of::<1, 1>(&[&[0]]),
        of::<2, 1>(&[&[0], &[1]]),
        of::<4, 2>(&[&[0, 1], &[2, 3]]),
        of::<4, 2>(&[&[0, 3], &[1], &[2]]),
        of::<5, 3>(&[&[0, 2, 4], &[1, 3]]),
        of::<5, 4>(&[&[0, 1, 3, 4], &[2]]),
        of::<16, 5>(&[&[0, 3, 6, 9, 12], &[1, 2], &[4, 5, 7, 8], &[10], &[11, 13, 14, 15]]),
    ] {
        // Measured: at most 4.4e-16.
        assert!(off <= 5e-16, "{off:e}");
    }
}

/// Checks that no solver returns finite numbers only.
fn lost<const N: usize, F: Matrix<N, f64>>(form: &F) {
    let rhs = SVector::<f64, N>::repeat(1.0);
    assert!(!form.solve(&rhs).iter().all(|entry| entry.is_finite()), "{form:?}");
    assert_eq!(solve(form, &rhs), None, "{form:?}");
    let by_inverse = F::apply(&form.inverse(), &rhs);
    assert!(!by_inverse.iter().all(|entry| entry.is_finite()), "{form:?}: {by_inverse:?}");
}

#[test]
fn singular_matrices_have_no_solution() {
    /// The unit matrix, one row of it zero.
    fn without<const N: usize>(row: usize) -> SMatrix<f64, N, N> {
        let mut a = SMatrix::identity();
        a[(row, row)] = 0.0;
        a
    }
    lost(&Symmetric(SMatrix::<f64, 5, 5>::repeat(1.0)));
    lost(&Symmetric(SMatrix::<f64, 5, 5>::zeros()));
    lost(&tridiagonal(&SMatrix::<f64, 2, 2>::repeat(1.0)));
    for row in 0..5 {
        lost(&Symmetric(without::<5>(row)));
        lost(&tridiagonal(&without::<5>(row)));
        lost(&banded::<5, 1>(&without::<5>(row)));
        lost(&banded::<5, 5>(&without::<5>(row)));
        lost(&blocks::<5, 3>(&without::<5>(row), &[&[0, 2, 4], &[1, 3]]));
        lost(&blocks::<5, 4>(&without::<5>(row), &[&[0, 1, 3, 4], &[2]]));
    }
    // An end of a free chain: its rows add up to zero, and no pivot vanishes but the last.
    let free = |i: usize, j: usize| match (i, j) {
        (0, 0) | (5, 5) => 1.0,
        _ if i == j => 2.0,
        _ => -f64::from(u8::from(i.abs_diff(j) == 1)),
    };
    lost(&tridiagonal(&SMatrix::<f64, 6, 6>::from_fn(free)));
    lost(&banded::<6, 3>(&SMatrix::from_fn(free)));
    lost(&Symmetric(SMatrix::<f64, 6, 6>::from_fn(free)));
}

/// An antidiagonal of pairs: a zero diagonal, regular for even N.
fn swapping<const N: usize>() -> SMatrix<f64, N, N> {
    SMatrix::from_fn(|i, j| f64::from(u8::from(i.abs_diff(j) == 1)))
}

#[test]
fn what_is_lost_without_pivoting_is_found_with_it() {
    fn found<const N: usize>(form: &impl Matrix<N, f64>, wanted: [f64; N]) {
        let x = SVector::from(wanted);
        let rhs = form.dense() * x;
        assert!(!form.solve(&rhs).iter().all(|entry| entry.is_finite()), "{form:?}");
        // Whole numbers: exact.
        assert_eq!(solve(form, &rhs), Some(x), "{form:?}");
    }
    let wanted = [3.0, -1.0, 4.0, 2.0];
    found(&tridiagonal(&swapping::<4>()), wanted);
    found(&banded::<4, 5>(&swapping::<4>()), wanted);
    lost(&tridiagonal(&swapping::<5>()));
    // Blocks are small dense matrices, which pivot or need not.
    let swapped = blocks::<4, 2>(&SMatrix::from_fn(|i, j| f64::from(u8::from(i + j == 3))), &[&[0, 3], &[1, 2]]);
    assert_eq!(swapped.solve(&(swapped.dense() * SVector::from(wanted))), SVector::from(wanted));
    let swapped = blocks::<5, 4>(&SMatrix::from_fn(|i, j| f64::from(u8::from(i + j == 4))), &[&[0, 1, 3, 4], &[2]]);
    assert_eq!(swapped.solve(&SVector::from([1.0, 2.0, 3.0, 4.0, 5.0])), SVector::from([5.0, 4.0, 3.0, 2.0, 1.0]));
}

#[test]
fn an_indefinite_symmetric_matrix_is_solved_with_pivoting() {
    let mut seed = 1;
    let rhs = SMatrix::<f64, 5, 2>::from_fn(|_, _| next(&mut seed));
    // Of no sign: rows that the pivots −1, 0 and 10⁻²⁰ begin, which without pivoting loses all digits.
    for corner in [-1.0, 0.0, 1e-20] {
        let mut a = SMatrix::<f64, 5, 5>::from_fn(|_, _| next(&mut seed));
        a += a.transpose();
        a[(0, 0)] = corner;
        assert_eq!(Symmetric(a).solve(&rhs), dense::eliminate([5, 2], a, rhs));
        let defect = (a * Symmetric(a).solve(&rhs) - rhs).amax();
        println!("corner {corner:e}: off by {defect:.1e}");
        // Measured: at most 4.4e-16.
        assert!(defect <= 1e-15, "corner {corner:e}: {defect:e}");
    }
}

/// Error of the solution of `a x = b` for a matrix whose elimination without pivoting loses digits and returns NaN.
fn off_where_lost<const N: usize>(a: &SMatrix<f64, N, N>) -> f64 {
    let x = SMatrix::<f64, N, 2>::from_fn(|row, column| [4.0, -1.0, 3.0, 2.0, -2.0, 5.0][(row + 2 * column) % 6]);
    let (rhs, three, five) = (a * x, tridiagonal(a), banded::<N, 5>(a));
    for alone in [three.solve(&rhs), five.solve(&rhs)] {
        assert!(!alone.sum().is_finite(), "{alone}");
    }
    let found = [solve(&three, &rhs), solve(&five, &rhs)].map(|found| (found.expect("regular") - x).amax());
    found[0].max(found[1])
}

#[test]
fn digits_lost_without_pivoting_are_found_with_it() {
    for small in [1e-12, 1e-17, 1e-30] {
        // The first pivot from each end is small; or it is not, and the determinant of the first two rows is.
        let mut of_one = swapping::<4>() + SMatrix::<f64, 4, 4>::identity() * 2.0;
        (of_one[(0, 0)], of_one[(3, 3)]) = (small, small);
        let mut of_two = swapping::<6>() + SMatrix::<f64, 6, 6>::identity() * 2.0;
        (of_two[(0, 0)], of_two[(1, 1)]) = (1.0, 1.0 + small);
        (of_two[(5, 5)], of_two[(4, 4)]) = (1.0, 1.0 + small);
        let (of_one, of_two) = (off_where_lost(&of_one), off_where_lost(&of_two));
        println!("{small:e}: off by {of_one:.1e} and {of_two:.1e}");
        // Measured: at most 1.8e-15; the first pivots by elimination alone 4.5e-5 and more.
        assert!(of_one <= 2e-15 && of_two <= 2e-15, "{small:e}: {of_one:e}, {of_two:e}");
    }
}

/// These rows among N, the others zero.
fn among<const N: usize, const M: usize, const C: usize>(of: &SMatrix<f64, M, C>) -> SMatrix<f64, N, C> {
    SMatrix::from_fn(|row, column| of.get((row, column)).copied().unwrap_or(0.0))
}

/// Solves a matrix as the first M rows of N, with the bits of its form of M rows.
fn is_solved_among<const N: usize, const M: usize, F: Matrix<M, f64>>(seed: &mut u32, of: AnyForm, exact: &F) {
    let mut part = AnyMatrix::<N, f64>::zeros(of, M, 1.0);
    exact.each_entry(|row, column, value| part.put(row, column, value));
    let rhs = SMatrix::<f64, M, 2>::from_fn(|_, _| next(seed));
    assert_eq!(part.solve(&among(&rhs)), among::<N, M, 2>(&exact.solve(&rhs)), "{of:?} {M}");
    assert_eq!(part.solve_unchecked(&among(&rhs)), among::<N, M, 2>(&exact.solve_unchecked(&rhs)), "{of:?} {M}");
    let x = rhs.column(1).clone_owned();
    assert_eq!(
        AnyMatrix::apply(&part.inverse(), &among(&x)),
        among::<N, M, 1>(&F::apply(&exact.inverse(), &x)),
        "{of:?} {M}"
    );
    assert_eq!(part.multiply(&among(&x)), among::<N, M, 1>(&exact.multiply(&x)), "{of:?} {M}");
    let (found, dense) = (part.inverse_unchecked(), exact.dense());
    assert_eq!(SMatrix::<f64, M, M>::from_fn(|i, j| found[(i, j)]), exact.inverse_unchecked(), "{of:?} {M}");
    let wanted = |i: usize, j: usize| dense.get((i, j)).copied().unwrap_or(if i == j { 1.0 } else { 0.0 });
    assert_eq!(part.dense(), SMatrix::<f64, N, N>::from_fn(wanted), "{of:?} {M}");
}

#[test]
fn the_first_rows_are_solved_with_the_bits_of_their_number() {
    let seed = &mut 1;
    macro_rules! each {
        ($($rows:literal),*) => {$(
            let a = dominant::<$rows>(seed, true, |_, _| true);
            is_solved_among::<24, $rows, _>(seed, AnyForm::Diagonal, &banded::<$rows, 1>(&a));
            is_solved_among::<24, $rows, _>(seed, AnyForm::Tridiagonal, &tridiagonal(&a));
            is_solved_among::<24, $rows, _>(seed, AnyForm::Symmetric, &Symmetric(a));
            let a = dominant::<$rows>(seed, false, |_, _| true);
            is_solved_among::<24, $rows, _>(seed, AnyForm::Dense, &a);
        )*};
    }
    each!(1, 2, 3, 4, 5, 8, 16, 17, 19, 24);
}
