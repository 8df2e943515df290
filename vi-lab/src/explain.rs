//! `vi-lab explain`: the mathematics of a system.
//!
//! In: the name of a ready system, or a file of Rust with systems of one's own. Out: L, f, L_d, its slot derivatives, the
//! equations of a step, what the generator found out, and operation counts, as text or as a LaTeX document. The ready
//! systems are read from the files that the library itself is made of.

use super::{catalogue, expand};
use crate::failure::Failure;
use clap::Args;
use std::path::Path;
use vi_codegen::inspect::{self, source};

/// The command line of `vi-lab explain`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// A system of `vi-lab list`, or a file of Rust
    #[arg(value_name = "SYSTEM|FILE.rs")]
    system: String,
    /// Write a LaTeX document
    #[arg(long)]
    latex: bool,
}

/// Explains a system.
pub(crate) fn explain(Arguments { system, latex }: &Arguments) -> Result<String, Failure> {
    let show = |explanation: inspect::Explanation| if *latex { explanation.latex() } else { explanation.text() };
    if Path::new(system).extension().is_some_and(|extension| extension == "rs") {
        return expand::each(Path::new(system), |tokens| inspect::explain(tokens).map(show));
    }
    let entry = catalogue::find(system)?;
    ready(entry.system.name()).map(show)
}

/// The mathematics of a ready system.
fn ready(name: &str) -> Result<inspect::Explanation, Failure> {
    let mut declared = catalogue::sources().filter_map(|text| source::declarations(text).ok()).flatten();
    let explained = declared.find_map(|tokens| {
        // The name stands first of all that a declaration says: no other system needs to be derived.
        let system = vi_codegen::syntax::parse::system(tokens.clone()).ok()?;
        (system.name == name).then(|| inspect::explain(tokens))
    });
    match explained {
        Some(Ok(explanation)) => Ok(explanation),
        Some(Err(error)) => Err(Failure::Input(format!("{name}: {error}"))),
        None => Err(Failure::Input(format!("the declaration of {name} is not at hand"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_system_of_the_catalogue_is_explained() {
        for entry in catalogue::entries() {
            let name = entry.system.name();
            let explanation = ready(name).unwrap_or_else(|failure| panic!("{failure}"));
            assert_eq!(explanation.title, name);
        }
    }
}
