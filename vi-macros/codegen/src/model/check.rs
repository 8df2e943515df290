//! The rules that a system has to keep, in the order in which they are checked.
//!
//! In: a [`System`]. Out: a [`Model`], or all messages.

use super::resolve::{Meaning, Scope};
use super::{Model, Parameter, mass};
use crate::discrete;
use crate::messages::{Errors, Message, nearest};
use crate::symbol::{Symbol, Variable};
use crate::syntax::{Definition, Discretization, System};
use proc_macro2::Ident;
use syn::Result;
use vi_expr::{Expr, Pool};

/// Checks a system.
///
/// # Errors
/// Everything that is wrong with it.
pub fn model(system: System) -> Result<Model> {
    let mut check = Check { pool: Pool::new(), scope: Scope::default(), errors: Errors::default() };
    check.constants(&system.constants);
    let defaults = check.parameters(&system.parameters);
    check.coordinates(&system.coordinates, &system.name);
    check.lets(&system.lets);
    let lagrangian = check.lagrangian(&system.lagrangians, &system.name);
    let forces = check.forces(&system.forces, system.coordinates.len());
    let rule = check.rule(system.discretizations, &system.name);
    let Check { mut pool, errors, .. } = check;
    errors.finish(())?;
    let (Some(lagrangian), Some((rule, rule_name))) = (lagrangian, rule) else {
        return Err(crate::messages::error(system.name.span(), &Message::MissingLagrangian));
    };
    mass::check(&mut pool, &system.coordinates, lagrangian, system.lagrangians[0].name.span())?;
    let parameters = system.parameters.into_iter().zip(defaults);
    Ok(Model {
        attributes: system.attributes,
        visibility: system.visibility,
        name: system.name,
        parameters: parameters
            .map(|(written, default)| Parameter { attributes: written.attributes, name: written.name, default })
            .collect(),
        coordinates: system.coordinates,
        lagrangian,
        forced: forces.iter().any(|force| !pool.is_zero(*force)),
        forces,
        rule,
        rule_name,
        pool,
    })
}

/// What the rules work on.
struct Check {
    pool: Pool<Symbol>,
    scope: Scope,
    errors: Errors,
}

impl Check {
    /// A declared name gets its meaning; a name that cannot be declared is reported.
    fn declare(&mut self, name: &Ident, meaning: Meaning) {
        if let Err(error) = self.scope.declare(name, meaning) {
            self.errors.add(error);
        }
    }

    /// The exact expression of a definition; a wrong one is reported and read as 1, so that later lines are checked.
    fn value(&mut self, written: &Definition) -> Expr {
        match self.scope.expression(&mut self.pool, &written.value) {
            Ok(value) => value,
            Err(error) => {
                self.errors.add(error);
                self.pool.one()
            }
        }
    }

    /// The finite number that a constant expression stands for.
    fn number(&mut self, written: &Definition) -> (Expr, f64) {
        let value = self.value(written);
        let name = written.name.to_string();
        if !self.pool.symbols(value).is_empty() {
            self.errors.at(written.value.span, &Message::NotConstant { name });
            return (self.pool.one(), 1.0);
        }
        let number = self.pool.evaluate(value, &mut |_| f64::NAN);
        if !number.is_finite() {
            self.errors.at(written.value.span, &Message::NotFinite { name });
            return (self.pool.one(), 1.0);
        }
        (value, number)
    }

    fn constants(&mut self, constants: &[Definition]) {
        for constant in constants {
            let (value, _) = self.number(constant);
            self.declare(&constant.name, Meaning::Value(value));
        }
    }

    fn parameters(&mut self, parameters: &[Definition]) -> Vec<f64> {
        let defaults: Vec<f64> = parameters.iter().map(|parameter| self.number(parameter).1).collect();
        for (index, parameter) in parameters.iter().enumerate() {
            let symbol = self.pool.symbol(Symbol::Parameter(index));
            self.declare(&parameter.name, Meaning::Value(symbol));
        }
        defaults
    }

    fn coordinates(&mut self, coordinates: &[Ident], system: &Ident) {
        if coordinates.is_empty() {
            self.errors.at(system.span(), &Message::MissingCoordinates);
        }
        for (index, coordinate) in coordinates.iter().enumerate() {
            self.declare(coordinate, Meaning::Coordinate(index));
        }
    }

    fn lets(&mut self, lets: &[Definition]) {
        for named in lets {
            let value = self.value(named);
            self.declare(&named.name, Meaning::Value(value));
        }
    }

    fn lagrangian(&mut self, written: &[Definition], system: &Ident) -> Option<Expr> {
        let Some((first, others)) = written.split_first() else {
            self.errors.at(system.span(), &Message::MissingLagrangian);
            return None;
        };
        for other in others {
            self.errors.at(other.name.span(), &Message::SecondLagrangian);
        }
        let lagrangian = self.value(first);
        let moves = |symbol: &Symbol| matches!(symbol, Symbol::Continuous(Variable::Velocity(_)));
        if self.errors.is_empty() && !self.pool.depends_on(lagrangian, &moves) {
            self.errors.at(first.name.span(), &Message::NoVelocity);
        }
        Some(lagrangian)
    }

    fn forces(&mut self, written: &[Definition], dimension: usize) -> Vec<Expr> {
        let mut forces = vec![None; dimension];
        for force in written {
            let name = force.name.to_string();
            let value = self.value(force);
            match self.scope.coordinate(&name) {
                Some(index) if forces[index].is_some() => {
                    self.errors.at(force.name.span(), &Message::SecondForce { name });
                }
                Some(index) => forces[index] = Some(value),
                None => {
                    let near = self.scope.near_coordinate(&name);
                    self.errors.at(force.name.span(), &Message::ForceOnOther { name, near });
                }
            }
        }
        let zero = self.pool.zero();
        forces.into_iter().map(|force| force.unwrap_or(zero)).collect()
    }

    fn rule(&mut self, written: Vec<Discretization>, system: &Ident) -> Option<(crate::syntax::Rule, String)> {
        let mut written = written.into_iter();
        let Some(first) = written.next() else {
            self.errors.at(system.span(), &Message::MissingRule);
            return None;
        };
        for other in written {
            let span = match &other {
                Discretization::Named(name) => name.span(),
                Discretization::Written(rule) => rule.span,
            };
            self.errors.at(span, &Message::SecondRule);
        }
        match first {
            Discretization::Written(rule) => Some((rule, "written out".to_owned())),
            Discretization::Named(name) => {
                let known = discrete::named_rule(&name.to_string());
                match known {
                    Some(Ok(rule)) => return Some((rule, name.to_string())),
                    Some(Err(error)) => self.errors.add(error),
                    None => {
                        let near = nearest(&name.to_string(), discrete::RULES);
                        self.errors.at(name.span(), &Message::UnknownRule { name: name.to_string(), near });
                    }
                }
                None
            }
        }
    }
}
