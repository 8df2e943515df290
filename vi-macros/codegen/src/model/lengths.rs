//! Declared arrays: their lengths and the values of their entries.
//!
//! In: lengths and a value as written: a number for all entries, or a list. Out: one constant for each entry, row by row.

use super::context::Context;
use super::value::Value;
use crate::arrays::ArrayMistake;
use crate::messages::Message;
use crate::syntax::{Expression, Kind};
use proc_macro2::{Ident, Span};
use vi_expr::{Expr, NoConstant};

impl Context<'_> {
    /// The lengths of an array of at most `limit` entries; reports a wrong length.
    pub(super) fn lengths<'e>(
        &mut self,
        written: impl IntoIterator<Item = &'e Expression>,
        limit: usize,
        message: impl Fn(i64) -> Message,
    ) -> Option<Vec<usize>> {
        let (mut lengths, mut count) = (Vec::new(), 1_i64);
        for written in written {
            let length = self.scope.integer(self.pool, written);
            let length = self.report(length)?;
            let given = length.saturating_mul(count);
            match usize::try_from(length)
                .ok()
                .filter(|_| usize::try_from(given).is_ok_and(|given| (1..=limit).contains(&given)))
            {
                Some(length) => lengths.push(length),
                None => {
                    self.errors.at(written.span, &message(given));
                    return None;
                }
            }
            count = given;
        }
        Some(lengths)
    }

    /// The constants of an array of these lengths, each with its number: one for all entries, or a list of them.
    /// Reports another shape, and entries without a number.
    pub(super) fn constants_of(
        &mut self,
        name: &Ident,
        (lengths, spans): (&[usize], &[Span]),
        written: &Expression,
    ) -> Option<Vec<(Expr, f64)>> {
        let count = lengths.iter().product::<usize>();
        let value = match written {
            // Its lengths are compared first.
            Expression { kind: Kind::List(entries), .. } if entries.is_empty() => None,
            written => Some(self.shaped(written)),
        };
        let value = match value {
            None => Value::vector_of(Vec::new()),
            Some(None) => return Some(vec![(self.pool.one(), 1.0); count]),
            Some(Some(value)) => value,
        };
        if let Value::Number(only) | Value::Wrong(only) = value {
            let number = self.constant(only, written.span, name).unwrap_or((self.pool.one(), 1.0));
            return Some(vec![number; count]);
        }
        if value.shape() != lengths {
            let (span, message) = mismatch(name, (lengths, spans), written, value.shape());
            self.errors.at(span, &message);
            return None;
        }
        let entries = value.entries().iter().enumerate();
        let numbers = entries.map(|(place, entry)| self.constant(*entry, entry_span(written, lengths, place), name));
        numbers.collect()
    }

    /// A constant with its number; a constant below the range of numbers may be multiplied before it is rounded.
    pub(super) fn constant(&mut self, value: Expr, span: Span, name: &Ident) -> Option<(Expr, f64)> {
        self.finite(value, span, name).map(|number| (value, number))
    }

    /// The value of a constant: reports entries that are not finite.
    pub(super) fn constant_value(&mut self, name: &Ident, written: &Expression, value: Value) -> Option<Value> {
        let shape = value.shape().to_vec();
        let mut is_right = true;
        for (place, entry) in value.entries().iter().enumerate() {
            // A value below the range of numbers may be multiplied before it is rounded.
            let is_small = self.pool.constant(*entry) == Err(NoConstant::TooSmall);
            is_right &= is_small || self.finite(*entry, entry_span(written, &shape, place), name).is_some();
        }
        is_right.then_some(value)
    }
}

/// The message for a value of another shape than that of its array, with its place.
pub(super) fn mismatch(
    name: &Ident,
    (lengths, spans): (&[usize], &[Span]),
    written: &Expression,
    given: &[usize],
) -> (Span, Message) {
    let text = name.to_string();
    let Some(first) = given.first().filter(|_| !lengths.is_empty()) else {
        let lengths = given.iter().map(|length| format!("[{length}]")).collect();
        return (name.span(), Message::ParameterWithoutLength { name: text, lengths });
    };
    let differs = lengths.iter().zip(given).position(|(length, values)| length != values);
    match differs.filter(|level| lengths.len() == given.len() || *level == 0 && *first == 0) {
        Some(level) => {
            let (length, values) = (lengths[level], given[level]);
            let name = text + &"[0]".repeat(level);
            // Points at the first surplus value, or at the length if values are missing.
            let surplus = row(written, level).and_then(|row| row.get(length)).map(|value| value.span);
            let span = surplus.or(spans.get(level).copied()).unwrap_or(written.span);
            (span, Message::ParameterValues { name, length, values })
        }
        None => {
            let (needs, given) = (lengths.to_vec(), given.to_vec());
            (written.span, Message::Array(ArrayMistake::ShapeNeeded { needs, given, name: text }))
        }
    }
}

/// The first list at this depth.
fn row(written: &Expression, level: usize) -> Option<&[Expression]> {
    let Kind::List(entries) = &written.kind else { return None };
    if level == 0 { Some(entries) } else { row(entries.first()?, level - 1) }
}

/// The place of an entry in a list of these lengths.
fn entry_span(written: &Expression, lengths: &[usize], place: usize) -> Span {
    let (Kind::List(entries), Some((_, inner))) = (&written.kind, lengths.split_first()) else { return written.span };
    let size = inner.iter().product::<usize>().max(1);
    entries.get(place / size).map_or(written.span, |row| entry_span(row, inner, place % size))
}
