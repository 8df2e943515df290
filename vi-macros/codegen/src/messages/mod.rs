//! Every message of `lagrangian!` to its users: what is wrong, what to write instead, and inputs that provoke it.
//!
//! In: an error found by a stage. Out: its text: the error, then the correction; lower case, no full stop. A stage
//! collects its errors in [`Errors`] and reports them all before the next stage starts. A test gives each input to the
//! compiler.

/// An enum of messages. An entry is a variant with the words that its texts name, what is wrong, what to write instead,
/// and examples: inputs with the wrong token in `«»`, and the words of their message.
macro_rules! catalogue {
    (
        $(#[$attribute:meta])* $name:ident $(($($group:ident($mistake:ty)),*))?:
        $($variant:ident $({ $($field:ident: $type:ty),* })? = $what:tt, $help:tt
            $(, [$($input:literal),*] $({ $($word:ident: $value:expr),* })?)*;)*
    ) => {
        $(#[$attribute])*
        #[allow(missing_docs)] // the texts
        #[derive(Clone, Debug, PartialEq, Eq)]
        pub enum $name {
            $($variant $({ $($field: $type),* })?,)*
            $($($group($mistake),)*)?
        }

        #[allow(unused_variables)] // a text names some of the words
        impl $name {
            /// What is wrong.
            #[must_use]
            pub fn what(&self) -> String {
                match self {
                    $(Self::$variant { $($($field),*)? } => text!($what),)*
                    $($(Self::$group(mistake) => mistake.what(),)*)?
                }
            }

            /// What to write instead.
            #[must_use]
            pub fn help(&self) -> String {
                match self {
                    $(Self::$variant { $($($field),*)? } => text!($help),)*
                    $($(Self::$group(mistake) => mistake.help(),)*)?
                }
            }

            /// Inputs and their messages.
            #[cfg(test)]
            pub(crate) fn examples() -> Vec<(&'static [&'static str], Self)> {
                #[allow(unused_imports)] // messages without words
                use crate::messages::examples::word;
                vec![$($((&[$($input),*], Self::$variant { $($($word: word($value)),*)? }),)*)*]
            }
        }
    };
}

/// A text with the words of its message, or code that writes one.
macro_rules! text {
    ($text:literal) => {
        format!($text)
    };
    ($code:block) => {
        $code
    };
}

mod arrays;
pub(crate) mod characters;
mod constraints;
#[cfg(test)]
mod examples;
mod functions;
mod general;
mod habits;
mod hamiltonian;
pub(crate) mod words;

pub use arrays::ArrayMistake;
pub use characters::Character;
pub use constraints::ConstraintMistake;
pub use functions::FunctionMistake;
pub use general::{Absence, FirstOrder, Massless, Message, Singular};
pub use habits::Habit;
pub use hamiltonian::HamiltonianMistake;

pub(crate) use arrays::bracketed;

use proc_macro2::Span;
use std::collections::BTreeSet;

/// Messages shown for one system; a last message counts the others.
const SHOWN: usize = 30;

/// The errors of a stage or of a part of it, in the order found.
#[derive(Debug, Default)]
pub struct Errors {
    combined: Option<syn::Error>,
    /// Texts reported so far.
    texts: BTreeSet<String>,
}

impl Errors {
    /// Adds a message at a token.
    pub fn at(&mut self, span: Span, message: &Message) {
        self.add(error(span, message));
    }

    /// Adds an existing error.
    pub fn add(&mut self, error: syn::Error) {
        self.texts.insert(error.to_string());
        match &mut self.combined {
            Some(combined) => combined.combine(error),
            None => self.combined = Some(error),
        }
    }

    /// The part, or `None` after adding its errors. Skips texts that were reported before.
    pub fn keep<P>(&mut self, part: syn::Result<P>) -> Option<P> {
        let error = match part {
            Ok(part) => return Some(part),
            Err(error) => error,
        };
        for one in error {
            if !self.texts.contains(&one.to_string()) {
                self.add(one);
            }
        }
        None
    }

    /// Whether there are no errors.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.combined.is_none()
    }

    /// The product, if there are no errors.
    ///
    /// # Errors
    /// All collected errors.
    pub fn finish<P>(self, product: P) -> syn::Result<P> {
        match self.combined {
            Some(error) => Err(error),
            None => Ok(product),
        }
    }
}

/// Whether errors say that a system is too large.
pub(crate) fn is_too_large(errors: &syn::Error) -> bool {
    errors.clone().into_iter().any(|error| error.to_string().contains(general::LARGE))
}

/// The first [`SHOWN`] messages of a system and the number of further ones: each prints its source line, which may be
/// long.
#[must_use]
pub(crate) fn bounded(errors: syn::Error) -> syn::Error {
    let count = errors.clone().into_iter().count();
    if count <= SHOWN + 1 {
        return errors;
    }
    let mut first = Errors::default();
    for (index, one) in errors.into_iter().take(SHOWN + 1).enumerate() {
        if index < SHOWN {
            first.add(one);
        } else {
            first.at(one.span(), &Message::More { count: count - SHOWN });
        }
    }
    first.combined.unwrap_or_else(|| error(Span::call_site(), &Message::More { count }))
}

/// One error at a token.
#[must_use]
pub fn error(span: Span, message: &Message) -> syn::Error {
    syn::Error::new(span, message.text())
}

/// The candidate nearest to a misspelt name, if at most a third of its letters differ.
#[must_use]
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    candidates
        .into_iter()
        .map(|candidate| (distance(name, candidate), candidate))
        .filter(|(distance, candidate)| *distance <= candidate.chars().count().max(name.chars().count()).div_ceil(3))
        .filter(|(distance, candidate)| *distance < candidate.chars().count())
        // Ties go to the longer common prefix: typing errors are more frequent at the end of a word.
        .min_by_key(|(distance, candidate)| {
            let beginning = name.chars().zip(candidate.chars()).take_while(|(a, b)| a == b).count();
            (*distance, core::cmp::Reverse(beginning), *candidate)
        })
        .map(|(_, candidate)| candidate.to_owned())
}

/// Levenshtein distance: insertions, deletions and replacements that turn one name into the other.
fn distance(left: &str, right: &str) -> usize {
    let right: Vec<char> = right.chars().collect();
    let mut row: Vec<usize> = (0..=right.len()).collect();
    for (i, a) in left.chars().enumerate() {
        let mut diagonal = i;
        row[0] = i + 1;
        for (j, b) in right.iter().enumerate() {
            let replaced = diagonal + usize::from(a != *b);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[right.len()]
}
