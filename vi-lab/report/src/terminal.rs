//! The output of a program on a terminal: its text, or its failure.
//!
//! In: an outcome. Out: standard output, standard error, and the exit status of the process.

use crate::failure::Failure;
use crate::machine::visible;
use std::io::{self, Write as _};
use std::process::ExitCode;

/// Writes a text and a line end to standard output, its control characters escaped.
///
/// # Errors
/// [`Failure::Unread`] or [`Failure::File`] if standard output cannot be written.
pub fn print(text: &str) -> Result<(), Failure> {
    writeln!(io::stdout(), "{}", visible(text)).map_err(Failure::standard_output)
}

/// Reports a failure, if there is one, and returns the exit status.
#[must_use]
pub fn end(outcome: Result<(), Failure>) -> ExitCode {
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure @ Failure::Unread) => ExitCode::from(failure.exit_status()),
        Err(Failure::System { shown, wrong }) => {
            // Correct systems come first. The mistakes are reported even if standard output is closed.
            let _ = if shown.is_empty() { Ok(()) } else { print(&shown) };
            let _ = write!(io::stderr(), "{}", visible(&wrong));
            ExitCode::FAILURE
        }
        Err(failure) => {
            // Standard error may be closed; the exit status reports the failure, too.
            let _ = writeln!(io::stderr(), "error: {}", visible(&failure.to_string()));
            ExitCode::from(failure.exit_status())
        }
    }
}
