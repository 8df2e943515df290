//! The rules that a system has to keep, in the order in which they are checked.
//!
//! In: a [`System`]. Out: a [`Model`], or all messages.

use super::context::Context;
use super::scope::Meaning;
use super::{Coordinate, Model, Parameter, Rule, check_state, force, mass, rule, time_scale};
use crate::limits::{COORDINATES, bounded};
use crate::messages::{Message, error};
use crate::symbol::{Symbol, Variable};
use crate::syntax::{self, Definition, Indices, System};
use proc_macro2::Ident;
use syn::Result;
use vi_expr::{Expr, Pool};

/// Checks a system, whose expressions go into the pool, with the rule of this place in its list.
///
/// # Errors
/// Everything that is wrong with it, whatever the place.
pub fn model(pool: &mut Pool<Symbol>, system: &System, place: usize) -> Result<Model> {
    let mut context = Context::new(pool);
    context.constants(&system.constants);
    let defaults = context.parameters(&system.parameters);
    let coordinates = context.coordinates(&system.coordinates, &system.name);
    context.lets(&system.lets);
    let lagrangian = context.lagrangian(&system.lagrangians, &system.name);
    let forces = force::forces(&mut context, &system.forces, &system.dissipations, coordinates.len());
    let forced = forces.iter().any(|force| !context.pool.is_zero(*force));
    let time_scale = time_scale::time_scale(&mut context, &system.time_scales);
    let rule = rule::rule(&mut context, system, place, coordinates.len(), forced);
    let check_state = check_state::check_state(&mut context, &system.checks, coordinates.len());
    if context.errors.is_empty() {
        let of_rule = rule.iter().flat_map(Rule::expressions);
        let acting = lagrangian.into_iter().chain(forces.iter().copied()).chain(time_scale);
        let acting: Vec<Expr> = acting.chain(of_rule).collect();
        context.every_parameter_acts(&system.parameters, &acting);
    }
    let Context { pool, errors, .. } = context;
    errors.finish(())?;
    let (Some(lagrangian), Some(rule)) = (lagrangian, rule) else {
        return Err(error(system.name.span(), &Message::MissingLagrangian));
    };
    let singular = mass::check(pool, &coordinates, lagrangian, system.lagrangians[0].name.span());
    // What an exhausted pool says means nothing.
    bounded(pool).map_err(|found| error(system.name.span(), &Message::TooLarge(found)))?;
    singular?;
    let parameters = system.parameters.iter().zip(defaults).map(|(written, default)| Parameter {
        attributes: written.attributes.clone(),
        name: written.name.clone(),
        default,
    });
    Ok(Model {
        attributes: system.attributes.clone(),
        visibility: system.visibility.clone(),
        name: system.name.clone(),
        parameters: parameters.collect(),
        coordinates,
        lagrangian,
        forced,
        forces,
        time_scale,
        rule,
        check_state,
    })
}

impl Context<'_> {
    fn constants(&mut self, constants: &[Definition]) {
        for constant in constants {
            let (value, _) = self.number(constant);
            self.declare(&constant.name, Meaning::Number(value));
        }
    }

    fn parameters(&mut self, parameters: &[Definition]) -> Vec<f64> {
        let defaults: Vec<f64> = parameters.iter().map(|parameter| self.number(parameter).1).collect();
        for (index, parameter) in parameters.iter().enumerate() {
            let symbol = self.pool.symbol(Symbol::Parameter(index));
            self.declare(&parameter.name, Meaning::Number(symbol));
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
            let length = self.scope.integer(self.pool, written);
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
                    self.declare(&named.name, Meaning::Number(value));
                }
                Some(Indices::Range(range)) => {
                    let first = self.scope.integer(self.pool, &range.from);
                    let entries =
                        self.scope.each(self.pool, range, &mut |scope, pool, _| scope.expression(pool, &named.value));
                    let meaning = match (self.report(entries), first) {
                        (Some(entries), Ok(first)) => Meaning::Array { first, entries },
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

    /// A parameter that none of L, f, the time scale and the rule depends on is a mistake of spelling or of thought.
    fn every_parameter_acts(&mut self, parameters: &[Definition], acting: &[Expr]) {
        let acting = self.pool.symbols_of(acting);
        for (index, parameter) in parameters.iter().enumerate() {
            if !acting.contains(&Symbol::Parameter(index)) && !self.is_too_large() {
                let name = parameter.name.to_string();
                self.errors.at(parameter.name.span(), &Message::UnusedParameter { name });
            }
        }
    }
}
