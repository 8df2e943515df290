//! Loops over instances.
//!
//! In: the numbers that the instances read, one row per instance. Out: [`Nest`]s that run over the same rows. A nest is
//! one loop if every column advances evenly. It is two loops if columns advance evenly in an inner loop whose start and
//! length advance evenly with the outer loop. Otherwise it is a table of the rows.

/// `constant + Σ by·counter`, of an outer and an inner counter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Affine {
    /// The value at the start.
    pub constant: i64,
    /// The change with each counter.
    pub by: [i64; 2],
}

impl Affine {
    /// The value at these counters.
    #[must_use]
    pub fn at(self, counters: [i64; 2]) -> i64 {
        self.constant + self.by[0] * counters[0] + self.by[1] * counters[1]
    }
}

/// Rows of numbers, in loops.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Nest {
    /// An outer counter from 0 to `outer`, an inner one from 0 to `inner`, and the columns.
    Loops {
        /// Rounds of the outer loop.
        outer: i64,
        /// Rounds of the inner loop, at most one by the outer counter.
        inner: Affine,
        /// The columns.
        columns: Vec<Affine>,
    },
    /// All rows.
    Table(Vec<Vec<usize>>),
}

/// Maximum number of even sequences that are written as loops one after the other.
const SEQUENCES: usize = 4;

impl Nest {
    /// Nests over these rows, in ascending order of the rows.
    pub(super) fn of(mut rows: Vec<Vec<usize>>) -> Vec<Self> {
        rows.sort_unstable();
        let sequences = sequences(&rows);
        if sequences.len() <= SEQUENCES {
            return sequences.into_iter().filter_map(Self::single).collect();
        }
        vec![Self::double(&rows).unwrap_or(Self::Table(rows))]
    }

    /// One loop over rows that advance evenly.
    pub(super) fn single<R: AsRef<[Vec<usize>]> + ?Sized>(rows: &R) -> Option<Self> {
        let rows = rows.as_ref();
        let (first, change) = even(rows)?;
        let columns = first.iter().zip(&change).map(|(constant, by)| Affine { constant: *constant, by: [*by, 0] });
        let inner = Affine { constant: 1, by: [0, 0] };
        Some(Self::Loops { outer: integer(rows.len()), inner, columns: columns.collect() })
    }

    /// Two loops.
    fn double(rows: &[Vec<usize>]) -> Option<Self> {
        let width = rows.first()?.len();
        let leading = (0..width).find(|column| rows.iter().any(|row| row[*column] != rows[0][*column]))?;
        let groups: Vec<&[Vec<usize>]> = rows.chunk_by(|left, right| left[leading] == right[leading]).collect();
        let firsts: Vec<Vec<usize>> = groups.iter().map(|group| group[0].clone()).collect();
        let lengths: Vec<Vec<usize>> = groups.iter().map(|group| vec![group.len()]).collect();
        let (constants, by_outer) = even(&firsts)?;
        let (least, change) = even(&lengths)?;
        let (_, by_inner) = even(groups.iter().find(|group| group.len() > 1)?)?;
        let columns =
            (0..width).map(|column| Affine { constant: constants[column], by: [by_outer[column], by_inner[column]] });
        let inner = Affine { constant: least[0], by: [change[0], 0] };
        let nest = Self::Loops { outer: integer(groups.len()), inner, columns: columns.collect() };
        let mut left = rows.iter();
        let mut is_same = true;
        nest.each(&mut |row| is_same &= left.next().is_some_and(|known| known == row));
        (is_same && left.next().is_none()).then_some(nest)
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        let mut rows = 0;
        self.each(&mut |_| rows += 1);
        rows
    }

    /// Calls `see` with each row.
    pub fn each(&self, see: &mut dyn FnMut(&[usize])) {
        match self {
            Self::Loops { outer, inner, columns } => {
                for i in 0..*outer {
                    for j in 0..inner.at([i, 0]) {
                        let value = |column: &Affine| usize::try_from(column.at([i, j])).unwrap_or(usize::MAX);
                        see(&columns.iter().map(value).collect::<Vec<_>>());
                    }
                }
            }
            Self::Table(rows) => rows.iter().for_each(|row| see(row)),
        }
    }
}

/// The rows in the longest sequences that advance evenly.
fn sequences(rows: &[Vec<usize>]) -> Vec<&[Vec<usize>]> {
    let mut found = Vec::new();
    let mut left = rows;
    while !left.is_empty() {
        let length = (1..=left.len()).take_while(|length| even(&left[..*length]).is_some()).last().unwrap_or(1);
        let (sequence, rest) = left.split_at(length);
        found.push(sequence);
        left = rest;
        if found.len() > SEQUENCES {
            break;
        }
    }
    found
}

/// The first row and the change from row to row, if it is always the same.
fn even(rows: &[Vec<usize>]) -> Option<(Vec<i64>, Vec<i64>)> {
    let first: Vec<i64> = rows.first()?.iter().copied().map(integer).collect();
    let change: Vec<i64> = match rows.get(1) {
        Some(second) => second.iter().zip(&first).map(|(second, first)| integer(*second) - first).collect(),
        None => vec![0; first.len()],
    };
    let follows = |pair: &[Vec<usize>]| {
        let columns = pair[0].iter().zip(&pair[1]).zip(&change);
        columns.into_iter().all(|((left, right), change)| integer(*right) - integer(*left) == *change)
    };
    rows.windows(2).all(follows).then_some((first, change))
}

fn integer(number: usize) -> i64 {
    i64::try_from(number).unwrap_or(i64::MAX)
}
