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
pub mod messages;
pub mod model;
pub mod program;
pub mod symbol;
pub mod syntax;

use model::check;
use proc_macro2::TokenStream;
use quote::quote;
use syntax::parse;

/// What a `lagrangian!` becomes: the items of the system, or its errors with a stub of the struct.
#[must_use]
pub fn expand(tokens: TokenStream) -> TokenStream {
    let system = match parse::system(tokens.clone()) {
        Ok(system) => system,
        Err(error) => {
            let (errors, stub) = (error.into_compile_error(), parse::outline(tokens).map(|system| emit::stub(&system)));
            return quote! { #errors #stub };
        }
    };
    let stub = emit::stub(&system);
    items(system).unwrap_or_else(|error| {
        let errors = error.into_compile_error();
        quote! { #errors #stub }
    })
}

fn items(system: syntax::System) -> syn::Result<TokenStream> {
    let mut model = check::model(system)?;
    let system = discrete::system::system(&mut model)?;
    let program = program::program(&mut model, &system)?;
    Ok(emit::items(&model, &system, &program))
}
