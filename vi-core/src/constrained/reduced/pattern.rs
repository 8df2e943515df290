//! The nonzeros of A, as rows and points.

use crate::linear::{Rectangular, Row};
use alloc::vec::Vec;

/// The nonzeros of A.
#[derive(Clone, Debug, Default)]
pub(super) struct Pattern {
    /// Row by row.
    pub(super) parts: Vec<Part>,
    /// Whether the first row has point 0 alone, and row r the points r − 1 and r: loops then need no list.
    pub(super) is_chain: bool,
}

/// The entries of a row of A at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) row: usize,
    pub(super) point: usize,
}

impl Pattern {
    pub(super) fn new(parts: Vec<Part>) -> Self {
        let is_next = |(index, part): (usize, &Part)| part.row == index.div_ceil(2) && part.point == index / 2;
        let is_chain = parts.len() % 2 == 1 && parts.iter().enumerate().all(is_next);
        Self { parts, is_chain }
    }

    /// Adds the products of the rows of A and x, as `f` adds a product of two entries.
    #[inline(always)]
    pub(super) fn add_products<const D: usize>(
        &self,
        a: &[f64],
        x: &[f64],
        rows: &mut [f64],
        f: impl Fn(f64, f64) -> f64,
    ) {
        let ((a, _), (x, _)) = (a.as_chunks::<D>(), x.as_chunks::<D>());
        let add =
            |row: &mut f64, a: &[f64; D], x: &[f64; D]| *row = a.iter().zip(x).fold(*row, |sum, (a, x)| f(sum, a * x));
        match (a, &mut *rows) {
            ([first, pairs @ ..], [row, rows @ ..]) if self.is_chain => {
                add(row, first, &x[0]);
                let (pairs, _) = pairs.as_chunks::<2>();
                for ((row, [before, own]), points) in rows.iter_mut().zip(pairs).zip(x.windows(2)) {
                    add(row, before, &points[0]);
                    add(row, own, &points[1]);
                }
            }
            _ => {
                for (Part { row, point }, a) in self.parts.iter().zip(a) {
                    add(&mut rows[*row], a, &x[*point]);
                }
            }
        }
    }

    /// Adds the terms of `AᵀΛ`, as `f` adds a term.
    #[inline(always)]
    pub(super) fn add_terms<const D: usize>(
        &self,
        a: &[f64],
        multipliers: &[f64],
        sums: &mut [f64],
        f: impl Fn(f64, f64) -> f64,
    ) {
        let ((a, _), (sums, _)) = (a.as_chunks::<D>(), sums.as_chunks_mut::<D>());
        let add = |sums: &mut [f64; D], a: &[f64; D], multiplier: f64| {
            sums.iter_mut().zip(a).for_each(|(sum, a)| *sum = f(*sum, a * multiplier));
        };
        if self.is_chain {
            let (pairs, last) = a.as_chunks::<2>();
            for ((sums, [own, next]), multipliers) in sums.iter_mut().zip(pairs).zip(multipliers.windows(2)) {
                add(sums, own, multipliers[0]);
                add(sums, next, multipliers[1]);
            }
            add(&mut sums[pairs.len()], &last[0], multipliers[pairs.len()]);
        } else {
            for (Part { row, point }, a) in self.parts.iter().zip(a) {
                add(&mut sums[*point], a, multipliers[*row]);
            }
        }
    }
}

/// The parts of A with points of this number of coordinates; `None` if one of these alone is in a row.
pub(super) fn parts<const N: usize>(gradients: &impl Rectangular<N, f64>, dimension: usize) -> Option<Vec<Part>> {
    let mut parts = Vec::new();
    for (row, Row { columns, .. }) in gradients.rows().enumerate() {
        for columns in columns.chunks(dimension) {
            let point = columns[0] / dimension;
            if !columns.iter().copied().eq(point * dimension..(point + 1) * dimension) {
                return None;
            }
            parts.push(Part { row, point });
        }
    }
    N.is_multiple_of(dimension).then_some(parts)
}

#[cfg(test)]
pub(super) mod tests {
    use super::{Part, Pattern};

    /// A chain of four points on a line, the first one at a fixed end.
    pub(in super::super) fn chain() -> Pattern {
        let of = |row: usize, point: usize| Part { row, point };
        Pattern::new(vec![of(0, 0), of(1, 0), of(1, 1), of(2, 1), of(2, 2), of(3, 2), of(3, 3)])
    }

    pub(in super::super) const LEFT: [f64; 7] = [1.1, -0.9, 1.2, -0.8, 1.3, -0.7, 1.4];

    #[test]
    fn a_chain_has_the_bits_of_its_list() {
        let chain = chain();
        assert!(chain.is_chain);
        let list = Pattern { is_chain: false, ..chain.clone() };
        let of = |pattern: &Pattern| {
            // The last point is in no row.
            let (mut rows, mut sums) = ([0.1, 0.2, 0.3, 0.4], [0.5, 0.6, 0.7, 0.8, 0.9]);
            pattern.add_products::<1>(&LEFT, &[1.7, -0.3, 0.9, 2.1, 4.0], &mut rows, |sum, term| sum + term);
            pattern.add_terms::<1>(&LEFT, &[0.7, -1.3, 0.6, 1.9], &mut sums, |sum, term| sum + term.abs());
            (rows.map(f64::to_bits), sums.map(f64::to_bits))
        };
        assert_eq!(of(&chain), of(&list));
        assert_eq!(of(&chain).1[4], 0.9_f64.to_bits());
    }
}
