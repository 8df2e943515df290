//! Checks of a system, in order.
//!
//! In: a [`System`]. Out: a [`Model`], or all messages.

use super::context::Context;
use super::scope::Meaning;
use super::{Coordinate, Model, Parameter, Rule, angles, check_state, force, mass, rule, time_scale};
use crate::limits::{COORDINATES, PARAMETERS, bounded};
use crate::messages::{Absence, Message, error};
use crate::symbol::{Symbol, Variable};
use crate::syntax::{self, Default, Definition, Expression, Indices, System};
use proc_macro2::Ident;
use syn::Result;
use vi_expr::{Expr, NoConstant, Pool};

/// Checks a system with the rule at this position of its list, and adds its expressions to the pool.
///
/// # Errors
/// All mistakes of the system.
pub fn model(pool: &mut Pool<Symbol>, system: &System, place: usize) -> Result<Model> {
    let mut context = Context::new(pool);
    let System { constants, parameters, coordinates, lets, .. } = system;
    context.scope.expect(lets.iter().map(|named| &named.name), Absence::Let);
    context.scope.expect(coordinates.iter().map(|coordinate| &coordinate.name), Absence::Coordinate);
    context.scope.expect(parameters.iter().map(|parameter| &parameter.name), Absence::Parameter);
    context.scope.expect(constants.iter().map(|constant| &constant.name), Absence::Below);
    context.constants(constants);
    let parameters = context.parameters(parameters);
    let coordinates = context.coordinates(coordinates, &system.name);
    context.scope.expect(lets.iter().map(|named| &named.name), Absence::Below);
    context.lets(lets);
    let lagrangian = context.lagrangian(&system.lagrangians, &system.name);
    let forces = force::forces(&mut context, &system.forces, &system.dissipations, &parameters, coordinates.len());
    let forced = forces.iter().any(|force| !context.pool.is_zero(*force));
    let time_scale = time_scale::time_scale(&mut context, &system.time_scales);
    let rule = rule::rule(&mut context, system, place, coordinates.len(), forced);
    let check_state = check_state::check_state(&mut context, &system.checks, &parameters, coordinates.len());
    angles::check(&mut context, system, (&coordinates, &parameters), (lagrangian, time_scale));
    if context.errors.is_empty() {
        let of_rule = rule.iter().flat_map(Rule::expressions);
        let acting = lagrangian.into_iter().chain(forces.iter().copied()).chain(time_scale);
        let acting: Vec<Expr> = acting.chain(of_rule).collect();
        context.check_parameters_used(&parameters, &acting);
    }
    let Context { pool, errors, .. } = context;
    errors.finish(())?;
    let Some(lagrangian) = lagrangian else {
        return Err(error(system.name.span(), &Message::MissingLagrangian));
    };
    let lagrangian_span = system.lagrangians[0].name.span();
    let singular = mass::check(pool, (&coordinates, &parameters), lagrangian, lagrangian_span);
    // Values from an exhausted pool are meaningless.
    bounded(pool).map_err(|found| error(system.name.span(), &Message::TooLarge(found)))?;
    singular?;
    Ok(Model {
        attributes: system.attributes.clone(),
        visibility: system.visibility.clone(),
        name: system.name.clone(),
        parameters,
        coordinates,
        lagrangian,
        lagrangian_span,
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
            let value = self.value(&constant.value);
            // A value below the range of numbers may be multiplied before it is rounded.
            let is_small = self.pool.constant(value) == Err(NoConstant::TooSmall);
            let has_value = is_small || self.finite(value, constant.value.span, &constant.name).is_some();
            self.declare(&constant.name, Meaning::Number(if has_value { value } else { self.pool.one() }));
        }
    }

    /// The parameters with their defaults; arrays entry by entry.
    fn parameters(&mut self, declared: &[syntax::Parameter]) -> Vec<Parameter> {
        let fields: Vec<Option<Vec<f64>>> = declared.iter().map(|parameter| self.defaults(parameter)).collect();
        let mut parameters = Vec::new();
        for (syntax::Parameter { attributes, name, length, .. }, defaults) in declared.iter().zip(fields) {
            let Some(defaults) = defaults else {
                self.declare(name, Meaning::Wrong);
                continue;
            };
            let mut entries = Vec::with_capacity(defaults.len());
            for (index, default) in defaults.into_iter().enumerate() {
                let index = length.is_some().then_some(index);
                let parameter = Parameter { attributes: attributes.clone(), name: name.clone(), index, default };
                entries.push(self.pool.symbol(parameter.symbol(parameters.len())));
                parameters.push(parameter);
            }
            let meaning = match (length, entries.first()) {
                (None, Some(only)) => Meaning::Number(*only),
                _ => Meaning::Array { first: 0, entries },
            };
            self.declare(name, meaning);
        }
        parameters
    }

    /// The default of a parameter, or of the entries of an array; reports a wrong length.
    fn defaults(&mut self, parameter: &syntax::Parameter) -> Option<Vec<f64>> {
        let syntax::Parameter { name, length, default, .. } = parameter;
        let length = match length {
            Some(written) => Some((self.length_of_parameters(written)?, written.span)),
            None => None,
        };
        let written = match default {
            Default::Same(value) => {
                let (_, number) = self.number(value, name);
                return Some(vec![number; length.map_or(1, |(length, _)| length)]);
            }
            Default::Each(written) => written,
        };
        let numbers: Vec<f64> = written.iter().map(|value| self.number(value, name).1).collect();
        let values = numbers.len();
        let Some((length, span)) = length else {
            self.errors.at(name.span(), &Message::ParameterWithoutLength { name: name.to_string(), values });
            return None;
        };
        if values != length {
            // Points at the first surplus value, or at the length if values are missing.
            let span = written.get(length).map_or(span, |value| value.span);
            self.errors.at(span, &Message::ParameterValues { name: name.to_string(), length, values });
            return None;
        }
        Some(numbers)
    }

    /// The length of an array of parameters; reports a wrong length.
    fn length_of_parameters(&mut self, written: &Expression) -> Option<usize> {
        let length = self.scope.integer(self.pool, written);
        let given = self.report(length)?;
        let fitting = usize::try_from(given).ok().filter(|length| (1..=PARAMETERS).contains(length));
        if fitting.is_none() {
            self.errors.at(written.span, &Message::ParametersLength { given, limit: PARAMETERS });
        }
        fitting
    }

    fn coordinates(&mut self, declared: &[syntax::Coordinate], system: &Ident) -> Vec<Coordinate> {
        if declared.is_empty() {
            self.errors.at(system.span(), &Message::MissingCoordinates);
        }
        let (mut coordinates, mut too_many) = (Vec::new(), None);
        for &syntax::Coordinate { ref name, ref length, is_angle } in declared {
            let first = coordinates.len();
            let Some(written) = length else {
                if first == COORDINATES {
                    self.declare(name, Meaning::Wrong);
                    too_many = too_many.or(Some(name.span()));
                    continue;
                }
                coordinates.push(Coordinate { name: name.clone(), index: None, is_angle });
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
                coordinates.extend((0..length).map(|i| Coordinate { name: name.clone(), index: Some(i), is_angle }));
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
                    let value = self.value(&named.value);
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
        let lagrangian = self.value(&first.value);
        let moves = |symbol: &Symbol| matches!(symbol, Symbol::Continuous(Variable::Velocity(_)));
        if self.errors.is_empty() && !self.pool.depends_on(lagrangian, &moves) {
            self.errors.at(first.name.span(), &Message::NoVelocity);
        }
        Some(lagrangian)
    }

    /// Reports a parameter that none of L, f, the time scale and the rule uses: it is a spelling mistake or an
    /// oversight. An array is reported only if all its entries are unused: an adjacency matrix may have unused entries.
    fn check_parameters_used(&mut self, parameters: &[Parameter], acting: &[Expr]) {
        let acting = self.pool.symbols_of(acting);
        if self.is_too_large() {
            return;
        }
        let acts = |(before, parameter): (usize, &Parameter)| acting.contains(&parameter.symbol(before));
        let acts: Vec<(&Parameter, bool)> = parameters.iter().zip(parameters.iter().enumerate().map(acts)).collect();
        for field in acts.chunk_by(|(left, _), (right, _)| left.name == right.name) {
            if let Some((parameter, _)) = field.first().filter(|_| field.iter().all(|(_, acts)| !acts)) {
                let name = parameter.name.to_string();
                self.errors.at(parameter.name.span(), &Message::UnusedParameter { name });
            }
        }
    }
}
