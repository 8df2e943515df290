//! The constraints: lines `constraint name = expression;`.
//!
//! In: the lines in order. Out: a [`Constraint`] for each number, the holonomic ones first, each kind in order:
//!
//! ```text
//! holonomic       g(t, q) = 0               no velocity remains in the expression
//! nonholonomic    A(t, q) v + a(t, q) = 0   linear in the velocities, and not the time derivative of a function
//! ```
//!
//! Whether constraints are independent is decided at points of a fixed sequence, as for the mass matrix: rows of A that
//! are dependent at all of them are dependent everywhere, except with negligible probability. As many constraints as
//! coordinates may depend on each other only where they hold, as those of mechanisms that move nevertheless: see
//! `mobility`.

use super::angles::outside_periods;
use super::closed::Closed;
use super::context::Context;
use super::force::{over, path};
use super::probe::vanish;
use super::rotation;
use super::scope::{Meaning, Scope};
use super::singular::is_singular;
use super::smoothness::{jump, with_conditions};
use super::value::Value;
use super::{
    Constraint, Coordinate, FunctionKind, Model, Parameter, Role, Space, TableKind, indices, mass, mobility, slope,
};
use crate::limits::bounded;
use crate::messages::{ConstraintMistake, Errors, Message, bracketed, error};
use crate::symbol::{Symbol, Variable};
use crate::syntax::{Definition, Expression, Kind, Operator, System};
use num_integer::Integer;
use num_traits::{One, Zero};
use std::collections::{BTreeMap, BTreeSet};
use syn::Result;
use vi_expr::{Expr, Function, Node, Pool, Rational};

/// Characters of an expression shown in a message.
const CHARACTERS: usize = 100;

/// A v + a.
pub(crate) struct Rate {
    /// A, one entry per coordinate.
    pub(crate) row: Vec<Expr>,
    /// a.
    pub(crate) rest: Expr,
}

impl Constraint {
    /// The name as the user writes it: `rod`, or `link[3]`.
    #[must_use]
    pub fn text(&self) -> String {
        self.name.to_string() + &bracketed(&self.indices)
    }

    /// The name as an identifier: `rod`, or `link_3`.
    #[must_use]
    pub fn ident(&self) -> String {
        let index = |index: &i64| index.to_string().replace('-', "m");
        self.indices.iter().fold(self.name.to_string(), |text, at| format!("{text}_{}", index(at)))
    }

    /// Whether its reaction has a component on this coordinate.
    pub(crate) fn acts_on(&self, pool: &Pool<Symbol>, coordinate: usize) -> bool {
        let by = if self.is_holonomic { Variable::Coordinate(coordinate) } else { Variable::Velocity(coordinate) };
        pool.depends_on(self.value, &|symbol| *symbol == Symbol::Continuous(by))
    }

    /// A and a. Those of a holonomic constraint are g_q and g_t.
    pub(crate) fn rate(&self, pool: &mut Pool<Symbol>, dimension: usize) -> Rate {
        let symbols = pool.symbols(self.value);
        let mut row = vec![pool.zero(); dimension];
        for (index, entry) in row.iter_mut().enumerate() {
            let by = if self.is_holonomic { Variable::Coordinate(index) } else { Variable::Velocity(index) };
            if symbols.contains(&Symbol::Continuous(by)) {
                *entry =
                    if self.is_holonomic { slope(pool, self.value, by) } else { coefficient(pool, self.value, by) };
            }
        }
        Rate { row, rest: self.rest(pool) }
    }

    /// a.
    pub(crate) fn rest(&self, pool: &mut Pool<Symbol>) -> Expr {
        if self.is_holonomic {
            slope(pool, self.value, Variable::Time)
        } else {
            pool.substitute(self.value, &mut |pool, symbol| is_velocity(symbol).then(|| pool.zero()))
        }
    }
}

/// The coefficient of a velocity in an expression that is linear in velocities, free of velocities after expansion.
fn coefficient(pool: &mut Pool<Symbol>, expr: Expr, by: Variable) -> Expr {
    let slope = slope(pool, expr, by);
    if pool.depends_on(slope, &is_velocity) { pool.expand(slope).unwrap_or(slope) } else { slope }
}

fn is_velocity(symbol: &Symbol) -> bool {
    matches!(symbol, Symbol::Continuous(Variable::Velocity(_)))
}

/// Whether an expression is a constant plus terms linear in the velocities.
fn is_linear(pool: &mut Pool<Symbol>, expr: Expr) -> bool {
    let velocities = pool.symbols(expr).into_iter().filter_map(|symbol| match symbol {
        Symbol::Continuous(variable @ Variable::Velocity(_)) => Some(variable),
        _ => None,
    });
    velocities.into_iter().all(|velocity| {
        let coefficient = coefficient(pool, expr, velocity);
        !pool.depends_on(coefficient, &is_velocity)
    })
}

/// The constraints of the rotations and of these lines, the holonomic ones first; reports wrong ones.
pub(super) fn constraints(context: &mut Context, lines: &[Definition], coordinates: &[Coordinate]) -> Vec<Constraint> {
    // Whether the name is that of an array.
    let mut declared: BTreeMap<String, bool> = BTreeMap::new();
    let (mut found, mut names) = (rotation::constraints(context.pool, coordinates), BTreeSet::new());
    let lets = context.scope.kept.as_deref().filter(|_| !lines.is_empty()).unwrap_or_default();
    let closed = Closed::of(context.pool, lets);
    for line in lines {
        let (name, is_array) = (line.name.to_string(), !line.indices.is_empty());
        let mistake = |mistake| error(line.name.span(), &Message::Constraint(mistake));
        if context.scope.is_coordinate(&name) {
            context.errors.add(mistake(ConstraintMistake::NoName));
            continue;
        }
        if !(is_array && declared.get(&name) == Some(&true)) {
            if let Err(found) = context.scope.declare(&line.name, Meaning::Constraint) {
                context.errors.add(found);
                continue;
            }
            declared.insert(name, is_array);
        }
        let made = entries(context, &closed, line);
        for mut constraint in context.report(made).unwrap_or_default() {
            modulo_turns(context.pool, &mut constraint, coordinates);
            let text = constraint.text();
            let moves = |symbol: &Symbol| matches!(symbol, Symbol::Continuous(Variable::Coordinate(_)));
            let is_free = constraint.is_holonomic && !context.pool.depends_on(constraint.value, &moves);
            // A name with a mistake counts as 1.
            let is_constant = is_free && context.errors.is_empty();
            found.push(constraint);
            let wrong = if is_constant {
                ConstraintMistake::Constant { name: text }
            } else if !names.insert(text.clone()) {
                ConstraintMistake::Twice { name: text }
            } else {
                continue;
            };
            context.errors.add(mistake(wrong));
            break;
        }
    }
    found.sort_by_key(|constraint| !constraint.is_holonomic);
    for array in found.chunk_by(|left, right| left.name == right.name) {
        let (name, exprs) = (&array[0].name, array.iter().map(|constraint| constraint.value).collect());
        context.defines(Role::Constraint, format!("the constraint `{name}`"), name.span(), exprs);
    }
    found
}

/// Reports the clauses that a system with constraints cannot have.
pub(super) fn check_clauses(context: &mut Context, system: &System) {
    for (clause, span) in system.of_free_systems() {
        context.errors.at(span, &Message::Constraint(ConstraintMistake::Clause { clause }));
    }
}

/// The constraints of a line: one for each number of each entry.
fn entries(context: &mut Context, closed: &Closed, line: &Definition) -> Result<Vec<Constraint>> {
    let Context { scope, pool, .. } = context;
    let mut made = Vec::new();
    over(scope, pool, &line.indices, &mut Vec::new(), &mut |scope, pool, at| {
        let written = scope.value(pool, &line.value)?;
        let value = written.clone().map(|entry| closed.expression(pool, entry));
        let of_entry: Vec<i64> = path(scope, pool, &line.indices, at)?.into_iter().map(|(index, _)| index).collect();
        if matches!(value, Value::Wrong(_)) {
            return Ok(());
        }
        if !value.entries().iter().all(|entry| is_linear(pool, *entry)) {
            let wrong = nonlinear(scope, pool, closed, &line.value).unwrap_or(&line.value);
            return Err(error(wrong.span, &Message::Constraint(ConstraintMistake::Nonlinear)));
        }
        let places = indices(value.shape()).into_iter();
        for ((place, entry), written) in places.zip(value.entries()).zip(written.entries()) {
            let place = place.into_iter().filter_map(|index| i64::try_from(index).ok());
            made.push(Constraint {
                name: line.name.clone(),
                indices: of_entry.iter().copied().chain(place).collect(),
                value: *entry,
                written: *written,
                is_holonomic: !pool.depends_on(*entry, &is_velocity),
            });
        }
        Ok(())
    })?;
    Ok(made)
}

/// Makes a constraint g that is linear in angles, with rational factors, periodic in them. If the factors are whole
/// multiples of ρ, the turns of the angles change g by any whole multiple of 2πρ, and g holds modulo 2πρ:
///
/// ```text
/// ρ atan2(sin(g/ρ), cos(g/ρ)) = 0        g less the nearest multiple of 2πρ, with the gradient of g
/// ```
fn modulo_turns(pool: &mut Pool<Symbol>, constraint: &mut Constraint, coordinates: &[Coordinate]) {
    let are_angles: Vec<bool> = coordinates.iter().map(|coordinate| coordinate.space == Space::Circle).collect();
    let is_angle = |(term, _): &(Expr, Rational)| match pool.as_symbol(*term) {
        Some(Symbol::Continuous(Variable::Coordinate(index))) => are_angles[*index],
        _ => false,
    };
    let terms = match pool.node(constraint.value) {
        Node::Sum(sum) => sum.terms.clone(),
        _ => vec![(constraint.value, Rational::one())],
    };
    let (of_angles, others): (Vec<_>, Vec<_>) = terms.into_iter().partition(is_angle);
    if others.into_iter().any(|(term, _)| outside_periods(pool, term, &are_angles).is_some()) {
        return;
    }
    let common = of_angles.iter().fold(Rational::zero(), |common, (_, factor)| {
        let numerator = (common.numer() * factor.denom()).gcd(&(factor.numer() * common.denom()));
        Rational::new(numerator, common.denom() * factor.denom())
    });
    if common.is_zero() {
        return;
    }
    for expr in [&mut constraint.value, &mut constraint.written] {
        let part = pool.scale(*expr, &common.recip());
        let [sine, cosine] = [Function::Sin, Function::Cos].map(|function| pool.call(function, &[part]));
        let least = pool.call(Function::Atan2, &[sine, cosine]);
        *expr = pool.scale(least, &common);
    }
}

/// The first term that is not linear in the velocities.
fn nonlinear<'e>(
    scope: &mut Scope,
    pool: &mut Pool<Symbol>,
    closed: &Closed,
    written: &'e Expression,
) -> Option<&'e Expression> {
    let is_sum = |rest: &[(Operator, Expression)]| {
        rest.iter().all(|(operator, _)| matches!(operator, Operator::Plus | Operator::Minus))
    };
    let parts: Vec<&Expression> = match &written.kind {
        Kind::Chain(first, rest) if is_sum(rest) => {
            [&**first].into_iter().chain(rest.iter().map(|(_, term)| term)).collect()
        }
        Kind::Negative(operand) => vec![operand],
        Kind::List(entries) => entries.iter().collect(),
        _ => Vec::new(),
    };
    if let Some(part) = parts.into_iter().find_map(|part| nonlinear(scope, pool, closed, part)) {
        return Some(part);
    }
    let value = scope.value(pool, written).ok()?.map(|entry| closed.expression(pool, entry));
    let wrong = value.entries().iter().any(|entry| !is_linear(pool, *entry));
    wrong.then_some(written)
}

/// The rows A of the constraints, one entry per coordinate.
pub(super) fn rows(pool: &mut Pool<Symbol>, constraints: &[Constraint], dimension: usize) -> Vec<Vec<Expr>> {
    constraints.iter().map(|constraint| constraint.rate(pool, dimension).row).collect()
}

/// Reports constraints on velocities that are derivatives of functions of a closed form, without inputs, then one that depends on others,
/// then constraints that leave no motion.
pub(super) fn check(pool: &mut Pool<Symbol>, model: &Model) -> Result<()> {
    let (constraints, parameters, dimension) = (&model.constraints, &model.parameters, model.dimension());
    let mut errors = Errors::default();
    let mut at = |constraint: &Constraint, mistake| {
        errors.at(constraint.name.span(), &Message::Constraint(mistake));
    };
    let mut integrable = false;
    // An input prescribes a velocity, and changes between steps: the constraint is no derivative.
    let is_input = |symbol: &Symbol| match symbol {
        Symbol::Parameter { index, .. } => parameters[*index].is_input,
        _ => false,
    };
    let of_inputs: Vec<bool> =
        constraints.iter().map(|constraint| pool.depends_on(constraint.value, &is_input)).collect();
    let given =
        constraints.iter().zip(of_inputs).filter(|(constraint, of_input)| !constraint.is_holonomic && !of_input);
    for (constraint, _) in given {
        let rate = constraint.rate(pool, dimension);
        // Without a closed form only its velocity can be constrained.
        if is_derivative(pool, &rate, parameters)
            && let Some(function) = potential(pool, &rate)
        {
            let function = pool.render_within(CHARACTERS, function, &|symbol| model.spell(symbol));
            at(constraint, ConstraintMistake::Integrable { name: constraint.text(), function });
            integrable = true;
        }
    }
    let rows = rows(pool, constraints, dimension);
    let dependent = dependent(pool, &rows, dimension, parameters);
    if !integrable && let Some(dependent) = dependent {
        let constraint = &constraints[dependent];
        let name = constraint.text();
        let alone = |rows: &[&Vec<Expr>]| {
            let rows: Vec<Vec<Expr>> = rows.iter().map(|row| (*row).clone()).collect();
            is_dependent(pool, &rows, dimension, parameters)
        };
        let twin = (0..dependent).find(|other| alone(&[&rows[*other], &rows[dependent]]));
        let mistake = match twin {
            _ if alone(&[&rows[dependent]]) => ConstraintMistake::Constant { name },
            Some(other) => ConstraintMistake::Same { name, other: constraints[other].text() },
            None => ConstraintMistake::Dependent { name },
        };
        at(constraint, mistake);
    } else if !integrable && constraints.len() >= dimension {
        let moves = mobility::leave_motion(pool, (constraints, &rows), dimension, parameters);
        if let Some(first) = constraints.get(dimension).or(constraints.last()).filter(|_| !moves) {
            at(first, ConstraintMistake::TooMany { count: constraints.len(), size: dimension });
        }
    }
    errors.finish(())
}

/// The first row that depends on those before it, at every point; beyond as many as coordinates, that depends on a
/// single one.
fn dependent(pool: &Pool<Symbol>, rows: &[Vec<Expr>], dimension: usize, parameters: &[Parameter]) -> Option<usize> {
    let (rows, more) = rows.split_at(rows.len().min(dimension));
    // One test for the usual case.
    if !is_dependent(pool, rows, dimension, parameters) {
        let repeats = |row: &Vec<Expr>| {
            rows.iter().any(|other| is_dependent(pool, &[other.clone(), row.clone()], dimension, parameters))
        };
        return more.iter().position(repeats).map(|index| rows.len() + index);
    }
    (1..=rows.len()).find(|count| is_dependent(pool, &rows[..*count], dimension, parameters)).map(|count| count - 1)
}

/// Whether rows are dependent at every point: with the unit matrix above them, the bordered matrix is singular.
fn is_dependent(pool: &Pool<Symbol>, rows: &[Vec<Expr>], dimension: usize, parameters: &[Parameter]) -> bool {
    let mut unit = vec![pool.zero(); dimension * dimension];
    for index in 0..dimension {
        unit[index * dimension + index] = pool.one();
    }
    let bordered = mass::bordered(pool, &unit, rows, dimension);
    is_singular(pool, &bordered, dimension + rows.len(), parameters)
}

/// Whether A v + a is d/dt of a function of time and coordinates: ∂A_i/∂q_j = ∂A_j/∂q_i and ∂A_i/∂t = ∂a/∂q_i at all
/// points.
fn is_derivative(pool: &mut Pool<Symbol>, Rate { row, rest }: &Rate, parameters: &[Parameter]) -> bool {
    let mut differences = Vec::new();
    let coordinate = Variable::Coordinate;
    let mut add = |pool: &mut Pool<Symbol>, [left, right]: [Expr; 2], [first, second]: [Variable; 2]| {
        if pool.is_zero(left) && pool.is_zero(right) {
            return;
        }
        let (left, right) = (slope(pool, left, first), slope(pool, right, second));
        let difference = pool.sub(left, right);
        if !pool.is_zero(difference) {
            differences.push(difference);
        }
    };
    for (i, entry) in row.iter().enumerate() {
        add(pool, [*entry, *rest], [Variable::Time, coordinate(i)]);
        for (j, other) in row.iter().enumerate().take(i) {
            add(pool, [*entry, *other], [coordinate(j), coordinate(i)]);
        }
    }
    vanish(pool, &differences, parameters)
}

/// A function with these derivatives, if it is a sum of powers, sines, cosines and exponentials.
fn potential(pool: &mut Pool<Symbol>, Rate { row, rest }: &Rate) -> Option<Expr> {
    let by_coordinate = row.iter().enumerate().map(|(index, entry)| (Variable::Coordinate(index), *entry));
    let slopes: Vec<(Variable, Expr)> = by_coordinate.chain([(Variable::Time, *rest)]).collect();
    let mut function = pool.zero();
    for (variable, wanted) in &slopes {
        let left = left_over(pool, function, (*variable, *wanted))?;
        let part = antiderivative(pool, left, *variable)?;
        function = pool.add(function, part);
    }
    let is_right = slopes.into_iter().all(|slope| {
        let left = left_over(pool, function, slope);
        left.is_some_and(|left| pool.is_zero(left))
    });
    is_right.then_some(function)
}

/// The wanted derivative less that of a function, expanded.
fn left_over(pool: &mut Pool<Symbol>, function: Expr, (variable, wanted): (Variable, Expr)) -> Option<Expr> {
    let slope = slope(pool, function, variable);
    let left = pool.sub(wanted, slope);
    pool.expand(left).ok()
}

/// A function with this derivative with respect to a variable; term by term.
fn antiderivative(pool: &mut Pool<Symbol>, expr: Expr, by: Variable) -> Option<Expr> {
    let (terms, constant) = match pool.node(expr).clone() {
        Node::Sum(sum) => (sum.terms, sum.constant),
        Node::Number(number) => (Vec::new(), number),
        _ => (vec![(expr, Rational::from_integer(1.into()))], Rational::from_integer(0.into())),
    };
    let variable = pool.symbol(Symbol::Continuous(by));
    let mut parts = vec![pool.scale(variable, &constant)];
    for (term, factor) in terms {
        let part = of_term(pool, term, by)?;
        parts.push(pool.scale(part, &factor));
    }
    Some(pool.sum(&parts))
}

/// A function whose derivative is this product: c x^n, or c times the sine, cosine or exponential of k x + ….
fn of_term(pool: &mut Pool<Symbol>, term: Expr, by: Variable) -> Option<Expr> {
    let one = Rational::from_integer(1.into());
    let is_variable = |symbol: &Symbol| *symbol == Symbol::Continuous(by);
    let factors = match pool.node(term) {
        Node::Product(product) => product.factors.clone(),
        _ => vec![(term, one.clone())],
    };
    let (moving, fixed): (Vec<_>, Vec<_>) =
        factors.into_iter().partition(|(base, _)| pool.depends_on(*base, &is_variable));
    let fixed: Vec<Expr> = fixed.iter().map(|(base, exponent)| pool.power(*base, exponent)).collect();
    let fixed = pool.product(&fixed);
    let variable = pool.symbol(Symbol::Continuous(by));
    let part = match &moving[..] {
        [] => variable,
        [(base, exponent)] if *base == variable && *exponent != -&one => {
            let next = exponent + &one;
            let power = pool.power(variable, &next);
            pool.scale(power, &next.recip())
        }
        [(base, exponent)] if *exponent == one => {
            let Node::Call(function, arguments) = pool.node(*base).clone() else { return None };
            let (integral, sign) = match function {
                Function::Sin => (Function::Cos, -1),
                Function::Cos => (Function::Sin, 1),
                Function::Exp => (Function::Exp, 1),
                _ => return None,
            };
            let argument = *arguments.first()?;
            let rate = slope(pool, argument, by);
            if pool.depends_on(rate, &is_variable) {
                return None;
            }
            let whole = pool.call(integral, &[argument]);
            let whole = pool.div(whole, rate);
            pool.scale(whole, &Rational::from_integer(sign.into()))
        }
        _ => return None,
    };
    Some(pool.mul(fixed, part))
}

/// Reports a constraint with a jump or a kink: velocities would jump there.
pub(super) fn check_smoothness(pool: &mut Pool<Symbol>, model: &Model) -> Result<()> {
    for constraint in &model.constraints {
        let mistake = |mistake| error(constraint.name.span(), &Message::Constraint(mistake));
        let name = constraint.text();
        let linear = pool.reachable(&[constraint.value]).into_iter().find_map(|node| {
            let Node::Opaque(function, _) = pool.node(node) else { return None };
            let known = model.functions.iter().find(|known| known.name == function.name.as_ref())?;
            let is_linear = matches!(&known.kind, FunctionKind::Table(table) if table.kind == TableKind::Linear);
            is_linear.then(|| function.name.to_string())
        });
        if let Some(table) = linear.filter(|_| constraint.is_holonomic) {
            return Err(mistake(ConstraintMistake::LinearTable { name, table }));
        }
        let Rate { row, rest } = constraint.rate(pool, model.dimension());
        for expr in [constraint.value, rest].into_iter().chain(row) {
            let expr = with_conditions(pool, expr, &|_, _| true);
            if let Some(condition) = jump(pool, expr, &model.parameters) {
                let condition = pool.render_within(CHARACTERS, condition, &|symbol| model.spell(symbol));
                return Err(mistake(ConstraintMistake::Jump { name, condition }));
            }
        }
        bounded(pool).map_err(|found| error(model.name.span(), &Message::TooLarge { size: found }))?;
    }
    Ok(())
}
