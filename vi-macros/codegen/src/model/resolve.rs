//! Names become symbols, and written expressions become exact ones.
//!
//! In: an [`Expression`] and the names in [`Scope`]. Out: an expression of the pool, or the message at the token.

use crate::messages::{Message, error, nearest};
use crate::symbol::{Symbol, Variable};
use crate::syntax::{Expression, Kind, Operator};
use proc_macro2::{Ident, Span};
use std::collections::BTreeMap;
use syn::Result;
use vi_expr::{Expr, Function, Pool, Rational};

/// Nodes that the expressions of one system may have together.
pub(crate) const NODES: usize = 400_000;

/// Names that the language keeps for itself, beside its functions.
const RESERVED: [&str; 5] = ["t", "pi", "L", "f", "self"];

/// The names that an expression may use.
#[derive(Default)]
pub struct Scope {
    names: BTreeMap<String, Meaning>,
}

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meaning {
    /// A parameter, constant, coordinate or `let`, with its expression.
    Value(Expr),
    /// A coordinate, with its index.
    Coordinate(usize),
}

impl Scope {
    /// Adds a name.
    ///
    /// # Errors
    /// The name is reserved, or was declared before.
    pub(crate) fn declare(&mut self, name: &Ident, meaning: Meaning) -> Result<()> {
        let text = name.to_string();
        if RESERVED.contains(&text.as_str()) || text == "dot" || text == "sqrt" || Function::from_name(&text).is_some()
        {
            return Err(error(name.span(), &Message::Reserved { name: text }));
        }
        if self.names.contains_key(&text) {
            return Err(error(name.span(), &Message::Duplicate { name: text }));
        }
        self.names.insert(text, meaning);
        Ok(())
    }

    /// The index of a coordinate.
    pub(crate) fn coordinate(&self, name: &str) -> Option<usize> {
        match self.names.get(name) {
            Some(Meaning::Coordinate(index)) => Some(*index),
            _ => None,
        }
    }

    /// The coordinate nearest to a misspelt name.
    pub(crate) fn near_coordinate(&self, name: &str) -> Option<String> {
        let coordinates = self.names.iter().filter(|(_, meaning)| matches!(meaning, Meaning::Coordinate(_)));
        nearest(name, coordinates.map(|(name, _)| name.as_str()))
    }

    /// The exact expression that a written one stands for.
    ///
    /// # Errors
    /// Unknown names, wrong arguments, division by zero, too many terms: at the token.
    pub fn expression(&self, pool: &mut Pool<Symbol>, written: &Expression) -> Result<Expr> {
        if pool.len() > NODES {
            return Err(error(written.span, &Message::TooLarge { limit: NODES }));
        }
        match &written.kind {
            Kind::Number(value) => Ok(pool.number(value.clone())),
            Kind::Name(name) => self.name(pool, name),
            Kind::Call(function, arguments) => self.call(pool, function, arguments),
            Kind::Negative(operand) => {
                let operand = self.expression(pool, operand)?;
                Ok(pool.neg(operand))
            }
            Kind::Power(base, exponent) => {
                let (base, power) = (self.expression(pool, base)?, self.expression(pool, exponent)?);
                let negative = pool.as_number(power).is_some_and(|value| *value < Rational::default());
                if negative && pool.is_zero(base) {
                    return Err(error(written.span, &Message::DivisionByZero));
                }
                Ok(pool.call(Function::Pow, &[base, power]))
            }
            Kind::Chain(first, rest) => self.chain(pool, first, rest),
        }
    }

    fn chain(&self, pool: &mut Pool<Symbol>, first: &Expression, rest: &[(Operator, Expression)]) -> Result<Expr> {
        let mut operands = vec![self.expression(pool, first)?];
        let mut sum = true;
        for (operator, written) in rest {
            let operand = self.expression(pool, written)?;
            operands.push(match operator {
                Operator::Plus | Operator::Times => operand,
                Operator::Minus => pool.neg(operand),
                Operator::Over if pool.is_zero(operand) => {
                    return Err(error(written.span, &Message::DivisionByZero));
                }
                Operator::Over => pool.power(operand, &Rational::from_integer((-1).into())),
            });
            sum = matches!(operator, Operator::Plus | Operator::Minus);
        }
        Ok(if sum { pool.sum(&operands) } else { pool.product(&operands) })
    }

    fn name(&self, pool: &mut Pool<Symbol>, name: &Ident) -> Result<Expr> {
        let text = name.to_string();
        match (self.names.get(&text), text.as_str()) {
            (Some(Meaning::Value(value)), _) => Ok(*value),
            (Some(Meaning::Coordinate(index)), _) => Ok(pool.symbol(Symbol::Continuous(Variable::Coordinate(*index)))),
            (None, "t") => Ok(pool.symbol(Symbol::Continuous(Variable::Time))),
            (None, "pi") => Ok(pool.pi()),
            (None, _) => Err(error(name.span(), &self.unknown(text))),
        }
    }

    /// What a name that stands for nothing was meant to be.
    fn unknown(&self, name: String) -> Message {
        if name == "dot" || name == "sqrt" || Function::from_name(&name).is_some() {
            return Message::FunctionWithoutArguments { name };
        }
        let acceleration = ["ddot", "_ddot", "_tt"].iter().find_map(|ending| name.strip_suffix(ending));
        if acceleration.is_some_and(|stem| self.coordinate(stem.trim_end_matches('_')).is_some()) {
            return Message::Acceleration { name };
        }
        let near = nearest(&name, self.names.keys().map(String::as_str));
        Message::Unknown { name, near }
    }

    fn call(&self, pool: &mut Pool<Symbol>, function: &Ident, arguments: &[Expression]) -> Result<Expr> {
        let name = function.to_string();
        if name == "dot" {
            return self.velocity(pool, function.span(), arguments);
        }
        let known = Function::from_name(&name);
        let Some(takes) = known.map(Function::arity).or_else(|| (name == "sqrt").then_some(1)) else {
            let functions = Function::ALL.into_iter().map(Function::name).chain(["sqrt", "dot"]);
            let near = nearest(&name, functions);
            return Err(error(function.span(), &Message::UnknownFunction { name, near }));
        };
        if arguments.len() != takes {
            return Err(error(function.span(), &Message::Arity { name, takes, given: arguments.len() }));
        }
        let values = arguments.iter().map(|each| self.expression(pool, each)).collect::<Result<Vec<_>>>()?;
        Ok(match known {
            Some(function) => pool.call(function, &values),
            None => pool.power(values[0], &Rational::new(1.into(), 2.into())),
        })
    }

    fn velocity(&self, pool: &mut Pool<Symbol>, span: Span, arguments: &[Expression]) -> Result<Expr> {
        let [argument] = arguments else {
            return Err(error(span, &Message::Arity { name: "dot".to_owned(), takes: 1, given: arguments.len() }));
        };
        match &argument.kind {
            Kind::Name(name) => match self.coordinate(&name.to_string()) {
                Some(index) => Ok(pool.symbol(Symbol::Continuous(Variable::Velocity(index)))),
                None if self.names.contains_key(&name.to_string()) || name == "t" || name == "pi" => {
                    Err(error(name.span(), &Message::DotOfOther { name: name.to_string() }))
                }
                None => Err(error(name.span(), &self.unknown(name.to_string()))),
            },
            Kind::Call(inner, _) if inner == "dot" => {
                Err(error(span, &Message::Acceleration { name: "dot(dot(…))".to_owned() }))
            }
            _ => Err(error(argument.span, &Message::DotOfExpression)),
        }
    }
}
