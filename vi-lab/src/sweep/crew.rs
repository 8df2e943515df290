//! All cores at work on a part.
//!
//! The threads make one missing chunk after the other; the main thread waits for them and for signals. AFTER A SIGNAL the chunks under way are lost with the
//! process, so that no run has to look for signals.

use super::part::Part;
use super::study::Study;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
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
/// [`Failure::Interrupted`] after a signal, [`Failure::File`] if a chunk cannot be written.
pub(super) fn work(study: Study, part: &Arc<Part>) -> Result<(), Failure> {
    let interrupt = Interrupt::heed().map_err(|error| Failure::file("signals", error))?;
    let chunks = part.heading.chunks();
    let mut present = part.present()?;
    let mut progress = Progress::new(chunks.saturating_sub(present));
    let (sender, results) = mpsc::channel();
    let next = AtomicU64::new(0);
    let shared = Arc::clone(part);
    rayon::spawn_broadcast(move |_| {
        loop {
            // One by one: a list of chunks would grow with the number of runs.
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= chunks {
                break;
            }
            if !shared.has(number) && sender.send(study.chunk(&shared, number)).is_err() {
                break;
            }
        }
    });
    loop {
        match results.recv_timeout(PATIENCE) {
            Ok(result) => {
                result?;
                present += 1;
                progress.advance_by(1);
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        }
        if let Some(signal) = interrupt.signal().filter(|_| present < chunks) {
            let reached = format!("{present} of {chunks} chunks, from which the same command goes on");
            return Err(Failure::Interrupted { signal, reached });
        }
    }
}
