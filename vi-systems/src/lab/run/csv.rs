//! Rows as CSV: comment lines that say what made the file, the names of the columns, one line per node.
//!
//! Numbers are the shortest that read back to the same bits.

use super::super::failure::Failure;
use super::super::machine::{VERSION, command_line};
use super::super::simulation::Row;
use super::super::table::csv_field;
use super::{Request, Sink};
use core::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// A CSV file, or standard output.
pub(super) struct Csv {
    name: String,
    writer: BufWriter<Box<dyn Write>>,
    line: String,
}

impl Csv {
    /// CSV on standard output.
    pub(super) fn standard_output(request: &Request) -> Result<Self, Failure> {
        Self::begin("standard output".to_owned(), Box::new(io::stdout()), request)
    }

    /// A CSV file.
    pub(super) fn create(path: &Path, request: &Request) -> Result<Self, Failure> {
        let file = File::create(path).map_err(|error| Failure::file(path, error))?;
        Self::begin(path.display().to_string(), Box::new(file), request)
    }

    fn begin(name: String, target: Box<dyn Write>, request: &Request) -> Result<Self, Failure> {
        let mut csv = Self { name, writer: BufWriter::new(target), line: String::new() };
        let columns: Vec<String> = request.columns().iter().map(|column| csv_field(column)).collect();
        let head = format!("{}{}\n", head(request), columns.join(","));
        csv.put(&head)?;
        Ok(csv)
    }

    fn put(&mut self, text: &str) -> Result<(), Failure> {
        self.writer.write_all(text.as_bytes()).map_err(|error| Failure::file(&self.name, error))
    }
}

/// What made the file, in comment lines.
fn head(request: &Request) -> String {
    let plan = &request.plan;
    let parameters: Vec<String> =
        request.system.parameters().iter().map(|(name, value)| format!("{name} = {value}")).collect();
    format!(
        "# vi-lab {VERSION}\n# command: {}\n# system: {}\n# parameters: {}\n# method: {}, h = {}, t = {}, q = {:?}, v = {:?}\n",
        command_line(),
        request.system.name(),
        parameters.join(", "),
        plan.method_name(),
        plan.h,
        plan.t,
        plan.q,
        plan.v
    )
}

impl Sink for Csv {
    fn write(&mut self, row: &Row) -> Result<(), Failure> {
        let Row { t, q, p, energy, h } = row;
        let mut line = core::mem::take(&mut self.line);
        line.clear();
        // Writing to a string cannot fail.
        let _ = write!(line, "{t:?}");
        for value in q.iter().chain(p).chain([energy, h]) {
            let _ = write!(line, ",{value:?}");
        }
        line.push('\n');
        self.put(&line)?;
        self.line = line;
        Ok(())
    }

    fn finish(&mut self) -> Result<(), Failure> {
        self.writer.flush().map_err(|error| Failure::file(&self.name, error))
    }
}
