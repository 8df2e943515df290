//! Written expressions become exact ones.
//!
//! In: an [`Expression`] and the names in [`Scope`]. Out: an expression of the pool, or the message at the token.

use super::scope::{Meaning, Scope};
use crate::discrete::bounded;
use crate::messages::{Message, error, nearest};
use crate::symbol::{Symbol, Variable};
use crate::syntax::{Expression, Kind, Operator, Range};
use num_traits::ToPrimitive;
use proc_macro2::{Ident, Span};
use syn::Result;
use vi_expr::{Expr, Function, Pool, Rational};

/// Work of reading one part of an expression.
const READING: usize = 8;

/// What is done with one value of an index.
type Make<'a, P> = &'a mut dyn FnMut(&mut Scope, &mut Pool<Symbol>, i64) -> Result<P>;

impl Scope {
    /// The exact expression that a written one stands for.
    ///
    /// # Errors
    /// Unknown names, wrong arguments, no value (a division by zero, say), too much work: at the token.
    pub(super) fn expression(&mut self, pool: &mut Pool<Symbol>, written: &Expression) -> Result<Expr> {
        pool.spend(READING);
        let value = match &written.kind {
            Kind::Number(value) => pool.number(value.clone()),
            Kind::Name(name) => self.name(pool, name)?,
            Kind::Entry(name, index) => self.entry(pool, name, index)?,
            Kind::Call(function, arguments) => self.call(pool, function, arguments)?,
            Kind::Sum(range, summand) => {
                let terms = self.each(pool, range, &mut |scope, pool, _| scope.expression(pool, summand))?;
                pool.sum(&terms)
            }
            Kind::Negative(operand) => {
                let operand = self.expression(pool, operand)?;
                pool.neg(operand)
            }
            Kind::Power(base, exponent) => {
                let (base, exponent) = (self.expression(pool, base)?, self.expression(pool, exponent)?);
                pool.call(Function::Pow, &[base, exponent])
            }
            Kind::Chain(first, rest) => self.chain(pool, first, rest)?,
        };
        bounded(pool).map_err(|found| error(written.span, &Message::TooLarge(found)))?;
        if pool.is_undefined(value) {
            return Err(error(written.span, &Message::NoValue));
        }
        Ok(value)
    }

    /// What is made of each value of an index, in order.
    ///
    /// # Errors
    /// A bound that is not an integer, a range that runs backwards, an index by a name that is taken; errors of `make`.
    pub(super) fn each<P>(&mut self, pool: &mut Pool<Symbol>, range: &Range, make: Make<P>) -> Result<Vec<P>> {
        let (from, to) = (self.integer(pool, &range.from)?, self.integer(pool, &range.to)?);
        if to < from {
            return Err(error(range.to.span, &Message::BackwardRange { from, to }));
        }
        let index = range.index.to_string();
        self.declare(&range.index, Meaning::Value(pool.zero()))?;
        let made = (from..to).map(|value| {
            self.set(&index, Meaning::Value(pool.integer(value)));
            make(self, pool, value)
        });
        let made = made.collect();
        self.forget(&index);
        made
    }

    /// The integer that an expression stands for.
    ///
    /// # Errors
    /// It is no constant, or not an integer.
    pub(super) fn integer(&mut self, pool: &mut Pool<Symbol>, written: &Expression) -> Result<i64> {
        let value = self.expression(pool, written)?;
        let integer = pool.as_number(value).filter(|number| number.is_integer()).and_then(ToPrimitive::to_i64);
        integer.ok_or_else(|| error(written.span, &Message::NotInteger))
    }

    fn chain(&mut self, pool: &mut Pool<Symbol>, first: &Expression, rest: &[(Operator, Expression)]) -> Result<Expr> {
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
        match (self.meaning(&text), text.as_str()) {
            (Some(Meaning::Value(value)), _) => Ok(*value),
            (Some(Meaning::Wrong), _) => Ok(pool.one()),
            (Some(Meaning::Coordinate(index)), _) => Ok(pool.symbol(Symbol::Continuous(Variable::Coordinate(*index)))),
            (Some(Meaning::Values { .. } | Meaning::Coordinates { .. }), _) => {
                Err(error(name.span(), &Message::ArrayWithoutIndex { name: text }))
            }
            (None, "t") => Ok(pool.symbol(Symbol::Continuous(Variable::Time))),
            (None, "pi") => Ok(pool.pi()),
            (None, _) => Err(error(name.span(), &self.unknown(pool, text))),
        }
    }

    /// An entry of an array.
    fn entry(&mut self, pool: &mut Pool<Symbol>, name: &Ident, index: &Expression) -> Result<Expr> {
        if let Some(coordinate) = self.coordinate_entry(pool, name, index)? {
            return Ok(pool.symbol(Symbol::Continuous(Variable::Coordinate(coordinate))));
        }
        let at = self.integer(pool, index)?;
        let text = name.to_string();
        let (first, entries) = match self.meaning(&text) {
            Some(Meaning::Values { first, entries }) => (first, entries),
            Some(Meaning::Wrong) => return Ok(pool.one()),
            _ => return Err(error(name.span(), &self.no_array(pool, text))),
        };
        let offset = at.checked_sub(*first).and_then(|offset| usize::try_from(offset).ok());
        let entry = offset.and_then(|offset| entries.get(offset));
        entry.copied().ok_or_else(|| {
            let end = first.saturating_add(i64::try_from(entries.len()).unwrap_or(i64::MAX));
            error(index.span, &Message::IndexRange { name: text, index: at, first: *first, end })
        })
    }

    /// The number of the coordinate that an entry is, if its array is one of coordinates.
    ///
    /// # Errors
    /// The index is not an integer, or out of range.
    pub(super) fn coordinate_entry(
        &mut self,
        pool: &mut Pool<Symbol>,
        name: &Ident,
        index: &Expression,
    ) -> Result<Option<usize>> {
        let text = name.to_string();
        let Some(Meaning::Coordinates { first, length }) = self.meaning(&text).cloned() else {
            return Ok(None);
        };
        let at = self.integer(pool, index)?;
        if let Some(at) = usize::try_from(at).ok().filter(|at| *at < length) {
            return Ok(Some(first + at));
        }
        let end = i64::try_from(length).unwrap_or(i64::MAX);
        Err(error(index.span, &Message::IndexRange { name: text, index: at, first: 0, end }))
    }

    /// What a name with an index was meant to be.
    fn no_array(&self, pool: &Pool<Symbol>, name: String) -> Message {
        if self.meaning(&name).is_some() || name == "t" || name == "pi" {
            return Message::NotArray { name };
        }
        self.unknown(pool, name)
    }

    /// What a name that stands for nothing was meant to be.
    fn unknown(&self, pool: &Pool<Symbol>, name: String) -> Message {
        if name == "dot" || name == "sum" || name == "sqrt" || Function::from_name(&name).is_some() {
            return Message::FunctionWithoutArguments { name };
        }
        let acceleration = ["ddot", "_ddot", "_tt"].iter().find_map(|ending| name.strip_suffix(ending));
        if acceleration.is_some_and(|stem| self.is_coordinate(stem.trim_end_matches('_'))) {
            return Message::Acceleration { name };
        }
        let near = self.near(pool, &name);
        Message::Unknown { name, near }
    }

    fn call(&mut self, pool: &mut Pool<Symbol>, function: &Ident, arguments: &[Expression]) -> Result<Expr> {
        let name = function.to_string();
        if name == "dot" {
            return self.velocity(pool, function.span(), arguments);
        }
        let known = Function::from_name(&name);
        let Some(takes) = known.map(Function::arity).or_else(|| (name == "sqrt").then_some(1)) else {
            let functions = Function::ALL.into_iter().map(Function::name).chain(["sqrt", "dot", "sum"]);
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

    fn velocity(&mut self, pool: &mut Pool<Symbol>, span: Span, arguments: &[Expression]) -> Result<Expr> {
        let [argument] = arguments else {
            return Err(error(span, &Message::Arity { name: "dot".to_owned(), takes: 1, given: arguments.len() }));
        };
        let coordinate = match &argument.kind {
            Kind::Name(name) => match self.meaning(&name.to_string()) {
                Some(Meaning::Coordinate(index)) => *index,
                Some(Meaning::Wrong) => return Ok(pool.one()),
                Some(Meaning::Coordinates { .. }) => {
                    return Err(error(name.span(), &Message::ArrayWithoutIndex { name: name.to_string() }));
                }
                None if name != "t" && name != "pi" => {
                    return Err(error(name.span(), &self.unknown(pool, name.to_string())));
                }
                _ => return Err(error(name.span(), &Message::DotOfOther { name: name.to_string() })),
            },
            Kind::Entry(name, index) => match self.coordinate_entry(pool, name, index)? {
                Some(coordinate) => coordinate,
                None if self.meaning(&name.to_string()) == Some(&Meaning::Wrong) => return Ok(pool.one()),
                None if self.meaning(&name.to_string()).is_some() => {
                    return Err(error(name.span(), &Message::DotOfOther { name: name.to_string() }));
                }
                None => return Err(error(name.span(), &self.unknown(pool, name.to_string()))),
            },
            Kind::Call(inner, _) if inner == "dot" => {
                return Err(error(span, &Message::Acceleration { name: "dot(dot(…))".to_owned() }));
            }
            _ => return Err(error(argument.span, &Message::DotOfExpression)),
        };
        Ok(pool.symbol(Symbol::Continuous(Variable::Velocity(coordinate))))
    }
}
