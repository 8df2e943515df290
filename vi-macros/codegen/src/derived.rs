//! A system with all that was derived from it by each of its rules, which is what the items are printed from.
//!
//! Each rule has a pool of its own: the order in which a pool meets expressions decides the order of operands, so a rule gives the
//! same operations, bit for bit, whatever other rules the system is declared with.

use crate::discrete::DiscreteSystem;
use crate::found::Findings;
use crate::model::Model;
use crate::program::Program;
use crate::symbol::Symbol;
use vi_expr::Pool;

/// A system by each rule that it is declared with.
pub struct Derivations {
    /// By its own rule: the first of the list, or the one that is written out.
    pub own: Derived,
    /// By the further rules of the list, in order; the model and the continuous functions are those of `own` once more.
    pub further: Vec<Derived>,
}

impl Derivations {
    /// All of them, that by the system's own rule first.
    pub fn all(&self) -> impl Iterator<Item = &Derived> {
        [&self.own].into_iter().chain(&self.further)
    }
}

/// A system with all that was derived from it by one rule.
pub struct Derived {
    /// All expressions.
    pub pool: Pool<Symbol>,
    /// The checked system.
    pub model: Model,
    /// L_d, its slot derivatives, and the equations of a step.
    pub system: DiscreteSystem,
    /// The functions as operations.
    pub program: Program,
    /// What is special about the system.
    pub findings: Findings,
}
