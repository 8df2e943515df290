//! Merges the chunks of a sweep into tables.
//!
//! The rows are in the order of the runs. So the tables have the same bytes for any division of the sweep.

use super::chunks::Chunks;
use super::sink::{Format, Target};
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
    /// Output file, .csv, .npy or .parquet; tables of series and sections are written beside it
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

/// Merges folders of chunks and returns a summary.
///
/// # Errors
/// [`Failure::Input`] if they do not contain all runs of one sweep, [`Failure::File`] if a file cannot be read or
/// written.
pub(crate) fn merge(arguments: &Arguments) -> Result<String, Failure> {
    Format::of(&arguments.output)?;
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
    let mut failed = 0;
    for number in 0..chunks {
        failed += source(&number).unwrap_or(first).read(number, &mut |table, row| targets[table].write(row))?;
    }
    // All or none: no table is replaced before all are on disk.
    let files = targets.into_iter().map(Target::finish).collect::<Result<Vec<_>, _>>()?;
    for (path, file) in files {
        file.finish().map_err(|error| Failure::file(path, error))?;
    }
    Ok(summary(output, description.items, failed))
}

/// The last line of output.
pub(super) fn summary(path: &Path, runs: u64, failed: u64) -> String {
    let ended =
        if failed == 0 { "all reached their end".to_owned() } else { format!("{failed} did not reach their end") };
    let runs = if runs == 1 { "1 run".to_owned() } else { format!("{runs} runs") };
    format!("{}: {runs}, {ended}", path.display())
}
