//! The declarations in a Rust file.
//!
//! In: the text of a file. Out: the tokens of each `lagrangian!` in order: in modules, in functions, under any path
//! that ends in that name, but not in arguments of other macros. Spans refer to the text. An explicit stack replaces
//! recursion, so that any nesting depth works.

use proc_macro2::{TokenStream, TokenTree};
use syn::Result;

/// The tokens of each `lagrangian!` in a file.
///
/// # Errors
/// Text that the lexer of Rust rejects.
pub fn declarations(text: &str) -> Result<Vec<TokenStream>> {
    let tokens: TokenStream = without_shebang(text).parse()?;
    let mut found = Vec::new();
    let mut open = vec![tokens.into_iter()];
    while let Some(innermost) = open.last_mut() {
        let Some(token) = innermost.next() else {
            open.pop();
            continue;
        };
        match token {
            TokenTree::Group(group) => open.push(group.stream().into_iter()),
            TokenTree::Ident(name) => {
                let arguments = arguments(innermost);
                found.extend(arguments.filter(|_| name == "lagrangian"));
            }
            _ => {}
        }
    }
    Ok(found)
}

/// The arguments after the name of a macro, `!(…)` or `! name(…)`; consumes them.
fn arguments(behind: &mut proc_macro2::token_stream::IntoIter) -> Option<TokenStream> {
    let mut ahead = behind.clone();
    let is_call = matches!(ahead.next(), Some(TokenTree::Punct(mark)) if mark.as_char() == '!');
    let argument = match ahead.next().filter(|_| is_call)? {
        TokenTree::Ident(_) => ahead.next()?,
        other => other,
    };
    let TokenTree::Group(group) = argument else { return None };
    *behind = ahead;
    Some(group.stream())
}

/// The text after the line `#!…`, if it begins with one.
fn without_shebang(text: &str) -> &str {
    let has_one = text.starts_with("#!") && !text[2..].trim_start().starts_with('[');
    text.find('\n').filter(|_| has_one).map_or(text, |end| &text[end..])
}
