//! Mass matrices bordered by constraint gradients.
//!
//! ```text
//! [ M  −Aᵀ ] [x]   [b]
//! [ A   0  ] [y] = [c]
//! ```
//!
//! M needs to be regular only for vectors x with `A x = 0`. Powers of two scale the diagonal of M and the rows of A to
//! about 1, so that pivots have no unit and no digit is lost. Only the constructor and the first factors allocate.

use super::{Block, Factored, Matrix, Rectangular, Row, reciprocal_power, reciprocal_root};
use crate::real::Real;
use alloc::vec::Vec;
use nalgebra::SVector;

/// Pivots of the scaled matrix below this leave fewer than three digits of the solution.
const SMALLEST: f64 = 1e-13;

/// The factors of a bordered matrix; see the [module](self).
#[derive(Clone, Debug)]
pub(crate) struct Bordered<T: Real = f64> {
    k: usize,
    factors: Factored<T>,
    diagonal: Vec<f64>,
    solution: Vec<T>,
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
        let factors = Factored::new(blocks, n + k, 1);
        Self { k, factors, diagonal: vec![0.0; n], solution: vec![T::zero(); n + k] }
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
        let Self { k, factors, diagonal, .. } = self;
        mass.each_entry(|row, column, value| {
            if row == column {
                diagonal[row] = value.to_f64();
            }
        });
        let rows = || gradients.rows().take(*k).enumerate();
        let mut is_finite = true;
        let is_regular = factors.factor(|fronts| {
            scale(fronts.scales(), diagonal.iter().copied(), rows().map(|(_, row)| row));
            mass.each_entry(|row, column, value| {
                let entry = fronts.entry(row, column);
                fronts.add(entry, [0, 0], value);
            });
            for (r, row) in rows() {
                for (column, value) in row.iter() {
                    let [lower, upper] = [fronts.entry(N + r, column), fronts.entry(column, N + r)];
                    fronts.add(lower, [0, 0], value);
                    fronts.add(upper, [0, 0], -value);
                }
            }
            for r in (0..*k).filter(|r| is_dropped(*r)) {
                let entry = fronts.entry(N + r, N + r);
                fronts.add(entry, [0, 0], T::one());
            }
            is_finite = fronts.is_finite();
        });
        match (is_finite, is_regular && factors.smallest_pivot() > SMALLEST) {
            (false, _) => Err(Unsolvable::NonFinite),
            (true, true) => Ok(()),
            (true, false) => Err(Unsolvable::Singular),
        }
    }

    /// Replaces b and c by x and y.
    pub(crate) fn solve<const N: usize>(&mut self, b: &mut SVector<T, N>, c: &mut [T]) {
        let Self { factors, solution, .. } = self;
        for (first, known) in [(0, b.as_slice()), (N, c)] {
            for (unknown, known) in known.iter().enumerate() {
                let (position, scale) = factors.position(first + unknown);
                solution[position] = *known * T::real(scale);
            }
        }
        factors.solve(solution);
        for (first, entries) in [(0, b.as_mut_slice()), (N, c)] {
            for (unknown, entry) in entries.iter_mut().enumerate() {
                let (position, scale) = factors.position(first + unknown);
                *entry = solution[position] * T::real(scale);
            }
        }
    }

    /// Sign of the determinant: positive if M is positive definite for `A x = 0`.
    pub(crate) fn determinant_sign(&self) -> i8 {
        self.factors.determinant_sign()
    }
}

/// Scale factors, powers of two, that make the diagonal of M and the rows of A about 1.
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
}
