//! The macro `lagrangian!`, which turns a mechanical system into variational integrators at build time.

use proc_macro::TokenStream;

/// Turns a mechanical system into variational integrators.
///
/// In: a struct with clauses such as `param`, `coord`, `L` and `discretize`; `docs/reference.md` lists all. Out: the
/// struct with its parameters, its implementations of `vi_core`'s traits, and a test for each check. Every mistake is a
/// compile error at the wrong token.
///
/// If the variable `VI_EXPAND_DIR` is set during the build, the macro also writes the expansion into that folder.
#[proc_macro]
pub fn lagrangian(input: TokenStream) -> TokenStream {
    vi_codegen::file::expand(input.into()).into()
}
