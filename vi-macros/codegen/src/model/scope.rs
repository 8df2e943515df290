//! The names that an expression may use, and what they stand for.

use crate::messages::{Message, error, nearest};
use crate::symbol::Symbol;
use proc_macro2::Ident;
use std::collections::BTreeMap;
use syn::Result;
use vi_expr::{Expr, Function, Pool};

/// Names that the language keeps for itself, beside its functions.
const RESERVED: [&str; 8] = ["t", "pi", "L", "f", "self", "dot", "sum", "sqrt"];

/// Work of comparing two names, beside that of comparing each of their letters with each.
const COMPARISON: usize = 16;

/// The names that an expression may use.
#[derive(Default)]
pub(super) struct Scope {
    names: BTreeMap<String, Meaning>,
}

/// What a name stands for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    /// A parameter, constant, index or `let`, with its expression.
    Value(Expr),
    /// An array of `let`s: its first index, its entries.
    Values { first: i64, entries: Vec<Expr> },
    /// A coordinate, by its number.
    Coordinate(usize),
    /// An array of coordinates: the number of its first one, its length.
    Coordinates { first: usize, length: usize },
    /// Something that was reported wrong where it was declared: it reads as 1, with or without an index.
    Wrong,
}

impl Scope {
    /// Adds a name.
    ///
    /// # Errors
    /// The name is reserved, or was declared before.
    pub(super) fn declare(&mut self, name: &Ident, meaning: Meaning) -> Result<()> {
        let text = name.to_string();
        if RESERVED.contains(&text.as_str()) || Function::from_name(&text).is_some() {
            return Err(error(name.span(), &Message::Reserved { name: text }));
        }
        if self.names.contains_key(&text) {
            return Err(error(name.span(), &Message::Duplicate { name: text }));
        }
        self.names.insert(text, meaning);
        Ok(())
    }

    /// Removes an index after its range.
    pub(super) fn forget(&mut self, name: &str) {
        self.names.remove(name);
    }

    /// Gives a declared name another meaning: an index its next value.
    pub(super) fn set(&mut self, name: &str, meaning: Meaning) {
        if let Some(known) = self.names.get_mut(name) {
            *known = meaning;
        }
    }

    /// What a name stands for.
    pub(super) fn meaning(&self, name: &str) -> Option<&Meaning> {
        self.names.get(name)
    }

    /// Whether a name is a coordinate, or an array of them.
    pub(super) fn is_coordinate(&self, name: &str) -> bool {
        matches!(self.meaning(name), Some(Meaning::Coordinate(_) | Meaning::Coordinates { .. }))
    }

    /// The declared name nearest to a misspelt one.
    pub(super) fn near(&self, pool: &Pool<Symbol>, name: &str) -> Option<String> {
        self.near_of(pool, name, |_| true)
    }

    /// The coordinate nearest to a misspelt name.
    pub(super) fn near_coordinate(&self, pool: &Pool<Symbol>, name: &str) -> Option<String> {
        self.near_of(pool, name, |known| self.is_coordinate(known))
    }

    fn near_of(&self, pool: &Pool<Symbol>, name: &str, is_meant: impl Fn(&str) -> bool) -> Option<String> {
        pool.spend(self.names.len() * (COMPARISON + name.len() * name.len()));
        let known = self.names.keys().map(String::as_str).filter(|known| is_meant(known));
        if pool.is_exhausted() { None } else { nearest(name, known) }
    }
}
