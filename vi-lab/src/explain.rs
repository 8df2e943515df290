//! `vi-lab explain`: the mathematics of a system.
//!
//! In: the name of a predefined system, or a Rust file with your own systems. Out: L, f, L_d, its slot derivatives, the
//! equations of a step, findings and operation counts, or the equations of a Gauss step, as text or as a LaTeX
//! document. The predefined systems are read from the sources of the library. With the run of a scene, the summands of L
//! that matter along it ([`along`]).

use super::{along, expand};
use clap::{Args, ValueEnum};
use proc_macro2::TokenStream;
use std::path::Path;
use vi_codegen::inspect::{self, source};
use vi_report::catalogue::Catalogue;
use vi_report::failure::Failure;
use vi_report::input::{self, number};

/// The command line of `vi-lab explain`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// A system of `vi-lab list`, or a file with systems: Rust, or a bare `struct` in a file that ends in .vi [default: the first system of this program]
    #[arg(value_name = "SYSTEM|FILE")]
    system: Option<String>,
    /// Write a LaTeX document
    #[arg(long)]
    latex: bool,
    /// Show the steps with this rule instead of the declared rules
    #[arg(long, value_enum)]
    rule: Option<Rule>,
    /// Stages of a Gauss step, 1 to 16 [default: 2]
    #[arg(long, value_name = "S", requires = "rule", value_parser = clap::value_parser!(u8).range(1..=MOST))]
    stages: Option<u8>,
    /// Show which summands of L matter along the run of a scene file
    #[arg(long, value_name = "SCENE.toml", conflicts_with_all = ["latex", "rule"])]
    along: Option<String>,
    /// The share of force and of energy below which a summand is named as small [default: 1e-3]
    #[arg(long, value_name = "SHARE", requires = "along", value_parser = number)]
    below: Option<f64>,
}

/// The default of `--below`.
const BELOW: f64 = 1e-3;

/// A rule that needs no declaration.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Rule {
    /// Collocation at the Gauss points
    Gauss,
}

/// Maximum stages of a Gauss step.
const MOST: i64 = 16;

impl Arguments {
    /// The requested mathematics.
    fn explained(&self, tokens: TokenStream) -> syn::Result<inspect::Explanation> {
        match self.rule {
            Some(Rule::Gauss) => inspect::explain_gauss(tokens, usize::from(self.stages.unwrap_or(2))),
            None => inspect::explain(tokens),
        }
    }
}

/// Explains a system.
pub(crate) fn explain(arguments: &Arguments, catalogue: &Catalogue) -> Result<String, Failure> {
    let Arguments { system, latex, along, below, .. } = arguments;
    if let Some(scene) = along {
        return along::terms(system.as_deref(), scene, below.unwrap_or(BELOW), catalogue);
    }
    let show = |explanation: inspect::Explanation| if *latex { explanation.latex() } else { explanation.text() };
    let explained = |tokens| arguments.explained(tokens);
    let file = system.as_ref().map(Path::new).filter(|path| input::has_systems(path));
    if let Some(file) = file {
        return expand::each(file, |tokens| explained(tokens).map(show));
    }
    let entry = catalogue.named(system.as_deref())?;
    ready(catalogue, entry.name, explained).map(show)
}

/// The mathematics of a predefined system.
fn ready(
    catalogue: &Catalogue,
    name: &str,
    explained: impl Fn(TokenStream) -> syn::Result<inspect::Explanation>,
) -> Result<inspect::Explanation, Failure> {
    let mut declared = catalogue.sources().filter_map(|text| source::declarations(text).ok()).flatten();
    let found = declared.find_map(|tokens| {
        // The name comes first in a declaration, so that no other system needs to be derived.
        let system = vi_codegen::syntax::parse::system(tokens.clone()).ok()?;
        (system.name == name).then(|| explained(tokens))
    });
    match found {
        Some(Ok(explanation)) => Ok(explanation),
        Some(Err(error)) => Err(Failure::Input(format!("{name}: {error}"))),
        None => Err(Failure::Input(format!("the source of {name} is not available"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_system_of_the_catalogue_is_explained() {
        let catalogue = crate::ready();
        for entry in catalogue.entries() {
            let name = entry.name;
            let explanation = ready(&catalogue, name, inspect::explain).unwrap_or_else(|failure| panic!("{failure}"));
            assert_eq!(explanation.title, name);
        }
    }
}
