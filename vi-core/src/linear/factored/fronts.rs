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
//! first. All unknowns in one block are a matrix of `dense`: its elimination is that of a front without border. The stages
//! of a step have one graph, so that each unknown of the graph is `copies` adjacent unknowns of the matrix.
//!
//! Source: J. W. H. Liu, The multifrontal method for sparse matrix solution, 1992.

use super::block::{backward, determinant_sign, eliminate, forward, subtract, with_constant};
use super::{Block, Entries};
use crate::real::Real;
use alloc::vec::Vec;

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
pub(super) struct Fronts<T: Real = f64> {
    copies: usize,
    matrices: Vec<Front>,
    /// Front and position of each unknown; positions are those of elimination.
    pub(super) homes: Vec<(usize, usize)>,
    /// The unknowns of each front, its own first.
    members: Vec<Vec<usize>>,
    values: Vec<T>,
    /// Positions of the borders, and their rows in the front of the parent.
    borders: Vec<usize>,
    rows: Vec<usize>,
    /// For each position the pivot row in its front, and the reciprocal of the pivot.
    pivots: Vec<usize>,
    pub(super) reciprocals: Vec<T>,
    /// Locations of the entries in the order in which the matrix is written.
    locations: Vec<Location>,
    /// Their rows and columns.
    #[cfg(debug_assertions)]
    names: Vec<[usize; 2]>,
    next: usize,
    /// Scale factor of each unknown: of its row and of its column.
    pub(super) scales: Vec<f64>,
}

/// The location of a row and a column, or of their copies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Location {
    start: u32,
    stride: u32,
}

/// An entry to which terms are added.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry<T> {
    location: Location,
    scale: T,
}

impl<T: Real> Fronts<T> {
    /// Allocates for `copies` copies of each unknown, without the unknowns of the blocks beyond the first ones. `None` for
    /// fewer than two blocks, and if they do not hold each unknown once, or a border is not that of an elimination.
    pub(super) fn new(blocks: &[Block], unknowns: usize, copies: usize) -> Option<Self> {
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
            locations: Vec::new(),
            #[cfg(debug_assertions)]
            names: Vec::new(),
            next: 0,
            scales: vec![1.0; homes.len()],
            homes,
        }
    }

    /// Begins a new matrix: zero.
    pub(super) fn clear(&mut self) {
        self.values.fill(T::zero());
        self.next = 0;
    }

    /// An entry outside of its front has no location: the blocks are not those of this matrix.
    #[cold]
    fn find(&mut self, row: usize, column: usize) {
        #[cfg(debug_assertions)]
        self.names.push([row, column]);
        let front = self.homes[row].0.min(self.homes[column].0);
        let Front { values, size, .. } = self.matrices[front];
        let member = |unknown| self.members[front].iter().position(|member| *member == unknown);
        let location = match (member(row), member(column)) {
            (Some(row), Some(column)) => {
                let start = values + (row + column * size) * self.copies;
                u32::try_from(start).ok().zip(u32::try_from(size).ok())
            }
            _ => None,
        };
        self.locations.push(location.map_or(Location::NONE, |(start, stride)| Location { start, stride }));
    }

    /// Factors the matrix in place. False if a pivot is zero, not finite, or too small against its column, or if an
    /// entry was outside of all fronts.
    pub(super) fn factor(&mut self) -> bool {
        let Self { matrices, values, rows, pivots, reciprocals, locations, .. } = self;
        if locations.iter().any(|location| location.is_none()) {
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
    pub(super) fn solve(&self, b: &mut [T]) {
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
    pub(super) fn determinant_sign(&self) -> i8 {
        let of = |Front { own, first, .. }: &Front| {
            determinant_sign(&self.pivots[*first..][..*own], &self.reciprocals[*first..][..*own])
        };
        self.matrices.iter().map(of).product()
    }
}

impl<T: Real> Entries<T> for Fronts<T> {
    type Entry = Entry<T>;

    fn scales(&mut self) -> &mut [f64] {
        &mut self.scales
    }

    /// The first matrix finds the locations of its entries, and allocates.
    #[inline(always)]
    fn entry(&mut self, row: usize, column: usize) -> Entry<T> {
        if self.next == self.locations.len() {
            self.find(row, column);
        }
        #[cfg(debug_assertions)]
        assert_eq!(self.names[self.next], [row, column], "entry {} in the order of the first matrix", self.next);
        let location = self.locations[self.next];
        self.next += 1;
        Entry { location, scale: T::real(self.scales[row] * self.scales[column]) }
    }

    #[inline(always)]
    fn add(&mut self, Entry { location, scale }: Entry<T>, [row, column]: [usize; 2], value: T) {
        let index = location.start as usize + row + column * location.stride as usize;
        if let Some(entry) = self.values.get_mut(index) {
            *entry += value * scale;
        }
    }
}

impl Location {
    const NONE: Self = Self { start: u32::MAX, stride: 0 };

    fn is_none(self) -> bool {
        self.start == u32::MAX
    }
}
