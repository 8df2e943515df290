//! Tables as files: CSV, NPY, and Parquet if the command is built with it.
//!
//! CSV contains the facts of the sweep as comments. NPY contains float64; words are indices of a list in a JSON file
//! beside it. Rows go to a temporary file, which replaces the target when complete. After a failed write the previous
//! file remains.

#[cfg(feature = "parquet")]
mod parquet;

use super::chunks::Description;
use super::schema::{ColumnKind, Schema};
use crate::npy;
use crate::place::{self, Temporary, with_extension};
use serde_json::{Map, Value, json};
use std::fs::File;
use std::io::{self, BufWriter, Seek as _, Write as _};
use std::path::{Path, PathBuf};
use vi_report::failure::Failure;

/// The format of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Csv,
    Npy,
    #[cfg(feature = "parquet")]
    Parquet,
}

/// A table during writing.
pub(super) struct Target<'a> {
    path: PathBuf,
    description: &'a Description,
    schema: &'a Schema,
    sink: TableSink,
    temporary: Temporary,
}

/// The file of a format.
enum TableSink {
    Csv(BufWriter<File>),
    /// With the number of rows so far.
    Npy(BufWriter<File>, u64),
    #[cfg(feature = "parquet")]
    Parquet(Box<parquet::Parquet>),
}

impl Format {
    /// The format for a path at which a file can be created.
    ///
    /// # Errors
    /// [`Failure::Input`] if there is no such format, or no file can be created.
    pub(super) fn of(path: &Path) -> Result<Self, Failure> {
        let shown = path.display();
        let extension = path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
        let format = match extension.as_deref() {
            Some("csv") => Self::Csv,
            Some("npy") => Self::Npy,
            #[cfg(feature = "parquet")]
            Some("parquet") => Self::Parquet,
            #[cfg(not(feature = "parquet"))]
            Some("parquet") => {
                let message = format!(
                    "`{shown}`: this command is built without Parquet; build vi-lab with its feature `parquet`"
                );
                return Err(Failure::Input(message));
            }
            _ => return Err(Failure::Input(format!("the output `{shown}` must end in .csv, .npy or .parquet"))),
        };
        place::check("output", path)?;
        if path.exists() && !path.is_file() {
            return Err(Failure::Input(format!("the output `{shown}` is a pipe or a device; name a file")));
        }
        Ok(format)
    }
}

impl<'a> Target<'a> {
    /// A new table: `study.csv` for the runs, `study.series.csv` beside it for their series.
    ///
    /// # Errors
    /// [`Failure::File`] if it cannot be created.
    pub(super) fn create(output: &Path, description: &'a Description, schema: &'a Schema) -> Result<Self, Failure> {
        let extension = output.extension().unwrap_or_default().to_string_lossy();
        let beside_it = || output.with_extension(format!("{}.{extension}", schema.table));
        let path = if schema.table == "runs" { output.to_owned() } else { beside_it() };
        let format = Format::of(&path)?;
        let created = Temporary::create(&path).and_then(|(temporary, file)| {
            let mut buffer = BufWriter::with_capacity(1 << 16, file.try_clone()?);
            let sink = match format {
                Format::Csv => {
                    for (name, fact) in &description.facts {
                        writeln!(buffer, "# {name}: {fact}")?;
                    }
                    writeln!(buffer, "# runs: {}\n{}", description.items, schema.heading())?;
                    TableSink::Csv(buffer)
                }
                Format::Npy => {
                    // The number of rows is known at the end. Every header has the same length.
                    buffer.write_all(&npy::head(0, schema.columns.len()))?;
                    TableSink::Npy(buffer, 0)
                }
                #[cfg(feature = "parquet")]
                Format::Parquet => TableSink::Parquet(Box::new(parquet::Parquet::begin(file, description, schema)?)),
            };
            Ok((temporary, sink))
        });
        let (temporary, sink) = created.map_err(|error| Failure::file(&path, error))?;
        Ok(Self { path, description, schema, sink, temporary })
    }

    /// Adds a row.
    ///
    /// # Errors
    /// [`Failure::File`] if it cannot be written.
    pub(super) fn write(&mut self, row: &[f64]) -> Result<(), Failure> {
        let written = match &mut self.sink {
            TableSink::Csv(file) => {
                let mut text = String::new();
                self.schema.write(row, &mut text);
                file.write_all(text.as_bytes())
            }
            TableSink::Npy(file, rows) => {
                *rows += 1;
                row.iter().try_for_each(|number| file.write_all(&number.to_le_bytes()))
            }
            #[cfg(feature = "parquet")]
            TableSink::Parquet(file) => file.write(row),
        };
        written.map_err(|error| Failure::file(&self.path, error))
    }

    /// Completes the file, which [`Temporary::finish`] then moves to its target.
    ///
    /// # Errors
    /// [`Failure::File`] if it cannot be written.
    pub(super) fn finish(self) -> Result<(PathBuf, Temporary), Failure> {
        let Self { path, description, schema, sink, temporary } = self;
        let finish = || -> io::Result<()> {
            let file = match sink {
                TableSink::Csv(file) => file.into_inner()?,
                TableSink::Npy(file, rows) => {
                    let mut file = file.into_inner()?;
                    file.rewind()?;
                    file.write_all(&npy::head(rows, schema.columns.len()))?;
                    place::replace(&with_extension(&path, "json"), &legend(description, schema))?;
                    file
                }
                #[cfg(feature = "parquet")]
                TableSink::Parquet(file) => file.finish()?,
            };
            file.sync_all()
        };
        match finish() {
            Ok(()) => Ok((path, temporary)),
            Err(error) => Err(Failure::file(&path, error)),
        }
    }
}

/// The JSON of an NPY file: facts, columns, and the words of word columns.
fn legend(description: &Description, schema: &Schema) -> String {
    let facts: Map<String, Value> = description.facts.iter().map(|(name, fact)| (name.clone(), json!(fact))).collect();
    let columns: Vec<&str> = schema.columns.iter().map(|column| column.name.as_str()).collect();
    let mut words = Map::new();
    for column in &schema.columns {
        if let ColumnKind::Words(list) = &column.kind {
            words.insert(column.name.clone(), json!(list));
        }
    }
    format!("{:#}\n", json!({ "sweep": facts, "runs": description.items, "columns": columns, "words": words }))
}
