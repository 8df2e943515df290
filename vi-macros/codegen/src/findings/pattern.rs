//! The zero pattern of a matrix.
//!
//! In: the positions of nonzero entries. Out: the narrowest [`Pattern`] that contains them. A pattern with entry (i, j)
//! also contains (j, i), because elimination needs both.

use super::CLOSED;
use std::collections::BTreeSet;

/// Zero pattern of a square matrix.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// One row.
    Scalar,
    /// Nonzero entries on the diagonal only.
    Diagonal,
    /// Decoupled blocks: the indices of each.
    Blocks(Vec<Vec<usize>>),
    /// Tridiagonal, with three rows or more.
    Tridiagonal,
    /// A band with this half-bandwidth. At least half of each row is outside the band.
    Banded(usize),
    /// Other zeros: the columns of the entries of each row.
    Sparse(Vec<Vec<usize>>),
    /// Dense, or nearly so.
    Dense,
}

impl Pattern {
    /// The pattern in words; `list` names coordinates.
    pub(super) fn text(&self, list: &dyn Fn(&[usize]) -> String) -> String {
        match self {
            Self::Scalar => "a number".to_owned(),
            Self::Diagonal => "diagonal".to_owned(),
            Self::Blocks(blocks) => {
                let blocks: Vec<String> = blocks.iter().map(|block| format!("({})", list(block))).collect();
                format!("block-diagonal: {}", blocks.join(", "))
            }
            Self::Tridiagonal => "tridiagonal".to_owned(),
            Self::Banded(width) => format!("banded, with {width} diagonals on each side"),
            Self::Sparse(_) => "sparse".to_owned(),
            Self::Dense => "dense".to_owned(),
        }
    }
}

/// The pattern of a square matrix; `rows` flags its nonzero entries.
pub(super) fn pattern(rows: &[Vec<bool>]) -> Pattern {
    let size = rows.len();
    let filled = |i: usize, j: usize| rows.get(i).and_then(|row| row.get(j)).copied().unwrap_or(false);
    let touching = |i: usize, j: usize| filled(i, j) || filled(j, i);
    let pairs = (0..size).flat_map(|i| (0..i).map(move |j| (i, j)));
    let width = pairs.filter(|(i, j)| touching(*i, *j)).map(|(i, j)| i - j).max().unwrap_or(0);
    let blocks = blocks(size, &touching);
    match (size, width, blocks.len()) {
        (0 | 1, ..) => Pattern::Scalar,
        (_, 0, _) => Pattern::Diagonal,
        (.., 2..) => Pattern::Blocks(blocks),
        (3.., 1, _) => Pattern::Tridiagonal,
        _ if 2 * (2 * width + 1) <= size => Pattern::Banded(width),
        _ => Pattern::Dense,
    }
}

/// The pattern of a square matrix that is not inverted: the columns of each row, if at most half of the entries are
/// nonzero.
pub(super) fn by_rows(rows: &[Vec<bool>]) -> Pattern {
    let columns = columns(rows);
    let filled: usize = columns.iter().map(Vec::len).sum();
    match pattern(rows) {
        found @ (Pattern::Scalar | Pattern::Diagonal) => found,
        _ if 2 * filled <= rows.len() * rows.len() && rows.len() > CLOSED => Pattern::Sparse(columns),
        _ => Pattern::Dense,
    }
}

/// The columns of the nonzero entries of each row.
pub(super) fn columns(rows: &[Vec<bool>]) -> Vec<Vec<usize>> {
    let of =
        |row: &Vec<bool>| row.iter().enumerate().filter(|(_, filled)| **filled).map(|(column, _)| column).collect();
    rows.iter().map(of).collect()
}

/// Groups of coupled indices; each group is ascending, and so are the first members.
fn blocks(size: usize, touching: &dyn Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let mut left: BTreeSet<usize> = (0..size).collect();
    let mut blocks = Vec::new();
    while let Some(first) = left.pop_first() {
        let mut block = BTreeSet::from([first]);
        let mut open = vec![first];
        while let Some(index) = open.pop() {
            let found: Vec<usize> = left.iter().copied().filter(|other| touching(index, *other)).collect();
            for other in &found {
                left.remove(other);
            }
            block.extend(&found);
            open.extend(found);
        }
        blocks.push(block.into_iter().collect());
    }
    blocks
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(rows: &[&str]) -> Pattern {
        let rows: Vec<Vec<bool>> = rows.iter().map(|row| row.chars().map(|entry| entry != '.').collect()).collect();
        pattern(&rows)
    }

    #[test]
    fn patterns_by_hand() {
        assert_eq!(of(&["x"]), Pattern::Scalar);
        assert_eq!(of(&["x.", ".x"]), Pattern::Diagonal);
        assert_eq!(of(&["xx", ".x"]), Pattern::Dense);
        assert_eq!(of(&["xx.", "xxx", ".xx"]), Pattern::Tridiagonal);
        assert_eq!(of(&["x.x", ".x.", "x.x"]), Pattern::Blocks(vec![vec![0, 2], vec![1]]));
        assert_eq!(of(&["xx..", "xx..", "..xx", "..xx"]), Pattern::Blocks(vec![vec![0, 1], vec![2, 3]]));
        assert_eq!(of(&["xxx", "xxx", "xxx"]), Pattern::Dense);
        let band = |size: usize, width: usize| {
            let rows: Vec<Vec<bool>> =
                (0..size).map(|i: usize| (0..size).map(|j| i.abs_diff(j) <= width).collect()).collect();
            pattern(&rows)
        };
        assert_eq!(band(10, 2), Pattern::Banded(2));
        assert_eq!(band(9, 2), Pattern::Dense);
    }
}
