//! Declared arrays: their lengths and the values of their entries.
//!
//! In: lengths and a value as written: a number for all entries, or a list. Out: one value for each entry, row by row.

use super::context::Context;
use super::value::Value;
use crate::messages::{ArrayMistake, Message, bracketed};
use crate::syntax::{self, Expression, Kind};
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
        let (mut lengths, mut count) = (Vec::new(), 1_usize);
        for written in written {
            let length = self.scope.integer(self.pool, written);
            let given = self.report(length)?;
            let length = usize::try_from(given).unwrap_or(0);
            count = count.saturating_mul(length);
            if !(1..=limit).contains(&count) {
                let given = if given > 0 { i64::try_from(count).unwrap_or(i64::MAX) } else { given };
                self.errors.at(written.span, &message(given));
                return None;
            }
            lengths.push(length);
        }
        Some(lengths)
    }

    /// The numbers of the entries of a parameter with these lengths, as written and as numbers. Reports another shape,
    /// and entries without a number.
    pub(super) fn numbers(&mut self, declared: &syntax::Parameter, lengths: &[usize]) -> Option<Vec<f64>> {
        let syntax::Parameter { name, lengths: written_lengths, default: written, .. } = declared;
        let of = (&written_lengths[..], lengths);
        let count = of.1.iter().product::<usize>();
        let value = match &written.kind {
            // The lengths name what is missing.
            Kind::List(entries) if entries.is_empty() => Value::vector_of(Vec::new()),
            _ => match self.shaped(written) {
                Some(value) => value,
                None => return Some(vec![1.0; count]),
            },
        };
        match value {
            Value::Number(only) | Value::Wrong(only) => {
                Some(vec![self.finite(only, written.span, name).unwrap_or(1.0); count])
            }
            value @ Value::Tensor(_) if value.shape() == of.1 => {
                let entries = value.entries().iter().enumerate();
                entries.map(|(place, entry)| self.finite(*entry, entry_span(written, of.1, place), name)).collect()
            }
            other @ Value::Tensor(_) => {
                if lengths.is_empty() {
                    let (text, clause) = (name.to_string(), declared.clause());
                    let lengths = bracketed(other.shape());
                    self.errors.at(name.span(), &Message::ParameterWithoutLength { name: text, lengths, clause });
                    return None;
                }
                let (span, message) = mismatch(name, of, written, other.shape());
                self.errors.at(span, &message);
                None
            }
        }
    }

    /// The value of a constant with these lengths, as written and as numbers; without lengths, the value as it is.
    /// Reports another shape, and entries without a number.
    pub(super) fn constant_value(
        &mut self,
        name: &Ident,
        of: (&[Expression], &[usize]),
        written: &Expression,
    ) -> Option<Value> {
        let value = self.shaped(written)?;
        let shape = value.shape().to_vec();
        let mut is_right = true;
        for (place, entry) in value.entries().iter().enumerate() {
            // A value below the range of numbers may be multiplied before it is rounded.
            let is_small = self.pool.constant(*entry) == Err(NoConstant::TooSmall);
            is_right &= is_small || self.finite(*entry, entry_span(written, &shape, place), name).is_some();
        }
        if !is_right {
            return None;
        }
        match value {
            Value::Number(only) => {
                let entries: Vec<Expr> = vec![only; of.1.iter().product::<usize>()];
                Some(Value::of_shape(of.1, entries))
            }
            Value::Tensor(tensor) if !of.1.is_empty() && tensor.shape != of.1 => {
                let (span, message) = mismatch(name, of, written, &shape);
                self.errors.at(span, &message);
                None
            }
            value => Some(value),
        }
    }
}

/// The message for a value of another shape than that of its array, with its place.
fn mismatch(
    name: &Ident,
    (written_lengths, lengths): (&[Expression], &[usize]),
    written: &Expression,
    given: &[usize],
) -> (Span, Message) {
    let text = name.to_string();
    let differs = lengths.iter().zip(given).position(|(length, values)| length != values);
    let Some(level) = differs.filter(|_| lengths.len() == given.len() || given == [0]) else {
        let (needs, given) = (lengths.to_vec(), given.to_vec());
        return (written.span, Message::Array(ArrayMistake::ShapeNeeded { needs, given, name: text }));
    };
    let (length, values) = (lengths[level], given[level]);
    // Points at the first surplus value, or at the length if values are missing.
    let surplus = row(written, level).and_then(|row| row.get(length));
    let span = surplus.or(written_lengths.get(level)).map_or(written.span, |value| value.span);
    (span, Message::ParameterValues { name: text + &"[0]".repeat(level), length, values })
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
