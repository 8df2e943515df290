//! Rows as NPY, the array format of `NumPy`: float64, one row per node, row by row; beside it `FILE.npy.json`, which
//! says what made the file and what the columns are.
//!
//! Source: the format's version 1.0. The head has a fixed room, and gets the number of rows at the end, so that rows are
//! written as they come; until then it says 0.

use super::super::failure::Failure;
use super::super::machine::{VERSION, command_line};
use super::super::simulation::Row;
use super::{Request, Sink};
use serde_json::json;
use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Bytes before the numbers: magic, version, length of the head, head; a multiple of 64.
const ROOM: usize = 128;

/// An NPY file.
pub(super) struct Npy {
    path: PathBuf,
    writer: BufWriter<File>,
    rows: u64,
    columns: usize,
}

impl Npy {
    /// An NPY file, and the JSON file beside it.
    pub(super) fn create(path: &Path, request: &Request) -> Result<Self, Failure> {
        let plan = &request.plan;
        let columns = request.columns();
        let parameters: serde_json::Map<String, serde_json::Value> =
            request.system.parameters().into_iter().map(|(name, value)| (name.to_owned(), json!(value))).collect();
        let description = json!({
            "version": VERSION, "command": command_line(), "system": request.system.name(), "parameters": parameters,
            "method": plan.method_name(), "h": plan.h, "t": plan.t, "q": plan.q, "v": plan.v, "columns": columns,
        });
        let beside = PathBuf::from(format!("{}.json", path.display()));
        fs::write(&beside, format!("{description:#}\n")).map_err(|error| Failure::file(&beside, error))?;
        let file = File::create(path).map_err(|error| Failure::file(path, error))?;
        let mut npy = Self { path: path.to_owned(), writer: BufWriter::new(file), rows: 0, columns: columns.len() };
        let begun = npy.put_head();
        npy.checked(begun)?;
        Ok(npy)
    }

    fn put_head(&mut self) -> io::Result<()> {
        self.writer.write_all(&head(self.rows, self.columns))
    }

    fn checked(&self, outcome: io::Result<()>) -> Result<(), Failure> {
        outcome.map_err(|error| Failure::file(&self.path, error))
    }

    /// Puts the number of rows into the head.
    fn complete(&mut self) -> io::Result<()> {
        self.writer.seek(SeekFrom::Start(0))?;
        self.put_head()?;
        self.writer.flush()
    }
}

impl Sink for Npy {
    fn write(&mut self, row: &Row) -> Result<(), Failure> {
        let Row { t, q, p, energy, h } = row;
        let values = core::iter::once(t).chain(q).chain(p).chain([energy, h]);
        let bytes: Vec<u8> = values.flat_map(|value| value.to_le_bytes()).collect();
        self.rows += 1;
        let written = self.writer.write_all(&bytes);
        self.checked(written)
    }

    fn finish(&mut self) -> Result<(), Failure> {
        let completed = self.complete();
        self.checked(completed)
    }
}

/// Magic, version 1.0, length of the description, description padded with blanks to the fixed room.
fn head(rows: u64, columns: usize) -> Vec<u8> {
    let description = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}");
    // Ten bytes come before the description, and a line end closes it: its length is 118, which two bytes hold.
    let mut head = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    head.extend(description.as_bytes());
    head.resize(ROOM - 1, b' ');
    head.push(b'\n');
    head
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_head_fills_its_room_for_any_number_of_rows() {
        for rows in [0, 1000, u64::MAX] {
            let head = head(rows, 1024);
            assert_eq!(head.len(), ROOM);
            assert_eq!(usize::from(head[8]) + 256 * usize::from(head[9]) + 10, ROOM);
            assert_eq!(head.last(), Some(&b'\n'));
            let text = String::from_utf8_lossy(&head[10..]);
            assert!(text.contains(&format!("'shape': ({rows}, 1024), }}")), "{text}");
        }
    }
}
