//! `vi-lab sweep` and `vi-lab merge`: many runs of one scene, on all cores and on many machines.
//!
//! In: a scene with a table `[sweep]`. Out: a table with a row for each run and, if asked for, one of their nodes and one of the crossings of a section.
//! A process makes chunks of runs, each a file that is there only when it is whole. So the same command goes on after any interruption. Run k depends on k alone, so the
//! tables are the same bytes however the work was divided.
//!
//! | module | what it does |
//! |---|---|
//! | [`scene`] | the table as it is written |
//! | [`axis`], [`random`], [`items`] | which runs there are |
//! | [`keep`], [`schema`], [`ending`] | what is kept of each, in which columns |
//! | [`study`], [`outcome`] | a run becomes rows |
//! | [`shard`], [`crew`], [`chunks`] | which chunks this process makes, its threads, their files |
//! | [`merge`], [`sink`] | chunks become tables |

mod axis;
mod chunks;
mod crew;
mod ending;
pub(crate) mod items;
mod keep;
pub(crate) mod merge;
mod outcome;
mod random;
pub(crate) mod scene;
mod schema;
mod shard;
mod sink;
mod study;

use crate::place::{beside, sync_folder};
use chunks::Chunks;
use clap::Args;
use merge::Tally;
use shard::Shard;
use sink::Format;
use std::path::PathBuf;
use std::sync::Arc;
use std::{env, fs, slice};
use study::Study;
use vi_report::catalogue::Catalogue;
use vi_report::failure::Failure;

/// The command line of `vi-lab sweep`.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Scene: the entries of a run, and a table [sweep]: `over`, the quantities that differ from run to run; `samples` and `seed`, if some are random; `keep`; `section`. \
docs/cluster.md has all of them.

Columns: item, the number of the run; the quantities of `over`; with keep = [\"ending\"] ending and steps; \"accuracy\" step_error, \
the largest error of a step relative to the motion of its coordinate; \"end\" the last node as end_t, end_ coordinates and momenta, end_H, end_E, \
end_h; \"extremes\" min_ and max_ of the coordinates and of H over all nodes; \"energy\" error_H and error_E, the largest distances of H and E from their first values. \
\"series\" writes FILE.series.csv with every Nth node of each run (`every` of the scene), `section` FILE.section.csv with its crossings; both begin with the item. `vi-lab run \
SCENE --item K` is one of the runs alone.

A run that fails is recorded, and the sweep goes on. The folder FILE.part holds the chunks of runs that are finished; after any interruption the same command goes on from them. \
Shards share this folder; `vi-lab merge` writes FILE from it.

Exit status: 0 all runs were taken, whatever their ends; 1 a file failed; 2 the input is wrong; 130 and 143 the sweep was interrupted (SIGINT, SIGTERM).")]
pub(crate) struct Arguments {
    /// Scene file with a table [sweep]
    #[arg(value_name = "SCENE.toml")]
    scene: String,
    /// File to write, .csv, .npy or .parquet
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Makes only the chunks I of N equal shares, I from 0 on; with N alone, I is the number of the array task [default: that of a Slurm array]
    #[arg(long, value_name = "I/N", allow_hyphen_values = true)]
    shard: Option<String>,
}

/// Takes the runs of a scene, and returns a summary.
///
/// # Errors
/// [`Failure::Input`] for wrong input, [`Failure::File`] if a file cannot be read or written, [`Failure::Interrupted`] after a signal.
pub(crate) fn sweep(arguments: &Arguments, catalogue: &Catalogue) -> Result<String, Failure> {
    let Arguments { scene, output, shard } = arguments;
    let shard = Shard::of(shard.as_deref(), |name| env::var(name).ok())?;
    let study = Study::read(scene, catalogue)?;
    Format::of(output)?;
    let folder = beside(output, "part");
    let chunks = Arc::new(Chunks::resume(&folder, study.description(), shard.is_none())?);
    let numbers = shard.unwrap_or(Shard::WHOLE).chunks(chunks.description.chunks());
    crew::work(study, &chunks, &numbers)?;
    if shard.is_some() {
        sync_folder(&folder);
        let runs = chunks.description.runs(&numbers);
        let mut tally = Tally::of(&chunks.description, runs.end - runs.start);
        for number in numbers {
            tally.failed += chunks.read(number, &mut |table, row| {
                tally.inaccurate.count(table, row);
                Ok(())
            })?;
        }
        return Ok(tally.summary(&folder));
    }
    let summary = merge::write(&chunks, slice::from_ref(&*chunks), output)?;
    // The chunks go when the tables are on the disk.
    sync_folder(output.parent().unwrap_or(output));
    fs::remove_dir_all(&folder).map_err(|error| Failure::file(&folder, error))?;
    Ok(summary)
}
