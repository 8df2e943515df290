//! The compiler behind `lagrangian!`, as an ordinary library: tests, benches and the command use it too.
//!
//! ```text
//! tokens ──parse──▶ syntax::System ──check──▶ model::Model ──discretize──▶ discrete::DiscreteSystem
//!                      (spans)                  (names resolved, exact)       (L_d, D1…D4, f±, g±, J)
//!                                    ──lower──▶ program::Program ──emit──▶ tokens
//!                                                 (shared operations)       (Rust)
//! ```
//!
//! One stage, one folder, one product. A stage reports all its errors before the next one starts. The stages after
//! parsing run once for each declared rule.

mod arrays;
mod constraints;
mod derived;
pub mod discrete;
pub mod emit;
pub mod file;
pub mod findings;
pub mod functions;
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

/// Expands a `lagrangian!` to the items of the system, or to its errors with a stub of the struct.
#[must_use]
pub fn expand(tokens: TokenStream) -> TokenStream {
    compile(tokens).map_or_else(|errors| errors, |derivations| items(&derivations))
}

/// Derives a system from its tokens.
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

/// Runs the stages from the parsed system to its programs, one per rule.
///
/// # Errors
/// All errors of the first stage that fails.
pub fn derive(system: &syntax::System) -> syn::Result<Derivations> {
    let own = derive_by(system, 0)?;
    let further = (1..system.rules()).map(|place| derive_by(system, place)).collect::<syn::Result<_>>()?;
    Ok(Derivations { own, further })
}

/// Runs the stages for the rule at this position of the list.
fn derive_by(system: &syntax::System, place: usize) -> syn::Result<Derived> {
    let mut pool = Pool::bounded(limits::WORK);
    let model = check::model(&mut pool, system, place).map_err(messages::bounded)?;
    let system = discrete::system::system(&mut pool, &model)?;
    let program = program::program(&mut pool, &model, &system)?;
    let findings = findings::findings(&model, &system, &program);
    Ok(Derived { pool, model, system, program, findings })
}

/// The expansion of a system as the text of a file.
///
/// # Errors
/// Tokens that are not Rust items: a bug of this compiler.
pub fn text(derivations: &Derivations) -> syn::Result<String> {
    Ok(header::header(derivations) + &pretty::text(items(derivations))?)
}

/// The items of a system.
#[must_use]
pub fn items(derivations: &Derivations) -> TokenStream {
    emit::items(derivations)
}
