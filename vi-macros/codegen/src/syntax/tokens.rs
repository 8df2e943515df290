//! What every clause reads: names, brackets, and tokens of Rust.

use super::BRACKETS;
use crate::messages::{ArrayMistake, Habit, Message, error};
use proc_macro2::{Ident, TokenStream, TokenTree};
use syn::Result;
use syn::ext::IdentExt;
use syn::parse::ParseStream;

/// Maximum nesting depth of an expression.
pub(crate) const DEPTH: usize = 100;

/// A name that may be declared.
pub(super) fn name(input: ParseStream) -> Result<Ident> {
    let span = input.span();
    let name = input.call(Ident::parse_any).map_err(|_| error(span, &Message::Expected { what: "a name" }))?;
    let text = name.to_string();
    if text == "mut" {
        return Err(error(span, &Message::Habit(Habit::Mutable)));
    }
    let is_keyword = syn::parse_str::<Ident>(&text).is_err();
    // `gen` is reserved since edition 2024, and tokens do not reveal their edition.
    if is_keyword || text.starts_with("r#") || text == "gen" {
        return Err(error(span, &Message::Reserved { name: text }));
    }
    Ok(name)
}

/// Whether a further index or length follows `before` others.
pub(super) fn has_bracket(input: ParseStream, before: usize) -> Result<bool> {
    let is_here = input.peek(syn::token::Bracket);
    if is_here && before == BRACKETS {
        return Err(error(input.span(), &Message::Array(ArrayMistake::Brackets { limit: BRACKETS })));
    }
    Ok(is_here)
}

/// Rejects tokens of Rust that may be nested deeper than any that is written, since parsing them recurses: besides
/// delimiters, these signs open a level of an expression or of a type.
pub(super) fn check_rust(tokens: TokenStream) -> Result<()> {
    let (mut open, mut signs) = (vec![tokens.into_iter()], 0);
    while let Some(innermost) = open.last_mut() {
        match innermost.next() {
            None => drop(open.pop()),
            Some(TokenTree::Group(group)) => open.push(group.stream().into_iter()),
            Some(TokenTree::Punct(sign)) if "<!-&*".contains(sign.as_char()) => {
                signs += 1;
                if signs > DEPTH {
                    return Err(error(sign.span(), &Message::TooDeep { limit: DEPTH }));
                }
            }
            Some(_) => {}
        }
    }
    Ok(())
}
