//! All unknowns in one block: a dense matrix that is written without lists of places.

use super::block::{backward, eliminate, forward, with_constant};
use super::{Assemble, Entries};
use crate::real::Real;
use alloc::vec::Vec;

/// A dense matrix, and its factors. Nothing is allocated before the first matrix.
#[derive(Clone, Debug)]
pub(super) struct DenseFactors<T: Real> {
    /// By columns.
    values: Vec<T>,
    pub(super) pivots: Vec<usize>,
    pub(super) reciprocals: Vec<T>,
    pub(super) scales: Vec<f64>,
}

/// The entries of a dense matrix. Callers inline it with constant sizes, so that no place is looked up.
struct DenseEntries<'a, T> {
    values: &'a mut [T],
    scales: &'a mut [f64],
    copies: usize,
}

impl<T: Real> DenseFactors<T> {
    pub(super) fn empty() -> Self {
        Self { values: Vec::new(), pivots: Vec::new(), reciprocals: Vec::new(), scales: Vec::new() }
    }

    /// Factors a matrix. False if a pivot is zero, not finite, or too small against its column.
    #[inline(always)]
    pub(super) fn factor(&mut self, [unknowns, copies]: [usize; 2], matrix: &impl Assemble<T>) -> bool {
        let Self { values, pivots, reciprocals, scales } = self;
        let size = unknowns * copies;
        values.clear();
        values.resize(size * size, T::zero());
        pivots.resize(size, 0);
        reciprocals.resize(size, T::zero());
        scales.resize(unknowns, 1.0);
        let (values, scales) = (&mut values[..size * size], &mut scales[..unknowns]);
        matrix.assemble(&mut DenseEntries { values, scales, copies });
        self.eliminate()
    }

    fn eliminate(&mut self) -> bool {
        let Self { values, pivots, reciprocals, .. } = self;
        let size = pivots.len();
        with_constant!(size => eliminate([size, size], values, pivots, reciprocals))
    }

    /// Replaces b by the x with `A x = b`.
    pub(super) fn solve(&self, b: &mut [T]) {
        let Self { values, pivots, reciprocals, .. } = self;
        let size = pivots.len();
        with_constant!(size => {
            forward([size, size], values, pivots, b);
            backward([size, size], values, reciprocals, b);
        });
    }
}

impl<T: Real> Entries<T> for DenseEntries<'_, T> {
    type Entry = (usize, T);

    #[inline(always)]
    fn scales(&mut self) -> &mut [f64] {
        self.scales
    }

    #[inline(always)]
    fn entry(&mut self, row: usize, column: usize) -> (usize, T) {
        let Self { scales, copies, .. } = self;
        let size = scales.len() * *copies;
        ((row + column * size) * *copies, T::real(scales[row] * scales[column]))
    }

    #[inline(always)]
    fn add(&mut self, (start, scale): (usize, T), [row, column]: [usize; 2], value: T) {
        let size = self.scales.len() * self.copies;
        self.values[start + row + column * size] += value * scale;
    }
}
