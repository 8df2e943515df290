//! A system with everything derived from it under each of its rules: the input of the emitter.
//!
//! Each rule has its own pool, because the order in which a pool receives expressions decides the order of operands. So
//! a rule has the same operations, bit for bit, with and without other rules in the system.

use crate::discrete::DiscreteSystem;
use crate::findings::Findings;
use crate::model::Model;
use crate::program::Program;
use crate::symbol::Symbol;
use vi_expr::Pool;

/// The derivation of a system under each declared rule.
pub struct Derivations {
    /// The derivation with the default rule: the first of the list, or the written-out one.
    pub own: Derived,
    /// The derivations with the further rules of the list, in order. Model and continuous functions equal those of
    /// `own`.
    pub further: Vec<Derived>,
}

impl Derivations {
    /// All derivations, the default rule first.
    pub fn all(&self) -> impl Iterator<Item = &Derived> {
        [&self.own].into_iter().chain(&self.further)
    }
}

/// A system with everything derived from it under one rule.
pub struct Derived {
    /// All expressions.
    pub pool: Pool<Symbol>,
    /// The checked system.
    pub model: Model,
    /// L_d, its slot derivatives, and the equations of a step.
    pub system: DiscreteSystem,
    /// The functions as operations.
    pub program: Program,
    /// Properties found in the operations.
    pub findings: Findings,
}
