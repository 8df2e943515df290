//! Matrices that are written entry by entry, and their factors: in fronts, or in one block.
//!
//! | file | content |
//! |---|---|
//! | `fronts` | elimination of the blocks of a graph |
//! | `dense` | all unknowns in one block |
//! | `block` | elimination in one block, of both |

mod block;
mod dense;
mod fronts;

use super::Block;
use crate::real::Real;
use alloc::vec::Vec;
use block::determinant_sign;
use dense::DenseFactors;
use fronts::Fronts;

/// The entries of a matrix while it is written. All matrices of a system name their entries in the same order.
pub(crate) trait Entries<T: Real> {
    /// The row and the column of two unknowns.
    type Entry: Copy;

    /// The scale factors of the unknowns, of their rows and of their columns: set before the first entry.
    fn scales(&mut self) -> &mut [f64];
    /// The entry of a row and a column.
    fn entry(&mut self, row: usize, column: usize) -> Self::Entry;
    /// Adds to an entry, with these copies of its row and column.
    fn add(&mut self, entry: Self::Entry, copies: [usize; 2], value: T);
}

/// Writes the entries of a matrix.
pub(crate) trait Assemble<T: Real> {
    /// Adds all entries to a matrix of zeros.
    fn assemble(&self, entries: &mut impl Entries<T>);
}

/// A matrix in fronts, dense for one block, and if a pivot inside a block is lost.
#[derive(Clone, Debug)]
pub(crate) struct Factored<T: Real = f64> {
    copies: usize,
    fronts: Option<Fronts<T>>,
    dense: DenseFactors<T>,
    state: Factors,
    /// Right-hand side and solution in the order of elimination.
    ordered: Vec<T>,
}

/// The factors that a matrix has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Factors {
    None,
    Fronts,
    Dense,
}

impl<T: Real> Factored<T> {
    /// Allocates for `copies` copies of each unknown. If the blocks are not those of an elimination, all unknowns form
    /// one block.
    pub(crate) fn new(blocks: &[Block], unknowns: usize, copies: usize) -> Self {
        let fronts = Fronts::new(blocks, unknowns, copies);
        Self {
            copies,
            fronts,
            dense: DenseFactors::empty(),
            state: Factors::None,
            ordered: vec![T::zero(); unknowns * copies],
        }
    }

    /// Factors a matrix of the allocated sizes. False if it is singular or not finite.
    #[inline(always)]
    pub(crate) fn factor(&mut self, sizes: [usize; 2], matrix: &impl Assemble<T>) -> bool {
        let Self { fronts, dense, state, .. } = self;
        if let Some(fronts) = fronts {
            fronts.clear();
            matrix.assemble(fronts);
            *state = Factors::Fronts;
            if fronts.factor() {
                return true;
            }
        }
        *state = if dense.factor(sizes, matrix) { Factors::Dense } else { Factors::None };
        *state != Factors::None
    }

    /// Replaces the right-hand sides of the rows of the first unknowns, and of those of the others, by the solution; NaN
    /// without factors. One copy of the unknowns after the other.
    pub(crate) fn solve(&mut self, b: &mut [T], c: &mut [T]) {
        let Self { copies, fronts, dense, state, ordered } = self;
        let lists = [b, c];
        match (*state, fronts) {
            (Factors::None, _) => lists.into_iter().flatten().for_each(|entry| *entry = T::real(f64::NAN)),
            (Factors::Fronts, Some(fronts)) => {
                let place = |unknown: usize| (fronts.homes[unknown].1, fronts.scales[unknown]);
                solve_in_order(*copies, place, lists, ordered, |ordered| fronts.solve(ordered));
            }
            _ => {
                let place = |unknown: usize| (unknown, dense.scales[unknown]);
                let solve = |ordered: &mut [T]| dense.solve(ordered);
                // Without copies, a constant shortens the loops.
                if *copies == 1 {
                    solve_in_order(1, place, lists, ordered, solve);
                } else {
                    solve_in_order(*copies, place, lists, ordered, solve);
                }
            }
        }
    }

    /// Sign of the determinant: −1, 0 or 1; 0 if the matrix has no factors.
    pub(crate) fn determinant_sign(&self) -> i8 {
        match (self.state, &self.fronts) {
            (Factors::None, _) => 0,
            (Factors::Fronts, Some(fronts)) => fronts.determinant_sign(),
            _ => determinant_sign(&self.dense.pivots, &self.dense.reciprocals),
        }
    }

    /// The smallest absolute value of a pivot; 0 without factors.
    pub(crate) fn smallest_pivot(&self) -> f64 {
        let reciprocals = match (self.state, &self.fronts) {
            (Factors::None, _) => return 0.0,
            (Factors::Fronts, Some(fronts)) => &fronts.reciprocals,
            _ => &self.dense.reciprocals,
        };
        reciprocals.iter().fold(0.0, |largest: f64, entry| largest.max(entry.to_f64().abs())).recip()
    }
}

/// Solves a system whose unknowns have these places in the order of elimination, and these scales.
#[inline(always)]
fn solve_in_order<T: Real>(
    copies: usize,
    place: impl Fn(usize) -> (usize, f64),
    mut lists: [&mut [T]; 2],
    ordered: &mut [T],
    solve: impl FnOnce(&mut [T]),
) {
    each_entry(copies, &place, &mut lists, ordered, |entry, ordered, scale| *ordered = *entry * scale);
    solve(ordered);
    each_entry(copies, &place, &mut lists, ordered, |entry, ordered, scale| *entry = *ordered * scale);
}

/// Calls a function with each entry of the lists, its place among the ordered ones and its scale.
#[inline(always)]
fn each_entry<T: Real>(
    copies: usize,
    place: &impl Fn(usize) -> (usize, f64),
    lists: &mut [&mut [T]; 2],
    ordered: &mut [T],
    f: impl Fn(&mut T, &mut T, T),
) {
    let firsts = [0, lists[0].len() / copies];
    for (list, first) in lists.iter_mut().zip(firsts) {
        let count = list.len() / copies;
        for index in 0..count {
            let (position, scale) = place(first + index);
            for copy in 0..copies {
                f(&mut list[copy * count + index], &mut ordered[position * copies + copy], T::real(scale));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Assemble, Block, Entries, Factored, Factors, Fronts};
    use nalgebra::{DMatrix, DVector};
    use std::vec::Vec;

    /// Leaves 0 and 3, two unknowns between them, all with copies.
    const BLOCKS: &[Block] =
        &[Block { own: &[3], border: &[2] }, Block { own: &[0], border: &[1] }, Block { own: &[2, 1], border: &[] }];

    /// A matrix of 4 unknowns with copies, without the entries outside of the blocks.
    struct Of<'a>(&'a DMatrix<f64>, usize);

    impl Assemble<f64> for Of<'_> {
        fn assemble(&self, entries: &mut impl Entries<f64>) {
            let Self(matrix, copies) = *self;
            entries.scales().copy_from_slice(&[1.0, 0.5, 4.0, 2.0]);
            for row in 0_usize..4 {
                for column in (0..4).filter(|column: &usize| row.abs_diff(*column) < 2) {
                    let entry = entries.entry(row, column);
                    for (i, k) in (0..copies).flat_map(|i| (0..copies).map(move |k| (i, k))) {
                        entries.add(entry, [i, k], matrix[(row * copies + i, column * copies + k)]);
                    }
                }
            }
        }
    }

    fn random(size: usize, copies: usize, diagonal: f64) -> DMatrix<f64> {
        let mut state = 1_u32;
        DMatrix::from_fn(size * copies, size * copies, |row, column| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let entry = f64::from(state) / f64::from(u32::MAX) - 0.5;
            let is_inside = (row / copies).abs_diff(column / copies) < 2;
            if is_inside { entry + if row == column { diagonal } else { 0.0 } } else { 0.0 }
        })
    }

    /// Solves with the first unknown apart from the others. One copy of all follows the other in the factors.
    fn solve(factored: &mut Factored, copies: usize, b: &[f64]) -> Vec<f64> {
        let by_copy = |unknowns: core::ops::Range<usize>| -> Vec<usize> {
            (0..copies).flat_map(|copy| unknowns.clone().map(move |unknown| unknown * copies + copy)).collect()
        };
        let parts = [by_copy(0..1), by_copy(1..4)];
        let [mut first, mut rest] = parts.clone().map(|part| part.iter().map(|index| b[*index]).collect::<Vec<f64>>());
        factored.solve(&mut first, &mut rest);
        let mut x = vec![0.0; b.len()];
        parts.iter().flatten().zip(first.iter().chain(&rest)).for_each(|(index, entry)| x[*index] = *entry);
        x
    }

    #[test]
    fn fronts_solve_what_dense_elimination_solves() {
        for copies in [1, 3] {
            let matrix = random(4, copies, 2.0);
            let b: Vec<f64> = (1..=4 * copies).map(|i| 1.0 / f64::from(u32::try_from(i).unwrap_or(1))).collect();
            let expected = matrix.clone().lu().solve(&DVector::from(b.clone())).expect("a regular matrix");
            let mut factored = Factored::new(BLOCKS, 4, copies);
            // Twice: the second matrix finds its places stored.
            for _ in 0..2 {
                assert!(factored.factor([4, copies], &Of(&matrix, copies)) && factored.state == Factors::Fronts);
                let x = solve(&mut factored, copies, &b);
                let off = x.iter().zip(&expected).fold(0.0, |worst: f64, (x, y)| worst.max((x - y).abs()));
                // Measured: at most 2.3e-16.
                assert!(off < 1e-15, "{off:e}");
                assert!(f64::from(factored.determinant_sign()) * matrix.determinant() > 0.0);
            }
        }
    }

    #[test]
    fn a_lost_pivot_is_found_by_dense_elimination() {
        let mut matrix = random(4, 1, 2.0);
        matrix[(3, 3)] = 1e-9;
        let mut factored = Factored::new(BLOCKS, 4, 1);
        assert!(factored.factor([4, 1], &Of(&matrix, 1)) && factored.state == Factors::Dense);
        let x = solve(&mut factored, 1, &[1.0, 2.0, 3.0, 4.0]);
        let rest = &matrix * DVector::from(x) - DVector::from(vec![1.0, 2.0, 3.0, 4.0]);
        // Measured: 2.1e-14.
        assert!(rest.amax() < 5e-14, "{rest}");
        assert!(f64::from(factored.determinant_sign()) * matrix.determinant() > 0.0);
        // A regular matrix needs it no longer; a singular one has no factors.
        matrix[(3, 3)] = 2.0;
        assert!(factored.factor([4, 1], &Of(&matrix, 1)));
        assert!(f64::from(factored.determinant_sign()) * matrix.determinant() > 0.0);
        matrix.fill_row(1, 0.0);
        assert!(!factored.factor([4, 1], &Of(&matrix, 1)));
        assert_eq!((factored.determinant_sign(), factored.smallest_pivot().to_bits()), (0, 0));
        assert!(solve(&mut factored, 1, &[1.0; 4]).iter().all(|entry| entry.is_nan()));
    }

    #[test]
    fn blocks_of_no_elimination_are_dense() {
        let twice = [Block { own: &[0, 1], border: &[] }, Block { own: &[1, 2], border: &[] }];
        let missing = [Block { own: &[0], border: &[1] }, Block { own: &[1], border: &[] }];
        let backwards = [Block { own: &[0], border: &[] }, Block { own: &[1, 2], border: &[0] }];
        let torn =
            [Block { own: &[0], border: &[1, 2] }, Block { own: &[1], border: &[] }, Block { own: &[2], border: &[] }];
        for blocks in [&twice[..], &missing, &backwards, &torn, &[]] {
            assert!(Fronts::<f64>::new(blocks, 3, 1).is_none(), "{blocks:?}");
        }
        // Unknowns beyond the first ones are left out.
        assert_eq!(Fronts::<f64>::new(BLOCKS, 2, 1).map(|fronts| fronts.homes), Some(vec![(0, 0), (1, 1)]));
    }
}
