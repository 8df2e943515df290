//! The clauses of the language: one table of their words.

use super::{Definition, System};
use proc_macro2::Span;

/// The token that has to follow a word for it to start a clause: elsewhere the word may be a name.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Next {
    /// Any token: the word always starts its clause.
    Any,
    /// A name.
    Name,
    /// `=`.
    Equals,
}

/// A clause of definitions, `force x = …;` or `L = …;`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Defining {
    /// `let a = …;`
    Let,
    /// `L = …;`
    Lagrangian,
    /// `H = …;`
    Hamiltonian,
    /// `force x = …;`; the name is the coordinate's.
    Force,
    /// `torque R = …;`; the name is the rotation's.
    Torque,
    /// `space_torque R = …;`
    SpaceTorque,
    /// `dissipation = …;`
    Dissipation,
    /// `constraint rod = …;`
    Constraint,
    /// `time_scale = …;`
    TimeScale,
}

/// The words of all clauses, in the order of messages.
pub(super) const CLAUSES: [(&str, Next, Option<Defining>); 20] = [
    ("const", Next::Any, None),
    ("param", Next::Any, None),
    ("input", Next::Name, None),
    ("coord", Next::Any, None),
    ("angle", Next::Any, None),
    ("rotation", Next::Name, None),
    ("momentum", Next::Any, None),
    ("fn", Next::Any, None),
    ("table", Next::Any, None),
    ("let", Next::Any, Some(Defining::Let)),
    ("L", Next::Equals, Some(Defining::Lagrangian)),
    ("H", Next::Any, Some(Defining::Hamiltonian)),
    ("force", Next::Any, Some(Defining::Force)),
    ("torque", Next::Name, Some(Defining::Torque)),
    ("space_torque", Next::Name, Some(Defining::SpaceTorque)),
    ("dissipation", Next::Any, Some(Defining::Dissipation)),
    ("constraint", Next::Name, Some(Defining::Constraint)),
    ("time_scale", Next::Any, Some(Defining::TimeScale)),
    ("discretize", Next::Any, None),
    ("check", Next::Any, None),
];

/// The words that start a clause.
pub fn clauses() -> impl Iterator<Item = &'static str> {
    CLAUSES.into_iter().map(|(word, ..)| word)
}

impl Defining {
    /// The clause that this word starts.
    pub(crate) fn of(word: &str) -> Option<Self> {
        CLAUSES.into_iter().find(|(of, ..)| *of == word)?.2
    }

    /// The word that starts it.
    pub(crate) fn word(self) -> &'static str {
        CLAUSES.into_iter().find(|(.., clause)| *clause == Some(self)).map_or("", |(word, ..)| word)
    }

    /// Whether its definitions have names.
    pub(crate) fn has_names(self) -> bool {
        !matches!(self, Self::Lagrangian | Self::Hamiltonian | Self::Dissipation | Self::TimeScale)
    }
}

impl System {
    /// The definitions of a clause, in order.
    #[must_use]
    pub fn all(&self, of: Defining) -> &[Definition] {
        self.definitions.get(&of).map_or(&[], Vec::as_slice)
    }

    /// The clauses that neither systems with constraints nor those of first order take, with their places.
    pub(crate) fn of_free_systems(&self) -> impl Iterator<Item = (&'static str, Span)> {
        let scales = self.all(Defining::TimeScale).iter().map(|of| (Defining::TimeScale.word(), of.name.span()));
        scales.chain(self.discretizations.iter().map(|of| ("discretize", of.span())))
    }
}
