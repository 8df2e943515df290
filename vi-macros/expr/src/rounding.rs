//! Values in floating point with error estimates.
//!
//! In: expressions and the exact values of the symbols. Out: their values, each with an upper estimate of its error.
//! The error of a sum is `Σ |c| error(u)`; products and functions propagate the errors of their operands; each
//! operation adds one rounding. So a value that is zero up to rounding differs from a small one. A value that no `f64`
//! represents with all its digits is [`Rounded::LOST`].

use std::hash::Hash;

use num_traits::{Signed, Zero};

use crate::effort::EVALUATED;
use crate::evaluate::raise;
use crate::number::nearest;
use crate::{Expr, Function, Node, Pool, Rational, Table};

/// A value and its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded {
    /// The value in floating point.
    pub value: f64,
    /// Estimated distance from the exact value.
    pub error: f64,
}

impl Rounded {
    /// An unknown value: undefined, or out of the range of `f64`.
    pub const LOST: Self = Self { value: f64::NAN, error: f64::NAN };

    /// The rounded result of an operation, given the propagated error.
    fn new(value: f64, error: f64) -> Self {
        let error = error + f64::EPSILON * value.abs();
        if value.is_subnormal() || !error.is_finite() { Self::LOST } else { Self { value, error } }
    }

    fn number(number: &Rational) -> Self {
        let value = nearest(number);
        if value == 0.0 && !number.is_zero() { Self::LOST } else { Self::new(value, 0.0) }
    }

    /// Applies a function that is monotone on both sides of 0; `nonzero` if it has no zero.
    fn map(self, nonzero: bool, function: impl Fn(f64) -> f64) -> Self {
        let value = function(self.value);
        let moved = |end: f64| (function(end) - value).abs();
        let error = moved(self.value - self.error).max(moved(self.value + self.error));
        if nonzero && value == 0.0 { Self::LOST } else { Self::new(value, error) }
    }

    fn call(self, function: Function) -> Self {
        let of = |x: f64| function.value(x, 0.0);
        match function {
            Function::Sin | Function::Cos => Self::new(of(self.value), self.error.min(2.0)),
            Function::Tan if self.error > 1.0 => Self::LOST,
            _ => self.map(function == Function::Exp, of),
        }
    }

    fn power(self, exponent: &Rational) -> Self {
        let has_pole = exponent.is_negative() && self.value.abs() <= self.error;
        if has_pole { Self::LOST } else { self.map(self.value != 0.0, |base| raise(base, exponent)) }
    }

    fn sum(parts: impl Iterator<Item = Self>) -> Self {
        let (mut value, mut magnitude, mut error) = (0.0, 0.0_f64, 0.0);
        for part in parts {
            value += part.value;
            magnitude = magnitude.max(value.abs());
            error += part.error + f64::EPSILON * magnitude;
        }
        Self::new(value, error)
    }

    fn product(factors: impl Iterator<Item = Self>) -> Self {
        let (mut value, mut error, mut nonzero) = (1.0, 0.0, true);
        for factor in factors {
            error = error * (factor.value.abs() + factor.error) + f64::abs(value) * factor.error;
            nonzero &= factor.value != 0.0;
            value *= factor.value;
            error += f64::EPSILON * f64::abs(value);
        }
        if nonzero && value == 0.0 { Self::LOST } else { Self::new(value, error) }
    }
}

impl<S: Clone + Eq + Hash> Pool<S> {
    /// Values of several expressions with their errors, in order; the closure is called once per symbol.
    #[must_use]
    pub fn evaluate_rounded(&self, exprs: &[Expr], values: &mut dyn FnMut(&S) -> f64) -> Vec<Rounded> {
        let mut known = Table::default();
        for expr in self.visited(exprs, 2 * EVALUATED) {
            if !self.is_constant(expr) {
                let value = self.rounded_node(expr, &known, values);
                known.insert(expr, value);
            }
        }
        exprs.iter().map(|expr| self.rounded_of(&known, *expr)).collect()
    }

    /// A known value, or the value of a constant.
    fn rounded_of(&self, known: &Table<Expr, Rounded>, expr: Expr) -> Rounded {
        if self.is_constant(expr) {
            self.constant(expr).map_or(Rounded::LOST, |value| Rounded::new(value, 0.0))
        } else {
            known.get(expr).copied().unwrap_or(Rounded::LOST)
        }
    }

    fn rounded_node(&self, expr: Expr, known: &Table<Expr, Rounded>, values: &mut dyn FnMut(&S) -> f64) -> Rounded {
        let of = |expr: Expr| self.rounded_of(known, expr);
        match self.node(expr) {
            Node::Number(_) | Node::Pi => of(expr),
            Node::Symbol(symbol) => Rounded { value: values(symbol), error: 0.0 },
            Node::Sum(sum) => {
                let term = |(term, number): &(Expr, Rational)| {
                    Rounded::product([Rounded::number(number), of(*term)].into_iter())
                };
                Rounded::sum(sum.terms.iter().map(term).chain([Rounded::number(&sum.constant)]))
            }
            Node::Product(product) => {
                Rounded::product(product.factors.iter().map(|(base, exponent)| of(*base).power(exponent)))
            }
            Node::Call(function, arguments) => match arguments.as_slice() {
                [x] => of(*x).call(*function),
                [x, y] => {
                    let (x, y) = (of(*x), of(*y));
                    let nonzero = *function == Function::Pow && x.value != 0.0;
                    let by_first = x.map(nonzero, |x| function.value(x, y.value));
                    let by_second = y.map(nonzero, |y| function.value(x.value, y));
                    Rounded::new(by_first.value, by_first.error + by_second.error)
                }
                _ => Rounded::LOST,
            },
            Node::Opaque(function, arguments) => {
                let arguments: Vec<Rounded> = arguments.iter().map(|argument| of(*argument)).collect();
                function.rounded(&arguments)
            }
            Node::Select([condition, then, otherwise]) => match of(*condition).value {
                condition if condition.is_nan() => Rounded::LOST,
                condition if condition > 0.0 => of(*then),
                _ => of(*otherwise),
            },
        }
    }
}
