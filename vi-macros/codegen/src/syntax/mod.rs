//! The language, as written: one type per clause, spans kept, nothing resolved.
//!
//! In: tokens. Out: a [`System`]. Grammar mistakes are all reported, clause by clause.
//! AFTER THIS no token stream is left, only spans.

mod expression;
pub mod parse;

pub use expression::{Expression, Kind, Operator};
use proc_macro2::{Ident, Span};

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
    /// `param a = …;` in order.
    pub parameters: Vec<Definition>,
    /// `coord x;` in order.
    pub coordinates: Vec<Ident>,
    /// `let a = …;` in order.
    pub lets: Vec<Definition>,
    /// `L = …;`, each one that was written.
    pub lagrangians: Vec<Definition>,
    /// `force x = …;` in order; the name is the coordinate's.
    pub forces: Vec<Definition>,
    /// `discretize …;`, each one that was written.
    pub discretizations: Vec<Discretization>,
}

/// A name with its expression.
pub struct Definition {
    /// Doc comments before it.
    pub attributes: Vec<syn::Attribute>,
    /// What is defined.
    pub name: Ident,
    /// As what.
    pub value: Expression,
}

/// How L becomes L_d.
pub enum Discretization {
    /// `discretize midpoint;`
    Named(Ident),
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
