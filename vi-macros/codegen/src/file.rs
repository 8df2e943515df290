//! Writes the expansion to a file if the variable `VI_EXPAND_DIR` is set.
//!
//! In: the tokens of a `lagrangian!`. Out: its expansion, and a line that makes cargo rebuild when the variable
//! changes. A system with mistakes is not written. A failed write is a compile error with its reason.

use crate::{Compiled, pretty};
use proc_macro2::{Span, TokenStream};
use quote::quote;
use std::env;
use std::path::Path;

/// Expands a system, and writes the expansion if `VI_EXPAND_DIR` is set.
#[must_use]
#[allow(clippy::needless_pass_by_value, reason = "a macro is given them")]
pub fn expand(tokens: TokenStream) -> TokenStream {
    let folder = env::var_os("VI_EXPAND_DIR").filter(|folder| !folder.is_empty());
    expand_into(&tokens, folder.as_ref().map(Path::new))
}

fn expand_into(tokens: &TokenStream, folder: Option<&Path>) -> TokenStream {
    // A system with mistakes expands to its errors and writes no file.
    let (items, error) = match Compiled::from_tokens(tokens.clone()) {
        Ok(compiled) => {
            let mut items = compiled.items();
            // Only tokens that are not nested too deep become text: that recurses.
            items.extend(crate::emit::structure::described(compiled.model(), &definition(tokens)));
            let written = folder.map_or(Ok(()), |folder| write(&compiled, folder));
            (items, written.err().map(|reason| quote!(::core::compile_error! { #reason })))
        }
        Err(errors) => (errors, None),
    };
    quote! {
        #items
        #error
        const _: ::core::option::Option<&::core::primitive::str> = ::core::option_env!("VI_EXPAND_DIR");
    }
}

/// The declaration as it was written; the text of its tokens if the compiler has no other, as inside another macro.
fn definition(tokens: &TokenStream) -> String {
    let tokens = tokens.to_string();
    let written = Span::call_site().source_text().and_then(|invocation| inside(&invocation));
    let is_same = |text: &String| text.parse::<TokenStream>().is_ok_and(|other| other.to_string() == tokens);
    written.filter(is_same).unwrap_or(tokens)
}

/// The text between the brackets of the invocation of a macro, without its common indentation.
fn inside(invocation: &str) -> Option<String> {
    let (_, behind) = invocation.split_once('!')?;
    let text = behind.trim().get(1..)?.strip_suffix(['}', ')', ']'])?;
    let lines = || text.lines().filter(|line| !line.trim().is_empty());
    let indent = lines().map(|line| line.len() - line.trim_start().len()).min()?;
    let lines: Vec<&str> = text.lines().map(|line| line.get(indent..).unwrap_or_default()).collect();
    Some(lines.join("\n").trim().to_owned())
}

fn write(compiled: &Compiled, folder: &Path) -> Result<(), String> {
    let name = &compiled.model().name.to_string();
    let text = compiled.text().map_err(|error| error.to_string())?;
    match pretty::write(folder, name, &text) {
        Ok(_) => Ok(()),
        Err(error) => Err(format!(
            "cannot write the expansion of `{name}` into `{}`: {error}\n\
             help: set `VI_EXPAND_DIR` to a folder that can be written, or unset it",
            folder.display()
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    const SYSTEM: &str = "struct FreeParticle { coord x; L = dot(x)^2 / 2; discretize midpoint; }";

    fn expansion(text: &str, folder: Option<&Path>) -> String {
        expand_into(&text.parse().expect("tokens of Rust"), folder).to_string()
    }

    #[test]
    fn a_definition_is_the_text_as_written() {
        let invocation =
            "lagrangian! {\n    /// Free.\n    struct Free {\n        coord x;\n\n        L = dot(x)^2;\n    }\n}";
        let written = "/// Free.\nstruct Free {\n    coord x;\n\n    L = dot(x)^2;\n}";
        assert_eq!(inside(invocation).as_deref(), Some(written));
        assert_eq!(inside("vi_macros::lagrangian!(struct A {})").as_deref(), Some("struct A {}"));
        assert_eq!(inside("other tokens"), None);
    }

    #[test]
    fn a_file_is_written_on_request() {
        let folder = env::temp_dir().join(format!("vi-expand-{}", std::process::id()));
        let inner = folder.join("of").join("its own");
        assert_eq!(expansion(SYSTEM, None), expansion(SYSTEM, Some(&inner)), "the expansion itself is the same");
        let written = fs::read_to_string(inner.join("free_particle.rs")).expect("the file");
        assert!(
            written.starts_with("// `FreeParticle`: L = dot(x)^2/2\n//\n// Operation counts by method\n"),
            "{written}"
        );
        assert!(written.contains("::vi_core::stepping::FixedStepping<1, T>"));
        // A system with mistakes reports them and writes no file.
        assert!(expansion("struct Wrong { coord x; }", Some(&inner)).contains("compile_error"));
        assert_eq!(fs::read_dir(&inner).expect("the folder").count(), 1);
        // A file has the name of the folder.
        let blocked = inner.join("free_particle.rs");
        let error = expansion(SYSTEM, Some(&blocked));
        assert!(error.contains("cannot write the expansion of `FreeParticle` into `"), "{error}");
        fs::remove_dir_all(&folder).expect("the folder can be removed");
    }

    #[test]
    fn a_large_system_is_written_too() {
        let system = "#[vi_limit(0)] struct Row { coord q[5]; \
            L = sum(i in 0..5, dot(q[i])^2) / 2 - sum(i in 1..5, (q[i] - q[i - 1])^4); discretize midpoint; }";
        let folder = env::temp_dir().join(format!("vi-expand-large-{}", std::process::id()));
        let expanded = expansion(system, Some(&folder));
        assert!(!expanded.contains("compile_error"), "{expanded}");
        assert!(expanded.contains("option_env !"), "cargo builds it again when the variable changes");
        let written = fs::read_to_string(folder.join("row.rs")).expect("the file");
        assert!(written.starts_with("// `Row`: L = ") && written.contains("\n// Functions in loops: "), "{written}");
        assert!(written.contains("impl<T: ::vi_core::real::Real> ::vi_core::indexed::Indexed<5, T> for Row<T>"));
        fs::remove_dir_all(&folder).expect("the folder can be removed");
    }

    #[test]
    fn cargo_builds_again_when_the_variable_changes() {
        let line = quote!(
            const _: ::core::option::Option<&::core::primitive::str> = ::core::option_env!("VI_EXPAND_DIR");
        )
        .to_string();
        assert!(expansion(SYSTEM, None).ends_with(&line));
    }
}
