//! Tables as files: CSV, NPY, and Parquet where the command is built with it.
//!
//! In: a [`Description`], and the numbers of a table row by row. Out: the file. AFTER A FAILURE what was at the place of the file is
//! there still: rows go to a file beside it, which takes the place when it is whole.

mod csv;
mod npy;
#[cfg(feature = "parquet")]
mod parquet;

use super::part::Description;
use super::shape::Shape;
use crate::place::{self, Temporary, beside};
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use vi_report::failure::Failure;

/// Where rows go.
trait Sink {
    /// Takes whole rows.
    fn write(&mut self, rows: &[f64]) -> io::Result<()>;
    /// Writes what is left, and gives the file back.
    fn finish(self: Box<Self>) -> io::Result<File>;
}

/// How a table is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    /// Text.
    Csv,
    /// An array of `NumPy`, and beside it a JSON file that says what is in it.
    Npy,
    /// Columns, each of its kind.
    #[cfg(feature = "parquet")]
    Parquet,
}

/// A table that is being written.
pub(super) struct Target {
    path: PathBuf,
    sink: Box<dyn Sink>,
    temporary: Temporary,
}

impl Format {
    /// That of a path, at which a file can be made.
    ///
    /// # Errors
    /// [`Failure::Input`] where there is no such format, or no file can be there.
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

impl Target {
    /// The table of a number of rows at a path.
    ///
    /// # Errors
    /// [`Failure::File`] where it cannot be made.
    pub(super) fn create(path: &Path, study: &Description, shape: &Shape, rows: u64) -> Result<Self, Failure> {
        let format = Format::of(path)?;
        let created = Temporary::create(path).and_then(|(temporary, file)| -> io::Result<(Temporary, Box<dyn Sink>)> {
            let sink: Box<dyn Sink> = match format {
                Format::Csv => Box::new(csv::Csv::begin(file, study, shape)?),
                Format::Npy => {
                    place::replace(&beside(path, "json"), &npy::description(study, shape))?;
                    Box::new(npy::Npy::begin(file, shape, rows)?)
                }
                #[cfg(feature = "parquet")]
                Format::Parquet => Box::new(parquet::Parquet::begin(file, study, shape)?),
            };
            Ok((temporary, sink))
        });
        let (temporary, sink) = created.map_err(|error| Failure::file(path, error))?;
        Ok(Self { path: path.to_owned(), sink, temporary })
    }

    /// Takes whole rows.
    ///
    /// # Errors
    /// [`Failure::File`] where they cannot be written.
    pub(super) fn write(&mut self, rows: &[f64]) -> Result<(), Failure> {
        self.sink.write(rows).map_err(|error| Failure::file(&self.path, error))
    }

    /// Puts the file in its place.
    ///
    /// # Errors
    /// [`Failure::File`] where it cannot be written.
    pub(super) fn finish(self) -> Result<(), Failure> {
        let Self { path, sink, temporary } = self;
        let finished = sink.finish().and_then(|file| file.sync_all()).and_then(|()| temporary.finish());
        finished.map_err(|error| Failure::file(&path, error))
    }
}
