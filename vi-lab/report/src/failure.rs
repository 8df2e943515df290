//! The failures of the command, each with one line of text and an exit status.

use crate::interrupt::Signal;
use crate::machine::program;
use crate::numbers::{about, short};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use core::fmt;
use std::io;
use std::path::Path;
use vi_core::StepError;
use vi_core::error::BORDERED_MASS;
use vi_erased::check::{Face, Refusal};
use vi_erased::plan::{Method, Plan};

/// The exit status for a closed standard output: that of a command ended by SIGPIPE.
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
        /// The last good state and its number of steps.
        before: String,
        /// Options on the command line.
        advice: Option<String>,
    },
    /// A run that cannot continue although no step failed: exit status 1.
    Ended {
        /// The reason and the remedy.
        why: String,
        /// The last state and its number of steps.
        before: String,
    },
    /// A signal ended a run: exit status 130 or 143.
    Interrupted {
        /// The signal.
        signal: Signal,
        /// The progress of the run.
        reached: String,
    },
    /// Systems have mistakes: exit status 1.
    System {
        /// The output for the correct systems.
        shown: String,
        /// The mistakes with their lines.
        wrong: String,
    },
    /// A file cannot be written or read: exit status 1.
    File {
        /// The name of the file.
        name: String,
        /// The error of the operating system.
        error: io::Error,
    },
    /// The reader closed standard output, as `head` does: exit status 141.
    Unread,
    /// Two failures; the exit status is that of the first.
    Both(Box<[Failure; 2]>),
}

impl From<Refusal> for Failure {
    /// A plan that has no run is wrong input.
    fn from(refusal: Refusal) -> Self {
        Self::Input(refusal.message(Face::Command))
    }
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

    /// A failed step of a run by this plan; `before` is the last good state.
    #[must_use]
    pub fn step(error: StepError, plan: &Plan, before: String) -> Self {
        Self::Step { advice: advice(&error, plan), error: Box::new(error), before }
    }

    /// A failed start from the initial state; an input that no integrator accepts is wrong input.
    #[must_use]
    pub fn start(error: StepError, plan: &Plan) -> Self {
        let Plan { t, q, v, .. } = plan;
        match error {
            StepError::InvalidInput { .. } => Self::Input(error.to_string()),
            StepError::InconsistentStart { .. } => {
                Self::Input(format!("{}; --project moves the initial state onto the constraints", error.reason()))
            }
            _ => Self::step(error, plan, format!("t = {}, q = {q:?}, v = {v:?}, the initial state", short(*t))),
        }
    }

    /// The error of the command-line parser, as one line.
    pub fn usage(error: &clap::Error) -> Self {
        if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
            return Self::Input(format!("no command given; `{} help` lists the commands", program()));
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

/// The replacement for an unknown option or command.
fn suggestion(error: &clap::Error) -> Option<String> {
    let [argument, command, usage] =
        [ContextKind::SuggestedArg, ContextKind::SuggestedSubcommand, ContextKind::Usage].map(|kind| error.get(kind));
    // One letter is near to no word: `--p` to `--parameter`.
    let is_word = |near: &&ContextValue| near.to_string().len() > "--p".len();
    if let Some(near) = argument.filter(is_word).or(command) {
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
            format!("`{} help` lists the commands", program())
        }
        _ => return None,
    };
    Some(advice)
}

/// The options of the command line for a failed step.
#[must_use]
pub fn advice(error: &StepError, plan: &Plan) -> Option<String> {
    let step = if plan.dtau.is_some() { "--dtau" } else { "--h" };
    let advice = match (error, plan.method) {
        (StepError::TooLong { longest, .. }, _) => return Some(format!("try {step} {}", about(*longest))),
        (
            StepError::NoForwardStep { .. }
            | StepError::NoForwardGaussStep { .. }
            | StepError::StepRatio { .. }
            | StepError::DegenerateStep { .. },
            _,
        ) => {
            "start with a shorter --h, or use steps of given length: --method gauss, or fixed without constraints; \
                  another --q or --v may avoid this state"
        }
        (StepError::NotConverged { .. }, Method::Energy) => {
            "use shorter steps with --h, or fixed steps with --method fixed"
        }
        (StepError::NotConverged { .. } | StepError::StagesNotConverged { .. }, _) => {
            return Some(format!("use shorter steps with {step}"));
        }
        (StepError::TimeScale { .. }, _) => {
            "use shorter steps with --dtau, or steps in time with --h, or write a `time_scale` that is positive there"
        }
        (StepError::NotAssembled { .. }, _) => "start from another guess with --q, or set other lengths with --set",
        (StepError::Singular { matrix: BORDERED_MASS, .. }, _) => {
            "start elsewhere with --q; of a file with more constraints than its mechanism needs, leave those out that \
                  follow from the others with --drop NAME"
        }
        (StepError::Redundant { rank: 0, .. }, _) => "set another length with --set, or start elsewhere with --q",
        (StepError::Redundant { constraint, .. }, _) => {
            return Some(format!(
                "start elsewhere with --q if bars are in one line, where several motions may begin; otherwise leave it out with \
                 --drop '{constraint}', if the system is one of a file"
            ));
        }
        _ => return None,
    };
    Some(advice.to_owned())
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(message) => f.write_str(message),
            Self::Step { error, before, advice } => {
                // The advice of the library is for programmers.
                write!(f, "{}\nlast good state: {before}", error.reason())?;
                advice.as_ref().map_or(Ok(()), |advice| write!(f, "\nwhat to do: {advice}"))
            }
            Self::Ended { why, before } => write!(f, "{why}\nlast good state: {before}"),
            Self::Interrupted { signal, reached } => {
                write!(f, "interrupted by {} after {reached}; the output up to this point is complete", signal.name)
            }
            Self::System { wrong, .. } => f.write_str(wrong),
            Self::File { name, error } => write!(f, "{name}: {error}"),
            Self::Unread => f.write_str("standard output was closed"),
            Self::Both(failures) => write!(f, "{}\n{}", failures[0], failures[1]),
        }
    }
}
