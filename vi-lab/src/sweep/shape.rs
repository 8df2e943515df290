//! The tables that a sweep makes: their names and columns.
//!
//! Stored with the numbers, so that parts are put together without the scene.

use serde::{Deserialize, Serialize};

/// A table.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Shape {
    /// What stands before the ending of its file's name; nothing for the table with a row for each run.
    pub(super) suffix: String,
    /// Its columns.
    pub(super) columns: Vec<Column>,
}

/// A column.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Column {
    /// Its name.
    pub(super) name: String,
    /// What its numbers are.
    pub(super) kind: Kind,
}

/// What the numbers of a column are.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Kind {
    /// Numbers; NaN where there is none.
    Number,
    /// Whole numbers.
    Count,
    /// Places in a list of words.
    Words(Vec<String>),
}

impl Column {
    /// A column of numbers.
    pub(super) fn number(name: impl Into<String>) -> Self {
        Self { name: name.into(), kind: Kind::Number }
    }

    /// A column of whole numbers.
    pub(super) fn count(name: &str) -> Self {
        Self { name: name.to_owned(), kind: Kind::Count }
    }

    /// A column of words.
    pub(super) fn words(name: &str, words: &[&str]) -> Self {
        Self { name: name.to_owned(), kind: Kind::Words(words.iter().map(|&word| word.to_owned()).collect()) }
    }
}

/// A number of a column of words as its word.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a place in a short list
pub(super) fn word(words: &[String], number: f64) -> &str {
    words.get(number as usize).map_or("", String::as_str)
}
