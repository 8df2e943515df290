//! Elimination in one block: a dense matrix by columns, of whose unknowns the first ones are eliminated.
//!
//! `[own, size]` are the numbers of unknowns to eliminate, and of all rows. The rest of the matrix becomes S.

use crate::real::Real;

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
pub(super) use with_constant;

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

/// Eliminates the unknowns of a block. False if a pivot is too small.
#[inline(always)]
pub(super) fn eliminate<T: Real>(
    [own, size]: [usize; 2],
    front: &mut [T],
    pivots: &mut [usize],
    reciprocals: &mut [T],
) -> bool {
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
pub(super) fn forward<T: Real>([own, size]: [usize; 2], front: &[T], pivots: &[usize], b: &mut [T]) {
    let (pivots, b) = (&pivots[..own], &mut b[..own]);
    for_each_column!(own, column => b.swap(column, pivots[column]));
    for_each_column!(own, column => {
        let (known, below) = b.split_at_mut(column + 1);
        subtract(below, known[column], &front[column * size..][column + 1..own]);
    });
}

/// Solves for the unknowns of a block, from which those behind it are subtracted.
#[inline(always)]
pub(super) fn backward<T: Real>([own, size]: [usize; 2], front: &[T], reciprocals: &[T], b: &mut [T]) {
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
pub(super) fn subtract<T: Real>(from: &mut [T], factor: T, column: &[T]) {
    for (entry, multiplier) in from.iter_mut().zip(column) {
        *entry -= factor * *multiplier;
    }
}

/// Sign of the determinant of a factored block: −1 or 1.
pub(super) fn determinant_sign<T: Real>(pivots: &[usize], reciprocals: &[T]) -> i8 {
    pivots.iter().zip(reciprocals).enumerate().fold(1, |sign, (column, (pivot, reciprocal))| {
        if (*pivot == column) == (reciprocal.to_f64() < 0.0) { -sign } else { sign }
    })
}
