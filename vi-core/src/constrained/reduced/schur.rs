//! The matrix S of the impulses: its pattern, its factors, and a solution by them.

use super::pattern::{Part, Pattern};
use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec::Vec;

/// Largest number of entries of S for each constraint, those of its elimination included.
const FILLED: usize = 12;
/// Smallest part of a diagonal entry that elimination may leave.
const KEPT: f64 = 1e-8;

/// S and its factors.
#[derive(Clone, Debug, Default)]
pub(super) struct Schur {
    values: Vec<f64>,
    reciprocals: Vec<f64>,
    /// Entries of S, with two parts of A whose product adds to them.
    products: Vec<[u32; 3]>,
    /// The pivots in order.
    pivots: Vec<Pivot>,
    /// For each pivot its later rows, and the entries of S in its column and in its row.
    later: Vec<[u32; 3]>,
    /// For each pivot, the entries of S in these rows and columns, by rows.
    targets: Vec<u32>,
    /// Whether S has three diagonals: the values are those of one row after the other, with the entry below the diagonal
    /// after the one above it.
    is_tridiagonal: bool,
}

/// A step of the elimination.
#[derive(Clone, Copy, Debug)]
struct Pivot {
    unknown: u32,
    entry: u32,
    /// End of its later rows, and of its targets.
    later: u32,
    targets: u32,
}

impl Schur {
    /// The pattern of S for the parts of A; `None` if elimination fills it.
    pub(super) fn new(Pattern { parts, .. }: &Pattern, count: usize) -> Option<Self> {
        let index = |index: usize| u32::try_from(index).ok();
        let mut at_point: BTreeMap<usize, Vec<[usize; 2]>> = BTreeMap::new();
        for (part, Part { row, point }) in parts.iter().enumerate() {
            at_point.entry(*point).or_default().push([*row, part]);
        }
        let mut pairs: BTreeMap<[usize; 2], Vec<[u32; 2]>> = BTreeMap::new();
        for parts in at_point.values() {
            for [row, left] in parts {
                for [column, right] in parts {
                    pairs.entry([*row, *column]).or_default().push([index(*left)?, index(*right)?]);
                }
            }
            if pairs.len() > FILLED * count.max(4) {
                return None;
            }
        }
        let mut coupled: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); count];
        for [row, column] in pairs.keys().filter(|[row, column]| row != column) {
            coupled[*row].insert(*column);
        }
        let mut places: BTreeMap<[usize; 2], u32> = BTreeMap::new();
        let place = |at: [usize; 2], places: &mut BTreeMap<[usize; 2], u32>| {
            let next = index(places.len())?;
            Some(*places.entry(at).or_insert(next))
        };
        let mut schur = Self::default();
        for (at, products) in &pairs {
            let entry = place(*at, &mut places)?;
            schur.products.extend(products.iter().map(|[left, right]| [entry, *left, *right]));
        }
        let mut left: BTreeSet<usize> = (0..count).collect();
        while let Some(pivot) = left.iter().copied().min_by_key(|row| coupled[*row].len()) {
            left.remove(&pivot);
            let later: Vec<usize> = core::mem::take(&mut coupled[pivot]).into_iter().collect();
            for row in &later {
                let [column, upper] = [[*row, pivot], [pivot, *row]].map(|at| place(at, &mut places));
                schur.later.push([index(*row)?, column?, upper?]);
                coupled[*row].remove(&pivot);
                coupled[*row].extend(later.iter().filter(|other| *other != row));
                for other in &later {
                    schur.targets.push(place([*row, *other], &mut places)?);
                }
            }
            let entry = place([pivot, pivot], &mut places)?;
            let (later, targets) = (index(schur.later.len())?, index(schur.targets.len())?);
            schur.pivots.push(Pivot { unknown: index(pivot)?, entry, later, targets });
            if places.len() > FILLED * count.max(4) {
                return None;
            }
        }
        schur.is_tridiagonal =
            pairs.len() + 2 == 3 * count && pairs.keys().all(|[row, column]| row.abs_diff(*column) < 2);
        schur.values = vec![0.0; places.len()];
        schur.reciprocals = vec![0.0; count];
        Some(schur)
    }

    /// Forms S from A and M⁻¹Aᵀ with D coordinates of a point, and factors it. False if a pivot is not positive.
    pub(super) fn factor<const D: usize>(&mut self, is_chain: bool, left: &[f64], right: &[f64]) -> bool {
        let Self { values, products, .. } = self;
        let ((left, _), (right, _)) = (left.as_chunks::<D>(), right.as_chunks::<D>());
        let product = |sum: f64, a: &[f64; D], b: &[f64; D]| a.iter().zip(b).fold(sum, |sum, (a, b)| sum + a * b);
        if is_chain {
            tridiagonal::write(values, left, right, product);
        } else {
            values.fill(0.0);
            for [entry, a, b] in products.iter() {
                let value = &mut values[*entry as usize];
                *value = product(*value, &left[*a as usize], &right[*b as usize]);
            }
        }
        if self.is_tridiagonal {
            return tridiagonal::factor(&mut self.values, &mut self.reciprocals);
        }
        let Self { values, reciprocals, pivots, later, targets, .. } = self;
        let (mut start, mut first_target) = (0, 0);
        let mut is_positive = true;
        for pivot in pivots.iter() {
            let diagonal = values[pivot.entry as usize];
            let reciprocal = diagonal.recip();
            is_positive &= diagonal > 0.0;
            reciprocals[pivot.unknown as usize] = reciprocal;
            let rows = &later[start..pivot.later as usize];
            let targets = &targets[first_target..pivot.targets as usize];
            for (place, [_, column, _]) in rows.iter().enumerate() {
                let multiplier = values[*column as usize] * reciprocal;
                values[*column as usize] = multiplier;
                for ([_, _, upper], target) in rows.iter().zip(&targets[place * rows.len()..]) {
                    let eliminated = multiplier * values[*upper as usize];
                    values[*target as usize] -= eliminated;
                }
                // A small rest of the diagonal has lost its digits.
                let own = targets[place * rows.len() + place] as usize;
                is_positive &= values[own] > KEPT * (multiplier * values[rows[place][2] as usize]).abs();
            }
            (start, first_target) = (pivot.later as usize, pivot.targets as usize);
        }
        is_positive
    }

    /// Replaces b by the x with `S x = b`.
    pub(super) fn solve(&self, b: &mut [f64]) {
        let Self { values, reciprocals, pivots, later, is_tridiagonal, .. } = self;
        if *is_tridiagonal {
            return tridiagonal::solve(values, reciprocals, b);
        }
        let mut start = 0;
        for pivot in pivots {
            let known = b[pivot.unknown as usize];
            for [row, column, _] in &later[start..pivot.later as usize] {
                b[*row as usize] -= values[*column as usize] * known;
            }
            start = pivot.later as usize;
        }
        for (index, pivot) in pivots.iter().enumerate().rev() {
            let start = if index == 0 { 0 } else { pivots[index - 1].later as usize };
            let rows = &later[start..pivot.later as usize];
            let known = b[pivot.unknown as usize];
            let rest =
                rows.iter().fold(known, |rest, [row, _, upper]| rest - values[*upper as usize] * b[*row as usize]);
            b[pivot.unknown as usize] = rest * reciprocals[pivot.unknown as usize];
        }
    }
}

/// S of a chain, in three diagonals.
mod tridiagonal {
    use super::KEPT;

    /// Diagonal, above it and below it, in a row and below the diagonal of this row.
    const WIDTH: usize = 3;

    /// S of a chain: row r has the parts 2r − 1 and 2r.
    #[inline(always)]
    pub(super) fn write<const D: usize>(
        values: &mut [f64],
        left: &[[f64; D]],
        right: &[[f64; D]],
        product: impl Fn(f64, &[f64; D], &[f64; D]) -> f64,
    ) {
        values[0] = product(0.0, &left[0], &right[0]);
        let rows = values[1..].as_chunks_mut::<WIDTH>().0.iter_mut();
        for (([upper, lower, diagonal], left), right) in
            rows.zip(left.windows(3).step_by(2)).zip(right.windows(3).step_by(2))
        {
            *upper = product(0.0, &left[0], &right[1]);
            *lower = product(0.0, &left[1], &right[0]);
            *diagonal = product(product(0.0, &left[1], &right[1]), &left[2], &right[2]);
        }
    }

    /// As [`Schur::factor`](super::Schur::factor).
    pub(super) fn factor(values: &mut [f64], reciprocals: &mut [f64]) -> bool {
        let (mut diagonal, mut is_positive) = (values[0], true);
        let (rows, _) = values[1..].as_chunks_mut::<WIDTH>();
        for ([upper, lower, next], reciprocal) in rows.iter_mut().zip(&mut *reciprocals) {
            *reciprocal = diagonal.recip();
            is_positive &= diagonal > 0.0;
            *lower *= *reciprocal;
            let eliminated = *lower * *upper;
            *next -= eliminated;
            // A small rest of the diagonal has lost its digits.
            is_positive &= *next > KEPT * eliminated.abs();
            diagonal = *next;
        }
        if let Some(reciprocal) = reciprocals.last_mut() {
            *reciprocal = diagonal.recip();
        }
        is_positive && diagonal > 0.0
    }

    /// As [`Schur::solve`](super::Schur::solve).
    pub(super) fn solve(values: &[f64], reciprocals: &[f64], b: &mut [f64]) {
        let (rows, _) = values[1..].as_chunks::<WIDTH>();
        let mut known = b[0];
        for ([_, lower, _], b) in rows.iter().zip(&mut b[1..]) {
            *b -= lower * known;
            known = *b;
        }
        let last = b.len() - 1;
        known *= reciprocals[last];
        b[last] = known;
        for (([upper, ..], reciprocal), b) in rows.iter().zip(reciprocals).zip(b).rev() {
            *b = (*b - upper * known) * reciprocal;
            known = *b;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::pattern::tests::{LEFT, chain};
    use super::{Part, Pattern, Schur};

    #[test]
    fn three_diagonals_have_the_bits_of_any_order() {
        let right = [0.9, -1.1, 1.0, -1.2, 0.8, -0.6, 1.5];
        let solved = |is_tridiagonal: bool, is_chain: bool| {
            let chain = chain();
            let mut schur = Schur::new(&chain, 4).expect("no fill");
            assert!(schur.is_tridiagonal && chain.is_chain);
            schur.is_tridiagonal = is_tridiagonal;
            assert!(schur.factor::<1>(is_chain, &LEFT, &right));
            let mut b = [1.0, -2.0, 3.0, 0.5];
            schur.solve(&mut b);
            b.map(f64::to_bits)
        };
        assert_eq!(solved(true, true), solved(false, false));
        assert_eq!(solved(true, false), solved(false, false));
        // A star has no three diagonals.
        let of = |row: usize, point: usize| Part { row, point };
        let star = Pattern::new(vec![of(0, 0), of(1, 0), of(1, 1), of(2, 0), of(2, 2)]);
        assert!(!Schur::new(&star, 3).expect("no fill").is_tridiagonal && !star.is_chain);
    }
}
