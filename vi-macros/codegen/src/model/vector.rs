//! Names, entries and functions of vectors and matrices.
//!
//! In: an array by its name, with some of its indices; or a function with its arguments. Out: a [`Value`].

use super::array::{Array, Path, part};
use super::scope::{Growing, Meaning, OF_VECTORS, Scope};
use super::value::{Tensor, Value, power};
use crate::messages::{Absence, ArrayMistake, Errors, Message, error};
use crate::symbol::{Symbol, Variable};
use crate::syntax::Expression;
use core::cmp::Ordering;
use core::ops::Range;
use proc_macro2::{Ident, Span};
use syn::Result;
use vi_expr::{Expr, Pool, Rational};

/// A written index with its value.
fn placed(values: &[i64], written: &[Expression]) -> Vec<(i64, Span)> {
    values.iter().zip(written).map(|(value, written)| (*value, written.span)).collect()
}

impl Scope {
    /// An array by its name: a vector or a matrix.
    ///
    /// # Errors
    /// It is no vector or matrix, or its entries are being defined.
    pub(super) fn whole(&self, pool: &mut Pool<Symbol>, name: &Ident) -> Result<Value> {
        self.at(pool, name, &[])
    }

    /// An entry of an array, or a row of it.
    ///
    /// # Errors
    /// An index that is not an integer or is out of range, an unknown name, a name that is not an array.
    pub(super) fn entry(&mut self, pool: &mut Pool<Symbol>, name: &Ident, indices: &[Expression]) -> Result<Value> {
        let text = name.to_string();
        if self.meaning(&text).is_none() {
            let mut errors = Errors::default();
            errors.at(name.span(), &self.unknown(pool, text));
            errors.keep(self.each_of(pool, indices, Self::integer));
            return errors.finish(Value::Wrong(pool.one()));
        }
        let values = self.each_of(pool, indices, Self::integer)?;
        self.at(pool, name, &placed(&values, indices))
    }

    /// The entry or row at these indices.
    fn at(&self, pool: &mut Pool<Symbol>, name: &Ident, path: Path) -> Result<Value> {
        let text = name.to_string();
        if let Some((range, rest)) = self.coordinates_at(name, path)? {
            pool.spend(range.len());
            let symbols = range.map(|index| pool.symbol(Symbol::Continuous(Variable::Coordinate(index))));
            return Ok(Value::of_shape(rest, symbols.collect()));
        }
        let value = match self.meaning(&text) {
            Some(Meaning::Array(array)) => {
                if let Some(growing) = self.growing(&text) {
                    is_defined(array, growing, path, name.span())?;
                }
                array.at(&text, path, name.span())?
            }
            Some(Meaning::Vector(symbols)) => {
                let lengths = [symbols.len()];
                let (range, rest) = part(&text, &lengths, path)?;
                let symbols = symbols.get(range).unwrap_or_default().iter();
                Value::of_shape(rest, symbols.map(|symbol| pool.symbol(symbol.clone())).collect())
            }
            Some(Meaning::Wrong) => Value::Wrong(pool.one()),
            _ => return Err(error(name.span(), &self.no_array(pool, text))),
        };
        pool.spend(value.entries().len());
        Ok(value)
    }

    /// The coordinates at these indices and the lengths that are left, if the name is an array of coordinates.
    fn coordinates_at(&self, name: &Ident, path: Path) -> Result<Option<(Range<usize>, &[usize])>> {
        let text = name.to_string();
        let Some(Meaning::Coordinates { first, lengths }) = self.meaning(&text) else { return Ok(None) };
        let (range, rest) = part(&text, lengths, path)?;
        Ok(Some((first + range.start..first + range.end, rest)))
    }

    /// The velocities of an array of coordinates, of a row or an entry of it; `None` for other names.
    ///
    /// # Errors
    /// An index that is not an integer, or is out of range.
    pub(super) fn velocities(
        &mut self,
        pool: &mut Pool<Symbol>,
        name: &Ident,
        indices: &[Expression],
    ) -> Result<Option<Value>> {
        if !matches!(self.meaning(&name.to_string()), Some(Meaning::Coordinates { .. })) {
            return Ok(None);
        }
        let values = self.each_of(pool, indices, Self::integer)?;
        let Some((range, rest)) = self.coordinates_at(name, &placed(&values, indices))? else { return Ok(None) };
        pool.spend(range.len());
        let symbols = range.map(|index| pool.symbol(Symbol::Continuous(Variable::Velocity(index))));
        Ok(Some(Value::of_shape(rest, symbols.collect())))
    }

    /// A function of vectors or matrices; `None` for other names.
    ///
    /// # Errors
    /// A wrong number of arguments, or arguments of other shapes.
    pub(super) fn of_vectors(
        &mut self,
        pool: &mut Pool<Symbol>,
        function: &Ident,
        arguments: &[Expression],
    ) -> Result<Option<Value>> {
        let Some(name) = OF_VECTORS.into_iter().find(|name| function == name) else { return Ok(None) };
        let takes = if name == "cross" { 2 } else { 1 };
        let values = self.arguments(pool, function, takes, arguments)?;
        if let Some(wrong) = values.iter().find(|value| matches!(value, Value::Wrong(_))) {
            return Ok(Some(wrong.clone()));
        }
        let made = match (name, &values[..]) {
            ("cross", [Value::Tensor(a), Value::Tensor(b)]) => cross(pool, a, b),
            ("norm", [Value::Tensor(a)]) if a.shape.len() == 1 => Some(norm(pool, &a.entries)),
            ("transpose", [Value::Tensor(a)]) => transpose(a),
            _ => None,
        };
        let given = || values.iter().map(|value| value.shape().to_vec()).collect();
        let mistake = || Message::Array(ArrayMistake::OfVectors { function: name, given: given() });
        made.map(Some).ok_or_else(|| error(function.span(), &mistake()))
    }
}

/// Checks that an entry of the array that is being defined comes before the one that is being defined.
fn is_defined(array: &Array, growing: &Growing, path: Path, span: Span) -> Result<()> {
    let name = &growing.name;
    let (Some((index, at)), length) = (path.first(), path.len().min(growing.at.len())) else {
        return Err(error(span, &Message::Absent { name: name.clone(), absence: Absence::Below }));
    };
    let indices: Vec<i64> = path.iter().take(length).map(|(index, _)| *index).collect();
    let differs = indices.iter().zip(&growing.at).position(|(index, of_entry)| index != of_entry);
    let at = path.get(differs.unwrap_or(length.saturating_sub(1))).map_or(*at, |(_, at)| *at);
    let mistake = match indices[..].cmp(growing.at.get(..length).unwrap_or_default()) {
        Ordering::Less if array.entries.is_empty() => ArrayMistake::Before { name: name.clone(), index: *index },
        Ordering::Less => return Ok(()),
        order => {
            let entry = growing.entry.clone();
            let before = entry.strip_suffix(']').map_or_else(|| entry.clone(), |entry| format!("{entry} - 1]"));
            ArrayMistake::Behind { entry, before, itself: order == Ordering::Equal }
        }
    };
    Err(error(at, &Message::Array(mistake)))
}

/// a × b; of two vectors of 2 its third component.
fn cross(pool: &mut Pool<Symbol>, a: &Tensor, b: &Tensor) -> Option<Value> {
    let mut minor = |a: [Expr; 2], b: [Expr; 2]| {
        let (left, right) = (pool.mul(a[0], b[1]), pool.mul(a[1], b[0]));
        pool.sub(left, right)
    };
    match (&a.entries[..], &b.entries[..]) {
        _ if a.shape.len() != 1 || b.shape.len() != 1 => None,
        (&[a0, a1], &[b0, b1]) => Some(Value::Number(minor([a0, a1], [b0, b1]))),
        (&[a0, a1, a2], &[b0, b1, b2]) => Some(Value::vector_of(vec![
            minor([a1, a2], [b1, b2]),
            minor([a2, a0], [b2, b0]),
            minor([a0, a1], [b0, b1]),
        ])),
        _ => None,
    }
}

/// √(a · a).
fn norm(pool: &mut Pool<Symbol>, entries: &[Expr]) -> Value {
    let squares: Vec<Expr> = entries.iter().map(|entry| pool.mul(*entry, *entry)).collect();
    let (square, half) = (pool.sum(&squares), pool.number(Rational::new(1.into(), 2.into())));
    Value::Number(power(pool, square, half))
}

/// The matrix with rows and columns exchanged.
fn transpose(matrix: &Tensor) -> Option<Value> {
    let [rows, columns] = matrix.shape[..] else { return None };
    let column = |column: usize| matrix.entries.iter().skip(column).step_by(columns.max(1)).take(rows).copied();
    Some(Value::of_shape(&[columns, rows], (0..columns).flat_map(column).collect()))
}
