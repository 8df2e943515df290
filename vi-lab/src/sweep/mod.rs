//! `vi-lab sweep` and `vi-lab merge`: many runs of one scene, on all cores and on many machines.
//!
//! In: a scene with a table `[sweep]`. Out: a table with a row for each run; beside it, where asked for, one of their nodes and one of the crossings of a section.
//! A process makes one part of the runs, a [`shard`], in a file that holds all that is finished whatever ends it: the same command goes on there. Run k
//! depends on k alone, so parts put together are the same bytes as the whole.
//!
//! | module | part of a sweep |
//! |---|---|
//! | [`scene`] | the table as it is written |
//! | [`axis`], [`random`], [`items`] | which runs there are |
//! | [`keep`], [`shape`], [`ending`] | what is kept of each, in which columns |
//! | [`study`], [`course`] | a run becomes rows |
//! | [`shard`], [`part`], [`crew`] | which runs this process takes, the file in which they stand, the threads |
//! | [`merge`], [`sink`] | parts become tables |

mod axis;
mod course;
mod crew;
mod ending;
pub(crate) mod items;
mod keep;
pub(crate) mod merge;
mod part;
mod random;
pub(crate) mod scene;
mod schema;
mod shard;
mod sink;
mod study;

use crate::place::{beside, sync_folder};
use clap::Args;
use part::Part;
use shard::Shard;
use sink::Format;
use std::env;
use std::path::PathBuf;
use std::slice;
use std::sync::Arc;
use study::Study;
use vi_report::failure::Failure;

/// The command line of `vi-lab sweep`.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Scene: the entries of a run, and a table [sweep]: `over`, the quantities that differ from run to run; `samples` and `seed`, where some are random; `keep`; `section`. \
docs/cluster.md has all of them.

Columns: item, the number of the run; the quantities of `over`; with keep = [\"ending\"] ending and steps; \"end\" the last node as end_t, end_ coordinates and momenta, end_H, end_E, \
end_h; \"extremes\" min_ and max_ of the coordinates and of H over all nodes; \"energy\" error_H and error_E, the largest distances of H and E from their first values. \
\"series\" writes FILE.series.csv with every Nth node of each run (`every` of the scene), `section` FILE.section.csv with its crossings; both begin with the item. `vi-lab run \
SCENE --item K` is one of the runs alone.

A run that fails has its ending, and the sweep goes on. Until all is there the runs stand in FILE.I-of-N.part; the same command goes on with it, however it ended.

Exit status: 0 all runs were taken, whatever their ends; 1 a file failed; 2 the input is wrong; 130 and 143 the sweep was interrupted (SIGINT, SIGTERM).")]
pub(crate) struct Arguments {
    /// Scene file with a table [sweep]
    #[arg(value_name = "SCENE.toml")]
    scene: String,
    /// File to write, .csv, .npy or .parquet; with --shard what its part is named after
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Makes the part I of N only, I from 0 on; with N alone, I is the number of the array task [default: that of a Slurm array]
    #[arg(long, value_name = "I/N", allow_hyphen_values = true)]
    shard: Option<String>,
}

/// Takes the runs of a scene, and says what came of them.
///
/// # Errors
/// [`Failure::Input`] for wrong input, [`Failure::File`] where a file cannot be read or written, [`Failure::Interrupted`] after a signal.
pub(crate) fn sweep(arguments: &Arguments) -> Result<String, Failure> {
    let Arguments { scene, output, shard } = arguments;
    let shard = Shard::of(shard.as_deref(), |name| env::var(name).ok())?;
    let study = Study::read(scene)?;
    Format::of(output)?;
    let Shard { index, count } = shard.unwrap_or(Shard::WHOLE);
    let folder = beside(output, &format!("{index}-of-{count}.part"));
    let heading = study.heading(Shard { index, count });
    let part = Arc::new(Part::resume(&folder, heading)?);
    crew::work(study, &part)?;
    if shard.is_some() {
        let failed = part.read(&mut |_, _| Ok(()))?;
        sync_folder(&folder);
        return Ok(merge::summary(&folder, part.heading.runs(), failed));
    }
    let summary = merge::write(slice::from_ref(&*part), output)?;
    // The chunks go when the tables are on the disk.
    sync_folder(output.parent().unwrap_or(output));
    part.remove()?;
    Ok(summary)
}
