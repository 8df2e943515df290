//! Rows as NPY, the array format of `NumPy`: float64, one row per node. `FILE.npy.json` beside it describes the origin
//! of the file and its columns. A missing value is NaN.
//!
//! AFTER A BLOCK IS WRITTEN the header, which has a fixed size, contains the number of rows in the file, even if the
//! run ends.

use super::{BLOCK, Request, Sink, energies, method};
use crate::npy::{HEADER_BYTES, head};
use crate::place;
use serde_json::json;
use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use vi_erased::simulation::Row;
use vi_report::failure::Failure;
use vi_report::machine::{VERSION, command_line};

/// An NPY file.
pub(super) struct Npy {
    path: PathBuf,
    file: File,
    columns: usize,
    /// Rows in the file.
    rows: u64,
    /// Complete rows to be written.
    block: Vec<u8>,
}

impl Npy {
    /// An NPY file, and its JSON file.
    pub(super) fn create(path: &Path, request: &Request) -> Result<Self, Failure> {
        let file = File::create(path).map_err(|error| Failure::file(path, error))?;
        let mut npy =
            Self { path: path.to_owned(), file, columns: request.columns().len(), rows: 0, block: Vec::new() };
        npy.flush()?;
        let description = format!("{:#}\n", description(request));
        let json = place::with_extension(path, "json");
        place::replace(&json, &description).map_err(|error| Failure::file(&json, error))?;
        Ok(npy)
    }

    /// Writes the block, then the number of rows in the header.
    fn flush(&mut self) -> Result<(), Failure> {
        let width = wide(8 * self.columns);
        let end = wide(HEADER_BYTES) + self.rows * width;
        let rows = self.rows + wide(self.block.len()) / width;
        let written = put(&mut self.file, end, &self.block);
        if let Err(error) = written.and_then(|()| put(&mut self.file, 0, &head(rows, self.columns))) {
            // The header counts the rows so far; a partial row after them is cut off, or is harmless.
            let _ = self.file.set_len(end);
            self.block.clear();
            return Err(Failure::file(&self.path, error));
        }
        self.rows = rows;
        self.block.clear();
        Ok(())
    }
}

/// A number of bytes in memory as one in a file.
fn wide(bytes: usize) -> u64 {
    u64::try_from(bytes).unwrap_or(u64::MAX)
}

/// Writes bytes at a position of a file.
fn put(file: &mut File, place: u64, bytes: &[u8]) -> io::Result<()> {
    file.seek(SeekFrom::Start(place))?;
    file.write_all(bytes)
}

/// The origin of the file, and its columns.
fn description(request: &Request) -> serde_json::Value {
    let Request { system, plan, every, .. } = request;
    let parameters: serde_json::Map<String, serde_json::Value> =
        system.parameters().into_iter().map(|(name, value)| (name.to_owned(), json!(value))).collect();
    json!({
        "version": VERSION, "command": command_line(), "system": system.name(), "parameters": parameters,
        "method": method::in_words(plan), "h": plan.h, "t": plan.t, "q": plan.q, "v": plan.v, "every": every,
        "columns": request.columns(), "energies": energies(system.as_ref(), plan),
    })
}

impl Sink for Npy {
    fn write(&mut self, row: &Row) -> Result<(), Failure> {
        self.block.extend(row.entries().flat_map(|entry| entry.unwrap_or(f64::NAN).to_le_bytes()));
        if self.block.len() < BLOCK { Ok(()) } else { self.flush() }
    }

    fn finish(&mut self) -> Result<(), Failure> {
        self.flush()
    }
}
