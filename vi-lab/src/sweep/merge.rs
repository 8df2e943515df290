//! Parts put together.
//!
//! In: the parts of a sweep. Out: its tables: first the rows of shard 0, then those of shard 1, and so on, each in the order of its chunks, which is that of
//! the runs; so they are the same bytes however the sweep was divided.

use super::part::Part;
use super::sink::{Format, Target};
use clap::Args;
use std::fs;
use std::path::{Path, PathBuf};
use vi_report::failure::Failure;

/// Names in a message.
const MOST_NAMES: usize = 5;

/// The command line of `vi-lab merge`.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
The parts must be all shards of one sweep, each of them whole. What is wrong with them is told, with exit status 2, and nothing is written. The parts stay.")]
pub(crate) struct Arguments {
    /// Parts that `vi-lab sweep --shard` has written
    #[arg(value_name = "PART", required = true)]
    parts: Vec<PathBuf>,
    /// File to write, .csv, .npy or .parquet; tables of series and sections go beside it
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

/// Puts parts together, and says what came of it.
///
/// # Errors
/// [`Failure::Input`] where the parts are not all of one sweep, [`Failure::File`] where a file cannot be read or written.
pub(crate) fn merge(arguments: &Arguments) -> Result<String, Failure> {
    Format::of(&arguments.output)?;
    let mut parts: Vec<Part> = arguments.parts.iter().map(|path| Part::read(path)).collect::<Result<_, _>>()?;
    parts.sort_by_key(|part| part.heading().shard.index);
    check(&parts).map_err(Failure::Input)?;
    write(&parts, &arguments.output)
}

/// Whether the parts are all of one sweep.
fn check(parts: &[Part]) -> Result<(), String> {
    let Some(first) = parts.first() else { return Err("there are no parts".to_owned()) };
    let count = first.heading().shard.count;
    let shown = |part: &Part| part.path().display().to_string();
    for part in parts {
        if let Some((name, here, there)) = first.heading().study.difference(&part.heading().study) {
            return Err(format!(
                "{} and {} are of different sweeps, by their {name}: {here} there, {there} here",
                shown(first),
                shown(part)
            ));
        }
        if part.heading().shard.count != count {
            let (one, other) = (first.heading().shard, part.heading().shard);
            return Err(format!(
                "{} is shard {one} and {} is shard {other}: the parts of a sweep are one of as many",
                shown(first),
                shown(part)
            ));
        }
    }
    for pair in parts.windows(2) {
        if pair[0].heading().shard == pair[1].heading().shard {
            return Err(format!(
                "{} and {} are both shard {}",
                shown(&pair[0]),
                shown(&pair[1]),
                pair[0].heading().shard
            ));
        }
    }
    let is_there = |index: &u64| parts.binary_search_by_key(index, |part| part.heading().shard.index).is_ok();
    let missing: Vec<String> = (0..count)
        .filter(|index| !is_there(index))
        .take(MOST_NAMES + 1)
        .map(|index| format!("{index}/{count}"))
        .collect();
    if !missing.is_empty() {
        return Err(format!("not all shards are there: {} missing", listed(&missing)));
    }
    let begun: Vec<String> = parts.iter().filter(|part| !part.missing().is_empty()).map(unfinished).collect();
    if begun.is_empty() {
        Ok(())
    } else {
        Err(format!("not all runs are there: {}; `vi-lab sweep` goes on with them", listed(&begun)))
    }
}

/// How far a part came.
fn unfinished(part: &Part) -> String {
    let chunks = part.heading().chunks();
    let done = chunks - part.missing().len() as u64;
    format!("{} has {done} of {chunks} chunks", part.path().display())
}

/// Some names.
fn listed(names: &[String]) -> String {
    let more = if names.len() > MOST_NAMES { ", …" } else { "" };
    names.iter().take(MOST_NAMES).map(String::as_str).collect::<Vec<_>>().join(", ") + more
}

/// Writes the tables of parts that are whole and in their order, and says what is in them.
///
/// # Errors
/// [`Failure::File`] where a file cannot be read or written.
pub(super) fn write(parts: &[Part], output: &Path) -> Result<String, Failure> {
    let Some(first) = parts.first() else { return Ok(String::new()) };
    let study = &first.heading().study;
    let mut targets = Vec::new();
    for (table, shape) in study.shapes.iter().enumerate() {
        let rows = parts.iter().map(|part| part.rows(table)).sum();
        let mut target = Target::create(&named(output, &shape.suffix), study, shape, rows)?;
        for numbers in parts.iter().flat_map(|part| part.table(table)) {
            target.write(&numbers?)?;
        }
        targets.push(target);
    }
    targets.into_iter().try_for_each(Target::finish)?;
    Ok(summary(output, study.items, parts.iter().map(Part::failed).sum()))
}

/// What a user is told at the end.
pub(super) fn summary(path: &Path, runs: u64, failed: u64) -> String {
    let ended =
        if failed == 0 { "all reached their end".to_owned() } else { format!("{failed} did not reach their end") };
    let runs = if runs == 1 { "1 run".to_owned() } else { format!("{runs} runs") };
    format!("{}: {runs}, {ended}", path.display())
}

/// The file of a table: `study.series.csv` beside `study.csv`.
fn named(output: &Path, suffix: &str) -> PathBuf {
    let extension = output.extension().unwrap_or_default().to_string_lossy();
    if suffix.is_empty() { output.to_owned() } else { output.with_extension(format!("{suffix}.{extension}")) }
}

/// Removes a part whose rows stand in tables.
///
/// # Errors
/// [`Failure::File`] where it cannot be removed.
pub(super) fn remove(part: &Path) -> Result<(), Failure> {
    fs::remove_file(part).map_err(|error| Failure::file(part, error))
}
