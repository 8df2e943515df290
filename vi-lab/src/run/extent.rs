//! Limits the size of the output of a run.
//!
//! In: a [`Request`]. Out: an [`Extent`], or [`Failure::Input`] if the run would write more than a gigabyte without
//! permission. The output of fixed steps has the predicted size. Steps that solve for their own length may become many
//! more: [`Extent::check`] ends such a run.

use super::request::Request;
use vi_report::failure::Failure;
use vi_report::numbers::{about, short};

/// Maximum output in bytes without permission.
const LIMIT: f64 = 1e9;
/// Maximum output in bytes if the prediction was below the limit.
const UNFORESEEN: f64 = 2.0 * LIMIT;
/// The largest N suggested for --every.
const LARGEST_EVERY: f64 = 1e15;

/// The size of an output.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    bytes_per_row: f64,
    is_limited: bool,
}

impl Extent {
    /// The predicted output of a run.
    ///
    /// # Errors
    /// [`Failure::Input`] with the size and the options if it is too large.
    #[allow(clippy::cast_precision_loss)] // an estimate
    pub(super) fn of(request: &Request) -> Result<Self, Failure> {
        let bytes_per_row = request.output.bytes_per_number() * request.columns().len() as f64;
        let extent = Self { bytes_per_row, is_limited: !request.large_output };
        let every = request.every as f64;
        let rows = request.length.steps(&request.plan) / every;
        let bytes = rows * bytes_per_row;
        if bytes <= LIMIT || request.large_output {
            return Ok(extent);
        }
        let sufficient = (every * bytes / LIMIT).ceil();
        let remedy = if sufficient < LARGEST_EVERY {
            format!("write fewer rows with --every {}", short(sufficient))
        } else {
            "shorten the run".to_owned()
        };
        Err(Failure::Input(format!(
            "the output would have about {} rows, {} GB; {remedy}, or allow more than {} GB with --large-output",
            about(rows),
            about(bytes / 1e9),
            about(LIMIT / 1e9),
        )))
    }

    /// Checks the rows written so far.
    #[allow(clippy::cast_precision_loss)] // an estimate
    pub(super) fn check(self, rows: u64) -> Result<(), String> {
        if self.is_limited && rows as f64 * self.bytes_per_row > UNFORESEEN {
            return Err(format!(
                "the output has {rows} rows, {} GB, far more than predicted, because the steps became short; write fewer \
                 rows with --every N, or allow them with --large-output",
                about(UNFORESEEN / 1e9)
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_output_beyond_the_prediction_ends() {
        let extent = Extent { bytes_per_row: 100.0, is_limited: true };
        assert_eq!(extent.check(20_000_000), Ok(()));
        let message = extent.check(20_000_001).expect_err("too many rows");
        assert!(message.starts_with("the output has 20000001 rows, 2 GB, far more than predicted"), "{message}");
        assert_eq!(Extent { is_limited: false, ..extent }.check(u64::MAX), Ok(()));
    }
}
