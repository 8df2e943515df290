//! A rule with resolved names: L_d, and the discrete forces if written.
//!
//! In: the lines `Ld = …; fd_minus = …; …`. Out: a [`Rule`] in the slots t0, q0, t1, q1, the step h, and L and f at the
//! [`Point`]s of the rule. Parameters, constants and their arrays have their usual meaning.

use super::context::Context;
use super::point::Point;
use super::scope::Scope;
use super::value::Value;
use crate::messages::{Errors, Message, nearest};
use crate::rules::{self, NamedRule};
use crate::symbol::{Quantity, Symbol};
use crate::syntax::{self, Definition, Discretization, System, parse};
use proc_macro2::{Ident, Span};
use std::collections::BTreeSet;
use syn::Result;
use vi_expr::{Expr, Pool};

/// The rule from L to L_d.
pub struct Rule {
    /// The built-in rule, if the system names one.
    pub named: Option<&'static NamedRule>,
    /// Where `Ld` is written.
    pub span: Span,
    /// L_d.
    pub ld: Expr,
    /// The discrete forces and powers, if written and if the system has a force.
    pub forces: Option<DiscreteForces>,
    /// The points at which the rule evaluates L and f.
    pub points: Vec<Point>,
}

impl Rule {
    /// The name of the rule in documentation.
    #[must_use]
    pub fn title(&self) -> &'static str {
        self.named.map_or("written out", |rule| rule.name)
    }

    /// All expressions of the rule.
    pub(super) fn expressions(&self) -> impl Iterator<Item = Expr> {
        let points = self.points.iter().flat_map(Point::arguments).map(|(_, argument)| argument);
        let forces = self.forces.iter().flat_map(DiscreteForces::expressions);
        [self.ld].into_iter().chain(points).chain(forces)
    }
}

/// The virtual work of f over an interval: f_d⁻·δq0 + f_d⁺·δq1 + g_d⁻ δt0 + g_d⁺ δt1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DiscreteForces {
    /// f_d⁻.
    pub fd_minus: Vec<Expr>,
    /// f_d⁺.
    pub fd_plus: Vec<Expr>,
    /// g_d⁻.
    pub gd_minus: Expr,
    /// g_d⁺.
    pub gd_plus: Expr,
}

impl DiscreteForces {
    /// All four, entry by entry.
    pub(crate) fn expressions(&self) -> impl Iterator<Item = Expr> {
        let vectors = self.fd_minus.iter().chain(&self.fd_plus).copied();
        vectors.chain([self.gd_minus, self.gd_plus])
    }
}

/// The line of the discrete Lagrangian.
const LD: &str = "Ld";

/// The lines of the discrete forces.
const FORCES: [&str; 4] = ["fd_minus", "fd_plus", "gd_minus", "gd_plus"];

/// The rule at this position of the `discretize` clause; reports a second clause.
pub(super) fn rule(
    context: &mut Context,
    written: &System,
    place: usize,
    dimension: usize,
    forced: bool,
) -> Option<Rule> {
    let (first, others) = written.discretizations.split_first()?;
    for other in others {
        let span = match other {
            Discretization::Named(names) => names.first().map_or(written.name.span(), Ident::span),
            Discretization::Written(rule) => rule.span,
        };
        context.errors.at(span, &Message::SecondRule);
    }
    let resolved = match first {
        Discretization::Named(names) => {
            let rules = of_names(context, names);
            named(context.pool, *rules.get(place)?, dimension, forced)
        }
        Discretization::Written(rule) => {
            let scope = Scope::of_rule(dimension).with_constants_of(&context.scope, context.pool);
            resolve(context.pool, scope, rule, forced)
        }
    };
    context.report(resolved)
}

/// The rules of a list of names: each is `gauss` or built in, and appears once.
fn of_names(context: &mut Context, names: &[Ident]) -> Vec<&'static NamedRule> {
    let mut rules: Vec<&'static NamedRule> = Vec::with_capacity(names.len());
    for (place, written) in names.iter().enumerate() {
        let name = written.to_string();
        match rules::named(&name) {
            _ if names[..place].contains(written) => {
                context.errors.at(written.span(), &Message::RepeatedRule { name });
            }
            Some(rule) => rules.push(rule),
            None if name == rules::GAUSS => {}
            None => {
                let near = nearest(&name, rules::names());
                context.errors.at(written.span(), &Message::UnknownRule { name, near });
            }
        }
    }
    rules
}

/// A built-in rule for a system with `dimension` coordinates, with or without a force.
///
/// # Errors
/// An invalid built-in rule: a bug of this compiler. A system that is too large.
pub(crate) fn named(pool: &mut Pool<Symbol>, rule: &'static NamedRule, dimension: usize, forced: bool) -> Result<Rule> {
    let resolved = resolve(pool, Scope::of_rule(dimension), &parse::rule(rule.text)?, forced)?;
    Ok(Rule { named: Some(rule), ..resolved })
}

/// Resolves the lines of a rule in their scope.
fn resolve(pool: &mut Pool<Symbol>, scope: Scope, rule: &syntax::Rule, forced: bool) -> Result<Rule> {
    let mut lines = Lines { pool, scope, rule, errors: Errors::default() };
    lines.check_names();
    let ld = lines.number(LD);
    let span = lines.written(LD).map_or(rule.span, |line| line.name.span());
    // If L_d is made of L, the work of f follows from it. Without a force the four force lines are ignored.
    let is_lagrangian =
        |symbol: &Symbol| matches!(symbol, Symbol::Field(field) if field.quantity == Quantity::Lagrangian);
    let is_made_of_lagrangian = lines.pool.depends_on(ld, &is_lagrangian);
    let is_wrong = !lines.errors.is_empty();
    let is_needed = FORCES.into_iter().any(|name| lines.written(name).is_some()) || !is_made_of_lagrangian && !is_wrong;
    let [fd_minus, fd_plus, gd_minus, gd_plus] = FORCES;
    let forces = (forced && is_needed).then(|| DiscreteForces {
        fd_minus: lines.vector(fd_minus),
        fd_plus: lines.vector(fd_plus),
        gd_minus: lines.number(gd_minus),
        gd_plus: lines.number(gd_plus),
    });
    let Lines { scope, errors, .. } = lines;
    errors.finish(Rule { named: None, span, ld, forces, points: scope.into_points() })
}

/// The lines of a rule during resolution; reports a wrong line and reads it as zero.
struct Lines<'a> {
    pool: &'a mut Pool<Symbol>,
    scope: Scope,
    rule: &'a syntax::Rule,
    errors: Errors,
}

impl<'a> Lines<'a> {
    /// Reports unknown and repeated lines.
    fn check_names(&mut self) {
        let mut seen = BTreeSet::new();
        for line in &self.rule.lines {
            let name = line.name.to_string();
            if name != LD && !FORCES.contains(&name.as_str()) {
                self.errors.at(line.name.span(), &Message::UnknownSlot { name });
            } else if !seen.insert(name.clone()) {
                self.errors.at(line.name.span(), &Message::SecondSlot { name });
            }
        }
    }

    /// The line with this name, if written.
    fn written(&self, name: &str) -> Option<&'a Definition> {
        self.rule.lines.iter().find(|line| line.name == name)
    }

    fn number(&mut self, name: &'static str) -> Expr {
        self.value(name, Value::number).unwrap_or(self.pool.zero())
    }

    fn vector(&mut self, name: &'static str) -> Vec<Expr> {
        self.value(name, Value::vector).unwrap_or_default()
    }

    fn value<P>(&mut self, name: &'static str, shaped: fn(Value, Span) -> Result<P>) -> Option<P> {
        let Some(line) = self.written(name) else {
            self.errors.at(self.rule.span, &Message::MissingSlot { name });
            return None;
        };
        let value = self.scope.value(self.pool, &line.value).and_then(|value| shaped(value, line.value.span));
        value.map_err(|error| self.errors.add(error)).ok()
    }
}
