//! A matrix at each eigenvalue of A, factored: a band by elimination, or the inverse of all entries.
//!
//! All eigenvalues are processed side by side. A band is eliminated without exchanges of rows, which is safe while no row
//! is added to another one more than [`LARGEST`] times. Otherwise the matrix is inverted, with exchanges.

use super::modes::Modal;
use super::stages::LOOPED;
use alloc::vec::Vec;
use vi_dispatch::{Instructions, Loop, by_baseline};

/// Largest part of a row that is added to another one.
const LARGEST: f64 = 10.0;
/// Largest reciprocal of a pivot: its square is in the range.
const LARGEST_RECIPROCAL: f64 = 1e150;

/// The factors of an N × N matrix.
#[derive(Clone, Debug)]
pub(crate) struct Factors<const N: usize, const S: usize> {
    instructions: Instructions,
    /// Diagonals on each side of the main diagonal, if the rows are those of a band.
    width: Option<usize>,
    /// The inverse, or `L + U − I` of a matrix L D U with triangles L, U of unit diagonal, without their zeros.
    rows: Vec<[Modal<S>; N]>,
    /// The reciprocals of D.
    reciprocals: [Modal<S>; N],
}

impl<const N: usize, const S: usize> Factors<N, S> {
    /// Allocates the buffers.
    pub(crate) fn new() -> Self {
        let rows = vec![[Modal::ZERO; N]; N];
        Self { instructions: Instructions::detected(), width: None, rows, reciprocals: [Modal::ZERO; N] }
    }

    /// Factors the matrix with these entries, zero where |row − column| > `width`.
    pub(crate) fn factor(&mut self, width: usize, entry: impl Fn(usize, usize) -> Modal<S>) {
        let fill = |rows: &mut [[Modal<S>; N]]| {
            for (row, entries) in rows.iter_mut().enumerate() {
                for column in row.saturating_sub(width)..N.min(row + width + 1) {
                    entries[column] = entry(row, column);
                }
            }
        };
        // An entry of a band takes four operations on half a vector, an entry of an inverse two on a whole one.
        if 4 * width + 2 <= N {
            fill(&mut self.rows);
            let eliminate = Eliminate { width, rows: &mut self.rows, reciprocals: &mut self.reciprocals };
            self.width = by_width::<N, _>(self.instructions, eliminate).then_some(width);
            if self.width.is_some() {
                return;
            }
        }
        self.width = None;
        self.rows.fill([Modal::ZERO; N]);
        fill(&mut self.rows);
        by_width::<N, _>(self.instructions, Invert { matrix: &mut self.rows });
    }

    /// Replaces the right-hand sides b by the solution.
    #[inline(always)]
    pub(crate) fn solve<const FUSED: bool>(&self, b: &mut [Modal<S>; N]) {
        match self.width {
            // Neighbours that are coupled are the most frequent case.
            Some(1) => self.substitute::<FUSED>(1, b),
            Some(width) => self.substitute::<FUSED>(width, b),
            None => {
                let mut exchanged = *b;
                for k in 0..N {
                    exchanged[k] = b[k].exchanged();
                }
                let sides = *b;
                for k in 0..N {
                    b[k] = Modal::dot::<N, FUSED>(&self.rows[k], &sides, &exchanged);
                }
            }
        }
    }

    /// Solves by the factors of a band.
    #[inline(always)]
    fn substitute<const FUSED: bool>(&self, width: usize, b: &mut [Modal<S>; N]) {
        for k in 0..N {
            let mut rest = b[k];
            for column in k.saturating_sub(width)..k {
                rest.subtract_product::<FUSED>(&self.rows[k][column], &b[column]);
            }
            b[k] = rest;
        }
        for k in 0..N {
            b[k] = b[k].times::<FUSED>(&self.reciprocals[k]);
        }
        for k in (0..N).rev() {
            let mut rest = b[k];
            for column in k + 1..N.min(k + width + 1) {
                rest.subtract_product::<FUSED>(&self.rows[k][column], &b[column]);
            }
            b[k] = rest;
        }
    }

    /// The instructions of its loops.
    pub(crate) fn instructions(&self) -> Instructions {
        self.instructions
    }
}

/// Runs a loop over the rows of N coordinates, with SIMD dispatch if there are many.
pub(crate) fn by_width<const N: usize, L: Loop>(instructions: Instructions, of: L) -> L::Output {
    if const { N > LOOPED } { instructions.run(of) } else { by_baseline(of) }
}

/// Factors a band in place: L D U. Returns whether that is safe.
struct Eliminate<'a, const N: usize, const S: usize> {
    width: usize,
    rows: &'a mut [[Modal<S>; N]],
    reciprocals: &'a mut [Modal<S>; N],
}

impl<const N: usize, const S: usize> Loop for Eliminate<'_, N, S> {
    type Output = bool;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> bool {
        let Self { width, rows, reciprocals } = self;
        let mut is_safe = true;
        for k in 0..N {
            let (above, below) = rows.split_at_mut(k + 1);
            let pivotal = &mut above[k];
            let scale = pivotal[k].recip();
            reciprocals[k] = scale;
            let end = N.min(k + width + 1);
            for row in &mut below[..end - k - 1] {
                let factor = row[k].times::<FUSED>(&scale);
                row[k] = factor;
                is_safe &= factor.is_at_most(LARGEST);
                for column in k + 1..end {
                    row[column].subtract_product::<FUSED>(&factor, &pivotal[column]);
                }
            }
            for column in k + 1..end {
                pivotal[column] = pivotal[column].times::<FUSED>(&scale);
            }
            is_safe &= scale.is_at_most(LARGEST_RECIPROCAL);
        }
        is_safe
    }
}

/// Inverts a matrix in place, by Gauss–Jordan elimination with partial pivoting; not finite if it is singular.
struct Invert<'a, const N: usize, const S: usize> {
    matrix: &'a mut [[Modal<S>; N]],
}

impl<const N: usize, const S: usize> Loop for Invert<'_, N, S> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Self { matrix } = self;
        let mut exchanged = [0; N];
        for k in 0..N {
            let mut pivot = k;
            for row in k + 1..N {
                if matrix[row][k].is_larger(&matrix[pivot][k]) {
                    pivot = row;
                }
            }
            exchanged[k] = pivot;
            matrix.swap(k, pivot);
            let scale = matrix[k][k].recip();
            matrix[k][k] = Modal::ONE;
            let pivotal = matrix[k].map(|entry| entry.times::<FUSED>(&scale));
            matrix[k] = pivotal;
            for row in (0..N).filter(|row| *row != k) {
                let factor = matrix[row][k] * -1.0;
                matrix[row][k] = Modal::ZERO;
                for column in 0..N {
                    matrix[row][column].add_product::<FUSED>(&factor, &pivotal[column]);
                }
            }
        }
        for k in (0..N).rev() {
            for row in &mut *matrix {
                row.swap(k, exchanged[k]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Factors;
    use crate::gauss::modes::Modal;

    const N: usize = 12;
    const S: usize = 5;

    /// Numbers that differ at each eigenvalue.
    fn number(seed: usize) -> Modal<S> {
        let of = f64::from(u32::try_from(seed).expect("a few"));
        Modal(core::array::from_fn(|i| (1.3 * of + 0.7 * f64::from(u32::try_from(i).expect("a few"))).sin()))
    }

    /// The factors of a matrix with these diagonals, and the largest residual of a solution.
    fn solved(width: usize, entry: impl Fn(usize, usize) -> Modal<S>) -> (Factors<N, S>, f64) {
        let mut factors = Factors::<N, S>::new();
        // Earlier factors must not change the result.
        factors.factor(N - 1, |row, column| number(row + 5 * column));
        factors.factor(width, &entry);
        let sides: [Modal<S>; N] = core::array::from_fn(|row| number(7 * row));
        let mut x = sides;
        factors.solve::<false>(&mut x);
        let mut worst = 0.0_f64;
        for row in 0..N {
            let mut left = sides[row];
            for column in row.saturating_sub(width)..N.min(row + width + 1) {
                left.subtract_product::<false>(&entry(row, column), &x[column]);
            }
            let finite = |part: f64| if part.is_finite() { part.abs() } else { f64::INFINITY };
            worst = left.0.iter().fold(worst, |worst, part| worst.max(finite(*part)));
        }
        (factors, worst)
    }

    #[test]
    fn a_band_is_eliminated_or_inverted() {
        for width in [0, 1, 2, 3, 7] {
            let dominant = |row: usize, column: usize| {
                let rest = number(3 * row + 11 * column);
                if row == column { rest + Modal::real(20.0) } else { rest }
            };
            let (factors, worst) = solved(width, dominant);
            // Measured: 6e-16.
            println!("{width}: {worst:e}");
            assert!(worst < 1e-15, "{width}: {worst:e}");
            // A band of 2 × 2 + 1 diagonals takes less than an inverse of 12 rows, one of 2 × 3 + 1 more.
            assert_eq!(factors.width, (width <= 2).then_some(width), "{width}");
        }
    }

    #[test]
    fn a_small_pivot_asks_for_an_exchange_of_rows() {
        let crossed = |row: usize, column: usize| {
            if row == column { Modal::real(1e-9) } else { number(1 + row + column) + Modal::real(2.0) }
        };
        let (factors, worst) = solved(1, crossed);
        assert_eq!(factors.width, None);
        assert!(worst < 1e-13, "{worst:e}");
    }

    #[test]
    fn a_singular_band_has_no_solution() {
        let (_, worst) = solved(1, |_, _| Modal::ZERO);
        assert!(worst.is_infinite(), "{worst:e}");
    }
}
