//! State of the checker: the pool of expressions, the names declared so far, and the errors found.
//!
//! In: one definition after the other. Out: their expressions and numbers. A wrong expression is reported and evaluates
//! to 1, so that later lines are checked too.

use super::Role;
use super::closed::Closed;
use super::scope::{Meaning, Scope};
use super::value::Value;
use crate::limits::bounded;
use crate::messages::{Errors, Message};
use crate::symbol::Symbol;
use crate::syntax::Expression;
use proc_macro2::{Ident, Span};
use syn::Result;
use vi_expr::{Expr, NoConstant, Pool};

/// State of the checker.
pub(super) struct Context<'a> {
    pub(super) pool: &'a mut Pool<Symbol>,
    pub(super) scope: Scope,
    pub(super) errors: Errors,
    /// The clauses with functions of the motion, as they were checked.
    pub(super) clauses: Vec<Clause>,
    /// The system is too large, and this is or will be reported.
    too_large: bool,
}

/// A clause with the functions that it defines.
pub(super) struct Clause {
    pub(super) role: Role,
    /// Its name in messages.
    pub(super) what: String,
    pub(super) span: Span,
    pub(super) exprs: Vec<Expr>,
}

impl<'a> Context<'a> {
    /// A context without declarations.
    pub(super) fn new(pool: &'a mut Pool<Symbol>) -> Self {
        Self { pool, scope: Scope::of_system(), errors: Errors::default(), clauses: Vec::new(), too_large: false }
    }

    /// An expression by coordinates: the entries of arrays of `let`s that stay symbols are replaced.
    pub(super) fn closed(&mut self, expr: Expr) -> Expr {
        let lets = self.scope.kept.as_deref().unwrap_or_default();
        Closed::of(self.pool, lets).expression(self.pool, expr)
    }

    /// Notes the functions of a clause, for the checks that go over all clauses.
    pub(super) fn defines(&mut self, role: Role, what: String, span: Span, exprs: Vec<Expr>) {
        self.clauses.push(Clause { role, what, span, exprs });
    }

    /// Declares a name; reports a name that cannot be declared.
    pub(super) fn declare(&mut self, name: &Ident, meaning: Meaning) {
        if let Err(error) = self.scope.declare(name, meaning) {
            self.errors.add(error);
        }
    }

    /// Whether the system is too large to be processed further.
    pub(super) fn is_too_large(&self) -> bool {
        bounded(self.pool).is_err()
    }

    /// The product of a stage, or `None` after a report. For a system that is too large, only the first report counts.
    pub(super) fn report<P>(&mut self, made: Result<P>) -> Option<P> {
        let reported = self.too_large;
        self.too_large = self.is_too_large();
        match made {
            Ok(made) => return Some(made),
            Err(error) if !reported => self.errors.add(error),
            Err(_) => {}
        }
        None
    }

    /// The exact expression; reports a wrong one and returns 1, so that later lines are checked.
    pub(super) fn value(&mut self, written: &Expression) -> Expr {
        let value = self.scope.expression(self.pool, written);
        self.report(value).unwrap_or_else(|| self.pool.one())
    }

    /// The exact value of an expression: a number, a vector or a matrix; `None` after a report.
    pub(super) fn shaped(&mut self, written: &Expression) -> Option<Value> {
        let value = self.scope.value(self.pool, written);
        self.report(value)
    }

    /// The finite number of a constant expression that defines this name.
    pub(super) fn number(&mut self, written: &Expression, name: &Ident) -> (Expr, f64) {
        let value = self.value(written);
        match self.finite(value, written.span, name) {
            Some(number) => (value, number),
            None => (self.pool.one(), 1.0),
        }
    }

    /// The finite number of an expression; reports an expression without one.
    pub(super) fn finite(&mut self, value: Expr, span: Span, name: &Ident) -> Option<f64> {
        let name = name.to_string();
        if !self.pool.is_constant(value) {
            self.errors.at(span, &Message::NotConstant { name });
            return None;
        }
        let message = match self.pool.constant(value) {
            Ok(number) => return Some(number),
            Err(_) if self.is_too_large() => return None,
            Err(NoConstant::Undefined | NoConstant::TooLarge) => Message::NotFinite { name },
            Err(NoConstant::TooSmall) => Message::NumberRange,
            Err(NoConstant::Undecided) => Message::Undecided,
        };
        self.errors.at(span, &message);
        None
    }
}
