//! `vi-lab sweep` and `vi-lab merge`: many runs of one scene, on all cores and on many machines.
//!
//! In: a scene with a table `[sweep]`. Out: a table with a row per run and, on request, tables of nodes and of
//! crossings of a section. A process computes chunks of runs; a chunk file exists only when complete. So the same
//! command resumes after any interruption. The number k determines run k, so the tables have the same bytes for any
//! division of the work.
//!
//! | module | contents |
//! |---|---|
//! | [`scene`] | the table in the scene file |
//! | [`axis`], [`random`], [`items`] | the runs |
//! | [`keep`] | results of each run, and their columns |
//! | [`study`], [`outcome`] | from a run to rows |
//! | [`shard`], [`crew`], [`chunks`] | the chunks of this process, its threads, their files |
//! | [`merge`] | from chunks to tables |

mod axis;
mod chunks;
mod crew;
pub(crate) mod items;
mod keep;
pub(crate) mod merge;
mod outcome;
mod random;
pub(crate) mod scene;
mod shard;
mod study;

use crate::place::{sync_folder, with_extension};
use chunks::{Chunks, Tally};
use clap::Args;
use shard::Shard;
use std::path::PathBuf;
use std::sync::Arc;
use std::{env, fs, slice};
use study::Study;
use vi_report::catalogue::Catalogue;
use vi_report::failure::Failure;

/// The command line of `vi-lab sweep`.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Scene: the entries of a run, and a table [sweep]: `over`, the quantities that vary from run to run; `samples` and `seed` for random ones; `keep`; `section`. \
docs/cluster.md describes them.

Columns: item, the number of the run; the quantities of `over`; with keep = [\"ending\"] ending and steps; \"accuracy\" step_error, \
the largest error of a step relative to the motion of its coordinate; \"end\" the last node as end_t, end_ coordinates and momenta, end_H, end_E, \
end_h; \"extremes\" min_ and max_ of the coordinates and of H over all nodes; \"energy\" error_H and error_E, the largest deviations of H and E from their first values. \
\"series\" writes FILE.series.csv with every Nth node of each run (`every` of the scene), `section` FILE.section.csv with its crossings; both begin with the item. `vi-lab run \
SCENE --item K` computes run K only.

A failed run is recorded, and the sweep continues. The folder FILE.part contains the chunks of finished runs; after an interruption the same command resumes from them. \
Shards share this folder; `vi-lab merge` writes FILE from it.

Exit status: 0 all runs were computed, including failed ones; 1 a file failed; 2 the input is wrong; 130 and 143 the sweep was interrupted (SIGINT, SIGTERM).")]
pub(crate) struct Arguments {
    /// Scene file with a table [sweep]
    #[arg(value_name = "SCENE.toml")]
    scene: String,
    /// CSV file
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Compute only the chunks of share I of N equal shares, I from 0; with only N, I is the index of the array task
    /// [default: that of a Slurm array]
    #[arg(long, value_name = "I/N", allow_hyphen_values = true)]
    shard: Option<String>,
}

/// Runs a scene with its sweep and returns a summary.
///
/// # Errors
/// [`Failure::Input`] for wrong input, [`Failure::File`] if a file cannot be read or written, [`Failure::Interrupted`] after a signal.
pub(crate) fn sweep(arguments: &Arguments, catalogue: &Catalogue) -> Result<String, Failure> {
    let Arguments { scene, output, shard } = arguments;
    let shard = Shard::of(shard.as_deref(), |name| env::var(name).ok())?;
    let study = Study::read(scene, catalogue)?;
    merge::check_output(output)?;
    let folder = with_extension(output, "part");
    let chunks = Arc::new(Chunks::resume(&folder, study.description(), shard.is_none())?);
    let numbers = shard.unwrap_or(Shard::WHOLE).chunks(chunks.description.chunks());
    crew::work(study, &chunks, &numbers)?;
    if shard.is_some() {
        sync_folder(&folder);
        let runs = chunks.description.runs(&numbers);
        let mut tally = Tally::default();
        for number in numbers {
            tally += chunks.read(number, &mut |_, _| Ok(()))?;
        }
        return Ok(merge::summary(&folder, runs.end - runs.start, tally));
    }
    let summary = merge::write(&chunks, slice::from_ref(&*chunks), output)?;
    // Chunks are removed after the tables are on disk.
    sync_folder(output.parent().unwrap_or(output));
    fs::remove_dir_all(&folder).map_err(|error| Failure::file(&folder, error))?;
    Ok(summary)
}
