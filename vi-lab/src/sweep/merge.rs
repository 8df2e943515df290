//! Merges the chunks of a sweep into tables.
//!
//! The rows are in the order of the runs. So the tables have the same bytes for any division of the sweep.

use super::chunks::{Chunks, Description};
use super::keep::STEP_ERROR;
use super::sink::{self, Target};
use crate::run::POOR;
use clap::Args;
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
    sink::check(&arguments.output)?;
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
    for schema in &description.schemas {
        targets.push(Target::create(output, description, schema)?);
    }
    let mut tally = Tally::of(description, description.items);
    for number in 0..chunks {
        let chunk = source(&number).unwrap_or(first);
        tally.failed += chunk.read(number, &mut |table, row| {
            tally.inaccurate.count(table, row);
            targets[table].write(row)
        })?;
    }
    // All or none: no table is replaced before all are on disk.
    let files = targets.into_iter().map(Target::finish).collect::<Result<Vec<_>, _>>()?;
    for (path, file) in files {
        file.finish().map_err(|error| Failure::file(path, error))?;
    }
    Ok(tally.summary(output))
}

/// The numbers of runs, of failed runs and of inaccurate runs.
pub(super) struct Tally {
    runs: u64,
    /// Those that did not reach their end.
    pub(super) failed: u64,
    pub(super) inaccurate: Inaccurate,
}

/// Runs with a step whose error exceeds [`POOR`].
pub(super) struct Inaccurate {
    /// The column with the largest error of a step.
    column: Option<usize>,
    runs: u64,
}

impl Inaccurate {
    /// Counts the row of a run.
    pub(super) fn count(&mut self, table: usize, row: &[f64]) {
        let error = self.column.filter(|_| table == 0).and_then(|column| row.get(column));
        self.runs += u64::from(error.is_some_and(|error| *error > POOR));
    }
}

impl Tally {
    /// No failed runs yet, of this number.
    pub(super) fn of(description: &Description, runs: u64) -> Self {
        let columns = description.schemas.first().map(|schema| &schema.columns);
        let column = columns.and_then(|columns| columns.iter().position(|column| column.name == STEP_ERROR));
        Self { runs, failed: 0, inaccurate: Inaccurate { column, runs: 0 } }
    }

    /// The last line of output.
    pub(super) fn summary(&self, path: &Path) -> String {
        let Self { runs, failed, inaccurate, .. } = self;
        let ended = match failed {
            0 => "all reached their end".to_owned(),
            _ => format!("{failed} did not reach their end"),
        };
        let warning = match inaccurate.runs {
            0 => String::new(),
            poor => format!("; warning: {poor} have a step with an error above {POOR}, see `{STEP_ERROR}`"),
        };
        let runs = if *runs == 1 { "1 run".to_owned() } else { format!("{runs} runs") };
        format!("{}: {runs}, {ended}{warning}", path.display())
    }
}
