//! A system with all that was derived from it, which is what the items are printed from.

use crate::discrete::DiscreteSystem;
use crate::found::Findings;
use crate::model::Model;
use crate::program::Program;
use crate::symbol::Symbol;
use vi_expr::Pool;

/// A system with all that was derived from it.
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
