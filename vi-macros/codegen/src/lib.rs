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

mod derived;
pub mod discrete;
pub mod emit;
pub mod found;
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

pub use derived::Derived;

use emit::Broken;
use model::check;
use proc_macro2::TokenStream;
use syntax::parse;
use vi_expr::Pool;

/// What a `lagrangian!` becomes: the items of the system, or its errors with a stub of the struct.
#[must_use]
pub fn expand(tokens: TokenStream) -> TokenStream {
    compile(tokens).map_or_else(|errors| errors, |derived| items(&derived))
}

/// A system from its tokens.
///
/// # Errors
/// The errors as items, with a stub of the struct.
pub fn compile(tokens: TokenStream) -> Result<Derived, TokenStream> {
    let system = parse::system(tokens.clone()).map_err(|error| {
        let outline = parse::outline(tokens);
        outline.map_or_else(|| error.to_compile_error(), |system| Broken::of(&system).with(&error))
    })?;
    let broken = Broken::of(&system);
    derive(system).map_err(|error| broken.with(&error))
}

/// The stages from a system as written up to its program.
///
/// # Errors
/// Everything that the first stage which fails finds wrong.
pub fn derive(system: syntax::System) -> syn::Result<Derived> {
    let mut pool = Pool::bounded(limits::WORK);
    let model = check::model(&mut pool, system)?;
    let system = discrete::system::system(&mut pool, &model)?;
    let program = program::program(&mut pool, &model, &system)?;
    let findings = found::findings(&model, &system, &program);
    Ok(Derived { pool, model, system, program, findings })
}

/// The items of a derived system.
#[must_use]
pub fn items(derived: &Derived) -> TokenStream {
    emit::items(derived, emit::LIMIT)
}
