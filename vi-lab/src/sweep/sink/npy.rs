//! A table as NPY: float64, row by row. Words are their places in the list that the JSON file beside it has.

use super::super::part::Description;
use super::super::shape::{Kind, Shape};
use super::Sink;
use crate::npy::head;
use serde_json::{Map, Value, json};
use std::fs::File;
use std::io::{self, Write as _};

/// An NPY file.
pub(super) struct Npy {
    file: File,
}

impl Npy {
    pub(super) fn begin(mut file: File, shape: &Shape, rows: u64) -> io::Result<Self> {
        file.write_all(&head(rows, shape.columns.len()))?;
        Ok(Self { file })
    }
}

impl Sink for Npy {
    fn write(&mut self, rows: &[f64]) -> io::Result<()> {
        let bytes: Vec<u8> = rows.iter().flat_map(|number| number.to_le_bytes()).collect();
        self.file.write_all(&bytes)
    }

    fn finish(self: Box<Self>) -> io::Result<File> {
        Ok(self.file)
    }
}

/// What is in the file: facts, columns, and the words of those that have some.
pub(super) fn description(study: &Description, shape: &Shape) -> String {
    let facts: Map<String, Value> = study.facts.iter().map(|(name, fact)| (name.clone(), json!(fact))).collect();
    let columns: Vec<&str> = shape.columns.iter().map(|column| column.name.as_str()).collect();
    let words: Map<String, Value> = shape
        .columns
        .iter()
        .filter_map(|column| match &column.kind {
            Kind::Words(words) => Some((column.name.clone(), json!(words))),
            Kind::Number | Kind::Count => None,
        })
        .collect();
    format!("{:#}\n", json!({ "sweep": facts, "runs": study.items, "columns": columns, "words": words }))
}
