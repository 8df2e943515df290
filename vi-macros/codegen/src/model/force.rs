//! The generalized force: the sum of what the lines `force` say and of what dissipates.
//!
//! In: the lines `force x = …;` and `dissipation = R;`. Out: one expression per coordinate,
//!
//! ```text
//! f_i = (line of x_i) − ∂R/∂v_i        R(t,q,v) is Rayleigh's function
//! ```

use super::context::Context;
use super::scope::Meaning;
use crate::messages::{Message, error};
use crate::symbol::{Symbol, Variable};
use crate::syntax::{Definition, Indices};
use syn::Result;
use vi_expr::Expr;

/// The force on each coordinate; zero where none is declared.
pub(super) fn forces(
    context: &mut Context,
    lines: &[Definition],
    dissipations: &[Definition],
    dimension: usize,
) -> Vec<Expr> {
    let mut forces: Vec<Option<Expr>> = vec![None; dimension];
    for line in lines {
        let Some(entries) = entries(context, line, &|name, near| Message::ForceOnOther { name, near }) else {
            continue;
        };
        for (coordinate, value) in entries {
            if forces[coordinate].replace(value).is_some() {
                context.errors.at(line.name.span(), &Message::SecondForce { name: line.name.to_string() });
                break;
            }
        }
    }
    let zero = context.pool.zero();
    let mut forces: Vec<Expr> = forces.into_iter().map(|force| force.unwrap_or(zero)).collect();
    dissipate(context, dissipations, &mut forces);
    forces
}

/// What a line says that is about no coordinate: its name, and the coordinate nearest to it.
pub(super) type Other<'a> = &'a dyn Fn(String, Option<String>) -> Message;

/// The coordinates that a line is about, with their values.
pub(super) fn entries(context: &mut Context, line: &Definition, other: Other) -> Option<Vec<(usize, Expr)>> {
    let name = line.name.to_string();
    let wanted = match (context.scope.meaning(&name).cloned(), &line.indices) {
        (Some(Meaning::Coordinate(coordinate)), None) => Ok(vec![(coordinate, context.value(&line.value))]),
        (Some(Meaning::Coordinates { .. }), None) => Err(error(line.name.span(), &Message::ArrayWithoutIndex { name })),
        (Some(Meaning::Wrong), _) => Ok(Vec::new()),
        (Some(Meaning::Coordinate(_)), Some(_)) => Err(error(line.name.span(), &Message::NotArray { name })),
        (Some(Meaning::Coordinates { .. }), Some(indices)) => array_entries(context, line, indices),
        _ => {
            // The value may be wrong too.
            context.value(&line.value);
            let near = context.scope.near_coordinate(context.pool, &name);
            Err(error(line.name.span(), &other(name, near)))
        }
    };
    context.report(wanted)
}

fn array_entries(context: &mut Context, line: &Definition, indices: &Indices) -> Result<Vec<(usize, Expr)>> {
    let Context { scope, pool, .. } = context;
    let range = match indices {
        Indices::One(index) => {
            let value = scope.expression(pool, &line.value)?;
            return Ok(scope
                .coordinate_entry(pool, &line.name, index)?
                .map(|entry| (entry, value))
                .into_iter()
                .collect());
        }
        Indices::Range(range) => range,
    };
    let Some(Meaning::Coordinates { first, length }) = scope.meaning(&line.name.to_string()).cloned() else {
        return Ok(Vec::new());
    };
    scope.each(pool, range, &mut |scope, pool, index| {
        let value = scope.expression(pool, &line.value)?;
        if let Some(index) = usize::try_from(index).ok().filter(|index| *index < length) {
            return Ok((first + index, value));
        }
        let (name, end) = (line.name.to_string(), i64::try_from(length).unwrap_or(i64::MAX));
        Err(error(range.to.span, &Message::IndexRange { name, index, first: 0, end }))
    })
}

/// Adds −∂R/∂v.
fn dissipate(context: &mut Context, written: &[Definition], forces: &mut [Expr]) {
    let Some((first, others)) = written.split_first() else { return };
    for other in others {
        context.errors.at(other.name.span(), &Message::SecondDissipation);
    }
    let rayleigh = context.value(&first.value);
    let moves = |symbol: &Symbol| matches!(symbol, Symbol::Continuous(Variable::Velocity(_)));
    if context.errors.is_empty() && !context.pool.depends_on(rayleigh, &moves) {
        context.errors.at(first.name.span(), &Message::NoDissipation);
    }
    for (index, force) in forces.iter_mut().enumerate() {
        let velocity = Symbol::Continuous(Variable::Velocity(index));
        let loss = context.pool.derivative(rayleigh, &mut |pool, symbol| {
            if *symbol == velocity { pool.one() } else { pool.zero() }
        });
        *force = context.pool.sub(*force, loss);
    }
}
