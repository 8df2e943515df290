//! The declarations in a Rust file.
//!
//! In: the text of a file. Out: the tokens of each `lagrangian!` in order: in modules, in functions, under any path
//! that ends in that name, but not in arguments of other macros. Spans refer to the text. An explicit stack replaces
//! recursion, so that any nesting depth works.

use core::iter::Peekable;
use proc_macro2::token_stream::IntoIter;
use proc_macro2::{TokenStream, TokenTree};
use syn::Result;

/// The tokens of each `lagrangian!` in a file.
///
/// # Errors
/// Text that the lexer of Rust rejects.
pub fn declarations(text: &str) -> Result<Vec<TokenStream>> {
    let tokens: TokenStream = without_shebang(text).parse()?;
    let mut found = Vec::new();
    let mut open = vec![tokens.into_iter().peekable()];
    while let Some(innermost) = open.last_mut() {
        let Some(token) = innermost.next() else {
            open.pop();
            continue;
        };
        match token {
            TokenTree::Group(group) => open.push(group.stream().into_iter().peekable()),
            TokenTree::Ident(name) => {
                let is_lagrangian = name == "lagrangian";
                found.extend(arguments(innermost).filter(|_| is_lagrangian));
            }
            _ => {}
        }
    }
    Ok(found)
}

/// The arguments after the name of a macro, `!(…)` or `! name(…)`; consumes them. A copy of the rest to look ahead would take
/// a time that is quadratic in the text.
fn arguments(behind: &mut Peekable<IntoIter>) -> Option<TokenStream> {
    behind.next_if(|token| matches!(token, TokenTree::Punct(mark) if mark.as_char() == '!'))?;
    behind.next_if(|token| matches!(token, TokenTree::Ident(_)));
    match behind.next_if(|token| matches!(token, TokenTree::Group(_)))? {
        TokenTree::Group(group) => Some(group.stream()),
        _ => None,
    }
}

/// The text after the line `#!…`, if it begins with one.
fn without_shebang(text: &str) -> &str {
    let has_one = text.starts_with("#!") && !text[2..].trim_start().starts_with('[');
    text.find('\n').filter(|_| has_one).map_or(text, |end| &text[end..])
}
