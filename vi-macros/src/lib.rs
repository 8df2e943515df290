//! The macro `lagrangian!`: a mechanical system becomes its variational integrators at build time.

use proc_macro::TokenStream;

/// Turns a mechanical system into its variational integrators.
///
/// In: a struct with the clauses `const`, `param`, `coord`, `let`, `L`, `force`, `dissipation`, `discretize` and `check`.
/// Out: the struct with its parameters, its implementations of `vi_core`'s traits, and a test for each check.
/// Every mistake is a compile error at the token that is wrong.
///
/// Where the variable `VI_EXPAND_DIR` is set while building, the expansion is written into that folder too.
#[proc_macro]
pub fn lagrangian(input: TokenStream) -> TokenStream {
    vi_codegen::file::expand(input.into()).into()
}
