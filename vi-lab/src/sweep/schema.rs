//! The tables of a sweep: their columns, and their rows as CSV.
//!
//! A number has the fewest digits that read back to the same bits. NaN is an empty entry.

use core::fmt::Write as _;
use serde::{Deserialize, Serialize};
use vi_report::table::csv_field;

/// Counts are below this number, so that float64 represents them exactly.
pub(super) const MOST: u64 = 1 << 53;

/// The columns of a table.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Schema {
    /// `runs`, `section` or `series`.
    pub(super) table: String,
    pub(super) columns: Vec<Column>,
}

/// A column.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Column {
    pub(super) name: String,
    pub(super) kind: ColumnKind,
}

/// The kind of the numbers in a column.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum ColumnKind {
    /// Numbers; NaN if there is none.
    Number,
    /// Whole numbers below [`MOST`].
    Count,
    /// Indices of a list of words.
    Words(Vec<String>),
}

impl Column {
    pub(super) fn number(name: impl Into<String>) -> Self {
        Self { name: name.into(), kind: ColumnKind::Number }
    }

    pub(super) fn count(name: &str) -> Self {
        Self { name: name.to_owned(), kind: ColumnKind::Count }
    }

    pub(super) fn words(name: &str, words: &[&str]) -> Self {
        Self { name: name.to_owned(), kind: ColumnKind::Words(words.iter().map(|&word| word.to_owned()).collect()) }
    }
}

impl Schema {
    /// The names of the columns, separated by commas.
    pub(super) fn heading(&self) -> String {
        self.columns.iter().map(|column| csv_field(&column.name)).collect::<Vec<_>>().join(",")
    }

    /// Appends a row to a text, with its line end.
    pub(super) fn write(&self, row: &[f64], text: &mut String) {
        for (index, (number, column)) in row.iter().zip(&self.columns).enumerate() {
            if index > 0 {
                text.push(',');
            }
            // Writing to a string cannot fail.
            let _ = match &column.kind {
                ColumnKind::Number if number.is_nan() => Ok(()),
                ColumnKind::Number => write!(text, "{number:?}"),
                // Without a decimal point.
                ColumnKind::Count => write!(text, "{number}"),
                ColumnKind::Words(words) => text.write_str(&csv_field(word(words, *number))),
            };
        }
        text.push('\n');
    }

    /// Reads a row that [`Self::write`] has written, without its line end.
    ///
    /// # Errors
    /// The error in the row.
    pub(super) fn read(&self, text: &str, row: &mut Vec<f64>) -> Result<(), String> {
        let (columns, entries) = (self.columns.len(), text.split(',').count());
        if entries != columns {
            return Err(format!("the row of `{}` has {entries} columns instead of {columns}", self.table));
        }
        row.clear();
        for (entry, column) in text.split(',').zip(&self.columns) {
            let number = column.kind.read(entry);
            row.push(number.ok_or_else(|| format!("`{entry}` cannot be an entry of the column `{}`", column.name))?);
        }
        Ok(())
    }
}

impl ColumnKind {
    /// The number of an entry.
    #[allow(clippy::cast_precision_loss)] // counts and indices below 2^53
    fn read(&self, entry: &str) -> Option<f64> {
        match self {
            Self::Number if entry.is_empty() => Some(f64::NAN),
            Self::Number => entry.parse().ok(),
            Self::Count => entry.parse::<u64>().ok().filter(|count| *count < MOST).map(|count| count as f64),
            Self::Words(words) => words.iter().position(|word| word == entry).map(|index| index as f64),
        }
    }
}

/// The word of a number in a column of words.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // an index of a short list
fn word(words: &[String], number: f64) -> &str {
    words.get(number as usize).map_or("", String::as_str)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_reads_back_to_the_same_bits() {
        let columns = vec![Column::count("item"), Column::number("x"), Column::words("ending", &["good", "bad"])];
        let schema = Schema { table: "runs".to_owned(), columns };
        let mut read = Vec::new();
        for x in [0.1, -0.0, 5e-324, f64::MAX, f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            let row = [9_007_199_254_740_991.0, x, 1.0];
            let mut text = String::new();
            schema.write(&row, &mut text);
            assert_eq!(schema.read(text.trim_end(), &mut read), Ok(()), "{text}");
            assert_eq!(read.iter().map(|x| x.to_bits()).collect::<Vec<_>>(), row.map(f64::to_bits), "{text}");
        }
        for (text, message) in [
            ("", "the row of `runs` has 1 columns instead of 3"),
            ("1,2.0", "the row of `runs` has 2 columns instead of 3"),
            ("1,2.0,bad,", "the row of `runs` has 4 columns instead of 3"),
            ("1.0,2.0,bad", "`1.0` cannot be an entry of the column `item`"),
            ("9007199254740992,2.0,bad", "`9007199254740992` cannot be an entry of the column `item`"),
            ("1,2.0.,bad", "`2.0.` cannot be an entry of the column `x`"),
            ("1,2.0,worse", "`worse` cannot be an entry of the column `ending`"),
        ] {
            assert_eq!(schema.read(text, &mut read), Err(message.to_owned()));
        }
    }
}
