//! The command `vi-lab`: runs, and the study of the paper as a web page.
//!
//! In: the command line. Out: files, text on standard output, and an exit status. Status 0 is success, 1 a failed step
//! or file, 2 wrong input, 130 or 143 a run interrupted by a signal, 141 a closed standard output. Progress and errors
//! go to standard error.
//!
//! | module | product |
//! |---|---|
//! | `new` | `vi-lab new`: a project with this command for your own systems |
//! | `run` | `vi-lab run`: rows as CSV |
//! | `vi_paper` | `vi-lab paper`: figures, tables and the page |
//! | `vi_stability` | `vi-lab stability`: limits of the methods, as maps |
//! | `work_precision` | `vi-lab work-precision`: error against time, for every method |
//! | `sweep` | `vi-lab sweep`, `vi-lab merge`: many runs of one scene, on all cores and many machines |
//! | `lyapunov` | `vi-lab lyapunov`: Lyapunov exponents |
//! | `compare` | `vi-lab compare`: two models of one motion |
//! | `expand`, `explain` | the products of the compiler; the mathematics of a system |
//! | `along` | the summands of L that matter along a run |
//! | `place`, `entries` | checks of files to write; entries of scenes |
//! | `declared` | the systems of a user, listed in `main!` |
//! | `vi_report` | output shared by all subcommands; the systems by name |
//! | `vi_ready` | the predefined systems |

mod along;
mod compare;
#[doc(hidden)]
pub mod declared;
mod entries;
mod expand;
mod explain;
mod lyapunov;
mod new;
mod place;
mod run;
mod sweep;
mod work_precision;

use clap::{Parser, Subcommand};
use std::process::ExitCode;
use vi_report::catalogue::Catalogue;
pub use vi_report::catalogue::Systems;
pub use vi_report::entry::Entry;
use vi_report::failure::Failure;
use vi_report::terminal::{end, print};

/// Variational integrators: simulate a system, or reproduce the paper.
#[derive(Debug, Parser)]
#[command(name = "vi-lab", version, max_term_width = 100)]
struct Command {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Compute every figure and table of the paper's numerical study, next to the published numbers
    Paper(vi_paper::Study),
    /// Simulate one system, and write its states
    Run(Box<run::Arguments>),
    /// Map where methods fail: the complete page, or the map of one system
    Stability(vi_stability::Arguments),
    /// Chart error against time, evaluations and step for every method on one system
    WorkPrecision(work_precision::Arguments),
    /// Estimate the largest Lyapunov exponents of a system along one run
    Lyapunov(lyapunov::Arguments),
    /// Compare a full and a reduced model of one motion: their difference against time, and what each costs
    Compare(compare::Arguments),
    /// Run a scene many times over parameters, initial values and steps: on all cores, or one shard of several
    Sweep(sweep::Arguments),
    /// Merge the chunks of a sweep into tables
    Merge(sweep::merge::Arguments),
    /// Show the products of the compiler for the systems in a file
    Expand(expand::Arguments),
    /// Show the mathematics of a system: L, `L_d`, D1 to D4, equations, findings, operation counts
    Explain(explain::Arguments),
    /// Create a project with this command for your own systems
    New(new::Arguments),
    /// List the systems, their parameters and initial states
    List,
}

/// Adds the command `vi-lab` to a program for its own systems, besides the predefined ones: `run`, `stability`,
/// `work-precision`, `explain`, scenes.
///
/// ```text
/// vi_lab::main! {
///     sources: ["main.rs"],        // files that declare the systems, beside this one: for `explain`
///     systems: [
///         Pendulum { about: "mass on a rod", q: [1.0], v: [0.0], h: 0.01 },
///     ],
/// }
/// ```
///
/// A system needs `Default`, which every parameter with a value provides. A system without a rule runs with Gauss
/// methods only, as does a system with constraints. `q`, `v` and `h` are the default initial coordinates, initial velocities and step.
#[macro_export]
macro_rules! main {
    (
        sources: [$($source:literal),* $(,)?],
        systems: [$($system:ident { about: $about:expr, q: $q:expr, v: $v:expr, h: $h:expr $(,)? }),+ $(,)?] $(,)?
    ) => {
        #[allow(clippy::needless_borrow, reason = "for a system with a rule all references are needed")]
        fn main() -> ::std::process::ExitCode {
            $crate::main_with($crate::Systems {
                sources: &[$(include_str!($source)),*],
                entries: || {
                    use $crate::declared::{Declared, WithConstraints as _, WithRule as _, WithoutRule as _};
                    vec![$((&&&Declared::<$system>::new()).entry($about, $q, $v, $h)),+]
                },
            })
        }
    };
}

/// The predefined systems, without those of a program.
pub(crate) fn ready() -> Catalogue {
    let ready = Systems { sources: &vi_systems::SOURCES, entries: vi_ready::systems };
    Catalogue { own: None, ready, of_text: Some(vi_ready::text::entry) }
}

/// Runs the command line of this process, including the systems of the program.
#[must_use]
pub fn main_with(own: Systems) -> ExitCode {
    command(&Catalogue { own: Some(own), ..ready() })
}

/// Runs the command line of this process.
#[must_use]
pub fn main() -> ExitCode {
    command(&ready())
}

fn command(catalogue: &Catalogue) -> ExitCode {
    end(match Command::try_parse() {
        Ok(Command { action }) => act(action, catalogue),
        Err(error) if !error.use_stderr() => {
            // The user asked for help or for the version.
            error.print().map_err(Failure::standard_output)
        }
        Err(error) => Err(Failure::usage(&error)),
    })
}

fn act(action: Action, catalogue: &Catalogue) -> Result<(), Failure> {
    match action {
        Action::Paper(study) => print(&vi_paper::write(&study)?),
        Action::Run(arguments) => run::run(&arguments, catalogue),
        Action::Stability(arguments) => print(&vi_stability::write(&arguments, catalogue)?),
        Action::WorkPrecision(arguments) => print(&work_precision::write(&arguments, catalogue)?),
        Action::Lyapunov(arguments) => lyapunov::write(&arguments, catalogue),
        Action::Compare(arguments) => print(&compare::write(&arguments, catalogue)?),
        Action::Sweep(arguments) => print(&sweep::sweep(&arguments, catalogue)?),
        Action::Merge(arguments) => print(&sweep::merge::merge(&arguments)?),
        Action::Expand(arguments) => print(&expand::expand(&arguments)?),
        Action::Explain(arguments) => print(explain::explain(&arguments, catalogue)?.trim_end()),
        Action::New(arguments) => print(&new::write(&arguments)?),
        Action::List => print(&catalogue.table().text()),
    }
}
