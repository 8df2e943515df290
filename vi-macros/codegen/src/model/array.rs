//! Arrays of names: the entries of parameters, constants and `let`s, whose rows may differ in length.
//!
//! In: entries, one by one and in order. Out: an entry, a row, or the whole array as a vector or a matrix.

use super::value::{Tensor, Value};
use crate::messages::{ArrayMistake, Message, bracketed, error};
use core::ops::Range;
use proc_macro2::Span;
use syn::Result;
use vi_expr::Expr;

/// An array.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Array {
    /// The index of its first entry.
    pub(super) first: i64,
    /// Its entries.
    pub(super) entries: Vec<Entry>,
}

/// An entry of an array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Entry {
    Number(Expr),
    Array(Array),
}

/// Indices with their places in the text.
pub(super) type Path<'a> = &'a [(i64, Span)];

impl Entry {
    /// The entry with this value.
    pub(super) fn of(value: &Value) -> Self {
        Self::of_shape(value.shape(), value.entries())
    }

    fn of_shape(shape: &[usize], entries: &[Expr]) -> Self {
        match (shape.split_first(), entries) {
            (None, [only, ..]) => Self::Number(*only),
            (None, []) => Self::Array(Array::default()),
            (Some((_, inner)), entries) => {
                let rows = entries.chunks(inner.iter().product::<usize>().max(1));
                Self::Array(Array { first: 0, entries: rows.map(|row| Self::of_shape(inner, row)).collect() })
            }
        }
    }

    /// Whether a number in it satisfies a condition.
    fn any(&self, condition: &dyn Fn(&Expr) -> bool) -> bool {
        match self {
            Self::Number(value) => condition(value),
            Self::Array(array) => array.any(condition),
        }
    }
}

impl Array {
    /// An array without entries.
    pub(super) fn from(first: i64) -> Self {
        Self { first, entries: Vec::new() }
    }

    /// Whether one of its numbers satisfies a condition.
    pub(super) fn any(&self, condition: &dyn Fn(&Expr) -> bool) -> bool {
        self.entries.iter().any(|entry| entry.any(condition))
    }

    /// Applies an operation to each of its numbers.
    pub(super) fn each(&mut self, make: &mut dyn FnMut(&mut Expr)) {
        for entry in &mut self.entries {
            match entry {
                Entry::Number(value) => make(value),
                Entry::Array(array) => array.each(make),
            }
        }
    }

    /// The index behind its last entry.
    pub(super) fn end(&self) -> i64 {
        self.first.saturating_add(i64::try_from(self.entries.len()).unwrap_or(i64::MAX))
    }

    /// The position of an index among the entries; at their end, for the next one.
    fn position(&self, index: i64) -> Option<usize> {
        let offset = index.checked_sub(self.first).and_then(|offset| usize::try_from(offset).ok());
        offset.filter(|offset| *offset <= self.entries.len())
    }

    /// The entry at these indices; a row or the whole array as a vector or a matrix.
    ///
    /// # Errors
    /// An index out of range, or too many indices, at the index. Rows that are no matrix, at `span`.
    pub(super) fn at(&self, name: &str, path: Path, span: Span) -> Result<Value> {
        let mut text = name.to_owned();
        let mut array = self;
        for (place, (index, at)) in path.iter().enumerate() {
            let entry = array.position(*index).and_then(|position| array.entries.get(position));
            let Some(entry) = entry else {
                let (index, first, end) = (*index, array.first, array.end());
                return Err(error(*at, &Message::IndexRange { name: text, index, first, end }));
            };
            text += &bracketed([index]);
            match (entry, path.get(place + 1)) {
                (Entry::Number(value), None) => return Ok(Value::Number(*value)),
                (Entry::Number(_), Some((_, at))) => return Err(error(*at, &Message::NotArray { name: text })),
                (Entry::Array(inner), _) => array = inner,
            }
        }
        let mistake = |mistake| error(span, &Message::Array(mistake));
        if let Some(first) = array.offset() {
            return Err(mistake(ArrayMistake::First { name: text, first }));
        }
        match array.tensor() {
            Some(tensor) => Ok(Value::Tensor(tensor)),
            None => Err(mistake(ArrayMistake::Ragged { name: text })),
        }
    }

    /// The first index of it, or of a row, that is not 0.
    fn offset(&self) -> Option<i64> {
        let of_row = |entry: &Entry| match entry {
            Entry::Array(inner) => inner.offset(),
            Entry::Number(_) => None,
        };
        if self.first == 0 { self.entries.iter().find_map(of_row) } else { Some(self.first) }
    }

    /// The vector or matrix, if the rows have one length.
    fn tensor(&self) -> Option<Tensor> {
        let mut whole: Option<Tensor> = None;
        for entry in &self.entries {
            let row = match entry {
                Entry::Number(value) => Tensor { shape: Vec::new(), entries: vec![*value] },
                Entry::Array(inner) => inner.tensor()?,
            };
            match &mut whole {
                None => whole = Some(row),
                Some(above) if above.shape == row.shape => above.entries.extend(row.entries),
                Some(_) => return None,
            }
        }
        let Tensor { shape, entries } = whole.unwrap_or(Tensor { shape: Vec::new(), entries: Vec::new() });
        Some(Tensor { shape: [self.entries.len()].into_iter().chain(shape).collect(), entries })
    }

    /// The row at these indices, which is created with this first index if it is the next one.
    ///
    /// # Errors
    /// The row is not the next one, or is a number.
    pub(super) fn open(&mut self, name: &str, path: Path, first: i64) -> Result<()> {
        let Some((parent, index, span)) = self.parent(name, path)? else { return Ok(()) };
        match parent.position(index).map(|position| parent.entries.get(position)) {
            Some(Some(Entry::Array(_))) => Ok(()),
            Some(Some(Entry::Number(_))) => {
                let name = spelled(name, &path[..path.len() - 1]);
                Err(error(span, &Message::Array(ArrayMistake::Entries { name, index })))
            }
            Some(None) => {
                parent.entries.push(Entry::Array(Self::from(first)));
                Ok(())
            }
            None => Err(misplaced(parent, name, path, span)),
        }
    }

    /// Adds the next entry.
    ///
    /// # Errors
    /// The entry is not the next one.
    pub(super) fn define(&mut self, name: &str, path: Path, value: &Value) -> Result<()> {
        let Some((parent, index, span)) = self.parent(name, path)? else { return Ok(()) };
        if index != parent.end() {
            return Err(misplaced(parent, name, path, span));
        }
        parent.entries.push(Entry::of(value));
        Ok(())
    }

    /// The array that holds the entry at these indices, with its last index.
    fn parent(&mut self, name: &str, path: Path) -> Result<Option<(&mut Self, i64, Span)>> {
        let Some(((last, span), rows)) = path.split_last() else { return Ok(None) };
        let mut array = self;
        for (place, (index, at)) in rows.iter().enumerate() {
            let position = array.position(*index).unwrap_or(array.entries.len());
            let Some(Entry::Array(inner)) = array.entries.get_mut(position) else {
                let name = spelled(name, &path[..place]);
                return Err(error(*at, &Message::Array(ArrayMistake::Entries { name, index: *index })));
            };
            array = inner;
        }
        Ok(Some((array, *last, *span)))
    }
}

/// The message for an entry that is defined already, or before others.
fn misplaced(parent: &Array, name: &str, path: Path, span: Span) -> syn::Error {
    let (entry, row) = (spelled(name, path), spelled(name, &path[..path.len().saturating_sub(1)]));
    let is_behind = path.last().is_some_and(|(index, _)| *index > parent.end());
    let mistake = if is_behind {
        ArrayMistake::Gap { entry, missing: format!("{row}[{}]", parent.end()) }
    } else if path.last().is_some_and(|(index, _)| *index < parent.first) {
        ArrayMistake::Gap { entry: format!("{row}[{}]", parent.first), missing: entry }
    } else {
        ArrayMistake::Twice { entry }
    };
    error(span, &Message::Array(mistake))
}

/// A name with its indices.
pub(super) fn spelled(name: &str, path: Path) -> String {
    name.to_owned() + &bracketed(path.iter().map(|(index, _)| index))
}

/// The entries of an array of these lengths at these indices, and the lengths that are left.
///
/// # Errors
/// An index out of range, or too many indices, at the index.
pub(super) fn part<'a>(name: &str, lengths: &'a [usize], path: Path) -> Result<(Range<usize>, &'a [usize])> {
    let (mut start, mut rest) = (0, lengths);
    for (place, (index, span)) in path.iter().enumerate() {
        let name = || spelled(name, &path[..place]);
        let Some((length, inner)) = rest.split_first() else {
            return Err(error(*span, &Message::NotArray { name: name() }));
        };
        let Some(index) = usize::try_from(*index).ok().filter(|index| index < length) else {
            let end = i64::try_from(*length).unwrap_or(i64::MAX);
            return Err(error(*span, &Message::IndexRange { name: name(), index: *index, first: 0, end }));
        };
        start += index * inner.iter().product::<usize>();
        rest = inner;
    }
    Ok((start..start + rest.iter().product::<usize>(), rest))
}
