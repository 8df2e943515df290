//! Tables as CSV files.
//!
//! The facts of the sweep are comments at the start. Rows go to a temporary file, which replaces the target when
//! complete. After a failed write the previous file remains.

use super::chunks::Description;
use super::schema::Schema;
use crate::place::{self, Temporary};
use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};
use vi_report::failure::Failure;

/// A table during writing.
pub(super) struct Target<'a> {
    path: PathBuf,
    schema: &'a Schema,
    file: BufWriter<File>,
    temporary: Temporary,
}

/// Checks that tables can be created at a path.
///
/// # Errors
/// [`Failure::Input`] if it does not end in .csv, or no file can be created.
pub(super) fn check(path: &Path) -> Result<(), Failure> {
    place::check_csv(path)?;
    if path.exists() && !path.is_file() {
        let shown = path.display();
        return Err(Failure::Input(format!("the output `{shown}` is a pipe or a device; name a file")));
    }
    Ok(())
}

impl<'a> Target<'a> {
    /// A new table: `study.csv` for the runs, `study.series.csv` beside it for their series.
    ///
    /// # Errors
    /// [`Failure::Input`] if no file can be created there, [`Failure::File`] if creating it fails.
    pub(super) fn create(output: &Path, description: &Description, schema: &'a Schema) -> Result<Self, Failure> {
        let extension = output.extension().unwrap_or_default().to_string_lossy();
        let beside_it = || output.with_extension(format!("{}.{extension}", schema.table));
        let path = if schema.table == "runs" { output.to_owned() } else { beside_it() };
        check(&path)?;
        let created = Temporary::create(&path).and_then(|(temporary, file)| {
            let mut file = BufWriter::with_capacity(1 << 16, file);
            for (name, fact) in &description.facts {
                writeln!(file, "# {name}: {fact}")?;
            }
            writeln!(file, "# runs: {}\n{}", description.items, schema.heading())?;
            Ok((temporary, file))
        });
        let (temporary, file) = created.map_err(|error| Failure::file(&path, error))?;
        Ok(Self { path, schema, file, temporary })
    }

    /// Adds a row.
    ///
    /// # Errors
    /// [`Failure::File`] if it cannot be written.
    pub(super) fn write(&mut self, row: &[f64]) -> Result<(), Failure> {
        let mut text = String::new();
        self.schema.write(row, &mut text);
        self.file.write_all(text.as_bytes()).map_err(|error| Failure::file(&self.path, error))
    }

    /// Completes the file, which [`Temporary::finish`] then moves to its target.
    ///
    /// # Errors
    /// [`Failure::File`] if it cannot be written.
    pub(super) fn finish(self) -> Result<(PathBuf, Temporary), Failure> {
        let Self { path, file, temporary, .. } = self;
        let written = file.into_inner().map_err(std::io::IntoInnerError::into_error);
        match written.and_then(|file| file.sync_all()) {
            Ok(()) => Ok((path, temporary)),
            Err(error) => Err(Failure::file(&path, error)),
        }
    }
}
