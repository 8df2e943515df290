//! The rules that a system has to keep, in the order in which they are checked.
//!
//! In: a [`System`]. Out: a [`Model`], or all messages.

use super::scope::{Meaning, Scope};
use super::{Coordinate, Model, Parameter, force, mass, place};
use crate::discrete::{self, WORK, bounded};
use crate::messages::{Errors, Message, error, nearest};
use crate::symbol::{Symbol, Variable};
use crate::syntax::{self, Definition, Discretization, Indices, System};
use proc_macro2::{Ident, Span};
use syn::Result;
use vi_expr::{Expr, Pool};

/// Coordinates that one system may have.
const COORDINATES: usize = 256;

/// Checks a system.
///
/// # Errors
/// Everything that is wrong with it.
pub fn model(system: System) -> Result<Model> {
    let (scope, errors) = (Scope::default(), Errors::default());
    let mut check = Check { pool: Pool::bounded(WORK), scope, errors, too_large: false };
    check.constants(&system.constants);
    let defaults = check.parameters(&system.parameters);
    let coordinates = check.coordinates(&system.coordinates, &system.name);
    check.lets(&system.lets);
    let lagrangian = check.lagrangian(&system.lagrangians, &system.name);
    let forces = force::forces(&mut check, &system.forces, &system.dissipations, coordinates.len());
    let rule = check.rule(system.discretizations, &system.name);
    let place = place::place(&mut check, &system.checks, coordinates.len());
    if check.errors.is_empty() {
        check.every_parameter_acts(&system.parameters, lagrangian, &forces);
    }
    let Check { mut pool, errors, .. } = check;
    errors.finish(())?;
    let (Some(lagrangian), Some((rule, rule_name))) = (lagrangian, rule) else {
        return Err(error(system.name.span(), &Message::MissingLagrangian));
    };
    let singular = mass::check(&mut pool, &coordinates, lagrangian, system.lagrangians[0].name.span());
    // What an exhausted pool says means nothing.
    bounded(&pool).map_err(|found| error(system.name.span(), &Message::TooLarge(found)))?;
    singular?;
    let parameters = system.parameters.into_iter().zip(defaults);
    Ok(Model {
        attributes: system.attributes,
        visibility: system.visibility,
        name: system.name,
        parameters: parameters
            .map(|(written, default)| Parameter { attributes: written.attributes, name: written.name, default })
            .collect(),
        coordinates,
        lagrangian,
        forced: forces.iter().any(|force| !pool.is_zero(*force)),
        forces,
        rule,
        rule_name,
        place,
        pool,
    })
}

/// What the rules work on.
pub(super) struct Check {
    pub(super) pool: Pool<Symbol>,
    pub(super) scope: Scope,
    pub(super) errors: Errors,
    /// It was reported, or will be, that the system is too large.
    too_large: bool,
}

impl Check {
    /// A declared name gets its meaning; a name that cannot be declared is reported.
    fn declare(&mut self, name: &Ident, meaning: Meaning) {
        if let Err(error) = self.scope.declare(name, meaning) {
            self.errors.add(error);
        }
    }

    /// Whether nothing more is to be made of the system.
    fn is_too_large(&self) -> bool {
        bounded(&self.pool).is_err()
    }

    /// What a stage makes, or nothing and a report. Of a system that is too large only the first: where it became so.
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

    /// The exact expression of a definition; a wrong one is reported and read as 1, so that later lines are checked.
    pub(super) fn value(&mut self, written: &Definition) -> Expr {
        let value = self.scope.expression(&mut self.pool, &written.value);
        self.report(value).unwrap_or_else(|| self.pool.one())
    }

    /// The finite number that a constant definition stands for.
    pub(super) fn number(&mut self, written: &Definition) -> (Expr, f64) {
        let value = self.value(written);
        match self.finite(value, written.value.span, &written.name) {
            Some(number) => (value, number),
            None => (self.pool.one(), 1.0),
        }
    }

    /// The finite number that an expression stands for; where it has none, a report.
    pub(super) fn finite(&mut self, value: Expr, span: Span, name: &Ident) -> Option<f64> {
        let name = name.to_string();
        if !self.pool.symbols(value).is_empty() {
            self.errors.at(span, &Message::NotConstant { name });
            return None;
        }
        let number = self.pool.evaluate(value, &mut |_| f64::NAN);
        if !number.is_finite() && !self.is_too_large() {
            self.errors.at(span, &Message::NotFinite { name });
            return None;
        }
        Some(number)
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

    fn coordinates(&mut self, declared: &[syntax::Coordinate], system: &Ident) -> Vec<Coordinate> {
        if declared.is_empty() {
            self.errors.at(system.span(), &Message::MissingCoordinates);
        }
        let (mut coordinates, mut too_many) = (Vec::new(), None);
        for syntax::Coordinate { name, length } in declared {
            let first = coordinates.len();
            let Some(written) = length else {
                if first == COORDINATES {
                    self.declare(name, Meaning::Wrong);
                    too_many = too_many.or(Some(name.span()));
                    continue;
                }
                coordinates.push(Coordinate { name: name.clone(), index: None });
                self.declare(name, Meaning::Coordinate(first));
                continue;
            };
            let length = self.scope.integer(&mut self.pool, written);
            let Some(length) = self.report(length) else {
                self.declare(name, Meaning::Wrong);
                continue;
            };
            let fitting = 1..=COORDINATES - first.min(COORDINATES);
            if let Some(length) = usize::try_from(length).ok().filter(|length| fitting.contains(length)) {
                coordinates.extend((0..length).map(|i| Coordinate { name: name.clone(), index: Some(i) }));
                self.declare(name, Meaning::Coordinates { first, length });
            } else {
                self.errors.at(written.span, &Message::Length { given: length, limit: COORDINATES });
                self.declare(name, Meaning::Wrong);
            }
        }
        if let Some(first) = too_many {
            self.errors.at(first, &Message::TooManyCoordinates { limit: COORDINATES });
        }
        coordinates
    }

    fn lets(&mut self, lets: &[Definition]) {
        for named in lets {
            match &named.indices {
                None => {
                    let value = self.value(named);
                    self.declare(&named.name, Meaning::Value(value));
                }
                Some(Indices::Range(range)) => {
                    let first = self.scope.integer(&mut self.pool, &range.from);
                    let entries = self
                        .scope
                        .each(&mut self.pool, range, &mut |scope, pool, _| scope.expression(pool, &named.value));
                    let meaning = match (self.report(entries), first) {
                        (Some(entries), Ok(first)) => Meaning::Values { first, entries },
                        _ => Meaning::Wrong,
                    };
                    self.declare(&named.name, meaning);
                }
                Some(Indices::One(index)) => {
                    self.errors.at(index.span, &Message::Expected { what: "a range, as in `i in 0..8`" });
                    self.declare(&named.name, Meaning::Wrong);
                }
            }
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

    /// A parameter that neither L nor f depends on is a mistake of spelling or of thought.
    fn every_parameter_acts(&mut self, parameters: &[Definition], lagrangian: Option<Expr>, forces: &[Expr]) {
        let acting: Vec<Expr> = lagrangian.into_iter().chain(forces.iter().copied()).collect();
        let acting = self.pool.symbols_of(&acting);
        for (index, parameter) in parameters.iter().enumerate() {
            if !acting.contains(&Symbol::Parameter(index)) && !self.is_too_large() {
                let name = parameter.name.to_string();
                self.errors.at(parameter.name.span(), &Message::UnusedParameter { name });
            }
        }
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
