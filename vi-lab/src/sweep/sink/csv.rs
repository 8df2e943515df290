//! A table as CSV: comment lines that say what it is of, the names of the columns, one line per row.
//!
//! Numbers are the shortest that read back to the same bits; where there is none, the entry is empty.

use super::super::part::Description;
use super::super::shape::{Column, Kind, Shape, word};
use super::Sink;
use core::fmt::Write as _;
use std::fs::File;
use std::io::{self, Write as _};
use vi_report::table::csv_field;

/// A CSV file.
pub(super) struct Csv {
    file: File,
    columns: Vec<Column>,
    /// Lines that are to be written.
    block: String,
}

impl Csv {
    pub(super) fn begin(file: File, study: &Description, shape: &Shape) -> io::Result<Self> {
        let mut block = String::new();
        for (name, fact) in &study.facts {
            // Writing to a string cannot fail, here and below.
            let _ = writeln!(block, "# {name}: {fact}");
        }
        let names: Vec<String> = shape.columns.iter().map(|column| csv_field(&column.name)).collect();
        let _ = writeln!(block, "# runs: {}\n{}", study.items, names.join(","));
        let mut csv = Self { file, columns: shape.columns.clone(), block };
        csv.flush().map(|()| csv)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.write_all(self.block.as_bytes())?;
        self.block.clear();
        Ok(())
    }
}

impl Sink for Csv {
    fn write(&mut self, rows: &[f64]) -> io::Result<()> {
        for row in rows.chunks_exact(self.columns.len()) {
            for (index, (number, column)) in row.iter().zip(&self.columns).enumerate() {
                if index > 0 {
                    self.block.push(',');
                }
                let _ = match &column.kind {
                    Kind::Number if number.is_nan() => Ok(()),
                    Kind::Number => write!(self.block, "{number:?}"),
                    // Whole: without a decimal point.
                    Kind::Count => write!(self.block, "{number}"),
                    Kind::Words(words) => self.block.write_str(&csv_field(word(words, *number))),
                };
            }
            self.block.push('\n');
        }
        self.flush()
    }

    fn finish(self: Box<Self>) -> io::Result<File> {
        Ok(self.file)
    }
}
