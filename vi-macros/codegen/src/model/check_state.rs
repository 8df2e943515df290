//! The state at which a system is checked.
//!
//! In: the clauses `check { x = 1, dot(x) = 0; h = 0.01; }`. Out: one [`CheckState`] of numbers; entries that are not named are
//! zero. The last plain `h` is the step, so that a coordinate may be called h too.

use super::context::Context;
use super::force;
use crate::messages::Message;
use crate::syntax::{self, Definition, Entry};

/// A state and a step, in the units of the system.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckState {
    /// Time.
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Step, positive.
    pub h: f64,
}

/// The state of the first clause; a second clause is a mistake.
pub(super) fn check_state(context: &mut Context, written: &[syntax::Check], dimension: usize) -> Option<CheckState> {
    let (first, others) = written.split_first()?;
    for other in others {
        context.errors.at(other.span, &Message::SecondCheck);
    }
    let is_step = |entry: &Entry| plain(entry) && entry.definition.name == "h";
    let last = first.entries.iter().rposition(is_step);
    let h = last.and_then(|last| first.entries.get(last)).map(|entry| step(context, &entry.definition));
    if h.is_none() {
        context.errors.at(first.span, &Message::MissingStep);
    }
    let mut t = None;
    let mut q = vec![None; dimension];
    let mut v = vec![None; dimension];
    for (index, Entry { velocity, definition }) in first.entries.iter().enumerate() {
        if Some(index) == last {
            continue;
        }
        let twice = if !velocity && definition.indices.is_none() && definition.name == "t" {
            let (_, number) = context.number(&definition.value, &definition.name);
            t.replace(number).is_some()
        } else {
            let numbers = if *velocity { &mut v } else { &mut q };
            fill(context, definition, *velocity, numbers)
        };
        if twice {
            let name = definition.name.to_string();
            context.errors.at(definition.name.span(), &Message::SecondEntry { name });
        }
    }
    let numbers = |entries: Vec<Option<f64>>| entries.into_iter().map(Option::unwrap_or_default).collect();
    Some(CheckState { t: t.unwrap_or_default(), q: numbers(q), v: numbers(v), h: h? })
}

fn plain(entry: &Entry) -> bool {
    !entry.velocity && entry.definition.indices.is_none()
}

/// A positive number.
fn step(context: &mut Context, written: &Definition) -> f64 {
    let (_, h) = context.number(&written.value, &written.name);
    if h <= 0.0 {
        context.errors.at(written.value.span, &Message::StepNotPositive);
    }
    h
}

/// Gives the entries of one line their numbers; whether one of them had a number before.
fn fill(context: &mut Context, written: &Definition, velocity: bool, numbers: &mut [Option<f64>]) -> bool {
    let other = |name: String, near| {
        if velocity { Message::DotOfOther { name } } else { Message::CheckOfOther { name, near } }
    };
    let Some(entries) = force::entries(context, written, &other) else { return false };
    let mut twice = false;
    for (coordinate, value) in entries {
        let number = context.finite(value, written.value.span, &written.name).unwrap_or_default();
        twice |= numbers[coordinate].replace(number).is_some();
    }
    twice
}
