//! Sparse linear systems by elimination of blocks.
//!
//! Unknowns form blocks, which are eliminated in order. The border of a block are the later unknowns that its rows and
//! columns reach, those of eliminated blocks included. A block and its border are one dense matrix, the front:
//!
//! ```text
//! [ D  U ]   own        D = P⁻¹ L R, pivoting inside the block
//! [ L  S ]   border     S ← S − L D⁻¹ U, added to the front of the first unknown of the border
//! ```
//!
//! So cost and memory follow the graph of the unknowns: both are linear for chains and trees, if leaves are eliminated
//! first. All unknowns in one block are a [`Dense`] matrix: its elimination is that of a front without border. The stages
//! of a step have one graph, so that each unknown of the graph is `copies` adjacent unknowns of the matrix.
//!
//! Source: J. W. H. Liu, The multifrontal method for sparse matrix solution, 1992.

use super::Block;
use crate::real::Real;
use alloc::vec::Vec;

/// Largest multiple of a pivot in its column. Beyond, elimination could lose three digits.
const GROWTH: f64 = 1024.0;

/// Calls a function with the size of a front, as a constant if it is small.
macro_rules! with_constant {
    ($size:ident => $call:expr) => {
        with_constant!($size => $call; 1 2 3 4 5 6 7 8)
    };
    ($size:ident => $call:expr; $($constant:literal)*) => {
        match $size {
            $($constant => {
                let $size = $constant;
                $call
            })*
            _ => $call,
        }
    };
}

/// Runs a block for each column, as a constant if the front is small: the compiler then unrolls the loops in it.
macro_rules! for_each_column {
    ($size:expr, $column:ident => $block:expr) => {
        for_each_column!($size, $column => $block; 0 1 2 3 4 5 6 7)
    };
    ($size:expr, $column:ident => $block:expr; $($constant:literal)*) => {
        if $size <= 8 {
            $(if $constant < $size {
                let $column = $constant;
                $block
            })*
        } else {
            for $column in 0..$size {
                $block
            }
        }
    };
}

/// One front. Matrices are stored by columns.
#[derive(Clone, Copy, Debug)]
struct Front {
    /// Rows of the block, and of the block with its border.
    own: usize,
    size: usize,
    /// Start of the matrix.
    values: usize,
    /// Position of the first unknown of the block.
    first: usize,
    /// Start in the lists of the border.
    border: usize,
    /// The front that takes S.
    parent: usize,
}

/// A matrix in fronts, and its factors; see the [module](self).
#[derive(Clone, Debug)]
pub(crate) struct Fronts<T: Real = f64> {
    copies: usize,
    matrices: Vec<Front>,
    /// Front and position of each unknown; positions are those of elimination.
    homes: Vec<(usize, usize)>,
    /// The unknowns of each front, its own first.
    members: Vec<Vec<usize>>,
    values: Vec<T>,
    /// Positions of the borders, and their rows in the front of the parent.
    borders: Vec<usize>,
    rows: Vec<usize>,
    /// For each position the pivot row in its front, and the reciprocal of the pivot.
    pivots: Vec<usize>,
    reciprocals: Vec<T>,
    /// Places of the entries in the order in which the matrix is written.
    places: Vec<Place>,
    /// Their rows and columns.
    #[cfg(debug_assertions)]
    names: Vec<[usize; 2]>,
    next: usize,
    /// Scale factor of each unknown: of its row and of its column.
    scales: Vec<f64>,
}

/// The place of a row and a column, or of their copies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    start: u32,
    stride: u32,
}

/// An entry to which terms are added.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry<T> {
    place: Place,
    scale: T,
}

impl<T: Real> Fronts<T> {
    /// Allocates for `copies` copies of each unknown, without the unknowns of the blocks beyond the first ones. `None` for
    /// fewer than two blocks, and if they do not hold each unknown once, or a border is not that of an elimination.
    fn new(blocks: &[Block], unknowns: usize, copies: usize) -> Option<Self> {
        let kept = |list: &'static [usize]| list.iter().copied().filter(move |unknown| *unknown < unknowns);
        let blocks = blocks.iter().filter(|block| kept(block.own).next().is_some());
        let (mut members, mut counts, mut homes) = (Vec::new(), Vec::new(), vec![None; unknowns]);
        let mut position = 0;
        for (front, block) in blocks.enumerate() {
            for unknown in kept(block.own) {
                if homes[unknown].replace((front, position)).is_some() {
                    return None;
                }
                position += 1;
            }
            counts.push(kept(block.own).count());
            members.push(kept(block.own).chain(kept(block.border)).collect::<Vec<_>>());
        }
        let homes = homes.into_iter().collect::<Option<Vec<_>>>().filter(|_| members.len() > 1)?;
        for (front, (members_of, own)) in members.iter().zip(&counts).enumerate() {
            let border = &members_of[*own..];
            let Some(first) = border.first() else { continue };
            let parent = homes[*first].0;
            let is_ordered = border.is_sorted_by_key(|unknown| homes[*unknown].1);
            if parent <= front || !is_ordered || !border.iter().all(|unknown| members[parent].contains(unknown)) {
                return None;
            }
        }
        Some(Self::allocated(members, &counts, homes, copies))
    }

    fn allocated(members: Vec<Vec<usize>>, counts: &[usize], homes: Vec<(usize, usize)>, copies: usize) -> Self {
        let (mut fronts, mut borders, mut rows) = (Vec::new(), Vec::new(), Vec::new());
        let (mut values, mut first) = (0, 0);
        for (members_of, own) in members.iter().zip(counts) {
            let (own_rows, size) = (own * copies, members_of.len() * copies);
            let parent = members_of.get(*own).map_or(0, |unknown| homes[*unknown].0);
            fronts.push(Front { own: own_rows, size, values, first, border: borders.len(), parent });
            for unknown in &members_of[*own..] {
                let row = members[parent].iter().position(|member| member == unknown).unwrap_or(0);
                borders.extend((0..copies).map(|copy| homes[*unknown].1 * copies + copy));
                rows.extend((0..copies).map(|copy| row * copies + copy));
            }
            values += size * size;
            first += own_rows;
        }
        Self {
            copies,
            matrices: fronts,
            members,
            values: vec![T::zero(); values],
            borders,
            rows,
            pivots: vec![0; first],
            reciprocals: vec![T::zero(); first],
            places: Vec::new(),
            #[cfg(debug_assertions)]
            names: Vec::new(),
            next: 0,
            scales: vec![1.0; homes.len()],
            homes,
        }
    }

    /// Begins a new matrix: zero.
    fn clear(&mut self) {
        self.values.fill(T::zero());
        self.next = 0;
    }

    /// An entry outside of its front has no place: the blocks are not those of this matrix.
    #[cold]
    fn find(&mut self, row: usize, column: usize) {
        #[cfg(debug_assertions)]
        self.names.push([row, column]);
        let front = self.homes[row].0.min(self.homes[column].0);
        let Front { values, size, .. } = self.matrices[front];
        let member = |unknown| self.members[front].iter().position(|member| *member == unknown);
        let place = match (member(row), member(column)) {
            (Some(row), Some(column)) => {
                let start = values + (row + column * size) * self.copies;
                u32::try_from(start).ok().zip(u32::try_from(size).ok())
            }
            _ => None,
        };
        self.places.push(place.map_or(Place::NONE, |(start, stride)| Place { start, stride }));
    }

    /// Factors the matrix in place. False if a pivot is zero, not finite, or too small against its column, or if an
    /// entry was outside of all fronts.
    fn factor(&mut self) -> bool {
        let Self { matrices, values, rows, pivots, reciprocals, places, .. } = self;
        if places.iter().any(|place| place.is_none()) {
            return false;
        }
        for Front { own, size, values: start, first, border, parent } in matrices.iter().copied() {
            let (front, later) = values[start..].split_at_mut(size * size);
            let (pivots, reciprocals) = (&mut pivots[first..][..own], &mut reciprocals[first..][..own]);
            if !with_constant!(size => eliminate([own, size], front, pivots, reciprocals)) {
                return false;
            }
            if own == size {
                continue;
            }
            let Front { size: width, values: begin, .. } = matrices[parent];
            let target = &mut later[begin - start - size * size..];
            let rows = &rows[border..][..size - own];
            for (column, place) in rows.iter().enumerate() {
                let from = &front[(own + column) * size + own..][..size - own];
                let column = &mut target[place * width..][..width];
                for (row, value) in rows.iter().zip(from) {
                    column[*row] += *value;
                }
            }
        }
        true
    }

    /// Replaces b by the x with `A x = b`, both in the order of elimination.
    fn solve(&self, b: &mut [T]) {
        let Self { matrices, values, borders, pivots, reciprocals, .. } = self;
        for Front { own, size, values: start, first, border, .. } in matrices.iter().copied() {
            let front = &values[start..][..size * size];
            let (pivots, known) = (&pivots[first..][..own], &mut b[first..][..own]);
            with_constant!(own => forward([own, size], front, pivots, known));
            for (column, position) in borders[border..][..size - own].iter().enumerate() {
                let row = own + column;
                for column in 0..own {
                    let known = b[first + column];
                    b[*position] -= known * front[column * size + row];
                }
            }
        }
        for Front { own, size, values: start, first, border, .. } in matrices.iter().copied().rev() {
            let front = &values[start..][..size * size];
            for (column, position) in borders[border..][..size - own].iter().enumerate() {
                let known = b[*position];
                subtract(&mut b[first..first + own], known, &front[(own + column) * size..][..own]);
            }
            let (reciprocals, b) = (&reciprocals[first..][..own], &mut b[first..][..own]);
            with_constant!(own => backward([own, size], front, reciprocals, b));
        }
    }

    /// Sign of the determinant of the factored matrix: −1 or 1.
    fn determinant_sign(&self) -> i8 {
        let of = |Front { own, first, .. }: &Front| {
            determinant_sign(&self.pivots[*first..][..*own], &self.reciprocals[*first..][..*own])
        };
        self.matrices.iter().map(of).product()
    }
}

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

impl<T: Real> Entries<T> for Fronts<T> {
    type Entry = Entry<T>;

    fn scales(&mut self) -> &mut [f64] {
        &mut self.scales
    }

    /// The first matrix finds the places of its entries, and allocates.
    #[inline(always)]
    fn entry(&mut self, row: usize, column: usize) -> Entry<T> {
        if self.next == self.places.len() {
            self.find(row, column);
        }
        #[cfg(debug_assertions)]
        assert_eq!(self.names[self.next], [row, column], "entry {} in the order of the first matrix", self.next);
        let place = self.places[self.next];
        self.next += 1;
        Entry { place, scale: T::real(self.scales[row] * self.scales[column]) }
    }

    #[inline(always)]
    fn add(&mut self, Entry { place, scale }: Entry<T>, [row, column]: [usize; 2], value: T) {
        let index = place.start as usize + row + column * place.stride as usize;
        if let Some(entry) = self.values.get_mut(index) {
            *entry += value * scale;
        }
    }
}

/// A dense matrix, and its factors. Nothing is allocated before the first matrix.
#[derive(Clone, Debug)]
struct Dense<T: Real> {
    /// By columns.
    values: Vec<T>,
    pivots: Vec<usize>,
    reciprocals: Vec<T>,
    scales: Vec<f64>,
}

/// The entries of a dense matrix. Callers inline it with constant sizes, so that no place is looked up.
struct DenseEntries<'a, T> {
    values: &'a mut [T],
    scales: &'a mut [f64],
    copies: usize,
}

impl<T: Real> Dense<T> {
    fn empty() -> Self {
        Self { values: Vec::new(), pivots: Vec::new(), reciprocals: Vec::new(), scales: Vec::new() }
    }

    /// Factors a matrix. False if a pivot is zero, not finite, or too small against its column.
    #[inline(always)]
    fn factor(&mut self, [unknowns, copies]: [usize; 2], matrix: &impl Assemble<T>) -> bool {
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
    fn solve(&self, b: &mut [T]) {
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

/// Sign of the determinant of a factored block: −1 or 1.
fn determinant_sign<T: Real>(pivots: &[usize], reciprocals: &[T]) -> i8 {
    pivots.iter().zip(reciprocals).enumerate().fold(1, |sign, (column, (pivot, reciprocal))| {
        if (*pivot == column) == (reciprocal.to_f64() < 0.0) { -sign } else { sign }
    })
}

impl Place {
    const NONE: Self = Self { start: u32::MAX, stride: 0 };

    fn is_none(self) -> bool {
        self.start == u32::MAX
    }
}

/// Eliminates the unknowns of a block. False if a pivot is too small.
#[inline(always)]
fn eliminate<T: Real>([own, size]: [usize; 2], front: &mut [T], pivots: &mut [usize], reciprocals: &mut [T]) -> bool {
    let front = &mut front[..size * size];
    for_each_column!(size, column => {
        if column < own && !eliminate_column([column, own, size], front, pivots, reciprocals) {
            return false;
        }
    });
    true
}

/// Eliminates one unknown.
#[inline(always)]
fn eliminate_column<T: Real>(
    [column, own, size]: [usize; 3],
    front: &mut [T],
    pivots: &mut [usize],
    reciprocals: &mut [T],
) -> bool {
    let Some((pivot, reciprocal)) = pivot(&front[column * size..][..size], column, own) else { return false };
    pivots[column] = pivot;
    reciprocals[column] = reciprocal;
    if pivot != column {
        for entries in front.chunks_exact_mut(size) {
            entries.swap(column, pivot);
        }
    }
    let (left, right) = front.split_at_mut((column + 1) * size);
    let multipliers = &mut left[column * size + column + 1..];
    for entry in &mut *multipliers {
        *entry *= reciprocal;
    }
    for next in right.chunks_exact_mut(size) {
        let (upper, below) = next.split_at_mut(column + 1);
        // Rows of constraints have many zeros.
        if upper[column] != T::zero() {
            subtract(below, upper[column], multipliers);
        }
    }
    true
}

/// Eliminates the unknowns of a block from its right-hand side.
#[inline(always)]
fn forward<T: Real>([own, size]: [usize; 2], front: &[T], pivots: &[usize], b: &mut [T]) {
    let (pivots, b) = (&pivots[..own], &mut b[..own]);
    for_each_column!(own, column => b.swap(column, pivots[column]));
    for_each_column!(own, column => {
        let (known, below) = b.split_at_mut(column + 1);
        subtract(below, known[column], &front[column * size..][column + 1..own]);
    });
}

/// Solves for the unknowns of a block, from which those behind it are subtracted.
#[inline(always)]
fn backward<T: Real>([own, size]: [usize; 2], front: &[T], reciprocals: &[T], b: &mut [T]) {
    let (reciprocals, b) = (&reciprocals[..own], &mut b[..own]);
    for_each_column!(own, column => {
        let column = own - 1 - column;
        let (above, known) = b.split_at_mut(column);
        known[0] *= reciprocals[column];
        subtract(above, known[0], &front[column * size..][..column]);
    });
}

/// The pivot of a column among the rows of the block, and its reciprocal; `None` if it is too small.
#[inline(always)]
fn pivot<T: Real>(entries: &[T], column: usize, own: usize) -> Option<(usize, T)> {
    let (inside, border) = entries.split_at(own);
    let (mut pivot, mut longest) = (column, inside[column].to_f64().abs());
    for (row, entry) in inside.iter().enumerate().skip(column + 1) {
        let length = entry.to_f64().abs();
        if length > longest {
            (pivot, longest) = (row, length);
        }
    }
    let border = border.iter().fold(0.0, |largest: f64, entry| largest.max(entry.to_f64().abs()));
    let reciprocal = entries[pivot].recip();
    // False for NaN. The reciprocal of zero is infinite, that of an infinite pivot is zero.
    let is_kept = border <= GROWTH * longest && reciprocal.is_finite() && longest < f64::INFINITY;
    is_kept.then_some((pivot, reciprocal))
}

/// Subtracts `factor * column` from `from`.
#[inline(always)]
fn subtract<T: Real>(from: &mut [T], factor: T, column: &[T]) {
    for (entry, multiplier) in from.iter_mut().zip(column) {
        *entry -= factor * *multiplier;
    }
}

/// A matrix in fronts, dense for one block, and if a pivot inside a block is lost.
#[derive(Clone, Debug)]
pub(crate) struct Factored<T: Real = f64> {
    copies: usize,
    fronts: Option<Fronts<T>>,
    dense: Dense<T>,
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
            dense: Dense::empty(),
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
        if *state == Factors::None {
            b.iter_mut().chain(c).for_each(|entry| *entry = T::real(f64::NAN));
            return;
        }
        let fronts = fronts.as_ref().filter(|_| *state == Factors::Fronts);
        let scales = fronts.map_or(&dense.scales, |fronts| &fronts.scales);
        let first = b.len() / *copies;
        // The number among the ordered ones, and the scale, of each entry of b or c.
        let place = |unknown: usize, copy: usize| {
            let position = fronts.map_or(unknown, |fronts| fronts.homes[unknown].1);
            (position * *copies + copy, T::real(scales[unknown]))
        };
        for (first, entries) in [(0, &*b), (first, &*c)] {
            for (copy, entries) in entries.chunks((entries.len() / *copies).max(1)).enumerate() {
                for (index, entry) in entries.iter().enumerate() {
                    let (position, scale) = place(first + index, copy);
                    ordered[position] = *entry * scale;
                }
            }
        }
        match fronts {
            Some(fronts) => fronts.solve(ordered),
            None => dense.solve(ordered),
        }
        for (first, entries) in [(0, b), (first, c)] {
            let count = (entries.len() / *copies).max(1);
            for (copy, entries) in entries.chunks_mut(count).enumerate() {
                for (index, entry) in entries.iter_mut().enumerate() {
                    let (position, scale) = place(first + index, copy);
                    *entry = ordered[position] * scale;
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

/// A power of two near `1/√x`; 1 for zero.
#[inline(always)]
pub(crate) fn reciprocal_root(x: f64) -> f64 {
    power(x, |exponent| exponent.div_euclid(2))
}

/// A power of two near `1/x`, for scaling without rounding; 1 for zero.
#[inline(always)]
pub(crate) fn reciprocal_power(x: f64) -> f64 {
    power(x, |exponent| exponent)
}

/// 2 to the minus `part` of the exponent of x; 1 if x is zero, subnormal or not finite.
#[inline(always)]
fn power(x: f64, part: impl Fn(i64) -> i64) -> f64 {
    const BIAS: i64 = 1023;
    if !x.is_normal() {
        return 1.0;
    }
    let exponent = ((x.abs().to_bits() >> 52).cast_signed()) - BIAS;
    // 2⁻¹⁰²³ is subnormal.
    f64::from_bits((BIAS - part(exponent).min(BIAS - 1)).cast_unsigned() << 52)
}

#[cfg(test)]
mod tests {
    use super::{Assemble, Block, Entries, Factored, Factors, Fronts, reciprocal_power, reciprocal_root};
    use crate::linear::Pivoted;
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
            let mut dense = Pivoted::new(4 * copies);
            let mut expected = b.clone();
            dense.factor(&matrix);
            dense.solve(&mut expected);
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

    #[test]
    fn scales_are_powers_of_two_in_any_unit() {
        for exponent in [-1000, -3, 0, 1, 7, 1022] {
            let x = 1.5 * 2.0_f64.powi(exponent);
            let [power, root] = [reciprocal_power(x) * x, reciprocal_root(x) * reciprocal_root(x) * x];
            assert!((1.0..2.0).contains(&power) && (1.0..4.0).contains(&root), "{exponent} {power} {root}");
        }
        for x in [0.0, f64::NAN, f64::INFINITY, 1e-310] {
            assert_eq!([reciprocal_power(x), reciprocal_root(x)].map(f64::to_bits), [1.0_f64.to_bits(); 2]);
        }
    }
}
