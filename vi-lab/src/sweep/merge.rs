//! Merges parts into tables.
//!
//! In: the parts of a sweep. Out: its tables, with the rows in the order of the runs. So they are the same bytes however the sweep was divided.

use super::part::{Description, Part};
use super::sink::{Format, Target};
use clap::Args;
use std::path::{Path, PathBuf};
use vi_report::failure::Failure;

/// Names in a message.
const MOST_NAMES: usize = 5;

/// The command line of `vi-lab merge`.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
The parts must be all shards of one sweep, each with all its runs. Otherwise a message names what is wrong, the exit status is 2, and nothing is written. The parts stay.")]
pub(crate) struct Arguments {
    /// Folders that `vi-lab sweep --shard` has written
    #[arg(value_name = "PART", required = true)]
    parts: Vec<PathBuf>,
    /// File to write, .csv, .npy or .parquet; tables of series and sections go beside it
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

/// Merges parts, and returns a summary.
///
/// # Errors
/// [`Failure::Input`] if the parts are not all of one sweep or have changed, [`Failure::File`] if a file cannot be read or written.
pub(crate) fn merge(arguments: &Arguments) -> Result<String, Failure> {
    Format::of(&arguments.output)?;
    let mut parts: Vec<Part> = arguments.parts.iter().map(|folder| Part::open(folder)).collect::<Result<_, _>>()?;
    parts.sort_by_key(|part| part.heading.shard.index);
    check(&parts)?;
    write(&parts, &arguments.output)
}

/// Whether parts, in the order of their shards, are all of one sweep.
fn check(parts: &[Part]) -> Result<(), Failure> {
    let wrong = |message: String| Err(Failure::Input(message));
    let [first, ..] = parts else { return wrong("there are no parts".to_owned()) };
    let shown = |part: &Part| part.folder.display().to_string();
    let count = first.heading.shard.count;
    let mut previous: Option<&Part> = None;
    for part in parts {
        let (one, other, shard) = (shown(first), shown(part), part.heading.shard);
        if let Some((name, here, there)) = first.heading.sweep.difference(&part.heading.sweep) {
            return wrong(format!(
                "{one} and {other} are of different sweeps, by their {name}: {here} there, {there} here"
            ));
        }
        if shard.count != count {
            let first = first.heading.shard;
            return wrong(format!("{one} is shard {first} and {other} is shard {shard}: name shards I/{count} only"));
        }
        if let Some(previous) = previous.filter(|previous| previous.heading.shard == shard) {
            return wrong(format!("{} and {other} are both shard {shard}", shown(previous)));
        }
        previous = Some(part);
    }
    let is_there = |index: &u64| parts.binary_search_by_key(index, |part| part.heading.shard.index).is_ok();
    let missing: Vec<String> = (0..count)
        .filter(|index| !is_there(index))
        .take(MOST_NAMES + 1)
        .map(|index| format!("{index}/{count}"))
        .collect();
    if !missing.is_empty() {
        return wrong(format!("not all shards are there: {} missing", listed(&missing)));
    }
    let mut begun = Vec::new();
    for part in parts {
        let (present, chunks) = (part.present()?, part.heading.chunks());
        if present < chunks {
            begun.push(format!("{} has {present} of {chunks} chunks", shown(part)));
        }
    }
    if begun.is_empty() {
        return Ok(());
    }
    wrong(format!("not all runs are there: {}; `vi-lab sweep` goes on with them", listed(&begun)))
}

/// The first names.
fn listed(names: &[String]) -> String {
    let more = if names.len() > MOST_NAMES { ", …" } else { "" };
    names.iter().take(MOST_NAMES).map(String::as_str).collect::<Vec<_>>().join(", ") + more
}

/// Writes the tables of parts in the order of their shards, and returns a summary.
///
/// # Errors
/// [`Failure::Input`] if a part has changed, [`Failure::File`] if a file cannot be read or written.
pub(super) fn write(parts: &[Part], output: &Path) -> Result<String, Failure> {
    let Some(Description { schemas, items, .. }) = parts.first().map(|first| &first.heading.sweep) else {
        return Ok(String::new());
    };
    let description = &parts[0].heading.sweep;
    let mut targets = Vec::new();
    for (index, schema) in schemas.iter().enumerate() {
        // `study.series.csv` beside `study.csv`.
        let extension = output.extension().unwrap_or_default().to_string_lossy();
        let other = || output.with_extension(format!("{}.{extension}", schema.table));
        targets.push(Target::create(if index == 0 { output.to_owned() } else { other() }, description, schema)?);
    }
    let mut failed = 0;
    for part in parts {
        failed += part.read(&mut |table, row| targets[table].write(row))?;
    }
    // All or none: no table is replaced before all of them are on the disk.
    let files = targets.into_iter().map(Target::finish).collect::<Result<Vec<_>, _>>()?;
    for (path, file) in files {
        file.finish().map_err(|error| Failure::file(path, error))?;
    }
    Ok(summary(output, *items, failed))
}

/// What the command prints at the end.
pub(super) fn summary(path: &Path, runs: u64, failed: u64) -> String {
    let ended =
        if failed == 0 { "all reached their end".to_owned() } else { format!("{failed} did not reach their end") };
    let runs = if runs == 1 { "1 run".to_owned() } else { format!("{runs} runs") };
    format!("{}: {runs}, {ended}", path.display())
}
