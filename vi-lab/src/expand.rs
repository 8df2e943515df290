//! `vi-lab expand`: the products of the compiler for the systems in a file.
//!
//! In: a Rust file. Out: the product of one stage for each `lagrangian!` in it. Mistakes are printed with their source
//! lines; later systems are still expanded.

use clap::{Args, ValueEnum};
use proc_macro2::{LexError, TokenStream};
use std::path::{Path, PathBuf};
use vi_codegen::inspect::{self, report, source};
use vi_report::failure::Failure;
use vi_report::input;

/// The command line of `vi-lab expand`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// A Rust file that declares systems with `lagrangian!`
    #[arg(value_name = "FILE.rs")]
    file: PathBuf,
    /// The last stage to run
    #[arg(long, value_enum, default_value_t = Stage::Rust)]
    stage: Stage,
}

/// The stages of the compiler.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Stage {
    /// The clauses as parsed
    Syntax,
    /// L and f with all names resolved
    Model,
    /// `L_d`, its slot derivatives, the equations of a step
    Discrete,
    /// The functions as operations
    Program,
    /// The items that the macro emits
    Rust,
}

impl From<Stage> for inspect::Stage {
    fn from(stage: Stage) -> Self {
        match stage {
            Stage::Syntax => Self::Syntax,
            Stage::Model => Self::Model,
            Stage::Discrete => Self::Discrete,
            Stage::Program => Self::Program,
            Stage::Rust => Self::Rust,
        }
    }
}

/// Expands every system of a file.
pub(crate) fn expand(arguments: &Arguments) -> Result<String, Failure> {
    each(&arguments.file, |tokens| inspect::stage(tokens, arguments.stage.into()))
}

/// Produces a text for every system in a file.
pub(super) fn each(file: &Path, mut show: impl FnMut(TokenStream) -> syn::Result<String>) -> Result<String, Failure> {
    let name = file.display().to_string();
    let text = input::text(file)?;
    let unreadable =
        |error: syn::Error| Failure::System { shown: String::new(), wrong: report::unreadable(&name, &text, &error) };
    let mut declarations = source::declarations(&text).map_err(unreadable)?;
    if declarations.is_empty() && file.extension().is_some_and(|kind| kind == "vi") {
        declarations.push(text.parse().map_err(|error: LexError| unreadable(error.into()))?);
    }
    if declarations.is_empty() {
        return Err(Failure::Input(format!("{name} declares no system with `lagrangian!`")));
    }
    let mut shown = Vec::new();
    let mut wrong = Vec::new();
    for tokens in declarations {
        match show(tokens) {
            Ok(text) => shown.push(text.trim_end().to_owned()),
            Err(error) => wrong.push(report::report(&name, &text, &error)),
        }
    }
    let shown = shown.join("\n\n");
    if wrong.is_empty() { Ok(shown) } else { Err(Failure::System { shown, wrong: wrong.join("\n") }) }
}
