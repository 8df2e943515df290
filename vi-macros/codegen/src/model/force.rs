//! The generalized force: the sum of the `force` lines and of the dissipation.
//!
//! In: the lines `force x = …;` and `dissipation = R;`. Out: one expression per coordinate,
//!
//! ```text
//! f_i = (line of x_i) − ∂R/∂v_i        R(t,q,v) is Rayleigh's function
//! ```

use super::Parameter;
use super::context::Context;
use super::dissipation;
use super::scope::Meaning;
use crate::messages::{Message, error};
use crate::symbol::{Symbol, Variable};
use crate::syntax::{Definition, Indices};
use proc_macro2::Span;
use syn::Result;
use vi_expr::Expr;

/// The force on each coordinate; zero where none is declared.
pub(super) fn forces(
    context: &mut Context,
    lines: &[Definition],
    dissipations: &[Definition],
    parameters: &[Parameter],
    dimension: usize,
) -> Vec<Expr> {
    let mut forces: Vec<Option<Expr>> = vec![None; dimension];
    for line in lines {
        let coordinates = Entries::of_coordinate(context, &line.name.to_string());
        let on_other = |context: &Context, name: String| {
            let near = context.scope.near_of(context.pool, &name, |known| context.scope.is_coordinate(known));
            Message::ForceOnOther { name, near }
        };
        let Some(values) = values(context, line, coordinates, &on_other) else { continue };
        for (coordinate, value) in values {
            if forces[coordinate].replace(value).is_some() {
                context.errors.at(line.name.span(), &Message::SecondForce { name: line.name.to_string() });
                break;
            }
        }
    }
    let zero = context.pool.zero();
    let mut forces: Vec<Expr> = forces.into_iter().map(|force| force.unwrap_or(zero)).collect();
    dissipate(context, dissipations, &mut forces, parameters);
    forces
}

/// The indices that a line assigns values to.
#[derive(Clone, Copy)]
pub(super) enum Entries {
    One(usize),
    Array { first: usize, length: usize },
}

impl Entries {
    /// The coordinates with this name.
    pub(super) fn of_coordinate(context: &Context, name: &str) -> Option<Self> {
        match context.scope.meaning(name)? {
            Meaning::Coordinate(coordinate) => Some(Self::One(*coordinate)),
            Meaning::Coordinates { first, length } => Some(Self::Array { first: *first, length: *length }),
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
    let wanted = match (entries, &line.indices) {
        (Some(Entries::One(entry)), None) => Ok(vec![(entry, context.value(&line.value))]),
        (Some(Entries::Array { .. }), None) => Err(error(line.name.span(), &Message::ArrayWithoutIndex { name })),
        (Some(Entries::One(_)), Some(_)) => Err(error(line.name.span(), &Message::NotArray { name })),
        (Some(Entries::Array { first, length }), Some(indices)) => {
            array_values(context, line, indices, &|index, span| match usize::try_from(index) {
                Ok(index) if index < length => Ok(first + index),
                _ => {
                    let (name, end) = (name.clone(), i64::try_from(length).unwrap_or(i64::MAX));
                    Err(error(span, &Message::IndexRange { name, index, first: 0, end }))
                }
            })
        }
        (None, _) if context.scope.meaning(&name) == Some(&Meaning::Wrong) => Ok(Vec::new()),
        (None, _) => {
            // Reports errors in the value too.
            context.value(&line.value);
            Err(error(line.name.span(), &other(context, name)))
        }
    };
    context.report(wanted)
}

/// The values of entries of an array; `entry` maps the value of the index and its position to the number of the entry.
fn array_values(
    context: &mut Context,
    line: &Definition,
    indices: &Indices,
    entry: &dyn Fn(i64, Span) -> Result<usize>,
) -> Result<Vec<(usize, Expr)>> {
    let Context { scope, pool, .. } = context;
    match indices {
        Indices::One(index) => {
            let value = scope.expression(pool, &line.value)?;
            Ok(vec![(entry(scope.integer(pool, index)?, index.span)?, value)])
        }
        Indices::Range(range) => scope.each(pool, range, &mut |scope, pool, index| {
            let value = scope.expression(pool, &line.value)?;
            Ok((entry(index, range.to.span)?, value))
        }),
    }
}

/// Adds −∂R/∂v.
fn dissipate(context: &mut Context, written: &[Definition], forces: &mut [Expr], parameters: &[Parameter]) {
    let Some((first, others)) = written.split_first() else { return };
    for other in others {
        context.errors.at(other.name.span(), &Message::SecondDissipation);
    }
    let rayleigh = context.value(&first.value);
    let moves = |symbol: &Symbol| matches!(symbol, Symbol::Continuous(Variable::Velocity(_)));
    if context.errors.is_empty() && !context.pool.depends_on(rayleigh, &moves) {
        context.errors.at(first.name.span(), &Message::NoDissipation);
    }
    let mut losses = Vec::with_capacity(forces.len());
    for (index, force) in forces.iter_mut().enumerate() {
        let loss = dissipation::slope(context.pool, rayleigh, index);
        *force = context.pool.sub(*force, loss);
        losses.push(loss);
    }
    if losses.iter().any(|loss| context.pool.is_undefined(*loss)) && !context.is_too_large() {
        context.errors.at(first.value.span, &Message::NoValue);
    }
    if context.errors.is_empty() {
        dissipation::check(context, &first.value, (rayleigh, &losses), parameters);
    }
}
