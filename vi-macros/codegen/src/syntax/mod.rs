//! The language as written: one type per clause, with spans, unresolved.
//!
//! In: tokens. Out: a [`System`]. Every clause reports its grammar mistakes.
//! The system keeps the spans of the tokens and nothing else of them.

pub mod alone;
mod expression;
mod function;
pub mod parse;
mod tokens;
mod unexpected;

pub use crate::clause::Defining;
use crate::rules::{self, GAUSS, NamedRule};
pub use expression::{Comparison, Expression, Kind, Operator, Range};
pub use function::{Body, Function, Table, TableArgument, TableData};
use proc_macro2::{Ident, Span};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::rc::Rc;

/// Maximum number of indices of an array.
const BRACKETS: usize = 100;
/// The tokens expected after an index or a length.
const INSIDE_BRACKETS: &str = "an operator or `]`";
/// What the end of an entry of a list expects.
const INSIDE_LIST: &str = "an operator, `,` or `]`";

/// A `lagrangian!` as written.
pub struct System {
    /// Attributes and doc comments of the struct.
    pub attributes: Vec<syn::Attribute>,
    /// Visibility of the struct.
    pub visibility: syn::Visibility,
    /// Name of the struct.
    pub name: Ident,
    /// `const a = …, s[3] = …;` in order.
    pub constants: Vec<Constant>,
    /// `param a = …, m[3] = …;` and `input u = …;` in order.
    pub parameters: Vec<Parameter>,
    /// `coord x, q[8];`, `angle θ;` and `rotation R;` in order.
    pub coordinates: Vec<Coordinate>,
    /// `momentum p of q;` in order.
    pub momenta: Vec<Momentum>,
    /// `fn f(a) = …;` in order.
    pub functions: Vec<Rc<Function>>,
    /// `table f(a) = …;` in order.
    pub tables: Vec<Table>,
    /// The folder of the paths of tables.
    pub folder: PathBuf,
    /// The texts of files that are known, by their paths from the folder; others are read.
    pub files: BTreeMap<PathBuf, String>,
    /// `let a = …;`, `L = …;`, `force x = …;` and alike, each occurrence in order.
    pub definitions: BTreeMap<Defining, Vec<Definition>>,
    /// Whether a `constraint` or a `rotation` is declared, readable or not.
    pub is_constrained: bool,
    /// `discretize …;`, each occurrence.
    pub discretizations: Vec<Discretization>,
    /// `check { … }`, each occurrence.
    pub checks: Vec<Check>,
}

impl System {
    /// The number of declared rules: the length of the list, 1 for a written-out rule, or 0.
    #[must_use]
    pub fn rules(&self) -> usize {
        match self.discretizations.first() {
            Some(Discretization::Named(names)) => names.iter().filter(|name| *name != GAUSS).count(),
            Some(Discretization::Written(_)) => 1,
            None => 0,
        }
    }

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

    /// The clause of the function that defines the motion: `L`, or `H`.
    pub(crate) fn function(&self) -> Option<&Definition> {
        self.all(Defining::Lagrangian).first().or(self.all(Defining::Hamiltonian).first())
    }

    /// Removes the rules of a system without constraints, if they are built-in ones, and returns the first. Others stay,
    /// with their mistakes.
    pub fn take_named_rules(&mut self) -> Option<&'static NamedRule> {
        let [Discretization::Named(names)] = self.discretizations.as_slice() else { return None };
        let are_known = names.iter().all(|name| *name == GAUSS || rules::named(&name.to_string()).is_some());
        let are_different = (1..names.len()).all(|index| !names[..index].contains(&names[index]));
        if !(are_known && are_different && self.all(Defining::Constraint).is_empty()) {
            return None;
        }
        let first = *self.named_rules().first()?;
        self.discretizations.clear();
        Some(first)
    }

    /// Reads the files of tables that are not known. The check reports those that cannot be read.
    pub fn read_files(&mut self) {
        for table in &self.tables {
            let TableData::File(path) = &table.data else { continue };
            let path = self.folder.join(path.value());
            if !self.files.contains_key(&path)
                && std::fs::metadata(&path).is_ok_and(|about| is_readable(&about))
                && let Ok(text) = std::fs::read_to_string(&path)
            {
                self.files.insert(path, text);
            }
        }
    }

    /// The declared built-in rules, in order.
    #[must_use]
    pub fn named_rules(&self) -> Vec<&'static NamedRule> {
        match self.discretizations.first() {
            Some(Discretization::Named(names)) => {
                names.iter().filter_map(|name| rules::named(&name.to_string())).collect()
            }
            _ => Vec::new(),
        }
    }
}

/// Largest file of a table, in bytes.
const LARGEST_FILE: u64 = 16_000_000;

/// Whether a file of a table is read: a device has no end.
pub(crate) fn is_readable(about: &std::fs::Metadata) -> bool {
    about.is_file() && about.len() <= LARGEST_FILE
}

/// A name with its expression.
pub struct Definition {
    /// Doc comments before it.
    pub attributes: Vec<syn::Attribute>,
    /// The defined name.
    pub name: Ident,
    /// The entries of an array that are defined, one for each pair of brackets.
    pub indices: Vec<Indices>,
    /// Its value.
    pub value: Expression,
}

/// Entries of an array.
pub enum Indices {
    /// `[i in 0..8]`: one definition for each value of the index.
    Range(Range),
    /// `[0]`: this entry.
    One(Expression),
}

/// A constant, or an array of them.
pub struct Constant {
    /// Doc comments before it.
    pub attributes: Vec<syn::Attribute>,
    /// Its name.
    pub name: Ident,
    /// The lengths of an array, one for each pair of brackets; an array may omit them.
    pub lengths: Vec<Expression>,
    /// Its value: a number, for each entry of an array, or a list of them.
    pub value: Expression,
}

/// A parameter, or an array of them.
pub struct Parameter {
    /// Attributes and doc comments of its field.
    pub attributes: Vec<syn::Attribute>,
    /// Its name.
    pub name: Ident,
    /// The lengths of an array, one for each pair of brackets.
    pub lengths: Vec<Expression>,
    /// Its default: a number, for each entry of an array, or a list of them.
    pub default: Expression,
    /// Whether it is declared by `input`.
    pub is_input: bool,
}

impl Parameter {
    /// The word that declares it.
    #[must_use]
    pub fn clause(&self) -> &'static str {
        clause_of(self.is_input)
    }
}

/// The word that declares a parameter or an input.
fn clause_of(is_input: bool) -> &'static str {
    if is_input { "input" } else { "param" }
}

/// A coordinate, or an array of them.
pub struct Coordinate {
    /// Its name.
    pub name: Ident,
    /// The lengths of an array, one for each pair of brackets.
    pub lengths: Vec<Expression>,
    /// What it is.
    pub space: Space,
}

/// What a coordinate is, by the word that declares it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Space {
    /// A number: `coord`.
    Line,
    /// An angle modulo 2π: `angle`.
    Circle,
    /// An orientation, with four components: `rotation`.
    Rotation,
}

impl Space {
    /// The word that declares it.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Line => "coord",
            Self::Circle => "angle",
            Self::Rotation => "rotation",
        }
    }
}

/// The momentum of a coordinate, or those of an array of coordinates.
pub struct Momentum {
    /// Its name.
    pub name: Ident,
    /// The name of the coordinate.
    pub of: Ident,
}

/// The rule from L to L_d.
pub enum Discretization {
    /// `discretize midpoint, trapezoidal;`: rules, the default first, and `gauss`, which is not a rule.
    Named(Vec<Ident>),
    /// `discretize { Ld = …; … }`
    Written(Rule),
}

impl Discretization {
    /// Its location: the first name, or the lines.
    #[must_use]
    pub fn span(&self) -> Span {
        match self {
            Self::Named(names) => names.first().map_or_else(Span::call_site, Ident::span),
            Self::Written(rule) => rule.span,
        }
    }
}

/// A written-out rule: its lines, in order.
pub struct Rule {
    /// Its location.
    pub span: Span,
    /// `Ld`, `fd_minus`, `fd_plus`, `gd_minus`, `gd_plus`.
    pub lines: Vec<Definition>,
}

/// `check { x = 1, dot(x) = 0, k = 2; h = 0.01; }`: the state of the checks.
pub struct Check {
    /// The location of the word `check`.
    pub span: Span,
    /// The entries, in order; the last plain `h` is the step.
    pub entries: Vec<CheckEntry>,
}

/// One entry of a check.
pub struct CheckEntry {
    /// Whether it is written `dot(…)`.
    pub velocity: bool,
    /// The name, its index and the value.
    pub definition: Definition,
}
