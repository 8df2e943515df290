//! Tridiagonal matrices, eliminated from both ends at once: the two halves do not wait for each other.
//!
//! ```text
//! lower_i x_{i−1} + diagonal_i x_i + upper_i x_{i+1} = b_i        lower_0 = upper_{N−1} = 0
//! ```

use super::Matrix;
use crate::Real;
use nalgebra::{SMatrix, SVector};

/// A matrix of three diagonals, entry i of each in row i.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tridiagonal<const N: usize, T> {
    /// Left of the diagonal; the first is not used.
    pub lower: [T; N],
    /// The diagonal.
    pub diagonal: [T; N],
    /// Right of the diagonal; the last is not used.
    pub upper: [T; N],
}

/// The matrix with the reciprocals of its pivots, which are those of the elimination from above in the rows before the
/// middle, from below in the rows after it.
#[derive(Clone, Copy, Debug)]
pub struct Factors<const N: usize, T> {
    matrix: Tridiagonal<N, T>,
    reciprocals: [T; N],
}

impl<const N: usize, T: Real> Tridiagonal<N, T> {
    const MIDDLE: usize = N / 2;

    /// The reciprocals of the pivots, those of the two halves in turn, and right-hand sides eliminated on the way, but for the
    /// middle row: they wait for less than the pivots do. The lower half of an even N is a row shorter.
    #[inline]
    fn eliminate<const M: usize>(&self, x: &mut SMatrix<T, N, M>) -> [T; N] {
        let Self { lower, diagonal, upper } = self;
        let mut reciprocals = [T::zero(); N];
        let (mut above, mut below) = (T::zero(), T::zero());
        for step in 0..Self::MIDDLE {
            let (i, j) = (step, N - 1 - step);
            let from_above = if step == 0 { T::zero() } else { lower[i] * upper[i - 1] };
            let from_below = if step == 0 { T::zero() } else { upper[j] * lower[j + 1] };
            above = (diagonal[i] - from_above * above).recip();
            reciprocals[i] = above;
            if j > Self::MIDDLE {
                below = (diagonal[j] - from_below * below).recip();
                reciprocals[j] = below;
            }
            self.inward(&reciprocals, x, step);
        }
        let m = Self::MIDDLE;
        let mut pivot = diagonal[m];
        if m > 0 {
            pivot -= lower[m] * upper[m - 1] * reciprocals[m - 1];
        }
        if m + 1 < N {
            pivot -= upper[m] * lower[m + 1] * reciprocals[m + 1];
        }
        reciprocals[m] = pivot.recip();
        // Everything passes through the middle.
        if !self.is_kept_by(&reciprocals) {
            reciprocals[m] = T::real(f64::NAN);
        }
        reciprocals
    }

    /// Whether no pivot is so small beside its row that digits are lost.
    #[inline]
    fn is_kept_by(&self, reciprocals: &[T; N]) -> bool {
        let Self { lower, diagonal, upper } = self;
        let is_kept = |i: usize, beside: T| {
            let row = diagonal[i].abs() + beside;
            (row * reciprocals[i].abs()).is_at_most(T::real(super::GROWTH))
        };
        let inside = 1..N.max(1) - 1;
        let kept = inside.fold(true, |kept, i| kept & is_kept(i, lower[i].abs() + upper[i].abs()));
        // The ends of the diagonals that are not used may hold anything.
        N < 2 || kept & is_kept(0, upper[0].abs()) & is_kept(N - 1, lower[N - 1].abs())
    }

    /// The rows so many steps from both ends, but for the middle one, less what they have of the rows before.
    #[inline]
    fn inward<const M: usize>(&self, reciprocals: &[T; N], x: &mut SMatrix<T, N, M>, step: usize) {
        let (i, j) = (step, N - 1 - step);
        for mut x in x.column_iter_mut() {
            let known = if step == 0 { T::zero() } else { self.lower[i] * x[i - 1] };
            x[i] = (x[i] - known) * reciprocals[i];
            if j > Self::MIDDLE {
                let known = if step == 0 { T::zero() } else { self.upper[j] * x[j + 1] };
                x[j] = (x[j] - known) * reciprocals[j];
            }
        }
    }

    /// The middle row, and from there all others.
    #[inline]
    fn outward<const M: usize>(&self, reciprocals: &[T; N], x: &mut SMatrix<T, N, M>) {
        let (Self { lower, upper, .. }, m) = (self, Self::MIDDLE);
        for mut x in x.column_iter_mut() {
            let mut middle = x[m];
            if m > 0 {
                middle -= lower[m] * x[m - 1];
            }
            if m + 1 < N {
                middle -= upper[m] * x[m + 1];
            }
            x[m] = middle * reciprocals[m];
            for step in 1..=m {
                let i = m - step;
                let known = upper[i] * reciprocals[i] * x[i + 1];
                x[i] -= known;
                if m + step < N {
                    let j = m + step;
                    let known = lower[j] * reciprocals[j] * x[j - 1];
                    x[j] -= known;
                }
            }
        }
    }
}

impl<const N: usize, T: Real> Matrix<N, T> for Tridiagonal<N, T> {
    type Inverse = Factors<N, T>;

    #[inline]
    fn solve<const M: usize>(&self, rhs: &SMatrix<T, N, M>) -> SMatrix<T, N, M> {
        let mut x = *rhs;
        let reciprocals = self.eliminate(&mut x);
        self.outward(&reciprocals, &mut x);
        x
    }

    fn inverse(&self) -> Self::Inverse {
        Factors { matrix: *self, reciprocals: self.eliminate(&mut SMatrix::<T, N, 0>::zeros()) }
    }

    #[inline]
    fn apply(inverse: &Self::Inverse, rhs: &SVector<T, N>) -> SVector<T, N> {
        let (Factors { matrix, reciprocals }, mut x) = (inverse, *rhs);
        (0..Self::MIDDLE).for_each(|step| matrix.inward(reciprocals, &mut x, step));
        matrix.outward(reciprocals, &mut x);
        x
    }

    fn dense(&self) -> SMatrix<T, N, N> {
        SMatrix::from_fn(|i, j| {
            if i == j {
                self.diagonal[i]
            } else if i == j + 1 {
                self.lower[i]
            } else if j == i + 1 {
                self.upper[i]
            } else {
                T::zero()
            }
        })
    }
}
