//! The compiler behind `lagrangian!`, an ordinary library: tests, benches and the command call it too.
//!
//! ```text
//! tokens ──parse──▶ syntax::System ──check──▶ model::Model ──discretize──▶ discrete::DiscreteSystem
//!                      (spans)                  (names resolved, exact)       (L_d, D1…D4, f±, g±, J)
//!                                    ──lower──▶ program::Program ──emit──▶ tokens
//!                                                 (shared operations)       (Rust)
//! ```
//!
//! One stage, one folder, one product. A stage reports all its errors before the next one starts. The stages behind parse run once
//! for each rule that the system is declared with.

mod derived;
pub mod discrete;
pub mod emit;
pub mod file;
pub mod found;
mod habits;
mod header;
#[cfg(feature = "inspect")]
pub mod inspect;
mod limits;
pub mod messages;
pub mod model;
pub mod pretty;
pub mod program;
pub mod rules;
pub mod symbol;
pub mod syntax;

pub use derived::{Derivations, Derived};

use emit::Broken;
use model::check;
use proc_macro2::TokenStream;
use syntax::parse;
use vi_expr::Pool;

/// What a `lagrangian!` becomes: the items of the system, or its errors with a stub of the struct.
#[must_use]
pub fn expand(tokens: TokenStream) -> TokenStream {
    compile(tokens).map_or_else(|errors| errors, |derivations| items(&derivations))
}

/// A system from its tokens.
///
/// # Errors
/// The errors as items, with a stub of the struct.
pub fn compile(tokens: TokenStream) -> Result<Derivations, TokenStream> {
    let system = parse::system(tokens.clone()).map_err(|error| {
        let outline = parse::outline(tokens);
        outline.map_or_else(|| error.to_compile_error(), |system| Broken::of(&system).with(&error))
    })?;
    derive(&system).map_err(|error| Broken::of(&system).with(&error))
}

/// The stages from a system as written up to its programs, one by each of its rules.
///
/// # Errors
/// Everything that the first stage which fails finds wrong.
pub fn derive(system: &syntax::System) -> syn::Result<Derivations> {
    let own = derive_by(system, 0)?;
    let further = (1..system.rules()).map(|place| derive_by(system, place)).collect::<syn::Result<_>>()?;
    Ok(Derivations { own, further })
}

/// The stages by the rule of this place in the list of the system.
fn derive_by(system: &syntax::System, place: usize) -> syn::Result<Derived> {
    let mut pool = Pool::bounded(limits::WORK);
    let model = check::model(&mut pool, system, place).map_err(messages::bounded)?;
    let system = discrete::system::system(&mut pool, &model)?;
    let program = program::program(&mut pool, &model, &system)?;
    let findings = found::findings(&model, &system, &program);
    Ok(Derived { pool, model, system, program, findings })
}

/// The expansion of a system as the text of a file.
///
/// # Errors
/// Tokens that are no items of Rust: a mistake of this compiler.
pub fn text(derivations: &Derivations) -> syn::Result<String> {
    Ok(header::header(derivations) + &pretty::text(items(derivations))?)
}

/// The items of a system.
#[must_use]
pub fn items(derivations: &Derivations) -> TokenStream {
    emit::items(derivations)
}
