//! The clauses of the language: one table of their words, which the parser and the messages read.

/// The token that has to follow a word for it to start a clause: elsewhere the word may be a name.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Next {
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
pub(crate) const CLAUSES: [(&str, Next, Option<Defining>); 20] = [
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
pub fn words() -> impl Iterator<Item = &'static str> {
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
