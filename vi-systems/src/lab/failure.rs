//! Why the command did not do what was asked, in one line, and the exit status that goes with it.

use core::fmt;
use std::io;
use std::path::Path;
use vi_core::StepError;

/// A failure of the command.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The input is wrong: exit status 2.
    Input(String),
    /// A step failed: exit status 1.
    Step {
        /// The error of the integrator.
        error: StepError,
        /// The last good state and how many steps led to it.
        before: String,
    },
    /// Systems have mistakes: exit status 1.
    System {
        /// What is shown of the systems that are right.
        shown: String,
        /// The mistakes at their places.
        wrong: String,
    },
    /// A file could not be written or read: exit status 1.
    File {
        /// Which file.
        name: String,
        /// What the system said.
        error: io::Error,
    },
}

impl Failure {
    /// A failure to write or read `name`.
    pub(crate) fn file(name: impl AsRef<Path>, error: io::Error) -> Self {
        Self::File { name: name.as_ref().display().to_string(), error }
    }

    /// A step that failed where no state came before it; an input with which no integrator can start is wrong input.
    pub(crate) fn start(error: StepError) -> Self {
        match error {
            StepError::InvalidInput { .. } => Self::Input(error.to_string()),
            _ => Self::Step { error, before: "the first state".to_owned() },
        }
    }

    /// What the parser of the command line found, as one line.
    pub(crate) fn usage(error: &clap::Error) -> Self {
        let text = error.to_string();
        let first: Vec<&str> = text.lines().take_while(|line| !line.is_empty()).map(str::trim).collect();
        let line = first.join(" ");
        Self::Input(line.strip_prefix("error: ").unwrap_or(&line).to_owned())
    }

    /// The exit status of the command.
    pub(crate) fn exit_status(&self) -> u8 {
        match self {
            Self::Input(_) => 2,
            Self::Step { .. } | Self::System { .. } | Self::File { .. } => 1,
        }
    }

    /// Whether the reader of standard output went away, as `head` does: then there is nothing left to do.
    pub(crate) fn is_closed_pipe(&self) -> bool {
        matches!(self, Self::File { error, .. } if error.kind() == io::ErrorKind::BrokenPipe)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(message) => f.write_str(message),
            Self::Step { error, before } => write!(f, "{error}\nlast good state: {before}"),
            Self::System { wrong, .. } => f.write_str(wrong),
            Self::File { name, error } => write!(f, "{name}: {error}"),
        }
    }
}
