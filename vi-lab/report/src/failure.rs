//! Why the command did not do what was asked, in one line, and the exit status that goes with it.

use crate::interrupt::Signal;
use crate::machine::program;
use crate::numbers::short;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use core::fmt;
use std::io;
use std::path::Path;
use vi_core::StepError;
use vi_runs::plan::{Method, Plan};

/// The exit status where nobody reads standard output any more: that of a command which SIGPIPE ends.
const UNREAD: u8 = 141;

/// A failure of the command.
#[derive(Debug)]
pub enum Failure {
    /// The input is wrong: exit status 2.
    Input(String),
    /// A step failed: exit status 1.
    Step {
        /// The error of the integrator.
        error: Box<StepError>,
        /// The last good state and how many steps led to it.
        before: String,
        /// What the command line can do about it.
        advice: Option<String>,
    },
    /// A run cannot go on, though no step failed: exit status 1.
    Ended {
        /// Why, and what to do.
        why: String,
        /// The last state and how many steps led to it.
        before: String,
    },
    /// A signal ended a run: exit status 130 or 143.
    Interrupted {
        /// Which signal.
        signal: Signal,
        /// How far the run came.
        reached: String,
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
    /// The reader of standard output went away, as `head` does: exit status 141.
    Unread,
    /// One failure after the other; the exit status is that of the first.
    Both(Box<[Failure; 2]>),
}

impl Failure {
    /// A failure to write or read `name`.
    pub fn file(name: impl AsRef<Path>, error: io::Error) -> Self {
        Self::File { name: name.as_ref().display().to_string(), error }
    }

    /// A failure to write to standard output.
    #[must_use]
    pub fn standard_output(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::Unread,
            _ => Self::file("standard output", error),
        }
    }

    /// One failure after the other.
    #[must_use]
    pub fn both(first: Self, second: Self) -> Self {
        Self::Both(Box::new([first, second]))
    }

    /// A run that does not start from the initial state; an input with which no integrator can start is wrong input.
    pub fn start(error: StepError, plan: &Plan) -> Self {
        let Plan { t, q, v, .. } = plan;
        match error {
            StepError::InvalidInput { .. } => Self::Input(error.to_string()),
            _ => Self::Step {
                advice: advice(&error, plan).map(str::to_owned),
                error: Box::new(error),
                before: format!("t = {}, q = {q:?}, v = {v:?}, the initial state", short(*t)),
            },
        }
    }

    /// What the parser of the command line found, as one line.
    pub fn usage(error: &clap::Error) -> Self {
        if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
            return Self::Input(format!("no command is given; `{} help` lists them", program()));
        }
        let text = error.to_string();
        let first: Vec<&str> = text.lines().take_while(|line| !line.is_empty()).map(str::trim).collect();
        let line = first.join(" ");
        let line = line.strip_prefix("error: ").unwrap_or(&line);
        Self::Input(suggestion(error).map_or_else(|| line.to_owned(), |suggestion| format!("{line}; {suggestion}")))
    }

    /// The exit status of the command.
    #[must_use]
    pub fn exit_status(&self) -> u8 {
        match self {
            Self::Input(_) => 2,
            Self::Step { .. } | Self::Ended { .. } | Self::System { .. } | Self::File { .. } => 1,
            Self::Interrupted { signal, .. } => signal.exit_status(),
            Self::Unread => UNREAD,
            Self::Both(failures) => failures[0].exit_status(),
        }
    }
}

/// What to write instead of an option or a command that does not exist.
fn suggestion(error: &clap::Error) -> Option<String> {
    let [argument, command, usage] =
        [ContextKind::SuggestedArg, ContextKind::SuggestedSubcommand, ContextKind::Usage].map(|kind| error.get(kind));
    if let Some(near) = argument.or(command) {
        let near = match near {
            ContextValue::Strings(names) => names.join(" or "),
            name => name.to_string(),
        };
        return Some(format!("did you mean `{near}`?"));
    }
    let of_a_run = usage.is_some_and(|usage| usage.to_string().contains(&format!("{} run", program())));
    let advice = match error.kind() {
        ErrorKind::UnknownArgument if of_a_run => {
            format!("--set NAME=VALUE sets a parameter, `{} run --help` lists the options", program())
        }
        ErrorKind::UnknownArgument | ErrorKind::InvalidSubcommand => {
            format!("`{} help` shows what there is", program())
        }
        _ => return None,
    };
    Some(advice)
}

/// What the command line can do about a step that failed.
#[must_use]
pub fn advice(error: &StepError, plan: &Plan) -> Option<&'static str> {
    match (error, plan.method) {
        (
            StepError::NoForwardStep { .. }
            | StepError::NoForwardGaussStep { .. }
            | StepError::StepRatio { .. }
            | StepError::DegenerateStep { .. },
            _,
        ) => {
            Some("take fixed steps with --method fixed, which exist here; another --h, --q or --v may avoid this place")
        }
        (StepError::NotConverged { .. }, Method::Energy) => {
            Some("take shorter steps with --h, or fixed ones with --method fixed")
        }
        (StepError::NotConverged { .. } | StepError::StagesUnsettled { .. }, _) if plan.dtau.is_some() => {
            Some("take shorter steps with --dtau")
        }
        (StepError::NotConverged { .. } | StepError::StagesUnsettled { .. }, _) => Some("take shorter steps with --h"),
        (StepError::TimeScale { .. }, _) => Some(
            "take shorter steps with --dtau, or steps in time with --h; or write a `time_scale` that is positive there",
        ),
        _ => None,
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(message) => f.write_str(message),
            Self::Step { error, before, advice } => {
                // The advice of the library is for those who call it.
                write!(f, "{}\nlast good state: {before}", error.reason())?;
                advice.as_ref().map_or(Ok(()), |advice| write!(f, "\nwhat to do: {advice}"))
            }
            Self::Ended { why, before } => write!(f, "{why}\nlast good state: {before}"),
            Self::Interrupted { signal, reached } => {
                write!(f, "interrupted by {} after {reached}; the output up to there is whole", signal.name)
            }
            Self::System { wrong, .. } => f.write_str(wrong),
            Self::File { name, error } => write!(f, "{name}: {error}"),
            Self::Unread => f.write_str("nobody reads standard output"),
            Self::Both(failures) => write!(f, "{}\n{}", failures[0], failures[1]),
        }
    }
}
