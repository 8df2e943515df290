//! The state of the checks.
//!
//! In: the clauses `check { x = 1, dot(x) = 0, k = 2; h = 0.01; }`. Out: one numeric [`CheckState`]. Unnamed
//! coordinates and velocities are zero, unnamed rotations the identity; unnamed parameters have their defaults, unnamed inputs are 1, so that the checks
//! see them. The last plain `h` is the step, so a coordinate or a parameter may also be called h.

use super::context::Context;
use super::force::{self, Entries};
use super::{Coordinate, Parameter, rotation};
use crate::messages::Message;
use crate::syntax::{self, CheckEntry, Definition};

/// A state and a step, in the units of the system.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckState {
    /// Time.
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Parameters with values other than the default, in ascending order of their indices.
    pub parameters: Vec<(usize, f64)>,
    /// Step, positive.
    pub h: f64,
}

/// Entries of a check, each at most once.
struct Given {
    q: Vec<Option<f64>>,
    v: Vec<Option<f64>>,
    parameters: Vec<Option<f64>>,
}

/// The state of the first clause; reports a second clause.
pub(super) fn check_state(
    context: &mut Context,
    written: &[syntax::Check],
    parameters: &[Parameter],
    coordinates: &[Coordinate],
) -> Option<CheckState> {
    let (first, others) = written.split_first()?;
    for other in others {
        context.errors.at(other.span, &Message::SecondCheck);
    }
    let is_step = |entry: &CheckEntry| plain(entry) && entry.definition.name == "h";
    let last = first.entries.iter().rposition(is_step);
    let h = last.and_then(|last| first.entries.get(last)).map(|entry| step(context, &entry.definition));
    if h.is_none() {
        context.errors.at(first.span, &Message::MissingStep);
    }
    let dimension = coordinates.len();
    let mut t = None;
    let [q, v] = [vec![None; dimension], vec![None; dimension]];
    let mut given = Given { q, v, parameters: vec![None; parameters.len()] };
    for (index, entry) in first.entries.iter().enumerate() {
        if Some(index) == last {
            continue;
        }
        let definition = &entry.definition;
        let twice = if plain(entry) && definition.name == "t" {
            let (_, number) = context.number(&definition.value, &definition.name);
            t.replace(number).is_some()
        } else {
            fill(context, entry, parameters, &mut given)
        };
        if twice {
            let name = definition.name.to_string();
            context.errors.at(definition.name.span(), &Message::SecondEntry { name });
        }
    }
    for (first, _) in rotation::rotations(coordinates) {
        let components = &mut given.q[first..first + rotation::COMPONENTS];
        if components.iter().all(Option::is_none) {
            components[0] = Some(1.0);
        }
    }
    let numbers = |entries: Vec<Option<f64>>| entries.into_iter().map(Option::unwrap_or_default).collect();
    let or_one = |(value, parameter): (Option<f64>, &Parameter)| value.or(parameter.is_input.then_some(1.0));
    let of_parameters = given.parameters.into_iter().zip(parameters).map(or_one);
    let of_parameters = of_parameters.enumerate().filter_map(|(index, value)| Some((index, value?))).collect();
    Some(CheckState {
        t: t.unwrap_or_default(),
        q: numbers(given.q),
        v: numbers(given.v),
        parameters: of_parameters,
        h: h?,
    })
}

fn plain(entry: &CheckEntry) -> bool {
    !entry.velocity && entry.definition.indices.is_empty()
}

/// The step; reports a value that is not positive.
fn step(context: &mut Context, written: &Definition) -> f64 {
    let (_, h) = context.number(&written.value, &written.name);
    if h <= 0.0 {
        context.errors.at(written.value.span, &Message::StepNotPositive);
    }
    h
}

/// Sets the entries of one line; returns whether one of them was set before.
fn fill(
    context: &mut Context,
    CheckEntry { velocity, definition }: &CheckEntry,
    of: &[Parameter],
    given: &mut Given,
) -> bool {
    let is_parameter = |known: &str| of.iter().any(|parameter| parameter.name == known);
    let other = |Context { scope, pool, .. }: &Context, name: String| {
        if *velocity {
            return Message::DotOfOther { name };
        }
        let near = scope.near_of(pool, &name, |known| scope.is_coordinate(known) || is_parameter(known));
        Message::CheckOfOther { name, near }
    };
    let name = definition.name.to_string();
    let coordinates = Entries::of_coordinate(context, &name);
    let is_coordinate = coordinates.is_some();
    let entries = coordinates.or_else(|| of_parameter(of, &name).filter(|_| !velocity));
    let numbers = match entries {
        Some(_) if !is_coordinate => &mut given.parameters,
        Some(_) if *velocity => &mut given.v,
        _ => &mut given.q,
    };
    let Some(values) = force::values(context, definition, entries, &other) else { return false };
    let mut twice = false;
    for (entry, value) in values {
        let number = context.finite(value, definition.value.span, &definition.name).unwrap_or_default();
        twice |= numbers[entry].replace(number).is_some();
    }
    twice
}

/// The parameters with this name.
fn of_parameter(parameters: &[Parameter], name: &str) -> Option<Entries> {
    let first = parameters.iter().position(|parameter| parameter.name == name)?;
    let last = parameters.iter().rfind(|parameter| parameter.name == name)?;
    Some(Entries { first, lengths: last.indices.iter().map(|index| index + 1).collect() })
}
