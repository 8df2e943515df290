//! Where a system is checked.
//!
//! In: the clauses `check { x = 1, dot(x) = 0; h = 0.01; }`. Out: one [`Place`] of numbers; entries that are not named are
//! zero. The last plain `h` is the step, so that a coordinate may be called h too.

use super::check::Check;
use super::force;
use crate::messages::Message;
use crate::syntax::{self, Definition, Entry};

/// A state and a step, in the units of the system.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Time.
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Step, positive.
    pub h: f64,
}

/// The place of the first clause; a second clause is a mistake.
pub(super) fn place(check: &mut Check, written: &[syntax::Check], dimension: usize) -> Option<Place> {
    let (first, others) = written.split_first()?;
    for other in others {
        check.errors.at(other.span, &Message::SecondCheck);
    }
    let is_step = |entry: &Entry| plain(entry) && entry.definition.name == "h";
    let last = first.entries.iter().rposition(is_step);
    let h = last.and_then(|last| first.entries.get(last)).map(|entry| step(check, &entry.definition));
    if h.is_none() {
        check.errors.at(first.span, &Message::MissingStep);
    }
    let (mut t, mut q, mut v) = (None, vec![None; dimension], vec![None; dimension]);
    for (index, Entry { velocity, definition }) in first.entries.iter().enumerate() {
        if Some(index) == last {
            continue;
        }
        let twice = if !velocity && definition.indices.is_none() && definition.name == "t" {
            let (_, number) = check.number(definition);
            t.replace(number).is_some()
        } else {
            let known = if *velocity { &mut v } else { &mut q };
            fill(check, definition, *velocity, known)
        };
        if twice {
            let name = definition.name.to_string();
            check.errors.at(definition.name.span(), &Message::SecondEntry { name });
        }
    }
    let numbers = |entries: Vec<Option<f64>>| entries.into_iter().map(Option::unwrap_or_default).collect();
    Some(Place { t: t.unwrap_or_default(), q: numbers(q), v: numbers(v), h: h? })
}

fn plain(entry: &Entry) -> bool {
    !entry.velocity && entry.definition.indices.is_none()
}

/// A positive number.
fn step(check: &mut Check, written: &Definition) -> f64 {
    let (_, h) = check.number(written);
    if h <= 0.0 {
        check.errors.at(written.value.span, &Message::StepNotPositive);
    }
    h
}

/// Gives the entries of one line their numbers; whether one of them had a number before.
fn fill(check: &mut Check, written: &Definition, velocity: bool, known: &mut [Option<f64>]) -> bool {
    let other = |name: String, near| {
        if velocity { Message::DotOfOther { name } } else { Message::CheckOfOther { name, near } }
    };
    let Some(entries) = force::entries(check, written, &other) else { return false };
    let mut twice = false;
    for (coordinate, value) in entries {
        let number = check.finite(value, written.value.span, &written.name).unwrap_or_default();
        twice |= known[coordinate].replace(number).is_some();
    }
    twice
}
