//! The expansion as a file, where the variable `VI_EXPAND_DIR` asks for it.
//!
//! In: the tokens of a `lagrangian!`. Out: its expansion, and a line that makes cargo build again when the variable
//! changes. A system with mistakes is not written; a file that cannot be written is a compile error with the reason.

use proc_macro2::TokenStream;
use quote::quote;
use std::env;
use std::path::Path;

/// Expands a system, and writes the expansion where it is wanted.
pub(crate) fn expand(tokens: TokenStream) -> TokenStream {
    let expansion = vi_codegen::expand(tokens.clone());
    let written = match env::var_os("VI_EXPAND_DIR") {
        Some(folder) if !folder.is_empty() => write(tokens, Path::new(&folder)),
        _ => Ok(()),
    };
    let error = written.err().map(|reason| quote!(::core::compile_error! { #reason }));
    quote! {
        #expansion
        #error
        const _: ::core::option::Option<&str> = ::core::option_env!("VI_EXPAND_DIR");
    }
}

fn write(tokens: TokenStream, folder: &Path) -> Result<(), String> {
    // Mistakes are reported by the expansion itself.
    let Ok(derived) = vi_codegen::syntax::parse::system(tokens).and_then(vi_codegen::derive) else { return Ok(()) };
    let name = derived.model.name.to_string();
    let text = vi_codegen::pretty::text(vi_codegen::items(&derived)).map_err(|error| error.to_string())?;
    match vi_codegen::pretty::write(folder, &name, &text) {
        Ok(_) => Ok(()),
        Err(error) => Err(format!(
            "cannot write the expansion of `{name}` into `{}`: {error}\n\
             help: set `VI_EXPAND_DIR` to a folder that can be written, or unset it",
            folder.display()
        )),
    }
}
