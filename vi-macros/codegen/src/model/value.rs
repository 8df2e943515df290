//! Values of expressions: numbers, vectors and matrices, and their sums and products.
//!
//! In: expressions of the pool with their shapes. Out: one expression for each entry. No later stage sees a shape.

use crate::limits::bounded;
use crate::messages::{ArrayMistake, Habit, Message, bracketed, error};
use crate::symbol::Symbol;
use crate::syntax::{Expression, Kind};
use proc_macro2::Span;
use syn::Result;
use vi_expr::{Expr, Function, Pool, Rational};

/// The value of an expression.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Number(Expr),
    /// A vector or a matrix.
    Tensor(Tensor),
    /// The value 1 of a name whose declaration has a reported error: it fits every shape.
    Wrong(Expr),
}

/// A vector or a matrix.
#[derive(Clone, Debug)]
pub(super) struct Tensor {
    /// The lengths: one of a vector; rows and columns of a matrix.
    pub(super) shape: Vec<usize>,
    /// The entries, row by row.
    pub(super) entries: Vec<Expr>,
}

impl Value {
    /// The vector of these entries.
    pub(super) fn vector_of(entries: Vec<Expr>) -> Self {
        Self::Tensor(Tensor { shape: vec![entries.len()], entries })
    }

    /// The number, or the vector or matrix of these lengths.
    pub(super) fn of_shape(shape: &[usize], entries: Vec<Expr>) -> Self {
        match (shape, &entries[..]) {
            ([], [only]) => Self::Number(*only),
            _ => Self::Tensor(Tensor { shape: shape.to_vec(), entries }),
        }
    }

    /// The lengths; none of a number.
    pub(super) fn shape(&self) -> &[usize] {
        match self {
            Self::Number(_) | Self::Wrong(_) => &[],
            Self::Tensor(tensor) => &tensor.shape,
        }
    }

    /// The entries, row by row.
    pub(super) fn entries(&self) -> &[Expr] {
        match self {
            Self::Number(value) | Self::Wrong(value) => core::slice::from_ref(value),
            Self::Tensor(tensor) => &tensor.entries,
        }
    }

    /// The number.
    ///
    /// # Errors
    /// A vector or a matrix: a message at this place.
    pub(super) fn number(self, span: Span) -> Result<Expr> {
        match self {
            Self::Number(value) | Self::Wrong(value) => Ok(value),
            Self::Tensor(Tensor { shape, .. }) => {
                Err(error(span, &Message::Array(ArrayMistake::NumberNeeded { given: shape, name: None })))
            }
        }
    }

    /// The vector.
    ///
    /// # Errors
    /// A number or a matrix: a message at this place.
    pub(super) fn vector(self, span: Span) -> Result<Vec<Expr>> {
        match self {
            Self::Tensor(Tensor { shape, entries }) if shape.len() == 1 => Ok(entries),
            _ => Err(error(span, &Message::Shape { needs: "vector" })),
        }
    }

    /// The entries of a value with this shape. An exact zero is the zero of every shape.
    pub(super) fn fitting(self, pool: &Pool<Symbol>, shape: &[usize]) -> core::result::Result<Vec<Expr>, Self> {
        match self {
            Self::Number(value) if shape.is_empty() || pool.is_zero(value) => {
                Ok(vec![value; shape.iter().product::<usize>()])
            }
            Self::Wrong(value) => Ok(vec![value; shape.iter().product::<usize>()]),
            Self::Tensor(tensor) if tensor.shape == shape => Ok(tensor.entries),
            other => Err(other),
        }
    }

    /// An operation on each entry.
    pub(super) fn map(self, mut make: impl FnMut(Expr) -> Expr) -> Self {
        match self {
            Self::Number(value) => Self::Number(make(value)),
            Self::Tensor(Tensor { shape, entries }) => {
                Self::Tensor(Tensor { shape, entries: entries.into_iter().map(make).collect() })
            }
            Self::Wrong(value) => Self::Wrong(value),
        }
    }

    /// The first of these values that is wrong.
    fn wrong<'a>(values: impl IntoIterator<Item = &'a Self>) -> Option<Self> {
        values.into_iter().find(|value| matches!(value, Self::Wrong(_))).cloned()
    }

    /// The sum of values of one shape, each with its place. An exact zero, such as a sum over an empty range, is the
    /// zero of every shape.
    ///
    /// # Errors
    /// Two shapes: a message at the second one.
    pub(super) fn sum(pool: &mut Pool<Symbol>, terms: Vec<(Self, Span)>) -> Result<Self> {
        if let Some(wrong) = Self::wrong(terms.iter().map(|(term, _)| term)) {
            return Ok(wrong);
        }
        if terms.iter().all(|(term, _)| matches!(term, Self::Number(_))) {
            let numbers: Vec<Expr> = terms.iter().flat_map(|(term, _)| term.entries()).copied().collect();
            return Ok(Self::Number(pool.sum(&numbers)));
        }
        let is_zero = |term: &Self| matches!(term, Self::Number(value) if pool.is_zero(*value));
        let terms: Vec<(Self, Span)> = terms.into_iter().filter(|(term, _)| !is_zero(term)).collect();
        let shape = terms.first().map(|(term, _)| term.shape().to_vec()).unwrap_or_default();
        if let Some((other, span)) = terms.iter().find(|(term, _)| term.shape() != shape) {
            let right = other.shape().to_vec();
            return Err(error(*span, &Message::Array(ArrayMistake::Added { left: shape, right })));
        }
        let length = shape.iter().product::<usize>();
        pool.spend(length * terms.len());
        let entry = |index: usize| terms.iter().filter_map(|(term, _)| term.entries().get(index)).copied().collect();
        let entries = (0..length).map(|index| pool.sum(&Vec::from_iter::<Vec<Expr>>(entry(index)))).collect();
        Ok(Self::of_shape(&shape, entries))
    }

    /// The product of factors, from left to right: of two vectors the inner product, of matrices and vectors the sum
    /// over the neighbouring index.
    ///
    /// # Errors
    /// Lengths that differ: a message at the right factor. Too much work.
    pub(super) fn product(pool: &mut Pool<Symbol>, factors: Vec<(Self, Span)>) -> Result<Self> {
        if let Some(wrong) = Self::wrong(factors.iter().map(|(factor, _)| factor)) {
            return Ok(wrong);
        }
        // Numbers scale the result once, not each entry on the way.
        let (mut numbers, mut product) = (Vec::new(), None);
        for (factor, span) in factors {
            product = match (factor, product) {
                (Self::Tensor(right), Some(left)) => match contraction(pool, &left, &right, span)? {
                    Self::Tensor(tensor) => Some(tensor),
                    number => {
                        numbers.extend(number.entries());
                        None
                    }
                },
                (Self::Tensor(first), None) => Some(first),
                (number, product) => {
                    numbers.extend(number.entries());
                    product
                }
            };
        }
        let Some(tensor) = product else { return Ok(Self::Number(pool.product(&numbers))) };
        if numbers.is_empty() {
            return Ok(Self::Tensor(tensor));
        }
        pool.spend(tensor.entries.len());
        let scale = pool.product(&numbers);
        Ok(Self::Tensor(tensor).map(|entry| pool.mul(entry, scale)))
    }
}

/// The sum over the last index on the left and the first one on the right.
fn contraction(pool: &mut Pool<Symbol>, left: &Tensor, right: &Tensor, span: Span) -> Result<Value> {
    let (Some((inner, rows)), Some((length, columns))) = (left.shape.split_last(), right.shape.split_first()) else {
        return Ok(Value::Number(pool.zero()));
    };
    if inner != length {
        let (left, right) = (left.shape.clone(), right.shape.clone());
        return Err(error(span, &Message::Array(ArrayMistake::Multiplied { left, right })));
    }
    let shape: Vec<usize> = rows.iter().chain(columns).copied().collect();
    let (height, width) = (rows.iter().product::<usize>(), columns.iter().product::<usize>());
    pool.spend(height.saturating_mul(width).saturating_mul(*inner));
    bounded(pool).map_err(|found| error(span, &Message::TooLarge { size: found }))?;
    let mut entries = Vec::with_capacity(height * width);
    for start in (0..height).map(|row| row * inner) {
        let row = left.entries.get(start..start + inner).unwrap_or_default();
        for column in 0..width {
            let pairs = row.iter().zip(right.entries.iter().skip(column).step_by(width));
            let products: Vec<Expr> = pairs.map(|(a, b)| pool.mul(*a, *b)).collect();
            entries.push(pool.sum(&products));
        }
    }
    Ok(Value::of_shape(&shape, entries))
}

/// An index as it is written; `…` for one that is computed.
pub(super) fn index_text(index: &Expression) -> String {
    match &index.kind {
        Kind::Number(number) => number.to_string(),
        Kind::Name(name) => name.to_string(),
        _ => "…".to_owned(),
    }
}

/// A name, or an entry of an array, as it is written; `None` for other expressions.
pub(super) fn spelled(written: &Expression) -> Option<String> {
    match &written.kind {
        Kind::Name(name) => Some(name.to_string()),
        Kind::Entry(name, indices) => Some(name.to_string() + &bracketed(indices.iter().map(index_text))),
        _ => None,
    }
}

/// The message for a vector or a matrix of this shape where a number is needed.
pub(super) fn not_a_number(written: &Expression, shape: &[usize]) -> syn::Error {
    if let Some(span) = brackets(written) {
        return error(span, &Message::Habit(Habit::OtherBrackets));
    }
    let mistake = ArrayMistake::NumberNeeded { given: shape.to_vec(), name: spelled(written) };
    error(written.span, &Message::Array(mistake))
}

/// The place of brackets that stand for parentheses: a list of one number among the operands.
pub(super) fn brackets(written: &Expression) -> Option<Span> {
    match &written.kind {
        Kind::List(entries) if matches!(&entries[..], [only] if !matches!(only.kind, Kind::List(_))) => {
            Some(written.span)
        }
        Kind::Chain(first, rest) => {
            [&**first].into_iter().chain(rest.iter().map(|(_, operand)| operand)).find_map(brackets)
        }
        Kind::Negative(operand) | Kind::Power(operand, _) => brackets(operand),
        _ => None,
    }
}

/// `base^exponent`. A root that starts at a point gets a form of its base that is exactly zero before that point.
pub(super) fn power(pool: &mut Pool<Symbol>, base: Expr, exponent: Expr) -> Expr {
    let is_root = !pool.as_number(exponent).is_some_and(Rational::is_integer);
    let base = if is_root { pool.with_ramps(base) } else { base };
    pool.call(Function::Pow, &[base, exponent])
}
