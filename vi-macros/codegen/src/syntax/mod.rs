//! The language, as written: one type per clause, spans kept, nothing resolved.
//!
//! In: tokens. Out: a [`System`]. Grammar mistakes are all reported, clause by clause.
//! AFTER THIS no token stream is left, only spans.

mod expression;
pub mod parse;
mod unfitting;

use crate::rules::GAUSS;
pub use expression::{Expression, Kind, Operator, Range};
use proc_macro2::{Ident, Span};

/// The words that open a clause.
const CLAUSES: [&str; 10] =
    ["const", "param", "coord", "let", "L", "force", "dissipation", "time_scale", "discretize", "check"];

/// A `lagrangian!` as written.
pub struct System {
    /// Attributes and doc comments of the struct.
    pub attributes: Vec<syn::Attribute>,
    /// Visibility of the struct.
    pub visibility: syn::Visibility,
    /// Name of the struct.
    pub name: Ident,
    /// `const a = …;` in order.
    pub constants: Vec<Definition>,
    /// `param a = …, m[3] = …;` in order.
    pub parameters: Vec<Parameter>,
    /// `coord x, q[8];` in order.
    pub coordinates: Vec<Coordinate>,
    /// `let a = …;` in order.
    pub lets: Vec<Definition>,
    /// `L = …;`, each one that was written.
    pub lagrangians: Vec<Definition>,
    /// `force x = …;` in order; the name is the coordinate's.
    pub forces: Vec<Definition>,
    /// `dissipation = …;`, each one that was written.
    pub dissipations: Vec<Definition>,
    /// `time_scale = …;`, each one that was written.
    pub time_scales: Vec<Definition>,
    /// `discretize …;`, each one that was written.
    pub discretizations: Vec<Discretization>,
    /// `check { … }`, each one that was written.
    pub checks: Vec<Check>,
}

impl System {
    /// The number of rules that the system is declared with: those of a list, one that is written out, or none.
    #[must_use]
    pub fn rules(&self) -> usize {
        match self.discretizations.first() {
            Some(Discretization::Named(names)) => names.iter().filter(|name| *name != GAUSS).count(),
            Some(Discretization::Written(_)) => 1,
            None => 0,
        }
    }
}

/// A name with its expression.
pub struct Definition {
    /// Doc comments before it.
    pub attributes: Vec<syn::Attribute>,
    /// What is defined.
    pub name: Ident,
    /// Which entries of an array are defined.
    pub indices: Option<Indices>,
    /// As what.
    pub value: Expression,
}

/// Entries of an array.
pub enum Indices {
    /// `[i in 0..8]`: one definition for each value of the index.
    Range(Range),
    /// `[0]`: this entry.
    One(Expression),
}

/// A parameter, or an array of them.
pub struct Parameter {
    /// Attributes and doc comments of its field.
    pub attributes: Vec<syn::Attribute>,
    /// Its name.
    pub name: Ident,
    /// The length of an array.
    pub length: Option<Expression>,
    /// Its default.
    pub default: Default,
}

/// What a parameter is by default.
pub enum Default {
    /// `= 1.0`: this, and in an array each entry.
    Same(Expression),
    /// `= [1.0, 2.0]`: the entries of an array, in order.
    Each(Vec<Expression>),
}

/// A coordinate, or an array of them.
pub struct Coordinate {
    /// Its name.
    pub name: Ident,
    /// The length of an array.
    pub length: Option<Expression>,
}

/// How L becomes L_d.
pub enum Discretization {
    /// `discretize midpoint, trapezoidal;`: rules, the system's own first, and `gauss`, which is none.
    Named(Vec<Ident>),
    /// `discretize { Ld = …; … }`
    Written(Rule),
}

/// A rule written out: each line of it, in order.
pub struct Rule {
    /// Where the rule stands.
    pub span: Span,
    /// `Ld`, `fd_minus`, `fd_plus`, `gd_minus`, `gd_plus`.
    pub lines: Vec<Definition>,
}

/// `check { x = 1, dot(x) = 0, k = 2; h = 0.01; }`: where the system is checked.
pub struct Check {
    /// Where the word `check` stands.
    pub span: Span,
    /// The entries, in order; the last plain `h` is the step.
    pub entries: Vec<Entry>,
}

/// One entry of a check.
pub struct Entry {
    /// Whether it is written `dot(…)`.
    pub velocity: bool,
    /// The name, its index and the value.
    pub definition: Definition,
}
