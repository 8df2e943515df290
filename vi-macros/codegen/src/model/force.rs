//! The generalized force: the sum of the `force` lines and of the dissipation.
//!
//! In: the lines `force x = …;` and `dissipation = R;`. Out: one expression per coordinate,
//!
//! ```text
//! f_i = (line of x_i) − ∂R/∂v_i        R(t,q,v) is Rayleigh's function
//! ```

use super::array::{part, spelled};
use super::context::Context;
use super::dissipation;
use super::scope::{Meaning, Scope};
use super::value::not_a_number;
use super::{Coordinate, Parameter, Role, Space, slope};
use crate::messages::{ArrayMistake, ConstraintMistake, Message, error};
use crate::symbol::{Symbol, Variable};
use crate::syntax::{Definition, Indices};
use proc_macro2::Span;
use syn::Result;
use vi_expr::{Expr, Pool};

/// The force on each coordinate by the `force` lines; zero where none is declared.
pub(super) fn forces(context: &mut Context, lines: &[Definition], coordinates: &[Coordinate]) -> Vec<Expr> {
    let mut forces: Vec<Option<Expr>> = vec![None; coordinates.len()];
    // A torque has three numbers, with the name of the rotation.
    let of_first = |of: &Coordinate| if of.component().is_some() { of.name.to_string() } else { of.text() };
    let first = coordinates.first().map_or("x".to_owned(), of_first);
    for line in lines {
        let is_rotation = coordinates.iter().any(|known| known.space == Space::Rotation && known.name == line.name);
        if is_rotation && has_three_components(context, line) {
            let mistake = ConstraintMistake::ForceOnRotation { name: line.name.to_string() };
            context.errors.at(line.name.span(), &Message::Constraint(mistake));
            continue;
        }
        let coordinates = Entries::of_coordinate(context, &line.name.to_string());
        let on_other = |context: &Context, name: String| {
            if context.scope.meaning(&name) == Some(&Meaning::Constraint) {
                return Message::Constraint(ConstraintMistake::Force { name });
            }
            let near = context.scope.near_of(context.pool, &name, |known| context.scope.is_coordinate(known));
            Message::ForceOnOther { name, near, coordinate: first.clone() }
        };
        let Some(values) = values(context, line, coordinates, &on_other) else { continue };
        let exprs = values.iter().map(|(_, value)| *value).collect();
        context.defines(Role::Force, format!("the force on `{}`", line.name), line.name.span(), exprs);
        for (coordinate, value) in values {
            if forces[coordinate].replace(value).is_some() {
                context.errors.at(line.name.span(), &Message::SecondForce { name: line.name.to_string() });
                break;
            }
        }
    }
    let zero = context.pool.zero();
    forces.into_iter().map(|force| force.unwrap_or(zero)).collect()
}

/// Whether the value of a line is a vector of three numbers; `false` for one with mistakes.
fn has_three_components(context: &mut Context, line: &Definition) -> bool {
    let Context { scope, pool, .. } = context;
    line.indices.is_empty() && scope.value(pool, &line.value).is_ok_and(|value| value.shape() == [3])
}

/// The numbers that a line assigns values to: one, or those of an array of these lengths.
pub(super) struct Entries {
    pub(super) first: usize,
    pub(super) lengths: Vec<usize>,
}

impl Entries {
    /// The coordinates with this name.
    pub(super) fn of_coordinate(context: &Context, name: &str) -> Option<Self> {
        match context.scope.meaning(name)? {
            Meaning::Coordinate(coordinate) => Some(Self { first: *coordinate, lengths: Vec::new() }),
            Meaning::Coordinates { first, lengths } => Some(Self { first: *first, lengths: lengths.clone() }),
            _ => None,
        }
    }
}

/// The message for a name without entries.
pub(super) type Other<'a> = &'a dyn Fn(&Context, String) -> Message;

/// The entries of a line with their values.
pub(super) fn values(
    context: &mut Context,
    line: &Definition,
    entries: Option<Entries>,
    other: Other,
) -> Option<Vec<(usize, Expr)>> {
    let name = line.name.to_string();
    let wanted = match entries {
        Some(Entries { first, lengths }) if lengths.is_empty() && line.indices.is_empty() => {
            Ok(vec![(first, context.value(&line.value))])
        }
        Some(Entries { lengths, .. }) if lengths.is_empty() => {
            Err(error(line.name.span(), &Message::NotArray { name }))
        }
        Some(entries) => array_values(context, line, &entries),
        None if context.scope.meaning(&name) == Some(&Meaning::Wrong) => Ok(Vec::new()),
        None => {
            // Reports errors in the value too.
            context.shaped(&line.value);
            Err(error(line.name.span(), &other(context, name)))
        }
    };
    context.report(wanted)
}

/// The values of the entries of an array: a number for a number, a vector for a vector.
fn array_values(
    context: &mut Context,
    line: &Definition,
    Entries { first, lengths }: &Entries,
) -> Result<Vec<(usize, Expr)>> {
    let Context { scope, pool, .. } = context;
    let name = line.name.to_string();
    let mut made = Vec::new();
    over(scope, pool, &line.indices, &mut Vec::new(), &mut |scope, pool, at| {
        let value = scope.value(pool, &line.value)?;
        let path = path(scope, pool, &line.indices, at)?;
        let (range, rest) = part(&name, lengths, &path)?;
        let values = value.fitting(pool, rest).map_err(|value| {
            if rest.is_empty() {
                return not_a_number(&line.value, value.shape());
            }
            let (needs, given) = (rest.to_vec(), value.shape().to_vec());
            let mistake = ArrayMistake::ShapeNeeded { needs, given, name: spelled(&name, &path) };
            error(line.value.span, &Message::Array(mistake))
        })?;
        made.extend(range.map(|place| first + place).zip(values));
        Ok(())
    })?;
    Ok(made)
}

/// The operation at the entries of a line.
pub(super) type Make<'a> = &'a mut dyn FnMut(&mut Scope, &mut Pool<Symbol>, &[i64]) -> Result<()>;

/// Applies an operation to the values of the indices of the ranges, in order.
pub(super) fn over(
    scope: &mut Scope,
    pool: &mut Pool<Symbol>,
    levels: &[Indices],
    at: &mut Vec<i64>,
    make: Make,
) -> Result<()> {
    match levels.split_first() {
        None => make(scope, pool, at),
        Some((Indices::One(_), inner)) => over(scope, pool, inner, at, make),
        Some((Indices::Range(range), inner)) => {
            scope.each(pool, range, &mut |scope, pool, index| {
                at.push(index);
                over(scope, pool, inner, at, make)?;
                at.pop();
                Ok(())
            })?;
            Ok(())
        }
    }
}

/// The indices of an entry with their places, from those of its ranges.
pub(super) fn path(
    scope: &mut Scope,
    pool: &mut Pool<Symbol>,
    levels: &[Indices],
    at: &[i64],
) -> Result<Vec<(i64, Span)>> {
    let mut of_ranges = at.iter();
    let index = |level: &Indices| match level {
        Indices::One(index) => Ok((scope.integer(pool, index)?, index.span)),
        Indices::Range(range) => Ok((of_ranges.next().copied().unwrap_or_default(), range.to.span)),
    };
    levels.iter().map(index).collect()
}

/// Adds −∂R/∂v to the forces. R itself, and nothing added, if arrays of `let`s stay symbols: their derivatives are
/// evaluated.
pub(super) fn dissipate(
    context: &mut Context,
    written: &[Definition],
    forces: &mut [Expr],
    parameters: &[Parameter],
) -> Option<Expr> {
    let (first, others) = written.split_first()?;
    for other in others {
        context.errors.at(other.name.span(), &Message::SecondDissipation);
    }
    let as_written = context.value(&first.value);
    context.defines(Role::Dissipation, "the dissipation".to_owned(), first.name.span(), vec![as_written]);
    let rayleigh = context.closed(as_written);
    let moves = |symbol: &Symbol| matches!(symbol, Symbol::Continuous(Variable::Velocity(_)));
    if context.errors.is_empty() && !context.pool.depends_on(rayleigh, &moves) {
        context.errors.at(first.name.span(), &Message::NoDissipation);
    }
    let stays = context.scope.kept.is_some();
    let mut losses = Vec::with_capacity(forces.len());
    for (index, force) in forces.iter_mut().enumerate() {
        let loss = slope(context.pool, rayleigh, Variable::Velocity(index));
        if !stays {
            *force = context.pool.sub(*force, loss);
        }
        losses.push(loss);
    }
    if losses.iter().any(|loss| context.pool.is_undefined(*loss)) && !context.is_too_large() {
        context.errors.at(first.value.span, &Message::NoValue);
    }
    if context.errors.is_empty() {
        dissipation::check(context, &first.value, (rayleigh, &losses), parameters);
    }
    stays.then_some(as_written)
}
