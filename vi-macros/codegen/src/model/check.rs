//! Checks of a system, in order.
//!
//! In: a [`System`]. Out: a [`Model`], or all messages.

use super::context::Context;
use super::hamiltonian::Transformed;
use super::rotation::{self, COMPONENTS};
use super::scope::Meaning;
use super::value::Value;
use super::{
    Coordinate, Function, Model, Parameter, Role, Rule, Space, angles, check_state, constraint, first_order, force,
    function, hamiltonian, indices, lets, mass, rule, smoothness, time_scale, timeless,
};
use crate::limits::{COORDINATES, ENTRIES, PARAMETERS, bounded};
use crate::messages::{Absence, ArrayMistake, FunctionMistake, Message, error};
use crate::symbol::{Symbol, Variable};
use crate::syntax::{self, Constant, Defining, Definition, Expression, System};
use proc_macro2::Ident;
use syn::Result;
use vi_expr::{Expr, Pool};

/// Characters of an expression shown in a message.
const CHARACTERS: usize = 100;

/// Checks a system with the rule at this position of its list, and adds its expressions to the pool.
///
/// # Errors
/// All mistakes of the system.
pub fn model(pool: &mut Pool<Symbol>, system: &System, place: usize) -> Result<Model> {
    checked(pool, system, place, false)
}

/// The same for a system that is too large for one expression, whose arrays of `let`s stay symbols. It is checked in
/// fewer respects: nothing says whether its mass matrix is singular.
///
/// # Errors
/// All mistakes of the system.
pub fn large_model(pool: &mut Pool<Symbol>, system: &System) -> Result<Model> {
    checked(pool, system, 0, true)
}

/// A number in the names of a system, with its `let`s, functions and tables.
///
/// # Errors
/// All mistakes of the names and of the expression.
pub fn number_expression(pool: &mut Pool<Symbol>, system: &System, written: &Expression) -> Result<Expr> {
    in_names(pool, system, |context| context.value(written))
}

/// The lengths and the entries, row by row, of an expression in these names; a number has no length.
///
/// # Errors
/// As [`number_expression`].
pub fn shaped_expression(
    pool: &mut Pool<Symbol>,
    system: &System,
    written: &Expression,
) -> Result<(Vec<usize>, Vec<Expr>)> {
    in_names(pool, system, |context| match context.shaped(written) {
        Some(Value::Tensor(of)) => (of.shape, of.entries),
        Some(Value::Number(of) | Value::Wrong(of)) => (Vec::new(), vec![of]),
        None => Default::default(),
    })
}

fn in_names<V>(pool: &mut Pool<Symbol>, system: &System, value: impl FnOnce(&mut Context) -> V) -> Result<V> {
    let mut context = Context::new(pool);
    context.names(system);
    let value = value(&mut context);
    context.errors.finish(value)
}

/// What the names of a system mean, except its `let`s.
struct Named {
    parameters: Vec<Parameter>,
    coordinates: Vec<Coordinate>,
    functions: Vec<Function>,
    /// L of a Hamiltonian.
    lagrangian: Option<Expr>,
}

fn checked(pool: &mut Pool<Symbol>, system: &System, place: usize, is_large: bool) -> Result<Model> {
    let mut context = Context::new(pool);
    context.scope.kept = is_large.then(Vec::new);
    let Named { parameters, coordinates, functions, lagrangian: of_hamiltonian } = context.names(system);
    let constraints = constraint::constraints(&mut context, system.all(Defining::Constraint), &coordinates);
    if system.is_constrained {
        constraint::check_clauses(&mut context, system);
    }
    let is_written = system.all(Defining::Hamiltonian).is_empty() && system.momenta.is_empty();
    let lagrangian =
        if is_written { context.lagrangian(system.all(Defining::Lagrangian), &system.name) } else { of_hamiltonian };
    if let Some((written, lagrangian)) = system.function().zip(lagrangian) {
        let name = &written.name;
        context.defines(Role::Lagrangian, format!("`{name}`"), name.span(), vec![lagrangian]);
    }
    let mut forces = force::forces(&mut context, system.all(Defining::Force), &coordinates);
    let dissipation = force::dissipate(&mut context, system.all(Defining::Dissipation), &mut forces, &parameters);
    rotation::torques(&mut context, system.all(Defining::Torque), false, &coordinates, &mut forces);
    rotation::torques(&mut context, system.all(Defining::SpaceTorque), true, &coordinates, &mut forces);
    let forced = forces.iter().chain(&dissipation).any(|force| !context.pool.is_zero(*force));
    let time_scale = time_scale::time_scale(&mut context, system.all(Defining::TimeScale));
    let rule = rule::rule(&mut context, system, place, coordinates.len(), forced);
    let check_state = check_state::check_state(&mut context, &system.checks, &parameters, &coordinates);
    let clauses = core::mem::take(&mut context.clauses);
    angles::check(&mut context, (&coordinates, &parameters), rule.as_ref(), &clauses);
    if context.errors.is_empty() {
        let of_rule = rule.iter().flat_map(Rule::expressions);
        // Terms of R without velocities exert no force.
        let clauses = clauses.iter().filter(|clause| clause.role != Role::Dissipation);
        let acting = clauses.flat_map(|clause| &clause.exprs).chain(&forces).chain(&dissipation).copied();
        let kept = context.scope.kept.iter().flatten().flat_map(|array| &array.definitions).copied();
        let acting: Vec<Expr> = acting.chain(of_rule).chain(kept).collect();
        context.check_parameters_used(&parameters, &acting);
        function::check_used(&mut context, system);
    }
    let Context { pool, errors, scope, .. } = context;
    errors.finish(())?;
    let Some(lagrangian) = lagrangian else {
        return Err(error(system.name.span(), &Message::MissingLagrangian));
    };
    let kept = scope.kept.as_deref().unwrap_or_default();
    let lagrangian = rotation::with_inertia(pool, lagrangian, kept, (&coordinates, &parameters));
    // A large system is not multiplied out: its sums have to stay loops.
    let mut without_time = |expr| if is_large { expr } else { timeless::timeless(pool, expr) };
    let lagrangian = without_time(lagrangian);
    let forces: Vec<Expr> = forces.into_iter().map(without_time).collect();
    let lagrangian_span = system.function().map_or_else(|| system.name.span(), |written| written.name.span());
    let rows = constraint::rows(pool, &constraints, coordinates.len());
    let singular = if is_large {
        Ok(Vec::new())
    } else {
        mass::check(pool, (&coordinates, &parameters), (lagrangian, lagrangian_span), &rows)
    };
    let first_order = match &singular {
        Ok(without) if !without.is_empty() => first_order::check(pool, system, &coordinates, (without, &forces)),
        _ => Ok(()),
    };
    // Values from an exhausted pool are meaningless.
    bounded(pool).map_err(|found| error(system.name.span(), &Message::TooLarge { size: found }))?;
    let mut model = Model {
        attributes: system.attributes.clone(),
        visibility: system.visibility.clone(),
        name: system.name.clone(),
        parameters,
        coordinates,
        functions,
        lagrangian,
        lagrangian_span,
        smoothness: None,
        forced,
        forces,
        dissipation,
        without_velocity: Vec::new(),
        constraints,
        time_scale,
        lets: scope.kept.unwrap_or_default(),
        rule,
        check_state,
    };
    let dependent = constraint::check(pool, &model);
    bounded(pool).map_err(|found| error(model.name.span(), &Message::TooLarge { size: found }))?;
    // A derivative with a jump is no derivative.
    constraint::check_smoothness(pool, &model)?;
    dependent?;
    first_order?;
    model.without_velocity = singular?;
    if let Some(condition) = smoothness::jump_of_lagrangian(pool, &model) {
        let condition = pool.render_within(CHARACTERS, condition, &|symbol| model.spell(symbol));
        return Err(error(lagrangian_span, &Message::Function(FunctionMistake::Jump { condition })));
    }
    if let Some(name) = smoothness::linear_table(pool, &model) {
        let (what, help) =
            ("is linear, but `L` needs a continuous slope", "use it in a force, or make it `cubic` or `monotone`");
        let message = Message::Function(FunctionMistake::Table { name, what: what.to_owned(), help: help.to_owned() });
        return Err(error(lagrangian_span, &message));
    }
    model.smoothness = smoothness::smoothness(pool, &model);
    Ok(model)
}

impl Context<'_> {
    /// Declares the names of a system, in order.
    fn names(&mut self, system: &System) -> Named {
        let System { constants, parameters, coordinates, .. } = system;
        let lets = system.all(Defining::Let);
        self.scope.expect(lets.iter().map(|named| &named.name), Absence::Let);
        self.scope.expect(coordinates.iter().map(|coordinate| &coordinate.name), Absence::Coordinate);
        self.scope.expect(system.momenta.iter().map(|momentum| &momentum.name), Absence::Momentum);
        self.scope.expect(parameters.iter().map(|parameter| &parameter.name), Absence::Parameter);
        self.scope
            .expect(system.all(Defining::Constraint).iter().map(|constraint| &constraint.name), Absence::Constraint);
        self.scope.expect(constants.iter().map(|constant| &constant.name), Absence::Below);
        self.constants(constants);
        let parameters = self.parameters(parameters);
        let mut coordinates = self.coordinates(coordinates, &system.name);
        self.scope.expect(lets.iter().map(|named| &named.name), Absence::Below);
        let functions = function::functions(self, system, &parameters);
        hamiltonian::momenta(self, system, &coordinates);
        lets::lets(self, lets);
        let transformed = hamiltonian::lagrangian(self, system, (&coordinates, &parameters));
        let lagrangian = transformed.map(|Transformed { lagrangian, momenta }| {
            coordinates.extend(momenta);
            lagrangian
        });
        Named { parameters, coordinates, functions, lagrangian }
    }

    fn constants(&mut self, constants: &[Constant]) {
        for Constant { name, lengths: written, value, .. } in constants {
            let too_long = |given| Message::Array(ArrayMistake::Length { given, limit: ENTRIES });
            let lengths = self.lengths(written, ENTRIES, too_long);
            let value = lengths.and_then(|lengths| self.constant_value(name, (written, &lengths), value));
            let meaning = value.map_or(Meaning::Wrong, |value| lets::meaning(&value));
            self.declare(name, meaning);
        }
    }

    /// The parameters with their defaults; arrays entry by entry.
    fn parameters(&mut self, declared: &[syntax::Parameter]) -> Vec<Parameter> {
        let fields: Vec<_> = declared.iter().map(|parameter| self.defaults(parameter)).collect();
        let mut parameters = Vec::new();
        for (syntax::Parameter { attributes, name, is_input, .. }, defaults) in declared.iter().zip(fields) {
            let Some((lengths, defaults)) = defaults else {
                self.declare(name, Meaning::Wrong);
                continue;
            };
            let mut entries = Vec::with_capacity(defaults.len());
            for (indices, default) in indices(&lengths).into_iter().zip(defaults) {
                let (attributes, name, is_input) = (attributes.clone(), name.clone(), *is_input);
                let parameter = Parameter { attributes, name, indices, default, is_input };
                entries.push(self.pool.symbol(parameter.symbol(parameters.len())));
                parameters.push(parameter);
            }
            self.declare(name, lets::meaning(&Value::of_shape(&lengths, entries)));
        }
        parameters
    }

    /// The lengths of a parameter and the defaults of its entries; reports a wrong length.
    fn defaults(&mut self, parameter: &syntax::Parameter) -> Option<(Vec<usize>, Vec<f64>)> {
        let too_long = |given| Message::ParametersLength { given, limit: PARAMETERS };
        let lengths = self.lengths(&parameter.lengths, PARAMETERS, too_long)?;
        let numbers = self.numbers(parameter, &lengths)?;
        Some((lengths, numbers))
    }

    fn coordinates(&mut self, declared: &[syntax::Coordinate], system: &Ident) -> Vec<Coordinate> {
        if declared.is_empty() {
            self.errors.at(system.span(), &Message::MissingCoordinates);
        }
        let (mut coordinates, mut too_many) = (Vec::new(), None);
        for syntax::Coordinate { name, lengths, space } in declared {
            let first = coordinates.len();
            if lengths.is_empty() && first == COORDINATES {
                self.declare(name, Meaning::Wrong);
                too_many = too_many.or(Some(name.span()));
                continue;
            }
            let is_rotation = *space == Space::Rotation;
            let components = if is_rotation { COMPONENTS } else { 1 };
            let left = (COORDINATES - first.min(COORDINATES)) / components;
            let too_long = |given| Message::Length { given, limit: COORDINATES };
            let Some(mut lengths) = self.lengths(lengths, left, too_long).filter(|_| left > 0) else {
                self.declare(name, Meaning::Wrong);
                continue;
            };
            lengths.extend(is_rotation.then_some(COMPONENTS));
            let each = indices(&lengths).into_iter();
            coordinates.extend(each.map(|indices| Coordinate { name: name.clone(), indices, space: *space }));
            let is_one = lengths.is_empty();
            let meaning = if is_one { Meaning::Coordinate(first) } else { Meaning::Coordinates { first, lengths } };
            self.declare(name, meaning);
        }
        if let Some(first) = too_many {
            self.errors.at(first, &Message::TooManyCoordinates { limit: COORDINATES });
        }
        coordinates
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
        if self.errors.is_empty() && self.scope.kept.is_none() && !self.pool.depends_on(lagrangian, &moves) {
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
                let (name, is_input) = (parameter.name.to_string(), parameter.is_input);
                self.errors.at(parameter.name.span(), &Message::UnusedParameter { name, is_input });
            }
        }
    }
}
