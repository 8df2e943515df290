//! Rows as CSV: comment lines with the origin of the file, the names of the columns, one line per node.
//!
//! Numbers have the fewest digits that read back to the same bits; a missing value is an empty entry. After each block
//! the file consists of complete lines, even if the run ends.

use super::{BLOCK, Request, Sink, energies, method};
use core::fmt::Write as _;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use vi_erased::simulation::Row;
use vi_report::failure::Failure;
use vi_report::machine::{VERSION, command_line};
use vi_report::numbers::{assigned, short};
use vi_report::table::csv_field;

/// A CSV file, or standard output.
pub(super) struct Csv {
    target: Target,
    /// Complete lines to be written.
    block: String,
}

/// The destination of lines.
enum Target {
    StandardOutput,
    /// A file, with the length of its complete lines.
    File {
        path: PathBuf,
        file: File,
        length: u64,
    },
}

impl Csv {
    /// CSV on standard output.
    pub(super) fn standard_output(request: &Request) -> Self {
        Self { target: Target::StandardOutput, block: head(request) }
    }

    /// A CSV file.
    pub(super) fn create(path: &Path, request: &Request) -> Result<Self, Failure> {
        let file = File::create(path).map_err(|error| Failure::file(path, error))?;
        Ok(Self { target: Target::File { path: path.to_owned(), file, length: 0 }, block: head(request) })
    }

    /// Writes the block.
    fn flush(&mut self) -> Result<(), Failure> {
        if self.block.is_empty() {
            // After a failure the block is lost, and the failure is reported.
            return Ok(());
        }
        let block = core::mem::take(&mut self.block);
        self.target.put(block.as_bytes())?;
        self.block = block;
        self.block.clear();
        Ok(())
    }
}

impl Target {
    fn put(&mut self, lines: &[u8]) -> Result<(), Failure> {
        match self {
            Self::StandardOutput => {
                let mut output = io::stdout().lock();
                output.write_all(lines).and_then(|()| output.flush()).map_err(Failure::standard_output)
            }
            Self::File { path, file, length } => {
                if let Err(error) = file.write_all(lines) {
                    // A part of a number would read as another number. A pipe cannot be truncated.
                    let _ = file.set_len(*length);
                    return Err(Failure::file(path, error));
                }
                *length += u64::try_from(lines.len()).unwrap_or(u64::MAX);
                Ok(())
            }
        }
    }
}

/// The origin of the file in comment lines, and the names of the columns.
fn head(request: &Request) -> String {
    let Request { system, plan, every, .. } = request;
    let columns: Vec<String> = request.columns().iter().map(|column| csv_field(column)).collect();
    let rows = if *every == 1 { "every node".to_owned() } else { format!("one node in {every}, and the last") };
    format!(
        "# vi-lab {VERSION}\n# command: {}\n# system: {}\n# parameters: {}\n# method: {}, h = {}, t = {}, q = {:?}, v = {:?}\n\
         # rows: {rows}\n# {}\n{}\n",
        command_line(),
        system.name(),
        assigned(&system.parameters()),
        method::in_words(plan),
        short(plan.h),
        short(plan.t),
        plan.q,
        plan.v,
        energies(system.as_ref(), plan),
        columns.join(","),
    )
}

impl Sink for Csv {
    fn write(&mut self, row: &Row) -> Result<(), Failure> {
        line(&mut self.block, row);
        if self.block.len() < BLOCK { Ok(()) } else { self.flush() }
    }

    fn finish(&mut self) -> Result<(), Failure> {
        self.flush()
    }
}

/// Adds the line of a row.
fn line(block: &mut String, row: &Row) {
    // Writing to a string cannot fail.
    let _ = write!(block, "{:?}", row.t);
    entries(block, numbers(row).skip(1));
    block.push('\n');
}

/// The numbers of a row; NaN for missing ones.
pub(crate) fn numbers(row: &Row) -> impl Iterator<Item = f64> + '_ {
    row.entries().map(|entry| entry.unwrap_or(f64::NAN))
}

/// Adds numbers, each after a comma, with the fewest digits that read back to the same bits. NaN is an empty entry.
pub(crate) fn entries(text: &mut String, numbers: impl IntoIterator<Item = f64>) {
    for number in numbers {
        text.push(',');
        if !number.is_nan() {
            let _ = write!(text, "{number:?}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_without_a_value_is_empty() {
        let mut block = String::new();
        let row = Row {
            t: 0.0,
            q: vec![1.0],
            p: vec![-2.5],
            energy: Some(1e-300),
            discrete_energy: None,
            shifted_energy: None,
            constraints: None,
            h: 0.01,
        };
        line(&mut block, &row);
        let row = Row { energy: None, discrete_energy: Some(3.0), ..row };
        line(&mut block, &row);
        line(&mut block, &Row { shifted_energy: Some(2.0), ..row });
        assert_eq!(block, "0.0,1.0,-2.5,1e-300,,0.01\n0.0,1.0,-2.5,,3.0,0.01\n0.0,1.0,-2.5,,3.0,2.0,0.01\n");
    }
}
