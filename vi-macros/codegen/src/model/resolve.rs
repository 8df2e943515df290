//! Resolves written expressions to exact ones.
//!
//! In: an [`Expression`] and the names in [`Scope`]. Out: a [`Value`] of the pool, or a message at the token. An
//! expression of a system is a number. In a rule, the coordinates at an end and the force are vectors, and `*` of two
//! vectors is their dot product.

use super::condition::CHOICES;
use super::point::Point;
use super::scope::{Meaning, Scope};
use crate::habits::Habit;
use crate::limits::bounded;
use crate::messages::{Errors, Message, error, nearest};
use crate::symbol::{Field, Quantity, Symbol, Variable};
use crate::syntax::{Expression, Kind, Operator, Range};
use core::cmp::Ordering;
use num_traits::ToPrimitive;
use proc_macro2::{Ident, Span};
use syn::Result;
use vi_expr::{Expr, Function, NoConstant, Pool, Rational};

/// Work of reading one node of an expression.
const READING: usize = 8;

/// Characters of a number in a message.
const CHARACTERS: usize = 30;

/// The operation for one value of an index.
type Make<'a, P> = &'a mut dyn FnMut(&mut Scope, &mut Pool<Symbol>, i64) -> Result<P>;

/// A number, or a vector with one entry per coordinate.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Number(Expr),
    Vector(Vec<Expr>),
}

impl Value {
    /// The number.
    ///
    /// # Errors
    /// A vector: a message at this place.
    pub(super) fn number(self, span: Span) -> Result<Expr> {
        match self {
            Self::Number(value) => Ok(value),
            Self::Vector(_) => Err(error(span, &Message::Shape { needs: "number" })),
        }
    }

    /// The vector.
    ///
    /// # Errors
    /// A number: a message at this place.
    pub(super) fn vector(self, span: Span) -> Result<Vec<Expr>> {
        match self {
            Self::Vector(entries) => Ok(entries),
            Self::Number(_) => Err(error(span, &Message::Shape { needs: "vector" })),
        }
    }

    /// Whether both are numbers, or vectors of equal length.
    pub(super) fn has_shape_of(&self, other: &Self) -> bool {
        core::mem::discriminant(self) == core::mem::discriminant(other) && self.entries().len() == other.entries().len()
    }

    /// The number, or the entries of the vector.
    pub(super) fn entries(&self) -> &[Expr] {
        match self {
            Self::Number(value) => core::slice::from_ref(value),
            Self::Vector(entries) => entries,
        }
    }

    /// Applies an operation to each entry.
    pub(super) fn map(self, mut make: impl FnMut(Expr) -> Expr) -> Self {
        match self {
            Self::Number(value) => Self::Number(make(value)),
            Self::Vector(entries) => Self::Vector(entries.into_iter().map(make).collect()),
        }
    }

    /// The sum of values of equal shape, each with its place.
    fn sum(pool: &mut Pool<Symbol>, terms: Vec<(Self, Span)>) -> Result<Self> {
        let Some((Self::Vector(first), _)) = terms.first() else {
            let numbers = terms.into_iter().map(|(term, span)| term.number(span)).collect::<Result<Vec<_>>>()?;
            return Ok(Self::Number(pool.sum(&numbers)));
        };
        let length = first.len();
        let vectors = terms.into_iter().map(|(term, span)| term.vector(span)).collect::<Result<Vec<_>>>()?;
        let entry = |index: usize| vectors.iter().filter_map(|vector| vector.get(index)).copied().collect::<Vec<_>>();
        Ok(Self::Vector((0..length).map(|index| pool.sum(&entry(index))).collect()))
    }

    /// The product of factors, from left to right.
    fn product(pool: &mut Pool<Symbol>, factors: Vec<Self>) -> Self {
        let numbers: Option<Vec<Expr>> = factors.iter().map(|factor| factor.clone().into_number()).collect();
        if let Some(numbers) = numbers {
            return Self::Number(pool.product(&numbers));
        }
        let times = |left: Self, right: Self| match (left, right) {
            (Self::Number(scale), other) | (other, Self::Number(scale)) => other.map(|entry| pool.mul(entry, scale)),
            (Self::Vector(left), Self::Vector(right)) => {
                let products: Vec<Expr> = left.into_iter().zip(right).map(|(a, b)| pool.mul(a, b)).collect();
                Self::Number(pool.sum(&products))
            }
        };
        factors.into_iter().reduce(times).unwrap_or(Self::Vector(Vec::new()))
    }

    fn into_number(self) -> Option<Expr> {
        if let Self::Number(value) = self { Some(value) } else { None }
    }
}

impl Scope {
    /// The exact number of a written expression.
    ///
    /// # Errors
    /// Those of [`Self::value`], and a vector.
    pub(super) fn expression(&mut self, pool: &mut Pool<Symbol>, written: &Expression) -> Result<Expr> {
        self.value(pool, written)?.number(written.span)
    }

    /// The exact value of a written expression.
    ///
    /// # Errors
    /// Unknown names, wrong arguments, no value (such as a division by zero), too much work: at the token.
    pub(super) fn value(&mut self, pool: &mut Pool<Symbol>, written: &Expression) -> Result<Value> {
        pool.spend(READING);
        let value = match &written.kind {
            Kind::Number(value) => Value::Number(pool.number(value.clone())),
            Kind::Name(name) => self.name(pool, name)?,
            Kind::Entry(name, index) => Value::Number(self.entry(pool, name, index)?),
            Kind::Call(function, arguments) => self.call(pool, function, arguments)?,
            Kind::Sum(range, summand) => {
                let terms = self.each(pool, range, &mut |scope, pool, _| scope.value(pool, summand))?;
                Value::sum(pool, terms.into_iter().map(|term| (term, summand.span)).collect())?
            }
            Kind::Negative(operand) => self.value(pool, operand)?.map(|operand| pool.neg(operand)),
            Kind::Power(base, exponent) => {
                let operands = self.each_of(pool, [&**base, exponent], Self::expression)?;
                Value::Number(power(pool, operands[0], operands[1]))
            }
            Kind::Chain(first, rest) => self.chain(pool, first, rest)?,
            Kind::If(comparison, arms) => self.condition(pool, comparison, arms)?,
        };
        let mut wrong = None;
        let value = value.map(|entry| {
            cancelled(pool, entry).unwrap_or_else(|message| {
                wrong = Some(message);
                entry
            })
        });
        bounded(pool).map_err(|found| error(written.span, &Message::TooLarge(found)))?;
        if value.entries().iter().any(|entry| pool.is_undefined(*entry)) {
            return Err(error(written.span, &Message::NoValue));
        }
        match wrong {
            Some(message) => Err(error(written.span, &message)),
            None => Ok(value),
        }
    }

    /// Applies an operation to each part of an expression, in order.
    ///
    /// # Errors
    /// The errors of all parts; for a system that is too large, only the first.
    pub(super) fn each_of<P, Q>(
        &mut self,
        pool: &mut Pool<Symbol>,
        parts: impl IntoIterator<Item = P>,
        make: fn(&mut Self, &mut Pool<Symbol>, P) -> Result<Q>,
    ) -> Result<Vec<Q>> {
        let mut errors = Errors::default();
        let mut made = Vec::new();
        for part in parts {
            made.extend(errors.keep(make(self, pool, part)));
            if !errors.is_empty() && bounded(pool).is_err() {
                break;
            }
        }
        errors.finish(made)
    }

    /// Applies an operation to each value of an index, in order.
    ///
    /// # Errors
    /// A bound that is not an integer, a reversed range, an index with a declared name; errors of `make`.
    pub(super) fn each<P>(&mut self, pool: &mut Pool<Symbol>, range: &Range, make: Make<P>) -> Result<Vec<P>> {
        let (from, to) = (self.integer(pool, &range.from)?, self.integer(pool, &range.to)?);
        if to < from {
            return Err(error(range.to.span, &Message::BackwardRange { from, to }));
        }
        let index = range.index.to_string();
        self.declare_index(&range.index, Meaning::Number(pool.zero()))?;
        let made = (from..to).map(|value| {
            self.set(&index, Meaning::Number(pool.integer(value)));
            make(self, pool, value)
        });
        let made = made.collect();
        self.forget(&index);
        made
    }

    /// The integer value of an expression.
    ///
    /// # Errors
    /// It is not constant, or not an integer.
    pub(super) fn integer(&mut self, pool: &mut Pool<Symbol>, written: &Expression) -> Result<i64> {
        let value = self.expression(pool, written)?;
        let integer = pool.as_number(value).filter(|number| number.is_integer()).and_then(ToPrimitive::to_i64);
        integer.ok_or_else(|| error(written.span, &Message::NotInteger))
    }

    fn chain(&mut self, pool: &mut Pool<Symbol>, first: &Expression, rest: &[(Operator, Expression)]) -> Result<Value> {
        let is_sum = rest.iter().all(|(operator, _)| matches!(operator, Operator::Plus | Operator::Minus));
        let leading = if is_sum { Operator::Plus } else { Operator::Times };
        let rest = rest.iter().map(|(operator, written)| (*operator, written));
        let operands = self.each_of(pool, [(leading, first)].into_iter().chain(rest), Self::operand)?;
        if is_sum {
            return Value::sum(pool, operands);
        }
        Ok(Value::product(pool, operands.into_iter().map(|(operand, _)| operand).collect()))
    }

    /// A term or factor with its place: negated after `-`, inverted after `/`.
    fn operand(&mut self, pool: &mut Pool<Symbol>, of: (Operator, &Expression)) -> Result<(Value, Span)> {
        let (operator, written) = of;
        let operand = self.value(pool, written)?;
        let operand = match operator {
            Operator::Plus | Operator::Times => operand,
            Operator::Minus => operand.map(|operand| pool.neg(operand)),
            Operator::Over => {
                let divisor = operand.number(written.span)?;
                if is_zero(pool, divisor) {
                    return Err(error(written.span, &Message::DivisionByZero));
                }
                Value::Number(pool.power(divisor, &Rational::from_integer((-1).into())))
            }
        };
        Ok((operand, written.span))
    }

    fn name(&self, pool: &mut Pool<Symbol>, name: &Ident) -> Result<Value> {
        let text = name.to_string();
        let message = match self.meaning(&text) {
            Some(Meaning::Number(value)) => return Ok(Value::Number(*value)),
            Some(Meaning::Wrong) => return Ok(Value::Number(pool.one())),
            Some(Meaning::Pi) => return Ok(Value::Number(pool.pi())),
            Some(Meaning::Symbol(symbol)) => return Ok(Value::Number(pool.symbol(symbol.clone()))),
            Some(Meaning::Coordinate(index)) => {
                return Ok(Value::Number(pool.symbol(Symbol::Continuous(Variable::Coordinate(*index)))));
            }
            Some(Meaning::Vector(entries)) => {
                return Ok(Value::Vector(entries.iter().map(|entry| pool.symbol(entry.clone())).collect()));
            }
            Some(Meaning::Array { .. } | Meaning::Coordinates { .. }) => Message::ArrayWithoutIndex { name: text },
            Some(Meaning::OfState) => Message::NotInRule { name: text },
            Some(Meaning::Moving) => Message::VelocityInTimeScale { name: text },
            Some(Meaning::Dot | Meaning::Lagrangian | Meaning::Force(_) | Meaning::Function(_)) => {
                Message::FunctionWithoutArguments { name: text }
            }
            None => self.unknown(pool, text),
        };
        Err(error(name.span(), &message))
    }

    /// An entry of an array.
    fn entry(&mut self, pool: &mut Pool<Symbol>, name: &Ident, index: &Expression) -> Result<Expr> {
        if let Some(coordinate) = self.coordinate_entry(pool, name, index)? {
            return Ok(pool.symbol(Symbol::Continuous(Variable::Coordinate(coordinate))));
        }
        let text = name.to_string();
        if self.meaning(&text).is_none() {
            let mut errors = Errors::default();
            errors.at(name.span(), &self.unknown(pool, text));
            errors.keep(self.integer(pool, index));
            return errors.finish(pool.one());
        }
        let at = self.integer(pool, index)?;
        let of_coordinates: Vec<Expr>;
        let (first, entries) = match self.meaning(&text) {
            Some(Meaning::Array { first, entries }) => (*first, entries),
            Some(Meaning::Vector(entries)) => {
                of_coordinates = entries.iter().map(|entry| pool.symbol(entry.clone())).collect();
                (0, &of_coordinates)
            }
            Some(Meaning::Wrong) => return Ok(pool.one()),
            _ => return Err(error(name.span(), &self.no_array(pool, text))),
        };
        let offset = at.checked_sub(first).and_then(|offset| usize::try_from(offset).ok());
        let entry = offset.and_then(|offset| entries.get(offset));
        entry.copied().ok_or_else(|| {
            let end = first.saturating_add(i64::try_from(entries.len()).unwrap_or(i64::MAX));
            error(index.span, &Message::IndexRange { name: text, index: at, first, end })
        })
    }

    /// The number of the coordinate of an entry, if its array is an array of coordinates.
    ///
    /// # Errors
    /// The index is not an integer, or is out of range.
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

    /// The message for an index on a name that is not an array.
    fn no_array(&self, pool: &Pool<Symbol>, name: String) -> Message {
        match self.meaning(&name) {
            Some(Meaning::OfState) => Message::NotInRule { name },
            Some(Meaning::Moving) => Message::VelocityInTimeScale { name },
            Some(Meaning::Dot | Meaning::Lagrangian | Meaning::Force(_) | Meaning::Function(_)) => {
                Message::FunctionWithoutArguments { name }
            }
            Some(_) => Message::NotArray { name },
            None => self.unknown(pool, name),
        }
    }

    /// The message for an undeclared name.
    fn unknown(&self, pool: &Pool<Symbol>, name: String) -> Message {
        if name == "sum" || name == "sqrt" || Function::from_name(&name).is_some() {
            return Message::FunctionWithoutArguments { name };
        }
        if let Some(absence) = self.absence(&name) {
            return Message::Absent { name, absence };
        }
        if self.coordinate_of_acceleration(&name).is_some() {
            return Message::Acceleration { name };
        }
        if let Some(habit) = self.habit(&name) {
            return Message::Habit(habit);
        }
        let near = self.near(pool, &name);
        Message::Unknown { name, near }
    }

    fn call(&mut self, pool: &mut Pool<Symbol>, function: &Ident, arguments: &[Expression]) -> Result<Value> {
        let name = function.to_string();
        match self.meaning(&name).cloned() {
            Some(Meaning::Dot) => return self.rate(pool, function.span(), arguments).map(Value::Number),
            Some(Meaning::Lagrangian) => {
                let point = self.arguments_of_point(pool, function, arguments)?;
                return Ok(Value::Number(pool.symbol(at_point(Quantity::Lagrangian, point))));
            }
            Some(Meaning::Force(dimension)) => {
                let point = self.arguments_of_point(pool, function, arguments)?;
                let components = (0..dimension).map(|index| pool.symbol(at_point(Quantity::Force(index), point)));
                return Ok(Value::Vector(components.collect()));
            }
            Some(Meaning::Moving) => return Err(error(function.span(), &Message::VelocityInTimeScale { name })),
            Some(Meaning::Wrong) => return Ok(Value::Number(pool.one())),
            Some(Meaning::Function(called)) => {
                self.record_call(&name);
                let values = self.each_of(pool, arguments, Self::value)?;
                let spans = arguments.iter().map(|argument| argument.span).collect();
                return self.call_declared(pool, function, called, (values, spans));
            }
            None if CHOICES.contains(&name.as_str()) => return self.choice(pool, function, arguments),
            _ => {}
        }
        let known = Function::from_name(&name);
        let Some(takes) = known.map(Function::arity).or_else(|| (name == "sqrt").then_some(1)) else {
            if name == "ddot" {
                return Err(error(function.span(), &Message::Acceleration { name: "ddot(…)".to_owned() }));
            }
            if self.is_coordinate(&name) {
                return Err(error(function.span(), &Message::Habit(Habit::CoordinateWithArguments { name })));
            }
            if self.is_declared(&name) {
                let product = Habit::MissingOperator { left: name, right: "(…)".to_owned(), is_number: false };
                return Err(error(function.span(), &Message::Habit(product)));
            }
            let near = nearest(&name, self.functions());
            return Err(error(function.span(), &Message::UnknownFunction { name, near }));
        };
        if arguments.len() != takes {
            return Err(error(function.span(), &Message::Arity { name, takes, given: arguments.len() }));
        }
        let values = self.each_of(pool, arguments, Self::expression)?;
        Ok(Value::Number(match known {
            Some(Function::Pow) => power(pool, values[0], values[1]),
            Some(function) => pool.call(function, &values),
            None => {
                let half = pool.number(Rational::new(1.into(), 2.into()));
                power(pool, values[0], half)
            }
        }))
    }

    /// The point given by the arguments of L or f: time, coordinates, velocities.
    fn arguments_of_point(
        &mut self,
        pool: &mut Pool<Symbol>,
        function: &Ident,
        arguments: &[Expression],
    ) -> Result<usize> {
        let values = self.each_of(pool, arguments, Self::value)?;
        let [time, coordinates, velocities] = <[Value; 3]>::try_from(values).map_err(|values| {
            let name = function.to_string();
            error(function.span(), &Message::Arity { name, takes: 3, given: values.len() })
        })?;
        let point = Point {
            time: time.number(arguments[0].span)?,
            coordinates: coordinates.vector(arguments[1].span)?,
            velocities: velocities.vector(arguments[2].span)?,
        };
        let is_field = |symbol: &Symbol| matches!(symbol, Symbol::Field(_));
        if point.arguments().any(|(_, argument)| pool.depends_on(argument, &is_field)) {
            return Err(error(function.span(), &Message::FieldInArgument));
        }
        Ok(self.point(point))
    }

    /// The derivative of a written expression with respect to time: the velocity of a coordinate, and for X(t, q)
    ///
    /// ```text
    /// dot(X) = ∂X/∂t + Σ_i ∂X/∂q_i v_i
    /// ```
    fn rate(&mut self, pool: &mut Pool<Symbol>, span: Span, arguments: &[Expression]) -> Result<Expr> {
        let [argument] = arguments else {
            return Err(error(span, &Message::Arity { name: "dot".to_owned(), takes: 1, given: arguments.len() }));
        };
        let name = match &argument.kind {
            Kind::Name(name) | Kind::Entry(name, _) => Some(name),
            _ => None,
        };
        match (&argument.kind, name.and_then(|name| self.meaning(&name.to_string()))) {
            (_, Some(Meaning::Wrong)) => return Ok(pool.one()),
            (Kind::Name(_), Some(Meaning::Coordinate(coordinate))) => {
                return Ok(pool.symbol(Symbol::Continuous(Variable::Velocity(*coordinate))));
            }
            (Kind::Entry(name, index), Some(Meaning::Coordinates { .. })) => {
                if let Some(coordinate) = self.coordinate_entry(pool, name, index)? {
                    return Ok(pool.symbol(Symbol::Continuous(Variable::Velocity(coordinate))));
                }
            }
            (Kind::Call(inner, _), _) if inner == "dot" => {
                return Err(error(span, &Message::Acceleration { name: "dot(dot(…))".to_owned() }));
            }
            (Kind::Number(number), _) => {
                let number = pool.number(number.clone());
                let name = pool.render_within(CHARACTERS, number, &|_| String::new());
                return Err(error(argument.span, &Message::DotOfConstant { name }));
            }
            _ => {}
        }
        let value = self.expression(pool, argument)?;
        if let Some(name) = name.filter(|name| self.is_constant(pool, &name.to_string())) {
            return Err(error(name.span(), &Message::DotOfConstant { name: name.to_string() }));
        }
        if pool.depends_on(value, &|symbol| matches!(symbol, Symbol::Continuous(Variable::Velocity(_)))) {
            // Names an array entry without its index; other expressions have no name.
            let name = match &argument.kind {
                Kind::Name(name) => format!("dot({name})"),
                Kind::Entry(name, _) => format!("dot({name}[…])"),
                _ => "dot(…)".to_owned(),
            };
            return Err(error(argument.span, &Message::Acceleration { name }));
        }
        Ok(pool.derivative(value, &mut |pool, symbol| match symbol {
            Symbol::Continuous(Variable::Time) => pool.one(),
            Symbol::Continuous(Variable::Coordinate(index)) => {
                pool.symbol(Symbol::Continuous(Variable::Velocity(*index)))
            }
            _ => pool.zero(),
        }))
    }

    /// Whether a name denotes numbers independent of time and state.
    fn is_constant(&self, pool: &Pool<Symbol>, name: &str) -> bool {
        let changes = |expr: &Expr| pool.depends_on(*expr, &|symbol| matches!(symbol, Symbol::Continuous(_)));
        match self.meaning(name) {
            Some(Meaning::Pi) => true,
            Some(Meaning::Number(value)) => !changes(value),
            Some(Meaning::Array { entries, .. }) => !entries.iter().any(changes),
            _ => false,
        }
    }
}

/// A constant whose sign is known: 0 if its terms cancel, as in sqrt(2) sqrt(3) − sqrt(6). Other expressions unchanged.
fn cancelled(pool: &Pool<Symbol>, value: Expr) -> core::result::Result<Expr, Message> {
    if !pool.is_constant(value) || pool.as_number(value).is_some() {
        return Ok(value);
    }
    match pool.constant_sign(value) {
        Ok(Ordering::Equal) => Ok(pool.zero()),
        Ok(_) => Ok(value),
        Err(NoConstant::Undefined) => Err(Message::NoValue),
        Err(NoConstant::Undecided) => Err(Message::Undecided),
        Err(NoConstant::TooLarge | NoConstant::TooSmall) => Err(Message::NumberRange),
    }
}

/// Whether a divisor is identically zero: the number 0, or zero after h = t1 − t0.
fn is_zero(pool: &mut Pool<Symbol>, divisor: Expr) -> bool {
    if pool.is_zero(divisor) || pool.is_constant(divisor) || pool.as_symbol(divisor).is_some() {
        return pool.is_zero(divisor);
    }
    if pool.depends_on(divisor, &|symbol| *symbol == Symbol::T1) {
        let start = pool.symbol(Symbol::T0);
        let step = pool.symbol(Symbol::Step);
        let end = pool.add(start, step);
        let over_step = pool.substitute(divisor, &mut |_, symbol| (*symbol == Symbol::T1).then_some(end));
        return pool.is_zero(over_step);
    }
    false
}

/// `base^exponent`. A root that starts at a point gets a form of its base that is exactly zero before that point.
fn power(pool: &mut Pool<Symbol>, base: Expr, exponent: Expr) -> Expr {
    let is_root = !pool.as_number(exponent).is_some_and(Rational::is_integer);
    let base = if is_root { pool.with_ramps(base) } else { base };
    pool.call(Function::Pow, &[base, exponent])
}

/// L or a component of f at a point of the rule.
fn at_point(quantity: Quantity, point: usize) -> Symbol {
    Symbol::Field(Field { quantity, derivatives: Vec::new(), point })
}
