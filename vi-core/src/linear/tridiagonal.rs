//! Tridiagonal matrices, eliminated two rows at a time and from both ends at once. This halves the number of sequential
//! quotients, and the two halves are independent.
//!
//! ```text
//! lower_i x_{i−1} + diagonal_i x_i + upper_i x_{i+1} = b_i        lower_0 = upper_{N−1} = 0
//! rows i, j = i + 1 from above, with y_i = b_i − lower_i y_{i−1}:
//! d = diagonal_i − lower_i upper_{i−1} z     ρ = 1/(d diagonal_j − upper_i lower_j)     z = d ρ, for the next two rows
//! y_i ← (diagonal_j y_i − upper_i b_j) ρ     y_j = (d b_j − lower_j y_i) ρ
//! x_i = y_i + upper_i ρ upper_j x_{j+1}      x_j = y_j − d ρ upper_j x_{j+1}
//! ```
//!
//! and mirrored from below. One or two rows in the middle close the elimination.

use super::{GROWTH, Matrix, is_kept};
use crate::real::Real;
use nalgebra::{SMatrix, SVector};

/// A matrix of three diagonals, entry i of each in row i.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tridiagonal<const N: usize, T> {
    /// Subdiagonal; the first entry is zero.
    pub lower: [T; N],
    /// The diagonal.
    pub diagonal: [T; N],
    /// Superdiagonal; the last entry is zero.
    pub upper: [T; N],
}

/// The factored matrix.
#[derive(Clone, Copy, Debug)]
pub struct Factors<const N: usize, T> {
    matrix: Tridiagonal<N, T>,
    /// d and ρ of two rows, in the order of their elimination; for the middle rows, the reciprocals.
    pivots: [T; N],
    /// Coefficient of the next unknown in each row.
    weights: [T; N],
}

/// State of the elimination from one end: the data that the next two rows need from the last two.
#[derive(Clone, Copy)]
struct Front<const M: usize, T> {
    /// Coefficient of the next unknown in the last row.
    beyond: T,
    /// z.
    corner: T,
    /// y of the last row, for each right-hand side.
    known: [T; M],
}

impl<const M: usize, T: Real> Front<M, T> {
    /// Before the first rows.
    fn start() -> Self {
        Self { beyond: T::zero(), corner: T::zero(), known: [T::zero(); M] }
    }
}

/// The order in which n rows are eliminated.
#[derive(Clone, Copy)]
struct Order {
    n: usize,
    /// Pairs of rows outside the middle: those from above, and those from below, which may be one more.
    above: usize,
    below: usize,
    /// The middle rows, which may be one row twice.
    middle: [usize; 2],
}

impl Order {
    #[inline(always)]
    const fn of(n: usize) -> Self {
        let pairs = n.saturating_sub(1) / 2;
        let above = pairs / 2;
        let below = pairs - above;
        Self { n, above, below, middle: [2 * above, n - 1 - 2 * below] }
    }

    /// The rows of a pair.
    #[inline(always)]
    fn rows<const FROM_ABOVE: bool>(self, step: usize) -> [usize; 2] {
        if FROM_ABOVE { [2 * step, 2 * step + 1] } else { [self.n - 1 - 2 * step, self.n - 2 - 2 * step] }
    }
}

impl<const N: usize, T: Real> Tridiagonal<N, T> {
    /// The coefficients of the previous and of the next row, in the order of elimination.
    #[inline(always)]
    fn neighbours<const FROM_ABOVE: bool>(&self, row: usize) -> [T; 2] {
        if FROM_ABOVE { [self.lower[row], self.upper[row]] } else { [self.upper[row], self.lower[row]] }
    }

    /// The pivot of the next two rows, [d, ρ], and their weights; and whether digits are kept.
    #[inline(always)]
    fn pivot<const FROM_ABOVE: bool, const M: usize>(
        &self,
        [i, j]: [usize; 2],
        front: &mut Front<M, T>,
    ) -> ([T; 2], [T; 2], bool) {
        let ([before, after], [back, beyond]) = (self.neighbours::<FROM_ABOVE>(i), self.neighbours::<FROM_ABOVE>(j));
        let ([near, far], product) = ([self.diagonal[i], self.diagonal[j]], before * front.beyond);
        let (straight, across, eliminated) = (near * far, after * back, product * front.corner);
        let first = near - eliminated;
        // The corner comes last, because the computation waits for it.
        let reciprocal = ((straight - across) - far * product * front.corner).recip();
        // Two nearly equal rows lose digits, too.
        let ratio = (straight.abs() + across.abs()) * reciprocal.abs();
        let kept = is_kept(near, eliminated) & ratio.is_at_most(T::real(GROWTH));
        (front.beyond, front.corner) = (beyond, first * reciprocal);
        let weight = beyond * reciprocal;
        ([first, reciprocal], [after * weight, -(first * weight)], kept)
    }

    /// The y of the next two rows.
    #[inline(always)]
    fn forward<const FROM_ABOVE: bool, const M: usize>(
        &self,
        [i, j]: [usize; 2],
        [first, reciprocal]: [T; 2],
        front: &mut Front<M, T>,
        x: &mut SMatrix<T, N, M>,
    ) {
        let ([before, after], [back, _]) = (self.neighbours::<FROM_ABOVE>(i), self.neighbours::<FROM_ABOVE>(j));
        for (mut x, known) in x.column_iter_mut().zip(&mut front.known) {
            let (near, far) = (x[i] - before * *known, x[j]);
            x[i] = (self.diagonal[j] * near - after * far) * reciprocal;
            x[j] = (first * far - back * near) * reciprocal;
            *known = x[j];
        }
    }

    /// Factors the matrix and eliminates right-hand sides at once: they finish soon after the pivots.
    #[inline(always)]
    fn eliminate<const M: usize>(&self, order: Order, x: &mut SMatrix<T, N, M>) -> ([T; N], [T; N]) {
        let (mut pivots, mut weights) = ([T::zero(); N], [T::zero(); N]);
        let (mut above, mut below, mut all_kept) = (Front::start(), Front::start(), true);
        let mut enter = |[i, j]: [usize; 2], pivot: [T; 2], [near, far]: [T; 2], kept: bool| {
            [pivots[i], pivots[j]] = pivot;
            (weights[i], weights[j]) = (near, far);
            all_kept &= kept;
        };
        for step in 0..order.below {
            if step < order.above {
                let rows = order.rows::<true>(step);
                let (pivot, weight, kept) = self.pivot::<true, M>(rows, &mut above);
                enter(rows, pivot, weight, kept);
                self.forward::<true, M>(rows, pivot, &mut above, x);
            }
            let rows = order.rows::<false>(step);
            let (pivot, weight, kept) = self.pivot::<false, M>(rows, &mut below);
            enter(rows, pivot, weight, kept);
            self.forward::<false, M>(rows, pivot, &mut below, x);
        }
        let [first, last] = order.middle;
        let eliminated = self.lower[first] * above.beyond * above.corner;
        let mut kept = is_kept(self.diagonal[first], eliminated);
        let mut pivot = self.diagonal[first] - eliminated;
        if first < last {
            pivots[first] = pivot.recip();
            weights[first] = -(self.upper[first] * pivots[first]);
            let eliminated = self.lower[last] * weights[first];
            kept &= is_kept(self.diagonal[last], eliminated);
            pivot = self.diagonal[last] + eliminated;
        }
        let eliminated = self.upper[last] * below.beyond * below.corner;
        kept &= is_kept(self.diagonal[last], eliminated);
        pivots[last] = (pivot - eliminated).recip();
        // The middle affects every unknown.
        if !(kept && all_kept) {
            pivots[last] = T::real(f64::NAN);
        }
        (pivots, weights)
    }

    /// Solves for the middle, and from there for all others.
    #[inline(always)]
    fn outward<const M: usize>(&self, order: Order, (pivots, weights): (&[T; N], &[T; N]), x: &mut SMatrix<T, N, M>) {
        let [first, last] = order.middle;
        for mut x in x.column_iter_mut() {
            if first > 0 {
                let known = self.lower[first] * x[first - 1];
                x[first] -= known;
            }
            if last + 1 < order.n {
                let known = self.upper[last] * x[last + 1];
                x[last] -= known;
            }
            if first < last {
                x[first] *= pivots[first];
                let known = self.lower[last] * x[first];
                x[last] -= known;
            }
            x[last] *= pivots[last];
            if first < last {
                let after = weights[first] * x[last];
                x[first] += after;
            }
            let [mut above, mut below] = [x[first], x[last]];
            for step in (0..order.below).rev() {
                if step < order.above {
                    let [i, j] = order.rows::<true>(step);
                    x[j] += weights[j] * above;
                    x[i] += weights[i] * above;
                    above = x[i];
                }
                let [i, j] = order.rows::<false>(step);
                x[j] += weights[j] * below;
                x[i] += weights[i] * below;
                below = x[i];
            }
        }
    }

    /// [`Matrix::solve`] for the first n rows and columns.
    #[inline(always)]
    pub(super) fn solve_first<const M: usize>(&self, n: usize, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        let (order, mut x) = (Order::of(n), *rhs);
        let (pivots, weights) = self.eliminate(order, &mut x);
        self.outward(order, (&pivots, &weights), &mut x);
        x
    }

    /// [`Matrix::inverse`] for the first n rows and columns.
    #[inline(always)]
    pub(super) fn inverse_of_first(&self, n: usize) -> Factors<N, T> {
        let (pivots, weights) = self.eliminate(Order::of(n), &mut SMatrix::<T, N, 0>::zeros());
        Factors { matrix: *self, pivots, weights }
    }

    /// [`Matrix::apply`] for the first n rows and columns.
    #[inline(always)]
    pub(super) fn apply_first(n: usize, inverse: &Factors<N, T>, rhs: &SVector<T, N>) -> SVector<T, N> {
        let (order, Factors { matrix, pivots, weights }, mut x) = (Order::of(n), inverse, *rhs);
        let (mut above, mut below) = (Front::start(), Front::start());
        for step in 0..order.below {
            if step < order.above {
                let [i, j] = order.rows::<true>(step);
                matrix.forward::<true, 1>([i, j], [pivots[i], pivots[j]], &mut above, &mut x);
            }
            let [i, j] = order.rows::<false>(step);
            matrix.forward::<false, 1>([i, j], [pivots[i], pivots[j]], &mut below, &mut x);
        }
        matrix.outward(order, (pivots, weights), &mut x);
        x
    }
}

impl<const N: usize, T: Real> Matrix<N, T> for Tridiagonal<N, T> {
    type Inverse = Factors<N, T>;

    #[inline]
    fn solve<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        self.solve_first(N, rhs)
    }

    fn inverse(&self) -> Self::Inverse {
        self.inverse_of_first(N)
    }

    #[inline]
    fn apply(inverse: &Self::Inverse, rhs: &SVector<T, N>) -> SVector<T, N> {
        Self::apply_first(N, inverse, rhs)
    }

    #[inline]
    fn entry(&self, row: usize, column: usize) -> T {
        if row == column {
            self.diagonal[row]
        } else if row == column + 1 {
            self.lower[row]
        } else if column == row + 1 {
            self.upper[row]
        } else {
            T::zero()
        }
    }

    #[inline]
    fn each_entry(&self, mut f: impl FnMut(usize, usize, T)) {
        for row in 0..N {
            if row > 0 {
                f(row, row - 1, self.lower[row]);
            }
            f(row, row, self.diagonal[row]);
            if row + 1 < N {
                f(row, row + 1, self.upper[row]);
            }
        }
    }

    #[inline]
    fn multiply(&self, x: &SVector<T, N>) -> SVector<T, N> {
        SVector::from_fn(|row, _| {
            let mut sum = self.diagonal[row] * x[row];
            if row > 0 {
                sum += self.lower[row] * x[row - 1];
            }
            if row + 1 < N {
                sum += self.upper[row] * x[row + 1];
            }
            sum
        })
    }
}
