//! Resolves written expressions to exact ones.
//!
//! In: an [`Expression`] and the names in [`Scope`]. Out: a [`Value`] of the pool, or a message at the token. An
//! expression of a system is a number, a vector or a matrix. In a rule, the coordinates at an end and the force are
//! vectors.

use super::closed::rate;
use super::point::Point;
use super::scope::{CHOICES, Meaning, OF_VECTORS, Scope};
use super::value::{Value, brackets, not_a_number, power, spelled};
use crate::limits::bounded;
use crate::messages::{ArrayMistake, ConstraintMistake, Errors, Habit, Message, error, nearest};
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

impl Scope {
    /// The exact number of a written expression.
    ///
    /// # Errors
    /// The errors of [`Self::value`], and a vector.
    pub(super) fn expression(&mut self, pool: &mut Pool<Symbol>, written: &Expression) -> Result<Expr> {
        match self.value(pool, written)? {
            Value::Number(value) | Value::Wrong(value) => Ok(value),
            Value::Tensor(tensor) => Err(not_a_number(written, &tensor.shape)),
        }
    }

    /// The exact value of a written expression.
    ///
    /// # Errors
    /// Unknown names, wrong arguments, no value (such as a division by zero), too much work: at the token.
    pub(super) fn value(&mut self, pool: &mut Pool<Symbol>, written: &Expression) -> Result<Value> {
        pool.spend(READING);
        let levels = if let Kind::Sum(ranges, _) = &written.kind { ranges.len() } else { 1 };
        self.deepen(levels, written.span)?;
        let value = self.kind(pool, written);
        self.rise(levels);
        decided(pool, written, value?)
    }

    /// The value by the kind of the expression. Each kind has a function of its own: a stack frame that holds what all
    /// of them need would be repeated at each level of nesting.
    fn kind(&mut self, pool: &mut Pool<Symbol>, written: &Expression) -> Result<Value> {
        match &written.kind {
            Kind::Number(value) => Ok(Value::Number(pool.number(value.clone()))),
            Kind::Name(name) => self.name(pool, name),
            Kind::Entry(name, indices) => self.entry(pool, name, indices),
            Kind::List(entries) => self.list(pool, written.span, entries),
            Kind::Call(function, arguments) => self.call(pool, function, arguments),
            Kind::Sum(ranges, summand) => self.sum_over(pool, ranges, summand),
            Kind::Negative(operand) => self.negative(pool, operand),
            Kind::Power(base, exponent) => self.power_of(pool, base, exponent),
            Kind::Chain(first, rest) => self.chain(pool, first, rest),
            Kind::If(comparison, arms) => self.condition(pool, comparison, arms),
        }
    }

    fn sum_over(&mut self, pool: &mut Pool<Symbol>, ranges: &[Range], summand: &Expression) -> Result<Value> {
        let mut terms = Vec::new();
        self.terms(pool, ranges, summand, &mut terms)?;
        Value::sum(pool, terms.into_iter().map(|term| (term, summand.span)).collect())
    }

    fn negative(&mut self, pool: &mut Pool<Symbol>, operand: &Expression) -> Result<Value> {
        Ok(self.value(pool, operand)?.map(|operand| pool.neg(operand)))
    }

    fn power_of(&mut self, pool: &mut Pool<Symbol>, base: &Expression, exponent: &Expression) -> Result<Value> {
        if let Kind::Name(name) = &exponent.kind
            && name == "T"
            && self.meaning("T").is_none()
        {
            let mistake = ArrayMistake::Transposed { name: spelled(base) };
            return Err(error(exponent.span, &Message::Array(mistake)));
        }
        let operands = self.each_of(pool, [base, exponent], Self::value)?;
        raised(pool, &operands, [base, exponent])
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
        let others = rest.iter().map(|(operator, written)| (*operator, written));
        let operands = self.each_of(pool, [(leading, first)].into_iter().chain(others), Self::operand)?;
        let made = if is_sum { Value::sum(pool, operands) } else { Value::product(pool, operands) };
        made.map_err(|mistake| match brackets_of(first, rest) {
            Some(span) => error(span, &Message::Habit(Habit::OtherBrackets)),
            None => mistake,
        })
    }

    /// The summands over nested ranges, in order.
    fn terms(
        &mut self,
        pool: &mut Pool<Symbol>,
        ranges: &[Range],
        summand: &Expression,
        terms: &mut Vec<Value>,
    ) -> Result<()> {
        let Some((range, inner)) = ranges.split_first() else {
            terms.push(self.value(pool, summand)?);
            return Ok(());
        };
        self.each(pool, range, &mut |scope, pool, _| scope.terms(pool, inner, summand, terms))?;
        Ok(())
    }

    /// A list of numbers, or of rows of one shape.
    fn list(&mut self, pool: &mut Pool<Symbol>, span: Span, written: &[Expression]) -> Result<Value> {
        let values = self.each_of(pool, written, Self::value)?;
        if let Some(wrong) = values.iter().find(|value| matches!(value, Value::Wrong(_))) {
            return Ok(wrong.clone());
        }
        let Some(first) = values.first() else {
            return Err(error(span, &Message::Array(ArrayMistake::EmptyList)));
        };
        if let Some((other, written)) = values.iter().zip(written).find(|(value, _)| value.shape() != first.shape()) {
            let (first, other) = (first.shape().to_vec(), other.shape().to_vec());
            return Err(error(written.span, &Message::Array(ArrayMistake::Rows { first, other })));
        }
        let shape: Vec<usize> = [values.len()].iter().chain(first.shape()).copied().collect();
        let entries = values.iter().flat_map(Value::entries).copied().collect();
        Ok(Value::of_shape(&shape, entries))
    }

    /// A term or factor with its place: negated after `-`, inverted after `/`.
    fn operand(&mut self, pool: &mut Pool<Symbol>, of: (Operator, &Expression)) -> Result<(Value, Span)> {
        let (operator, written) = of;
        let operand = self.value(pool, written)?;
        let operand = match operator {
            Operator::Plus | Operator::Times => operand,
            Operator::Minus => operand.map(|operand| pool.neg(operand)),
            Operator::Over => {
                let divisor = match operand {
                    Value::Number(value) | Value::Wrong(value) => value,
                    Value::Tensor(tensor) => return Err(not_a_number(written, &tensor.shape)),
                };
                if is_zero(pool, divisor) {
                    return Err(error(written.span, &Message::DivisionByZero));
                }
                Value::Number(pool.power(divisor, &Rational::from_integer((-1).into())))
            }
        };
        Ok((operand, written.span))
    }

    fn name(&mut self, pool: &mut Pool<Symbol>, name: &Ident) -> Result<Value> {
        let text = name.to_string();
        let message = match self.meaning(&text) {
            Some(Meaning::Number(value)) => return Ok(Value::Number(*value)),
            Some(Meaning::Wrong) => return Ok(Value::Wrong(pool.one())),
            Some(Meaning::Pi) => return Ok(Value::Number(pool.pi())),
            Some(Meaning::Symbol(symbol)) => return Ok(Value::Number(pool.symbol(symbol.clone()))),
            Some(Meaning::Coordinate(index)) => {
                return Ok(Value::Number(pool.symbol(Symbol::Continuous(Variable::Coordinate(*index)))));
            }
            Some(Meaning::Vector(_) | Meaning::Array(_) | Meaning::Coordinates { .. }) => {
                return self.whole(pool, name);
            }
            Some(Meaning::OfState) => Message::NotInRule { name: text },
            Some(Meaning::Constraint) => Message::Constraint(ConstraintMistake::Value { name: text }),
            Some(Meaning::Moving(clause)) => Message::VelocityIn { name: text, clause },
            Some(Meaning::Dot | Meaning::Lagrangian | Meaning::Force(_) | Meaning::Function(_)) => {
                Message::FunctionWithoutArguments { name: text }
            }
            None => self.unknown(pool, text),
        };
        Err(error(name.span(), &message))
    }

    /// The message for an index on a name that is not an array.
    pub(super) fn no_array(&self, pool: &Pool<Symbol>, name: String) -> Message {
        match self.meaning(&name) {
            Some(Meaning::OfState) => Message::NotInRule { name },
            Some(Meaning::Constraint) => Message::Constraint(ConstraintMistake::Value { name }),
            Some(Meaning::Moving(clause)) => Message::VelocityIn { name, clause },
            Some(Meaning::Dot | Meaning::Lagrangian | Meaning::Force(_) | Meaning::Function(_)) => {
                Message::FunctionWithoutArguments { name }
            }
            Some(_) => Message::NotArray { name },
            None => self.unknown(pool, name),
        }
    }

    /// The message for an undeclared name.
    pub(super) fn unknown(&self, pool: &Pool<Symbol>, name: String) -> Message {
        let is_function = ["sum", "sqrt"].into_iter().chain(OF_VECTORS).any(|function| function == name);
        if is_function || Function::from_name(&name).is_some() {
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
            Some(Meaning::Dot) => self.rate(pool, function.span(), arguments),
            Some(Meaning::Lagrangian) => {
                let point = self.arguments_of_point(pool, function, arguments)?;
                Ok(Value::Number(pool.symbol(at_point(Quantity::Lagrangian, point))))
            }
            Some(Meaning::Force(dimension)) => {
                let point = self.arguments_of_point(pool, function, arguments)?;
                let components = (0..dimension).map(|index| pool.symbol(at_point(Quantity::Force(index), point)));
                Ok(Value::vector_of(components.collect()))
            }
            Some(Meaning::Moving(clause)) => Err(error(function.span(), &Message::VelocityIn { name, clause })),
            Some(Meaning::Wrong) => Ok(Value::Number(pool.one())),
            Some(Meaning::Function(called)) => {
                self.record_call(&name);
                let values = self.each_of(pool, arguments, Self::value)?;
                let spans = arguments.iter().map(|argument| argument.span).collect();
                self.call_declared(pool, function, called, (values, spans))
            }
            None if CHOICES.contains(&name.as_str()) => self.choice(pool, function, arguments),
            _ => self.call_elementary(pool, function, arguments),
        }
    }

    /// An elementary function of these arguments, or one of vectors or rotations.
    fn call_elementary(
        &mut self,
        pool: &mut Pool<Symbol>,
        function: &Ident,
        arguments: &[Expression],
    ) -> Result<Value> {
        let name = function.to_string();
        let known = Function::from_name(&name);
        let Some(takes) = known.map(Function::arity).or_else(|| (name == "sqrt").then_some(1)) else {
            return self.call_other(pool, function, arguments);
        };
        let values = self.arguments(pool, function, takes, arguments)?;
        let values = numbers(&name, values, arguments)?;
        Ok(Value::Number(match known {
            Some(Function::Pow) => power(pool, values[0], values[1]),
            Some(function) => pool.call(function, &values),
            None => {
                let half = pool.number(Rational::new(1.into(), 2.into()));
                power(pool, values[0], half)
            }
        }))
    }

    /// The arguments of a function that takes this many.
    pub(super) fn arguments(
        &mut self,
        pool: &mut Pool<Symbol>,
        function: &Ident,
        takes: usize,
        given: &[Expression],
    ) -> Result<Vec<Value>> {
        if given.len() != takes {
            let message = Message::Arity { name: function.to_string(), takes, given: given.len() };
            return Err(error(function.span(), &message));
        }
        self.each_of(pool, given, Self::value)
    }

    /// A function of vectors or rotations, or the message for a name that is no function.
    fn call_other(&mut self, pool: &mut Pool<Symbol>, function: &Ident, arguments: &[Expression]) -> Result<Value> {
        if let Some(message) = self.no_function(&function.to_string()) {
            return Err(error(function.span(), &message));
        }
        if let Some(value) = self.of_vectors(pool, function, arguments)? {
            return Ok(value);
        }
        if let Some(value) = self.of_rotation(pool, function, arguments)? {
            return Ok(value);
        }
        let name = function.to_string();
        let near = nearest(&name, self.functions());
        Err(error(function.span(), &Message::UnknownFunction { name, near }))
    }

    /// The message for a call of a name that has another meaning.
    fn no_function(&self, name: &str) -> Option<Message> {
        let text = name.to_owned();
        if name == "reaction" && !self.is_declared(name) {
            return Some(Message::Constraint(ConstraintMistake::Reaction));
        }
        if name == "ddot" {
            return Some(Message::Acceleration { name: "ddot(…)".to_owned() });
        }
        if matches!(self.meaning(name), Some(Meaning::Array(_) | Meaning::Coordinates { .. })) {
            return Some(Message::Habit(Habit::EntryInParentheses { name: text }));
        }
        if self.is_coordinate(name) {
            return Some(Message::Habit(Habit::CoordinateWithArguments { name: text }));
        }
        let product = Habit::MissingOperator { left: text, right: "(…)".to_owned(), is_number: false };
        self.is_declared(name).then_some(Message::Habit(product))
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
    ///
    /// and the same of each entry of a vector or a matrix.
    pub(super) fn rate(&mut self, pool: &mut Pool<Symbol>, span: Span, arguments: &[Expression]) -> Result<Value> {
        let [argument] = arguments else {
            if let [_, _] = arguments {
                return Err(error(span, &Message::Array(ArrayMistake::InnerProduct)));
            }
            return Err(error(span, &Message::Arity { name: "dot".to_owned(), takes: 1, given: arguments.len() }));
        };
        let (name, indices) = match &argument.kind {
            Kind::Name(name) => (Some(name), [].as_slice()),
            Kind::Entry(name, indices) => (Some(name), indices.as_slice()),
            _ => (None, [].as_slice()),
        };
        if let Some(name) = name
            && let Some(velocities) = self.velocities(pool, name, indices)?
        {
            return Ok(velocities);
        }
        match (&argument.kind, name.and_then(|name| self.meaning(&name.to_string()))) {
            (_, Some(Meaning::Wrong)) => return Ok(Value::Wrong(pool.one())),
            (Kind::Name(_), Some(Meaning::Coordinate(coordinate))) => {
                return Ok(Value::Number(pool.symbol(Symbol::Continuous(Variable::Velocity(*coordinate)))));
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
        let value = self.value(pool, argument)?;
        if let Some(name) = name.filter(|name| self.is_constant(pool, &name.to_string())) {
            return Err(error(name.span(), &Message::DotOfConstant { name: name.to_string() }));
        }
        let is_velocity =
            |symbol: &Symbol| matches!(symbol, Symbol::Continuous(Variable::Velocity(_)) | Symbol::Momentum(_));
        if value.entries().iter().any(|entry| pool.depends_on(*entry, &is_velocity)) {
            // Names an array entry without its index; other expressions have no name.
            let name = match &argument.kind {
                Kind::Name(name) => format!("dot({name})"),
                Kind::Entry(name, _) => format!("dot({name}[…])"),
                _ => "dot(…)".to_owned(),
            };
            return Err(error(argument.span, &Message::Acceleration { name }));
        }
        Ok(value.map(|entry| rate(pool, entry)))
    }

    /// Whether a name denotes numbers independent of time and state.
    fn is_constant(&self, pool: &Pool<Symbol>, name: &str) -> bool {
        let moves = |symbol: &Symbol| matches!(symbol, Symbol::Continuous(_) | Symbol::Momentum(_) | Symbol::Let(_));
        let changes = |expr: &Expr| pool.depends_on(*expr, &moves);
        match self.meaning(name) {
            Some(Meaning::Pi) => true,
            Some(Meaning::Number(value)) => !changes(value),
            Some(Meaning::Array(array)) => !array.any(&changes),
            _ => false,
        }
    }
}

/// `base^exponent` of these operands.
fn raised(pool: &mut Pool<Symbol>, operands: &[Value], written: [&Expression; 2]) -> Result<Value> {
    if let Some(Value::Tensor(tensor)) = operands.first() {
        let mistake = match (&tensor.shape[..], &written[1].kind) {
            ([_, _], Kind::Negative(_)) => ArrayMistake::Inverse,
            (shape, _) => ArrayMistake::Power { given: shape.to_vec(), name: spelled(written[0]) },
        };
        return Err(error(written[0].span, &Message::Array(mistake)));
    }
    let numbers = operands.iter().zip(written).map(|(operand, written)| match operand {
        Value::Number(value) | Value::Wrong(value) => Ok(*value),
        Value::Tensor(tensor) => Err(not_a_number(written, &tensor.shape)),
    });
    let numbers = numbers.collect::<Result<Vec<Expr>>>()?;
    Ok(Value::Number(power(pool, numbers[0], numbers[1])))
}

/// The value of an expression, with constants whose terms cancel as 0.
///
/// # Errors
/// It is too large, or has no value.
fn decided(pool: &Pool<Symbol>, written: &Expression, value: Value) -> Result<Value> {
    let mut wrong = None;
    let value = value.map(|entry| {
        cancelled(pool, entry).unwrap_or_else(|message| {
            wrong = Some(message);
            entry
        })
    });
    bounded(pool).map_err(|found| error(written.span, &Message::TooLarge { size: found }))?;
    if value.entries().iter().any(|entry| pool.is_undefined(*entry)) {
        return Err(error(written.span, &Message::NoValue));
    }
    match wrong {
        Some(message) => Err(error(written.span, &message)),
        None => Ok(value),
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

/// The place of brackets that stand for parentheses in a chain.
fn brackets_of(first: &Expression, rest: &[(Operator, Expression)]) -> Option<Span> {
    [first].into_iter().chain(rest.iter().map(|(_, operand)| operand)).find_map(brackets)
}

/// The arguments of an elementary function.
fn numbers(function: &str, values: Vec<Value>, written: &[Expression]) -> Result<Vec<Expr>> {
    let numbers = values.into_iter().zip(written).map(|(value, written)| match value {
        Value::Number(value) | Value::Wrong(value) => Ok(value),
        Value::Tensor(tensor) => {
            let (function, given) = (function.to_owned(), tensor.shape);
            let mistake = ArrayMistake::Function { function, given, name: spelled(written) };
            Err(error(written.span, &Message::Array(mistake)))
        }
    });
    numbers.collect()
}

/// L or a component of f at a point of the rule.
fn at_point(quantity: Quantity, point: usize) -> Symbol {
    Symbol::Field(Field { quantity, derivatives: Vec::new(), point })
}
