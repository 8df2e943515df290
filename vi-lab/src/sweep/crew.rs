//! Computes the chunks of a shard on all cores.
//!
//! The threads take one chunk after the other; the main thread waits for them and for signals. A signal ends the
//! process and loses unfinished chunks, so that runs need not check for signals.

use super::chunks::Chunks;
use super::study::Study;
use core::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;
use vi_report::failure::Failure;
use vi_report::interrupt::Interrupt;
use vi_report::progress::Progress;

/// Interval between checks for a signal.
const PATIENCE: Duration = Duration::from_millis(50);

/// Writes the missing ones among these chunks.
///
/// # Errors
/// [`Failure::Interrupted`] after a signal, [`Failure::File`] if a chunk cannot be written.
pub(super) fn work(study: Study, chunks: &Arc<Chunks>, numbers: &Range<u64>) -> Result<(), Failure> {
    let interrupt = Interrupt::install().map_err(|error| Failure::file("signals", error))?;
    let (all, mut done) = (numbers.end - numbers.start, 0);
    let mut progress = Progress::new(all);
    let (sender, results) = mpsc::channel();
    // A counter, because a list of chunks would grow with the number of runs.
    let (next, end) = (AtomicU64::new(numbers.start), numbers.end);
    let shared = Arc::clone(chunks);
    rayon::spawn_broadcast(move |_| {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= end {
                break;
            }
            let follow = |item, text: &mut String| study.follow(item, text);
            let result = if shared.is_made(number) { Ok(()) } else { shared.write(number, follow) };
            if sender.send(result).is_err() {
                break;
            }
        }
    });
    loop {
        match results.recv_timeout(PATIENCE) {
            Ok(result) => {
                result?;
                done += 1;
                progress.advance_by(1);
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        }
        if let Some(signal) = interrupt.signal().filter(|_| done < all) {
            let reached = format!("{done} of {all} chunks; the same command resumes from them");
            return Err(Failure::Interrupted { signal, reached });
        }
    }
}
