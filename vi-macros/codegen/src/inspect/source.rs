//! The declarations in a file of Rust.
//!
//! In: the text of a file. Out: the tokens of each `lagrangian!` in it, in order, wherever it stands: in modules, in
//! functions, under any path that ends in that name. Their spans are places in the text.

use proc_macro2::TokenStream;
use syn::visit::Visit;

/// The tokens of each `lagrangian!` in a file.
///
/// # Errors
/// What is no Rust.
pub fn declarations(text: &str) -> syn::Result<Vec<TokenStream>> {
    let file = syn::parse_file(text)?;
    let mut found = Declarations::default();
    found.visit_file(&file);
    Ok(found.0)
}

#[derive(Default)]
struct Declarations(Vec<TokenStream>);

impl<'a> Visit<'a> for Declarations {
    fn visit_macro(&mut self, called: &'a syn::Macro) {
        if called.path.segments.last().is_some_and(|last| last.ident == "lagrangian") {
            self.0.push(called.tokens.clone());
        }
    }
}
