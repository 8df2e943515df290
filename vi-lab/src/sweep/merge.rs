//! Merges the chunks of a sweep into tables, CSV files with the facts of the sweep as comments at the start.
//!
//! The rows are in the order of the runs. So the tables have the same bytes for any division of the sweep. Rows go to
//! temporary files, which replace the targets when all are complete. After a failure the previous files remain.

use super::chunks::{Chunks, Description, TABLES, Tally};
use super::keep::STEP_ERROR;
use crate::place::{self, Temporary};
use crate::run::POOR;
use clap::Args;
use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};
use vi_report::failure::Failure;

/// The command line of `vi-lab merge`.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
The folders must belong to one sweep and together contain all its runs. Otherwise the exit status is 2, with a message, and nothing is written. The folders are not removed.")]
pub(crate) struct Arguments {
    /// Folders of chunks written by `vi-lab sweep --shard`
    #[arg(value_name = "FILE.part", required = true)]
    folders: Vec<PathBuf>,
    /// CSV file; tables of series and sections are written beside it
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

/// Merges folders of chunks and returns a summary.
///
/// # Errors
/// [`Failure::Input`] if they do not contain all runs of one sweep, [`Failure::File`] if a file cannot be read or
/// written.
pub(crate) fn merge(arguments: &Arguments) -> Result<String, Failure> {
    check_output(&arguments.output)?;
    let folders = arguments.folders.iter().map(|folder| Chunks::open(folder)).collect::<Result<Vec<_>, _>>()?;
    let Some(first) = folders.first() else { return Ok(String::new()) };
    for other in &folders {
        if let Some(difference) = other.description.difference(&first.description) {
            let [first, other] = [first, other].map(|chunks| chunks.folder.display());
            return Err(Failure::Input(format!("{other} belongs to another sweep than {first}: {difference}")));
        }
    }
    write(first, &folders, &arguments.output)
}

/// Writes the tables of a sweep from its chunks and returns a summary.
///
/// # Errors
/// [`Failure::Input`] if a chunk is missing or was changed, [`Failure::File`] if a file cannot be read or written.
pub(super) fn write(first: &Chunks, folders: &[Chunks], output: &Path) -> Result<String, Failure> {
    let description = &first.description;
    let chunks = description.chunks();
    let source = |number: &u64| folders.iter().find(|folder| folder.has(*number));
    if let Some(missing) = (0..chunks).find(|number| source(number).is_none()) {
        let runs = description.runs(&(missing..missing + 1));
        let (first, last) = (runs.start, runs.end - 1);
        return Err(Failure::Input(format!(
            "chunk {missing} of {chunks} is missing, runs {first} to {last}; `vi-lab sweep` computes it"
        )));
    }
    let mut targets = Vec::new();
    for (table, heading) in TABLES.into_iter().zip(&description.headings) {
        targets
            .extend(heading.as_ref().map(|heading| Target::create(output, description, table, heading)).transpose()?);
    }
    let mut tally = Tally::default();
    for number in 0..chunks {
        tally += source(&number).unwrap_or(first).read(number, &mut |table, row| {
            targets.iter_mut().find(|target| target.table == table).map_or(Ok(()), |target| target.write(row))
        })?;
    }
    let files = targets.into_iter().map(Target::finish).collect::<Result<Vec<_>, _>>()?;
    for (path, file) in files {
        file.finish().map_err(|error| Failure::file(path, error))?;
    }
    Ok(summary(output, description.items, tally))
}

/// The last line of output.
pub(super) fn summary(path: &Path, runs: u64, Tally { failed, inaccurate }: Tally) -> String {
    let runs = if runs == 1 { "1 run".to_owned() } else { format!("{runs} runs") };
    let ended = match failed {
        0 => "all reached their end".to_owned(),
        _ => format!("{failed} did not reach their end"),
    };
    let warning = match inaccurate {
        0 => String::new(),
        poor => format!("; warning: {poor} have a step with an error above {POOR}, see `{STEP_ERROR}`"),
    };
    format!("{}: {runs}, {ended}{warning}", path.display())
}

/// Checks that tables can be created at a path.
///
/// # Errors
/// [`Failure::Input`] if it does not end in .csv, or no file can be created.
pub(super) fn check_output(path: &Path) -> Result<(), Failure> {
    place::check_csv(path)?;
    if path.exists() && !path.is_file() {
        let shown = path.display();
        return Err(Failure::Input(format!("the output `{shown}` is a pipe or a device; name a file")));
    }
    Ok(())
}

/// A table during writing.
struct Target {
    table: &'static str,
    path: PathBuf,
    file: BufWriter<File>,
    temporary: Temporary,
}

impl Target {
    /// A new table: `study.csv` for the runs, `study.series.csv` beside it for their series.
    ///
    /// # Errors
    /// [`Failure::Input`] if no file can be created there, [`Failure::File`] if creating it fails.
    fn create(output: &Path, description: &Description, table: &'static str, heading: &str) -> Result<Self, Failure> {
        let extension = output.extension().unwrap_or_default().to_string_lossy();
        let beside_it = || output.with_extension(format!("{table}.{extension}"));
        let path = if table == TABLES[0] { output.to_owned() } else { beside_it() };
        check_output(&path)?;
        let created = Temporary::create(&path).and_then(|(temporary, file)| {
            let mut file = BufWriter::with_capacity(1 << 16, file);
            for (name, fact) in &description.facts {
                writeln!(file, "# {name}: {fact}")?;
            }
            writeln!(file, "# runs: {}\n{heading}", description.items)?;
            Ok((temporary, file))
        });
        let (temporary, file) = created.map_err(|error| Failure::file(&path, error))?;
        Ok(Self { table, path, file, temporary })
    }

    /// Adds a row, with its line end.
    fn write(&mut self, row: &str) -> Result<(), Failure> {
        self.file.write_all(row.as_bytes()).map_err(|error| Failure::file(&self.path, error))
    }

    /// Completes the file, which [`Temporary::finish`] then moves to its target.
    fn finish(self) -> Result<(PathBuf, Temporary), Failure> {
        let Self { path, file, temporary, .. } = self;
        let written = file.into_inner().map_err(io::IntoInnerError::into_error).and_then(|file| file.sync_all());
        written.map_err(|error| Failure::file(&path, error))?;
        Ok((path, temporary))
    }
}
