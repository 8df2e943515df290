//! The compiler behind `lagrangian!`, an ordinary library: tests, benches and the command call it too.
//!
//! ```text
//! tokens ──parse──▶ syntax::System ──check──▶ model::Model ──discretize──▶ discrete::DiscreteSystem
//!                      (spans)                  (names resolved, exact)       (L_d, D1…D4, f±, g±, J)
//!                                    ──lower──▶ program::Program ──emit──▶ tokens
//!                                                 (shared operations)       (Rust)
//! ```
//!
//! One stage, one folder, one product. A stage reports all its errors before the next one starts.

pub mod discrete;
pub mod emit;
pub mod found;
#[cfg(feature = "inspect")]
pub mod inspect;
pub mod messages;
pub mod model;
pub mod pretty;
pub mod program;
pub mod symbol;
pub mod syntax;

use discrete::DiscreteSystem;
use emit::Broken;
use found::Findings;
use model::{Model, check};
use proc_macro2::TokenStream;
use program::Program;
use syntax::parse;

/// A system with all that was derived from it.
pub struct Derived {
    /// The checked system, and the pool of all expressions.
    pub model: Model,
    /// L_d, its slot derivatives, and the equations of a step.
    pub system: DiscreteSystem,
    /// The functions as operations.
    pub program: Program,
    /// What is special about the system.
    pub findings: Findings,
}

/// What a `lagrangian!` becomes: the items of the system, or its errors with a stub of the struct.
#[must_use]
pub fn expand(tokens: TokenStream) -> TokenStream {
    let system = match parse::system(tokens.clone()) {
        Ok(system) => system,
        Err(error) => {
            let outline = parse::outline(tokens);
            return outline.map_or_else(|| error.to_compile_error(), |system| Broken::of(&system).with(&error));
        }
    };
    let broken = Broken::of(&system);
    match derive(system) {
        Ok(derived) => items(&derived),
        Err(error) => broken.with(&error),
    }
}

/// The stages from a system as written up to its program.
///
/// # Errors
/// Everything that the first stage which fails finds wrong.
pub fn derive(system: syntax::System) -> syn::Result<Derived> {
    let mut model = check::model(system)?;
    let system = discrete::system::system(&mut model)?;
    let program = program::program(&mut model, &system)?;
    let findings = found::findings(&model, &system, &program);
    Ok(Derived { model, system, program, findings })
}

/// The items of a derived system.
#[must_use]
pub fn items(derived: &Derived) -> TokenStream {
    emit::items(&derived.model, &derived.system, &derived.program, &derived.findings, emit::LIMIT)
}
