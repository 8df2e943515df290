//! Values in floating point.
//!
//! In: expressions and the value of each symbol. Out: their values in `f64`; each shared node is computed once.
//! Intended for checks, not for speed. Constants are rounded once; a constant without a value, or too large, is NaN.
//! An opaque function has the value of its stand-in, unless others are given.

use std::hash::Hash;

use num_traits::ToPrimitive;

use crate::effort::EVALUATED;
use crate::number::nearest;
use crate::{Expr, NoConstant, Node, Opaque, Pool, Rational, Table};

impl<S: Clone + Eq + Hash> Pool<S> {
    /// Value of one expression.
    #[must_use]
    pub fn evaluate(&self, expr: Expr, values: &mut dyn FnMut(&S) -> f64) -> f64 {
        self.evaluate_all(&[expr], values).into_iter().next().unwrap_or(f64::NAN)
    }

    /// Values of several expressions in order; the closure is called once per symbol.
    #[must_use]
    pub fn evaluate_all(&self, exprs: &[Expr], values: &mut dyn FnMut(&S) -> f64) -> Vec<f64> {
        self.evaluate_with(exprs, values, &Opaque::value)
    }

    /// Values of several expressions in order, with values of opaque functions in place of their stand-ins.
    #[must_use]
    pub fn evaluate_with(
        &self,
        exprs: &[Expr],
        values: &mut dyn FnMut(&S) -> f64,
        opaque: &dyn Fn(&Opaque, &[f64]) -> f64,
    ) -> Vec<f64> {
        let mut known = Table::default();
        for expr in self.visited(exprs, EVALUATED) {
            if !self.is_constant(expr) {
                let value = self.value_by(expr, &known, values, opaque);
                known.insert(expr, value);
            }
        }
        exprs.iter().map(|expr| self.value_of(&known, *expr)).collect()
    }

    /// Value of an expression with symbols, from the values of its operands.
    pub fn node_value(&self, expr: Expr, known: &Table<Expr, f64>, values: &mut dyn FnMut(&S) -> f64) -> f64 {
        self.value_by(expr, known, values, &Opaque::value)
    }

    fn value_by(
        &self,
        expr: Expr,
        known: &Table<Expr, f64>,
        values: &mut dyn FnMut(&S) -> f64,
        opaque: &dyn Fn(&Opaque, &[f64]) -> f64,
    ) -> f64 {
        let of = |expr: Expr| self.value_of(known, expr);
        match self.node(expr) {
            Node::Number(_) | Node::Pi => self.value_of(known, expr),
            Node::Symbol(symbol) => values(symbol),
            Node::Sum(sum) => {
                let parts = sum.terms.iter().map(|(term, coefficient)| nearest(coefficient) * of(*term));
                parts.sum::<f64>() + nearest(&sum.constant)
            }
            Node::Product(product) => {
                product.factors.iter().map(|(base, exponent)| raise(of(*base), exponent)).product()
            }
            Node::Call(function, arguments) => {
                let argument = |slot| arguments.get(slot).map_or(f64::NAN, |argument| of(*argument));
                function.value(argument(0), argument(1))
            }
            Node::Opaque(function, arguments) => {
                let arguments: Vec<f64> = arguments.iter().map(|argument| of(*argument)).collect();
                opaque(function, &arguments)
            }
            Node::Select([condition, then, otherwise]) => selected(of(*condition), of(*then), of(*otherwise)),
        }
    }

    /// A known value, or the value of a constant.
    fn value_of(&self, known: &Table<Expr, f64>, expr: Expr) -> f64 {
        if !self.is_constant(expr) {
            return known.get(expr).copied().unwrap_or(f64::NAN);
        }
        if let Some(number) = self.as_number(expr) {
            return nearest(number);
        }
        match self.constant(expr) {
            Ok(value) => value,
            Err(NoConstant::TooSmall) => 0.0,
            Err(_) => f64::NAN,
        }
    }
}

/// `then` for a positive condition, `otherwise` for another one; NaN for NaN.
#[must_use]
pub fn selected(condition: f64, then: f64, otherwise: f64) -> f64 {
    if condition.is_nan() {
        f64::NAN
    } else if condition > 0.0 {
        then
    } else {
        otherwise
    }
}

/// Integer powers by multiplication, square roots by `sqrt`, the others by `powf`.
pub(crate) fn raise(base: f64, exponent: &Rational) -> f64 {
    match (exponent.numer().to_i32(), exponent.denom().to_u32()) {
        (Some(power), Some(1)) => base.powi(power),
        (Some(power), Some(2)) => base.sqrt().powi(power),
        _ => base.powf(nearest(exponent)),
    }
}
