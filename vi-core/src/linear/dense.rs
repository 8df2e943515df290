//! Dense matrices: branch-free closed forms up to three rows, elimination beyond. The number of rows is a constant, so that
//! the program contains only one of these, unless it is known at run time only ([`AnyMatrix`](super::AnyMatrix)).

use super::{Matrix, is_kept};
use crate::real::Real;
use nalgebra::{SMatrix, SVector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;
use vi_dispatch::{Instructions, Loop, by_baseline};

impl<const N: usize, T: Real> Matrix<N, T> for SMatrix<T, N, N> {
    type Inverse = Self;

    #[inline(always)]
    fn quotient<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> (SMatrix<T, N, M>, T) {
        quotient([N, M], self, rhs)
    }

    #[inline(always)]
    fn solve<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        solve([N, M], self, rhs)
    }

    #[inline]
    fn inverse(&self) -> Self {
        eliminate([N, N], *self, Self::identity())
    }

    #[inline(always)]
    fn apply(inverse: &Self, rhs: &SVector<T, N>) -> SVector<T, N> {
        inverse * rhs
    }

    #[inline(always)]
    fn apply_to_rows<const S: usize>(inverse: &Self, rows: &mut [[T; S]; N]) {
        multiply_rows(N, inverse, rows);
    }

    #[inline(always)]
    fn entry(&self, row: usize, column: usize) -> T {
        self[(row, column)]
    }

    #[inline(always)]
    fn multiply(&self, x: &SVector<T, N>) -> SVector<T, N> {
        self * x
    }

    #[inline(always)]
    fn dense(&self) -> Self {
        *self
    }
}

/// [`Matrix::quotient`] for the first n rows and columns, and the first m right-hand sides.
#[inline(always)]
pub(super) fn quotient<T: Real, const N: usize, const M: usize>(
    [n, m]: [usize; 2],
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, M>,
) -> (SMatrix<T, N, M>, T) {
    match n {
        1 => (*b, a[(0, 0)]),
        2 => cramer_2(m, a, b),
        3 => cramer_3(m, a, b),
        _ => (eliminate([n, m], *a, *b), T::one()),
    }
}

/// [`Matrix::solve`] for the same.
#[inline(always)]
pub(super) fn solve<T: Real, const N: usize, const M: usize>(
    [n, m]: [usize; 2],
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, M>,
) -> SMatrix<T, N, M> {
    let (mut x, determinant) = quotient([n, m], a, b);
    if n <= 3 {
        let reciprocal = determinant.recip();
        // NaN if the determinant overflowed, or is too small to hold all its digits.
        let lost = determinant * reciprocal * T::zero();
        for column in 0..m {
            for row in 0..n {
                x[(row, column)] = x[(row, column)] * reciprocal + lost;
            }
        }
    }
    x
}

/// Multiplies the first n rows by the first n rows and columns of a matrix.
#[inline(always)]
pub(super) fn multiply_rows<T: Real, const N: usize, const S: usize>(
    n: usize,
    matrix: &SMatrix<T, N, N>,
    rows: &mut [[T; S]; N],
) {
    let known = *rows;
    for i in 0..n {
        for column in 0..S {
            rows[i][column] = matrix[(i, 0)] * known[0][column];
        }
        for j in 1..n {
            for column in 0..S {
                rows[i][column] += matrix[(i, j)] * known[j][column];
            }
        }
    }
}

/// Numerators and determinant of Cramer's rule for two unknowns.
#[inline(always)]
fn cramer_2<T: Real, const N: usize, const M: usize>(
    m: usize,
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, M>,
) -> (SMatrix<T, N, M>, T) {
    let mut x = *b;
    for column in 0..m {
        let (b0, b1) = (b[(0, column)], b[(1, column)]);
        x[(0, column)] = a[(1, 1)] * b0 - a[(0, 1)] * b1;
        x[(1, column)] = a[(0, 0)] * b1 - a[(1, 0)] * b0;
    }
    (x, a[(0, 0)] * a[(1, 1)] - a[(0, 1)] * a[(1, 0)])
}

/// The same for three unknowns, by cofactors.
#[inline(always)]
fn cramer_3<T: Real, const N: usize, const M: usize>(
    m: usize,
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, M>,
) -> (SMatrix<T, N, M>, T) {
    let mut cofactors = [[T::zero(); 3]; 3];
    for (i, row) in cofactors.iter_mut().enumerate() {
        for (j, cofactor) in row.iter_mut().enumerate() {
            // Cyclic indices carry the sign of the cofactor.
            let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            *cofactor = a[(i1, j1)] * a[(i2, j2)] - a[(i1, j2)] * a[(i2, j1)];
        }
    }
    let mut x = *b;
    for column in 0..m {
        for row in 0..3 {
            let [c0, c1, c2] = [0, 1, 2].map(|i| cofactors[i][row]);
            x[(row, column)] = c0 * b[(0, column)] + c1 * b[(1, column)] + c2 * b[(2, column)];
        }
    }
    let [c0, c1, c2] = cofactors[0];
    (x, a[(0, 0)] * c0 + a[(0, 1)] * c1 + a[(0, 2)] * c2)
}

/// Gaussian elimination of the first n rows in their order; with pivoting if digits would be lost.
#[inline(always)]
pub(super) fn eliminate<T: Real, const N: usize, const M: usize>(
    [n, m]: [usize; 2],
    a: SMatrix<T, N, N>,
    b: SMatrix<T, N, M>,
) -> SMatrix<T, N, M> {
    in_order([n, m], a, b).unwrap_or_else(|| pivoted([n, m], a, b))
}

/// `None` if a pivot is lost.
#[inline(always)]
fn in_order<T: Real, const N: usize, const M: usize>(
    [n, m]: [usize; 2],
    mut a: SMatrix<T, N, N>,
    mut b: SMatrix<T, N, M>,
) -> Option<SMatrix<T, N, M>> {
    if const { N > LARGEST_UNBLOCKED } && n > LARGEST_UNBLOCKED {
        return by_blocks([n, m], &mut a, &mut b, None).then_some(b);
    }
    let mut kept = true;
    for column in 0..n {
        for row in column + 1..n {
            let eliminated = a[(row, column)] / a[(column, column)] * a[(column, row)];
            kept &= is_kept(a[(row, row)], eliminated);
        }
        eliminate_column([n, m], &mut a, &mut b, column);
    }
    kept.then(|| substitute([n, m], &a, b))
}

/// With partial pivoting of scaled rows.
#[cold]
pub(super) fn pivoted<T: Real, const N: usize, const M: usize>(
    [n, m]: [usize; 2],
    mut a: SMatrix<T, N, N>,
    mut b: SMatrix<T, N, M>,
) -> SMatrix<T, N, M> {
    let mut weights = weights(&a);
    if const { N > LARGEST_UNBLOCKED } && n > LARGEST_UNBLOCKED {
        by_blocks([n, m], &mut a, &mut b, Some(&mut weights));
        return b;
    }
    for column in 0..n {
        if let Some(row) = pivot(&mut a, &mut weights, column) {
            b.swap_rows(column, row);
        }
        eliminate_column([n, m], &mut a, &mut b, column);
    }
    substitute([n, m], &a, b)
}

/// Subtracts multiples of the pivot's row from those below it.
#[inline(always)]
fn eliminate_column<T: Real, const N: usize, const M: usize>(
    [n, m]: [usize; 2],
    a: &mut SMatrix<T, N, N>,
    b: &mut SMatrix<T, N, M>,
    column: usize,
) {
    for row in column + 1..n {
        let factor = a[(row, column)] / a[(column, column)];
        for k in column + 1..n {
            let eliminated = factor * a[(column, k)];
            a[(row, k)] -= eliminated;
        }
        for k in 0..m {
            let eliminated = factor * b[(column, k)];
            b[(row, k)] -= eliminated;
        }
    }
}

/// Back substitution in the upper triangle.
#[inline(always)]
fn substitute<T: Real, const N: usize, const M: usize>(
    [n, m]: [usize; 2],
    a: &SMatrix<T, N, N>,
    mut b: SMatrix<T, N, M>,
) -> SMatrix<T, N, M> {
    for row in (0..n).rev() {
        for k in 0..m {
            let known = (row + 1..n).fold(T::zero(), |sum, column| sum + a[(row, column)] * b[(column, k)]);
            b[(row, k)] = (b[(row, k)] - known) / a[(row, row)];
        }
    }
    b
}

/// Larger matrices are eliminated in blocks of columns.
const LARGEST_UNBLOCKED: usize = 16;
/// Pivots of a block: a column is loaded and stored once for all of them.
const BLOCK: usize = 4;
/// Right-hand sides that are substituted together.
const TOGETHER: usize = 8;

/// Replaces `b` by the solution, with the same roundings as elimination column by column. With `weights` it pivots;
/// without, it returns `false` if a pivot is lost. Not inlined: one copy per instruction set.
#[inline(never)]
fn by_blocks<T: Real, const N: usize, const M: usize>(
    [n, m]: [usize; 2],
    a: &mut SMatrix<T, N, N>,
    b: &mut SMatrix<T, N, M>,
    weights: Option<&mut [f64; N]>,
) -> bool {
    let elimination = Elimination { n, m, a, b, weights };
    // Wide vectors do not speed up other numbers.
    if const { size_of::<T>() <= size_of::<f64>() } {
        Instructions::detected().run(elimination)
    } else {
        by_baseline(elimination)
    }
}

/// Elimination along the columns, which are contiguous in memory.
struct Elimination<'a, T, const N: usize, const M: usize> {
    n: usize,
    m: usize,
    a: &'a mut SMatrix<T, N, N>,
    b: &'a mut SMatrix<T, N, M>,
    weights: Option<&'a mut [f64; N]>,
}

impl<T: Real, const N: usize, const M: usize> Loop for Elimination<'_, T, N, M> {
    type Output = bool;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> bool {
        let Self { n, m, a, b, mut weights } = self;
        for start in (0..n).step_by(BLOCK) {
            let end = (start + BLOCK).min(n);
            let mut kept = true;
            for column in start..end {
                let (factors, columns) = a.data.0.split_at_mut(column);
                let entries = &mut columns[0];
                for pivot in start..column {
                    kept &= is_kept(entries[column], factors[pivot][column] * entries[pivot]);
                    subtract_row(n, &factors[pivot], pivot, entries);
                }
                // Columns beyond the block are swapped before their subtractions instead of between them.
                if let Some(weights) = &mut weights
                    && let Some(row) = pivot(a, weights, column)
                {
                    b.swap_rows(column, row);
                }
                let entries = &mut a.data.0[column];
                let pivot = entries[column];
                for entry in &mut entries[column + 1..n] {
                    *entry = *entry / pivot;
                }
            }
            let diagonal = core::array::from_fn(|i| a[(i, i)]);
            let (factors, columns) = a.data.0.split_at_mut(end);
            let (factors, columns) = (&factors[start..], &mut columns[..n - end]);
            if let Ok(factors) = <&[_; BLOCK]>::try_from(factors) {
                // Two columns share the loads of the factors.
                let (pairs, last) = columns.as_chunks_mut::<2>();
                for pair in pairs {
                    subtract_rows(n, factors, start, pair);
                }
                for column in last.iter_mut().chain(&mut b.data.0[..m]) {
                    subtract_rows(n, factors, start, core::array::from_mut(column));
                }
                kept &= weights.is_some() || are_kept(n, &diagonal, factors, columns, start);
            } else {
                for column in &mut b.data.0[..m] {
                    for (pivot, factors) in (start..).zip(factors) {
                        subtract_row(n, factors, pivot, column);
                    }
                }
            }
            if !kept && weights.is_none() {
                return false;
            }
        }
        if const { M <= TOGETHER } {
            substitute_together(n, a, &mut b.data.0);
        } else {
            let (groups, rest) = b.data.0[..m].as_chunks_mut::<TOGETHER>();
            for group in groups {
                substitute_together(n, a, group);
            }
            for column in rest {
                substitute_together(n, a, core::array::from_mut(column));
            }
        }
        true
    }
}

/// Subtracts multiples of the row `pivot` from those below it, in one column.
#[inline(always)]
fn subtract_row<T: Real, const N: usize>(n: usize, factors: &[T; N], pivot: usize, column: &mut [T; N]) {
    let entry = column[pivot];
    for row in pivot + 1..n {
        let eliminated = factors[row] * entry;
        column[row] -= eliminated;
    }
}

/// [`subtract_row`] for the rows of a block from `start` on, one after the other, in C columns.
#[inline(always)]
fn subtract_rows<T: Real, const N: usize, const C: usize>(
    n: usize,
    factors: &[[T; N]; BLOCK],
    start: usize,
    columns: &mut [[T; N]; C],
) {
    let mut pivots = [[T::zero(); C]; BLOCK];
    for k in 0..C {
        for i in 0..BLOCK {
            pivots[i][k] = columns[k][start + i];
            for j in i + 1..BLOCK {
                let eliminated = factors[i][start + j] * pivots[i][k];
                columns[k][start + j] -= eliminated;
            }
        }
    }
    for row in start + BLOCK..n {
        let mut entries = [T::zero(); C];
        for k in 0..C {
            entries[k] = columns[k][row];
        }
        for i in 0..BLOCK {
            for k in 0..C {
                let eliminated = factors[i][row] * pivots[i][k];
                entries[k] -= eliminated;
            }
        }
        for k in 0..C {
            columns[k][row] = entries[k];
        }
    }
}

/// Whether the diagonal entries below a block kept their digits. `diagonal` has their values before the subtraction,
/// `columns` those after it.
#[inline(always)]
fn are_kept<T: Real, const N: usize>(
    n: usize,
    diagonal: &[T; N],
    factors: &[[T; N]; BLOCK],
    columns: &[[T; N]],
    start: usize,
) -> bool {
    // By rows, so that the comparison is vectorized.
    let mut pivots = [[T::zero(); N]; BLOCK];
    for (column, entries) in (start + BLOCK..n).zip(columns) {
        for i in 0..BLOCK {
            pivots[i][column] = entries[start + i];
        }
    }
    let mut kept = true;
    for row in start + BLOCK..n {
        let mut entry = diagonal[row];
        for i in 0..BLOCK {
            let eliminated = factors[i][row] * pivots[i][row];
            kept &= is_kept(entry, eliminated);
            entry -= eliminated;
        }
    }
    kept
}

/// [`substitute`] for C right-hand sides, whose sums are independent of each other.
#[inline(always)]
fn substitute_together<T: Real, const N: usize, const C: usize>(
    n: usize,
    a: &SMatrix<T, N, N>,
    columns: &mut [[T; N]; C],
) {
    let mut x = [[T::zero(); C]; N];
    for row in (0..n).rev() {
        let mut known = [T::zero(); C];
        for column in row + 1..n {
            for k in 0..C {
                known[k] += a[(row, column)] * x[column][k];
            }
        }
        for k in 0..C {
            x[row][k] = (columns[k][row] - known[k]) / a[(row, row)];
            columns[k][row] = x[row][k];
        }
    }
}

/// The sign of the determinant of one or two rows, if it exceeds rounding. Elimination with weights takes 2400 instructions
/// for two rows.
pub(super) fn sign_of_few<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> Option<i8> {
    let [left, right] = match N {
        1 => [a[(0, 0)].to_f64(), 0.0],
        2 => [a[(0, 0)] * a[(1, 1)], a[(0, 1)] * a[(1, 0)]].map(T::to_f64),
        _ => return None,
    };
    let determinant = left - right;
    // False for NaN and for infinite products.
    let is_known = determinant.abs() > 64.0 * T::EPSILON * (left.abs() + right.abs());
    is_known.then_some(if determinant > 0.0 { 1 } else { -1 })
}

/// Rounds of scaling. Each takes the square root of the ratio of a row or column to its target: ratios of 10⁴⁰ become
/// ratios of 1.5.
const ROUNDS: usize = 8;

/// Scale factors that make rows comparable, in any units of rows and columns. With columns scaled likewise, the largest
/// entry of each row and of each column is about 1 (D. Ruiz, A scaling algorithm to equilibrate both rows and columns
/// norms in matrices, 2001).
pub(super) fn weights<T: Real, const N: usize>(a: &SMatrix<T, N, N>) -> [f64; N] {
    let (mut rows, mut columns) = ([1.0_f64; N], [1.0_f64; N]);
    for _ in 0..ROUNDS {
        let (mut row_lengths, mut column_lengths) = ([0.0_f64; N], [0.0_f64; N]);
        for j in 0..N {
            for i in 0..N {
                let entry = a[(i, j)].abs().to_f64() * rows[i] * columns[j];
                // The comparison is faster than `f64::max`, and ignores NaN as well.
                row_lengths[i] = if entry > row_lengths[i] { entry } else { row_lengths[i] };
                column_lengths[j] = if entry > column_lengths[j] { entry } else { column_lengths[j] };
            }
        }
        let lengths = row_lengths.into_iter().chain(column_lengths);
        for (scale, length) in rows.iter_mut().chain(&mut columns).zip(lengths) {
            if length > 0.0 && length.is_finite() {
                *scale /= length.sqrt();
            }
        }
    }
    rows
}

/// Swaps the row with the largest scaled entry of `column` onto the diagonal; returns its index if it was another row.
/// Not inlined, so that the loops of all instruction sets share it.
#[inline(never)]
pub(super) fn pivot<T: Real, const N: usize>(
    a: &mut SMatrix<T, N, N>,
    weights: &mut [f64; N],
    column: usize,
) -> Option<usize> {
    let size = |row: usize| a[(row, column)].abs().to_f64() * weights[row];
    let pivot = (column + 1..N).fold(column, |pivot, row| if size(row) > size(pivot) { row } else { pivot });
    a.swap_rows(column, pivot);
    weights.swap(column, pivot);
    (pivot != column).then_some(pivot)
}
