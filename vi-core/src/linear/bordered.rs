//! Mass matrices bordered by constraint gradients.
//!
//! ```text
//! [ M  −Aᵀ ] [x]   [b]
//! [ A   0  ] [y] = [c]
//! ```
//!
//! M needs to be regular only for vectors x with `A x = 0`. Powers of two scale the diagonal of M and the rows of A to
//! about 1, so that pivots have no unit and no digit is lost. Only the constructor and the first factors allocate.

use super::{Assemble, Block, Entries, Factored, Matrix, Rectangular, Row, reciprocal_power, reciprocal_root};
use crate::real::Real;
use nalgebra::SVector;

/// Pivots of the scaled matrix below this leave fewer than three digits of the solution.
const SMALLEST: f64 = 1e-13;

/// The factors of a bordered matrix; see the [module](self).
#[derive(Clone, Debug)]
pub(crate) struct Bordered<T: Real = f64> {
    k: usize,
    factors: Factored<T>,
}

/// The reason why a bordered matrix has no factors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Unsolvable {
    Singular,
    NonFinite,
}

impl<T: Real> Bordered<T> {
    /// Allocates for `n` coordinates and the first `k` constraints, which are eliminated in these blocks.
    pub(crate) fn new(n: usize, k: usize, blocks: &[Block]) -> Self {
        Self { k, factors: Factored::new(blocks, n + k, 1) }
    }

    /// Factors the matrix of M and the rows of A.
    ///
    /// # Errors
    /// [`Unsolvable`] if it is singular, or an entry is not finite.
    pub(crate) fn factor<const N: usize>(
        &mut self,
        mass: &impl Matrix<N, T>,
        gradients: &(impl Rectangular<N, T> + ?Sized),
    ) -> Result<(), Unsolvable> {
        self.factor_without(mass, gradients, |_| false)
    }

    /// Factors the matrix without the rows that are dropped: their gradients are zero, and their entries of y those of c.
    ///
    /// # Errors
    /// As [`Self::factor`].
    pub(crate) fn factor_without<const N: usize>(
        &mut self,
        mass: &impl Matrix<N, T>,
        gradients: &(impl Rectangular<N, T> + ?Sized),
        is_dropped: impl Fn(usize) -> bool,
    ) -> Result<(), Unsolvable> {
        let matrix = Unfactored { k: self.k, mass, gradients, is_dropped };
        let is_regular = self.factors.factor([N + self.k, 1], &matrix) && self.factors.smallest_pivot() > SMALLEST;
        if is_regular {
            Ok(())
        } else if matrix.is_finite() {
            Err(Unsolvable::Singular)
        } else {
            Err(Unsolvable::NonFinite)
        }
    }

    /// Replaces b and c by x and y.
    pub(crate) fn solve<const N: usize>(&mut self, b: &mut SVector<T, N>, c: &mut [T]) {
        self.factors.solve(b.as_mut_slice(), c);
    }

    /// Sign of the determinant: positive if M is positive definite for `A x = 0`.
    pub(crate) fn determinant_sign(&self) -> i8 {
        self.factors.determinant_sign()
    }
}

/// The entries of a bordered matrix.
struct Unfactored<'a, M, A: ?Sized, D, const N: usize> {
    k: usize,
    mass: &'a M,
    gradients: &'a A,
    is_dropped: D,
}

impl<M, A: ?Sized, D, const N: usize> Unfactored<'_, M, A, D, N> {
    fn rows<'a, T: Real + 'a>(&'a self) -> impl Iterator<Item = (usize, Row<'a, T>)>
    where
        A: Rectangular<N, T>,
    {
        self.gradients.rows().take(self.k).enumerate()
    }

    #[cold]
    fn is_finite<T: Real>(&self) -> bool
    where
        M: Matrix<N, T>,
        A: Rectangular<N, T>,
    {
        let mut is_finite = true;
        self.mass.each_entry(|_, _, value| is_finite &= value.is_finite());
        is_finite && self.rows().flat_map(|(_, row)| row.iter()).all(|(_, value)| value.is_finite())
    }
}

impl<T: Real, M, A, D, const N: usize> Assemble<T> for Unfactored<'_, M, A, D, N>
where
    M: Matrix<N, T>,
    A: Rectangular<N, T> + ?Sized,
    D: Fn(usize) -> bool,
{
    #[inline(always)]
    fn assemble(&self, entries: &mut impl Entries<T>) {
        let mut diagonal = [0.0; N];
        self.mass.each_entry(|row, column, value| {
            if row == column {
                diagonal[row] = value.to_f64();
            }
        });
        scale(entries.scales(), diagonal.into_iter(), self.rows().map(|(_, row)| row));
        self.mass.each_entry(|row, column, value| {
            let entry = entries.entry(row, column);
            entries.add(entry, [0, 0], value);
        });
        for (r, row) in self.rows() {
            for (column, value) in row.iter() {
                let [lower, upper] = [entries.entry(N + r, column), entries.entry(column, N + r)];
                entries.add(lower, [0, 0], value);
                entries.add(upper, [0, 0], -value);
            }
        }
        for r in (0..self.k).filter(|r| (self.is_dropped)(*r)) {
            let entry = entries.entry(N + r, N + r);
            entries.add(entry, [0, 0], T::one());
        }
    }
}

/// Scale factors, powers of two, that make the diagonal of M and the rows of A about 1.
#[inline(always)]
pub(crate) fn scale<'a, T: Real>(
    scales: &mut [f64],
    diagonal: impl ExactSizeIterator<Item = f64>,
    gradients: impl Iterator<Item = Row<'a, T>>,
) {
    let (coordinates, multipliers) = scales.split_at_mut(diagonal.len());
    for (scale, entry) in coordinates.iter_mut().zip(diagonal) {
        *scale = reciprocal_root(entry);
    }
    for (scale, row) in multipliers.iter_mut().zip(gradients) {
        let lengths = row.iter().map(|(column, value)| value.to_f64().abs() * coordinates[column]);
        *scale = reciprocal_power(lengths.fold(0.0, f64::max));
    }
}

#[cfg(test)]
mod tests {
    use super::{Bordered, Unsolvable};
    use nalgebra::{SMatrix, SVector};

    #[test]
    fn masses_without_inertia_along_the_constraint_are_solved() {
        // A mass along y only, in small units; the constraint holds x.
        let mass = SMatrix::<f64, 2, 2>::from([[0.0, 0.0], [0.0, 3e-12]]);
        let gradient = SVector::from([2e8, 0.0]);
        let mut bordered = Bordered::new(2, 1, &[]);
        assert_eq!(bordered.factor(&mass, &[gradient]), Ok(()));
        assert_eq!(bordered.determinant_sign(), 1);
        let (mut b, mut c) = (SVector::from([4e8, 6e-12]), [6e8]);
        bordered.solve(&mut b, &mut c);
        // x = c/A, y = b/M along y, and the multiplier −b/A.
        assert!((b - SVector::from([3.0, 2.0])).amax() < 1e-15 && (c[0] + 2.0).abs() < 1e-15, "{b} {c:?}");
    }

    #[test]
    fn a_repeated_row_is_singular() {
        let mut bordered = Bordered::new(2, 2, &[]);
        let row = SVector::from([0.6, -0.8]);
        let factored = bordered.factor(&SMatrix::<f64, 2, 2>::identity(), &[row, row * 3.0]);
        assert_eq!(factored, Err(Unsolvable::Singular));
        let lost = bordered.factor(&SMatrix::<f64, 2, 2>::identity(), &[row, row * f64::NAN]);
        assert_eq!(lost, Err(Unsolvable::NonFinite));
    }

    #[test]
    fn an_infinite_entry_is_no_pivot() {
        let mut bordered = Bordered::new(1, 1, &[]);
        for [mass, gradient] in [[1.0, f64::INFINITY], [f64::INFINITY, 1.0]] {
            let factored = bordered.factor(&SMatrix::<f64, 1, 1>::new(mass), &[SVector::from([gradient])]);
            assert_eq!(factored, Err(Unsolvable::NonFinite), "{mass} {gradient}");
        }
    }
}
