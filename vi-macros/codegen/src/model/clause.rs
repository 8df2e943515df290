//! The functions of a system that its clauses define.

use super::Model;
use super::context::Context;
use proc_macro2::Span;
use vi_expr::Expr;

/// What a function is to the motion.
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

/// A clause with the functions that it defines.
pub(super) struct Clause {
    pub(super) role: Role,
    /// Its name in messages.
    pub(super) what: String,
    pub(super) span: Span,
    pub(super) exprs: Vec<Expr>,
}

impl Context<'_> {
    /// Notes what a clause defines, for the checks of all clauses.
    pub(super) fn defines(&mut self, role: Role, what: String, span: Span, exprs: Vec<Expr>) {
        self.clauses.push(Clause { role, what, span, exprs });
    }
}

impl Model {
    /// The functions that the clauses define. Entries of arrays of `let`s are symbols if they stay so.
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
}
