//! A scope of their own for the implementations, in which names mean what the emitted code means by them.
//!
//! In: the implementations. Out: they, in a block of items. Where the struct is declared there may be a `const x`, a `static x`
//! or a `struct x;`, and in their scope `let x = …` is a pattern that compares and no binding. So each name that is bound is
//! first one of a function, which a binding may shadow; and types that have no path are taken from `::core::primitive`. The list
//! is the end of the block, so that a reader meets the functions first.

use proc_macro2::{Delimiter, Ident, Spacing, TokenStream, TokenTree};
use quote::quote;
use vi_expr::Distinct;

/// Names on one line.
const TOGETHER: usize = 3;

/// The implementations in their scope.
pub(super) fn scope(attributes: &[&syn::Attribute], implementations: &TokenStream) -> TokenStream {
    let mut names = Distinct::default();
    bound(implementations.clone(), &mut names);
    let names: Vec<Ident> = names.into_iter().collect();
    let lines = names.chunks(TOGETHER).map(|names| quote!(use ::core::convert::{#(identity as #names),*};));
    quote! {
        #(#attributes)*
        #[allow(clippy::all, clippy::pedantic, deprecated, non_snake_case, unused_imports, unused_parens, unused_variables)]
        const _: () = {
            #implementations

            /// Every name that is bound above is one of a function first: a binding may shadow that, and no constant from around.
            use ::core::primitive::{bool, f64, str, usize};
            #(#lines)*
        };
    }
}

/// Collects the names that tokens bind: in patterns after `let` and `for`, and as parameters of functions and closures.
fn bound(tokens: TokenStream, names: &mut Distinct<Ident>) {
    let mut tokens = tokens.into_iter().peekable();
    let mut in_signature = false;
    while let Some(token) = tokens.next() {
        match token {
            TokenTree::Ident(word) if word == "let" || word == "for" => {
                let mut pattern = Vec::new();
                while let Some(token) = tokens.next_if(|token| !ends_pattern(token)) {
                    pattern.push(token);
                }
                // `impl Trait for Type { … }` binds nothing.
                if tokens.peek().is_some_and(|end| !is_brace(end)) {
                    in_pattern(pattern, names);
                }
            }
            TokenTree::Ident(word) if word == "fn" => in_signature = true,
            TokenTree::Punct(bar) if bar.as_char() == '|' => {
                while let Some(token) = tokens.next_if(|token| !is_punct(token, '|')) {
                    in_pattern([token], names);
                }
                tokens.next();
            }
            TokenTree::Group(group) if in_signature && group.delimiter() == Delimiter::Parenthesis => {
                in_signature = false;
                parameters(group.stream(), names);
            }
            TokenTree::Group(group) => bound(group.stream(), names),
            _ => {}
        }
    }
}

/// Collects the names before single colons.
fn parameters(tokens: TokenStream, names: &mut Distinct<Ident>) {
    let mut tokens = tokens.into_iter().peekable();
    while let Some(token) = tokens.next() {
        let is_single = |next: &TokenTree| matches!(next, TokenTree::Punct(next) if next.spacing() == Spacing::Alone);
        if tokens.peek().is_some_and(|next| is_punct(next, ':') && is_single(next)) {
            in_pattern([token], names);
        }
    }
}

/// Collects the names of a pattern.
fn in_pattern(tokens: impl IntoIterator<Item = TokenTree>, names: &mut Distinct<Ident>) {
    let mut open: Vec<TokenTree> = tokens.into_iter().collect();
    open.reverse();
    while let Some(token) = open.pop() {
        match token {
            TokenTree::Ident(name) if name != "mut" && name != "_" => drop(names.insert(name)),
            TokenTree::Group(group) => {
                let inner: Vec<TokenTree> = group.stream().into_iter().collect();
                open.extend(inner.into_iter().rev());
            }
            _ => {}
        }
    }
}

fn ends_pattern(token: &TokenTree) -> bool {
    is_punct(token, '=')
        || is_punct(token, ':')
        || is_brace(token)
        || matches!(token, TokenTree::Ident(word) if word == "in")
}

fn is_brace(token: &TokenTree) -> bool {
    matches!(token, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace)
}

fn is_punct(token: &TokenTree, character: char) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == character)
}
