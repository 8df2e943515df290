//! What a text may contain that is compiled by itself, outside a crate of its author.
//!
//! In: the tokens of a system. Out: nothing, or a message at the first tokens that would run or read Rust: a Rust
//! function, a macro or another attribute with an effect. Tokens are examined, not characters: spaces, raw names and
//! comments hide nothing.

use super::{Body, parse};
use crate::messages::{Errors, FunctionMistake, Message};
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use syn::Result;

/// Checks that a text contains nothing but the language: no Rust functions, and no attributes but documentation and
/// derives of the standard library.
///
/// # Errors
/// Each such token. Text that does not parse is left to the compiler.
pub fn check(tokens: &TokenStream) -> Result<()> {
    let mut errors = Errors::default();
    // Parsing bounds the nesting, and reports what it refuses when the text is compiled.
    let Ok(system) = parse::system(tokens.clone()) else { return Ok(()) };
    for function in &system.functions {
        if let Body::Path(path) = &function.body {
            let name = function.name.to_string();
            let span = path.segments.first().map_or(function.name.span(), |first| first.ident.span());
            errors.at(span, &Message::Function(FunctionMistake::OfCrate { name }));
        }
    }
    let mut open = vec![tokens.clone().into_iter()];
    let mut is_behind_sign = false;
    while let Some(innermost) = open.last_mut() {
        let Some(token) = innermost.next() else {
            open.pop();
            continue;
        };
        let is_sign = matches!(&token, TokenTree::Punct(sign) if sign.as_char() == '#');
        if let TokenTree::Group(group) = &token {
            if is_behind_sign && !is_harmless(group.stream()) {
                errors.at(group.span_open(), &Message::AttributeOfText);
            }
            open.push(group.stream().into_iter());
        }
        is_behind_sign = is_sign;
    }
    errors.finish(())
}

/// Whether an attribute is `doc = "…"`, or `derive(…)` of plain names.
fn is_harmless(attribute: TokenStream) -> bool {
    let tokens: Vec<TokenTree> = attribute.into_iter().collect();
    match tokens.as_slice() {
        [TokenTree::Ident(word), TokenTree::Punct(equals), TokenTree::Literal(_)] => {
            word == "doc" && equals.as_char() == '='
        }
        [TokenTree::Ident(word), TokenTree::Group(names)] => {
            let is_name = |token: TokenTree| match token {
                TokenTree::Ident(_) => true,
                TokenTree::Punct(comma) => comma.as_char() == ',',
                TokenTree::Group(_) | TokenTree::Literal(_) => false,
            };
            word == "derive" && names.delimiter() == Delimiter::Parenthesis && names.stream().into_iter().all(is_name)
        }
        _ => false,
    }
}
