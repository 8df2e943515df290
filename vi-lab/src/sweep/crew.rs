//! All cores at work on a part.
//!
//! In: a study, and a part with chunks that are missing. Out: the part with all of them. The threads take one chunk after the other; this one writes what
//! they have finished. AFTER A SIGNAL, or a disk that is full, the chunks that were written stay; those under way are lost with the process, for whose end
//! no run has to look at anything.

use super::part::Growing;
use super::study::Study;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;
use vi_report::failure::Failure;
use vi_report::interrupt::Interrupt;
use vi_report::progress::Progress;

/// Time between two looks for a signal.
const PATIENCE: Duration = Duration::from_millis(50);

/// Makes the chunks that are missing.
///
/// # Errors
/// [`Failure::Interrupted`], and [`Failure::File`] where the part cannot be written.
pub(super) fn work(study: Study, growing: &mut Growing) -> Result<(), Failure> {
    let interrupt = Interrupt::heed().map_err(|error| Failure::file("signals", error))?;
    let heading = growing.part.heading().clone();
    let missing = growing.part.missing();
    let mut left = missing.len() as u64;
    let mut progress = Progress::new(left);
    // No more chunks wait than there are threads, so that their memory has a bound.
    let (finished, chunks) = mpsc::sync_channel(rayon::current_num_threads());
    let next = AtomicUsize::new(0);
    let all = Arc::new((study, heading, missing));
    rayon::spawn_broadcast(move |_| {
        let (study, heading, missing) = &*all;
        while let Some(number) = missing.get(next.fetch_add(1, Ordering::Relaxed)) {
            if finished.send(study.chunk(heading, *number)).is_err() {
                break;
            }
        }
    });
    loop {
        match chunks.recv_timeout(PATIENCE) {
            Ok(chunk) => {
                growing.append(&chunk)?;
                progress.advance_by(1);
                left -= 1;
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        }
        if let Some(signal) = interrupt.signal().filter(|_| left > 0) {
            let done = growing.part.heading().chunks() - left;
            let reached = format!("{done} of {} chunks, from which the same command goes on", done + left);
            return Err(Failure::Interrupted { signal, reached });
        }
    }
}
