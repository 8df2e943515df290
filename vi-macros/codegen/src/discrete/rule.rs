//! A rule, evaluated: its lines become expressions in fields and slots, its arguments of L and f become points.
//!
//! In: a [`Rule`] as written. Out: an [`Evaluated`]. Values are numbers or vectors of N entries; `*` of two vectors is
//! their dot product.

use super::{Point, bounded};
use crate::messages::{Errors, Message, error};
use crate::symbol::{Field, Quantity, Symbol};
use crate::syntax::{Expression, Kind, Operator, Rule};
use proc_macro2::{Ident, Span};
use syn::Result;
use vi_expr::{Expr, Pool, Rational};

/// What the lines of a rule say.
#[derive(PartialEq)]
pub(super) struct Evaluated {
    /// L_d.
    pub(super) ld: Expr,
    /// f_d⁻, f_d⁺; empty without a force.
    pub(super) fd: [Vec<Expr>; 2],
    /// g_d⁻, g_d⁺; zero without a force.
    pub(super) gd: [Expr; 2],
    /// Where L and f are evaluated.
    pub(super) points: Vec<Point>,
}

/// A number or a vector.
#[derive(Clone)]
enum Value {
    Number(Expr),
    Vector(Vec<Expr>),
}

/// The lines of a rule, in the order in which the paper names them.
const LINES: [&str; 5] = ["Ld", "fd_minus", "fd_plus", "gd_minus", "gd_plus"];

/// Evaluates a rule for a system of `dimension` coordinates, with or without a force.
///
/// # Errors
/// Lines that are missing, double or unknown; numbers where vectors are needed, and the reverse.
pub(super) fn evaluate(pool: &mut Pool<Symbol>, rule: &Rule, dimension: usize, forced: bool) -> Result<Evaluated> {
    let mut evaluation = Evaluation { pool, dimension, points: Vec::new() };
    let mut errors = Errors::default();
    let mut lines: [Option<Value>; 5] = Default::default();
    for line in &rule.lines {
        let name = line.name.to_string();
        match LINES.iter().position(|known| *known == name) {
            None => errors.at(line.name.span(), &Message::UnknownSlot { name }),
            Some(index) if lines[index].is_some() => errors.at(line.name.span(), &Message::SecondSlot { name }),
            // Without a force the four force lines are nothing: they are not evaluated.
            Some(index) if index > 0 && !forced => {}
            Some(index) => match evaluation.line(&line.value, (1..3).contains(&index)) {
                Ok(value) => lines[index] = Some(value),
                Err(error) => errors.add(error),
            },
        }
    }
    for (name, line) in LINES.into_iter().zip(&lines).take(if forced { 5 } else { 1 }) {
        if line.is_none() && rule.lines.iter().all(|line| line.name != name) {
            errors.at(rule.span, &Message::MissingSlot { name });
        }
    }
    errors.finish(())?;
    let points = evaluation.points;
    let [ld, fd_minus, fd_plus, gd_minus, gd_plus] = lines;
    let zero = pool.zero();
    let number = |value: Option<Value>| if let Some(Value::Number(value)) = value { value } else { zero };
    let vector = |value: Option<Value>| if let Some(Value::Vector(value)) = value { value } else { Vec::new() };
    Ok(Evaluated {
        ld: number(ld),
        fd: [vector(fd_minus), vector(fd_plus)],
        gd: [number(gd_minus), number(gd_plus)],
        points,
    })
}

struct Evaluation<'a> {
    pool: &'a mut Pool<Symbol>,
    dimension: usize,
    points: Vec<Point>,
}

impl Evaluation<'_> {
    fn line(&mut self, written: &Expression, vector: bool) -> Result<Value> {
        match self.value(written)? {
            value @ Value::Vector(_) if vector => Ok(value),
            value @ Value::Number(_) if !vector => Ok(value),
            _ if vector => Err(error(written.span, &Message::Shape { needs: "vector" })),
            _ => Err(error(written.span, &Message::Shape { needs: "number" })),
        }
    }

    fn number(&mut self, written: &Expression) -> Result<Expr> {
        match self.value(written)? {
            Value::Number(value) => Ok(value),
            Value::Vector(_) => Err(error(written.span, &Message::Shape { needs: "number" })),
        }
    }

    fn vector(&mut self, written: &Expression) -> Result<Vec<Expr>> {
        match self.value(written)? {
            Value::Vector(value) => Ok(value),
            Value::Number(_) => Err(error(written.span, &Message::Shape { needs: "vector" })),
        }
    }

    fn value(&mut self, written: &Expression) -> Result<Value> {
        bounded(self.pool).map_err(|found| error(written.span, &Message::TooLarge(found)))?;
        match &written.kind {
            Kind::Number(value) => Ok(Value::Number(self.pool.number(value.clone()))),
            Kind::Name(name) => self.name(name),
            Kind::Call(function, arguments) => self.call(function, arguments),
            Kind::Entry(..) | Kind::Sum(..) => {
                Err(error(written.span, &Message::Expected { what: "t0, t1, h, q0, q1, L(…) or f(…)" }))
            }
            Kind::Negative(operand) => {
                let operand = self.value(operand)?;
                let minus = self.pool.integer(-1);
                Ok(self.times(&operand, &Value::Number(minus)))
            }
            Kind::Power(base, exponent) => {
                let (base, exponent_span) = (self.number(base)?, exponent.span);
                let exponent = self.number(exponent)?;
                match self.pool.as_number(exponent).cloned() {
                    Some(exponent) => Ok(Value::Number(self.pool.power(base, &exponent))),
                    None => Err(error(exponent_span, &Message::Shape { needs: "constant number" })),
                }
            }
            Kind::Chain(first, rest) => {
                let mut value = self.value(first)?;
                for (operator, operand) in rest {
                    value = self.operate(value, *operator, operand)?;
                }
                Ok(value)
            }
        }
    }

    fn operate(&mut self, left: Value, operator: Operator, written: &Expression) -> Result<Value> {
        let right = self.value(written)?;
        match operator {
            Operator::Plus => self.plus(left, right, written.span),
            Operator::Minus => {
                let minus = self.pool.integer(-1);
                let right = self.times(&right, &Value::Number(minus));
                self.plus(left, right, written.span)
            }
            Operator::Times => Ok(self.times(&left, &right)),
            Operator::Over => match right {
                Value::Number(right) if self.pool.is_zero(right) => Err(error(written.span, &Message::DivisionByZero)),
                Value::Number(right) => {
                    let inverse = self.pool.power(right, &Rational::from_integer((-1).into()));
                    Ok(self.times(&left, &Value::Number(inverse)))
                }
                Value::Vector(_) => Err(error(written.span, &Message::Shape { needs: "number" })),
            },
        }
    }

    fn plus(&mut self, left: Value, right: Value, span: Span) -> Result<Value> {
        match (left, right) {
            (Value::Number(left), Value::Number(right)) => Ok(Value::Number(self.pool.add(left, right))),
            (Value::Vector(left), Value::Vector(right)) => {
                Ok(Value::Vector(left.into_iter().zip(right).map(|(a, b)| self.pool.add(a, b)).collect()))
            }
            (Value::Number(_), Value::Vector(_)) => Err(error(span, &Message::Shape { needs: "number" })),
            (Value::Vector(_), Value::Number(_)) => Err(error(span, &Message::Shape { needs: "vector" })),
        }
    }

    fn times(&mut self, left: &Value, right: &Value) -> Value {
        match (left, right) {
            (Value::Number(left), Value::Number(right)) => Value::Number(self.pool.mul(*left, *right)),
            (Value::Number(scale), Value::Vector(vector)) | (Value::Vector(vector), Value::Number(scale)) => {
                Value::Vector(vector.iter().map(|entry| self.pool.mul(*entry, *scale)).collect())
            }
            (Value::Vector(left), Value::Vector(right)) => {
                let products: Vec<Expr> = left.iter().zip(right).map(|(a, b)| self.pool.mul(*a, *b)).collect();
                Value::Number(self.pool.sum(&products))
            }
        }
    }

    fn name(&mut self, name: &Ident) -> Result<Value> {
        let text = name.to_string();
        let vector = |pool: &mut Pool<Symbol>, dimension, symbol: fn(usize) -> Symbol| {
            Value::Vector((0..dimension).map(|index| pool.symbol(symbol(index))).collect())
        };
        Ok(match text.as_str() {
            "t0" => Value::Number(self.pool.symbol(Symbol::T0)),
            "t1" => Value::Number(self.pool.symbol(Symbol::T1)),
            "h" => Value::Number(self.pool.symbol(Symbol::Step)),
            "q0" => vector(self.pool, self.dimension, Symbol::Q0),
            "q1" => vector(self.pool, self.dimension, Symbol::Q1),
            _ => return Err(error(name.span(), &Message::Unknown { name: text, near: None })),
        })
    }

    fn call(&mut self, function: &Ident, arguments: &[Expression]) -> Result<Value> {
        let name = function.to_string();
        if name != "L" && name != "f" {
            return Err(error(function.span(), &Message::UnknownFunction { name, near: None }));
        }
        let [time, coordinates, velocities] = arguments else {
            return Err(error(function.span(), &Message::Arity { name, takes: 3, given: arguments.len() }));
        };
        let point = Point {
            time: self.number(time)?,
            coordinates: self.vector(coordinates)?,
            velocities: self.vector(velocities)?,
        };
        let index = self.points.iter().position(|known| *known == point).unwrap_or_else(|| {
            self.points.push(point);
            self.points.len() - 1
        });
        let mut field =
            |quantity| self.pool.symbol(Symbol::Field(Field { quantity, derivatives: Vec::new(), point: index }));
        Ok(if name == "L" {
            Value::Number(field(Quantity::Lagrangian))
        } else {
            Value::Vector((0..self.dimension).map(|component| field(Quantity::Force(component))).collect())
        })
    }
}
