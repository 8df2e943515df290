//! The checked system: its names, its parts, and L and f as expressions.
//!
//! In: a [`System`](crate::syntax::System). Out: a [`Model`], whose expressions are in the pool. From here on every name,
//! including those of the rule, is resolved and every number is exact. L and f are expressions in
//! [`Symbol::Continuous`](crate::symbol::Symbol) and parameters only. The remaining spans are those of declared names.

mod angles;
mod array;
mod called;
pub mod check;
mod check_state;
mod closed;
mod condition;
pub(crate) mod constraint;
mod context;
mod dissipation;
mod first_order;
mod force;
mod function;
mod hamiltonian;
mod inverse;
pub(crate) mod legendre;
mod lengths;
mod lets;
mod mass;
mod mobility;
mod point;
mod probe;
mod resolve;
mod rotation;
pub(crate) mod rule;
mod scope;
mod singular;
mod smoothness;
mod table;
mod time_scale;
mod timeless;
mod value;
mod vector;

pub use check_state::CheckState;
pub use closed::{LetArray, rate};
pub use function::{Function, FunctionKind};
pub use point::Point;
pub(crate) use rotation::COMPONENTS;
pub use rule::{DiscreteForces, Rule};
pub use smoothness::Smoothness;
pub use table::{Outside, Table, TableKind, Values};

use crate::messages::bracketed;
use crate::symbol::{LetEntry, Symbol, Variable};
pub use crate::syntax::Space;
use proc_macro2::{Ident, Span};
use vi_expr::{Expr, Node, Pool};

/// A constraint, or one entry of an array of them.
#[derive(Clone)]
pub struct Constraint {
    /// Its name as declared.
    pub name: Ident,
    /// Its indices in an array; none outside.
    pub indices: Vec<i64>,
    /// g(t, q), or A v + a, by coordinates.
    pub value: Expr,
    /// The same with entries of arrays of `let`s, if these stay symbols.
    pub written: Expr,
    /// Whether it constrains positions.
    pub is_holonomic: bool,
}

/// Maximum characters of a number written without a power of ten.
const CHARACTERS: usize = 20;

/// A checked system.
pub struct Model {
    /// Attributes and doc comments of the struct.
    pub attributes: Vec<syn::Attribute>,
    /// Visibility of the struct.
    pub visibility: syn::Visibility,
    /// Name of the struct.
    pub name: Ident,
    /// Runtime parameters; the entries of an array are adjacent.
    pub parameters: Vec<Parameter>,
    /// Coordinates.
    pub coordinates: Vec<Coordinate>,
    /// Rust functions and tables.
    pub functions: Vec<Function>,
    /// L(t, q, v).
    pub lagrangian: Expr,
    /// Where L is declared.
    pub lagrangian_span: Span,
    /// f(t, q, v), one component per coordinate; zero without a declaration.
    pub forces: Vec<Expr>,
    /// Rayleigh's function R, if −∂R/∂v is not part of `forces`: where arrays of `let`s are symbols.
    pub dissipation: Option<Expr>,
    /// The smoothness of L and f, if tables or conditions limit it.
    pub smoothness: Option<Smoothness>,
    /// Whether a force is declared that is not identically zero.
    pub forced: bool,
    /// For each coordinate of a system whose L is linear in the velocities, whether L does not contain its velocity; empty
    /// for all other systems.
    pub without_velocity: Vec<bool>,
    /// The constraints, the holonomic ones first.
    pub constraints: Vec<Constraint>,
    /// g(t, q) of the time transformation dt = g dτ, if declared.
    pub time_scale: Option<Expr>,
    /// Arrays of `let`s whose entries are symbols in L and f; none if expressions replace them.
    pub lets: Vec<LetArray>,
    /// The rule from L to L_d; `None` for a system with Gauss steps only.
    pub rule: Option<Rule>,
    /// The state of the checks, if there is a `check` clause.
    pub check_state: Option<CheckState>,
}

/// The place of a function in the equations of motion.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// L.
    Lagrangian,
    /// A component of f.
    Force,
    /// Rayleigh's function R.
    Dissipation,
    /// g of the time transformation dt = g dτ.
    TimeScale,
    /// An expression that is 0.
    Constraint,
}

impl Role {
    /// The order of derivatives of L to which it is added; `None` if its smoothness does not limit that of the motion.
    const fn order(self) -> Option<usize> {
        match self {
            // The derivatives of R are forces.
            Self::Lagrangian | Self::Dissipation => Some(0),
            Self::Force => Some(1),
            Self::TimeScale | Self::Constraint => None,
        }
    }
}

/// A coordinate.
#[derive(Clone)]
pub struct Coordinate {
    /// Its name as declared.
    pub name: Ident,
    /// Its indices in an array; none outside.
    pub indices: Vec<usize>,
    /// What it is. L, f and the time scale are 2π-periodic in an angle, and a run reduces it; a rotation has four of
    /// these coordinates.
    pub space: Space,
}

impl Coordinate {
    /// Its place in a quaternion, scalar first; `None` outside of a rotation.
    #[must_use]
    pub fn component(&self) -> Option<usize> {
        self.indices.last().copied().filter(|_| self.space == Space::Rotation)
    }

    /// The name as the user writes it: `x`, or `q[3]`.
    #[must_use]
    pub fn text(&self) -> String {
        text(&self.name, &self.indices)
    }

    /// The name as an identifier: `x`, or `q_3`.
    #[must_use]
    pub fn ident(&self) -> String {
        ident(&self.name, &self.indices)
    }
}

/// A name as an identifier, with its indices in an array.
fn ident(name: &Ident, indices: &[usize]) -> String {
    indices.iter().fold(name.to_string(), |text, index| format!("{text}_{index}"))
}

/// A name as the user writes it, with its indices in an array.
fn text(name: &Ident, indices: &[usize]) -> String {
    name.to_string() + &bracketed(indices)
}

/// The indices of all entries of an array of these lengths, row by row; no indices for no lengths.
fn indices(lengths: &[usize]) -> Vec<Vec<usize>> {
    lengths.iter().fold(vec![Vec::new()], |rows, length| {
        let with = |row: &Vec<usize>, index: usize| row.iter().copied().chain([index]).collect();
        rows.iter().flat_map(|row| (0..*length).map(move |index| with(row, index))).collect()
    })
}

/// A runtime parameter, or one entry of an array of them.
pub struct Parameter {
    /// The attributes and doc comments of its field.
    pub attributes: Vec<syn::Attribute>,
    /// The name of its field.
    pub name: Ident,
    /// Its indices in an array; none outside.
    pub indices: Vec<usize>,
    /// Its value in `Default`.
    pub default: f64,
    /// Whether a controller sets it between steps: declared by `input`.
    pub is_input: bool,
}

/// The text of doc comments.
fn words(attributes: &[syn::Attribute]) -> String {
    let lines = attributes.iter().filter_map(|attribute| match &attribute.meta {
        syn::Meta::NameValue(syn::MetaNameValue {
            path,
            value: syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }),
            ..
        }) if path.is_ident("doc") => Some(text.value()),
        _ => None,
    });
    let lines: Vec<String> = lines.map(|line| line.strip_prefix(' ').unwrap_or(&line).to_owned()).collect();
    lines.join("\n")
}

impl Parameter {
    /// Its doc comments.
    #[must_use]
    pub fn about(&self) -> String {
        words(&self.attributes)
    }

    /// Its symbol, if `before` parameters precede it. Loops run over arrays of numbers, not over arrays of arrays.
    #[must_use]
    pub fn symbol(&self, before: usize) -> Symbol {
        let array = if let [place] = self.indices[..] { before.checked_sub(place) } else { None };
        Symbol::Parameter { index: before, array }
    }

    /// The name as the user writes it: `k`, or `m[3]`.
    #[must_use]
    pub fn text(&self) -> String {
        text(&self.name, &self.indices)
    }

    /// The name as an identifier: `k`, or `m_3`.
    #[must_use]
    pub fn ident(&self) -> String {
        ident(&self.name, &self.indices)
    }

    /// Its default in words, `0.04` or `1e150`.
    #[must_use]
    pub fn default_text(&self) -> String {
        let plain = self.default.to_string();
        if plain.len() > CHARACTERS { format!("{:e}", self.default) } else { plain }
    }
}

impl Model {
    /// The doc comments of the struct.
    #[must_use]
    pub fn about(&self) -> String {
        words(&self.attributes)
    }

    /// The functions that the clauses define, with entries of arrays of `let`s as symbols if these stay.
    pub(crate) fn expressions(&self) -> impl Iterator<Item = (Role, Expr)> {
        let forces = self.forces.iter().map(|force| (Role::Force, *force));
        let constraints = self.constraints.iter().map(|constraint| (Role::Constraint, constraint.written));
        [(Role::Lagrangian, self.lagrangian)]
            .into_iter()
            .chain(forces)
            .chain(self.dissipation.map(|rayleigh| (Role::Dissipation, rayleigh)))
            .chain(self.time_scale.map(|g| (Role::TimeScale, g)))
            .chain(constraints)
    }

    /// A digest of the numbers of all tables, by the hash FNV-1a; 0 without tables.
    #[must_use]
    pub fn digest_of_tables(&self) -> u32 {
        let tables = self.functions.iter().filter_map(|function| match &function.kind {
            FunctionKind::Table(Table { kind, outside, values, .. }) => {
                let values = match values {
                    Values::Parameters { ends, count, .. } => format!("{ends:?} {count}"),
                    numbers => format!("{numbers:?}"),
                };
                Some(format!("{} {kind:?} {outside:?} {values}", function.name))
            }
            FunctionKind::Rust(_) => None,
        });
        let text: String = tables.collect();
        let hash = |hash: u32, byte: u8| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193);
        if text.is_empty() { 0 } else { text.bytes().fold(0x811C_9DC5, hash) }
    }

    /// The name of a monotone table in L, whose expressions are in the pool.
    #[must_use]
    pub fn monotone_table(&self, pool: &Pool<Symbol>) -> Option<String> {
        let is_monotone = |function: &&Function| {
            let is_called =
                |expr: Expr| matches!(pool.node(expr), Node::Opaque(of, _) if function.name == of.name.as_ref());
            function.is_monotone() && pool.reachable(&[self.lagrangian]).into_iter().any(is_called)
        };
        self.functions.iter().find(is_monotone).map(|function| function.name.to_string())
    }

    /// The parameters grouped by field of the struct: a scalar parameter, or the entries of an array row by row.
    pub fn fields(&self) -> impl Iterator<Item = &[Parameter]> {
        self.parameters.chunk_by(|left, right| left.name == right.name)
    }

    /// Number of coordinates.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.coordinates.len()
    }

    /// An entry of an array of `let`s as the user wrote it.
    fn let_text(&self, LetEntry { array, entry }: LetEntry) -> String {
        let LetArray { name, width, .. } = &self.lets[array];
        if *width == 1 { format!("{name}[{entry}]") } else { format!("{name}[{}][{}]", entry / width, entry % width) }
    }

    /// A symbol as the user wrote it.
    #[must_use]
    pub fn spell(&self, symbol: &Symbol) -> String {
        use crate::symbol::{Field, Quantity, Variable};
        let coordinate = |index: usize| self.coordinates[index].text();
        match symbol {
            Symbol::Parameter { index, .. } => self.parameters[*index].text(),
            Symbol::Let(entry) => self.let_text(*entry),
            Symbol::LetRate(entry) => format!("dot({})", self.let_text(*entry)),
            Symbol::Access(place) => format!("a{place}"),
            Symbol::Continuous(Variable::Time) => "t".to_owned(),
            Symbol::Continuous(Variable::Coordinate(index)) => coordinate(*index),
            Symbol::Continuous(Variable::Velocity(index)) => format!("dot({})", coordinate(*index)),
            Symbol::Momentum(index) => format!("p_{}", coordinate(*index)),
            Symbol::Acceleration(index) => format!("dot(dot({}))", coordinate(*index)),
            Symbol::Multiplier(index) => format!("λ_{}", self.constraints[*index].text()),
            Symbol::T0 => "t0".to_owned(),
            Symbol::T1 => "t1".to_owned(),
            Symbol::Step => "h".to_owned(),
            Symbol::E0 => "E0".to_owned(),
            Symbol::Q0(index) => slot(&coordinate(*index), 0),
            Symbol::Q1(index) => slot(&coordinate(*index), 1),
            Symbol::P0(index) => format!("p0_{}", coordinate(*index)),
            Symbol::StepVelocity(index) => format!("v_{}", coordinate(*index)),
            Symbol::Low(of) => format!("{}_low", self.spell(of)),
            Symbol::AtPoint(point, variable) => format!("{}@{point}", self.spell(&Symbol::Continuous(*variable))),
            Symbol::Field(Field { quantity, derivatives, .. }) => {
                let mut text = match quantity {
                    Quantity::Lagrangian => "L".to_owned(),
                    Quantity::Force(index) => format!("f_{}", coordinate(*index)),
                };
                for (order, variable) in derivatives.iter().enumerate() {
                    text.push_str(if order == 0 { "_" } else { "," });
                    match variable {
                        Variable::Time => text.push('t'),
                        Variable::Coordinate(index) => text.push_str(&coordinate(*index)),
                        Variable::Velocity(index) => text.extend(["v_", &coordinate(*index)]),
                    }
                }
                text
            }
        }
    }
}

/// A coordinate at an end of the interval: `x0`, `x1`; `θ1_0`, `q[3]_1` after a digit or a bracket.
fn slot(coordinate: &str, end: u8) -> String {
    let separator = if coordinate.ends_with(char::is_alphabetic) { "" } else { "_" };
    format!("{coordinate}{separator}{end}")
}

/// The partial derivative with respect to a variable.
pub(crate) fn slope(pool: &mut Pool<Symbol>, expr: Expr, by: Variable) -> Expr {
    pool.partial_derivative(expr, &Symbol::Continuous(by))
}
