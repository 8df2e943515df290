//! Expressions, and the parser that gives `^` its mathematical precedence.
//!
//! In: tokens up to the end of an expression. Out: an [`Expression`] of depth at most [`DEPTH`]. Sums and products are
//! chains, not nested pairs: a sum of a thousand terms is one level deep.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = unary { ("*" | "/") unary }
//! unary   = "-" unary | power
//! power   = atom [ "^" unary ]                  binds tightest, right-associative
//! atom    = number | name { "[" sum "]" } | name "(" sum { "," sum } ")" | "sum" "(" range { "," range } "," sum ")"
//!         | "(" sum ")" | "[" sum { "," sum } "]" | if
//! if      = "if" (test | "(" test ")") "{" sum "}" "else" (if | "{" sum "}")
//! test    = sum (">" | ">=" | "<" | "<=") sum
//! range   = name "in" sum ".." sum
//! ```
//!
//! A list may end with a comma. A power `a^1/2` is rejected: it means `(a^1)/2`, which is never intended.

use super::tokens::{DEPTH, has_bracket};
use super::{INSIDE_BRACKETS, INSIDE_LIST, unexpected};
use crate::messages::{FunctionMistake, Habit, Message, error};
use num_bigint::BigInt;
use num_traits::{One, ToPrimitive, Zero};
use proc_macro2::{Ident, Literal, Span, TokenTree};
use syn::parse::ParseStream;
use syn::{Result, Token};
use vi_expr::Rational;

/// Maximum absolute exponent of a literal; `f64` ends at 308.
const EXPONENT: i64 = 400;
/// Maximum number of characters of a literal.
const DIGITS: usize = 800;
/// The largest power of five in a machine integer.
const FIVES: u32 = 27;

/// An expression as written, with the span of its main token.
pub struct Expression {
    /// The smallest token that names it.
    pub span: Span,
    /// Its kind, with its parts.
    pub kind: Kind,
}

/// The kinds of expressions.
pub enum Kind {
    /// An exact number.
    Number(Rational),
    /// A name.
    Name(Ident),
    /// An entry of an array, or a row of one.
    Entry(Ident, Vec<Expression>),
    /// A vector by its entries, or a matrix by its rows.
    List(Vec<Expression>),
    /// A function of its arguments.
    Call(Ident, Vec<Expression>),
    /// The sum of an expression over ranges; a range may use the indices of those before it.
    Sum(Vec<Range>, Box<Expression>),
    /// Minus an expression.
    Negative(Box<Expression>),
    /// Base and exponent.
    Power(Box<Expression>, Box<Expression>),
    /// Operands of one precedence, from left to right.
    Chain(Box<Expression>, Vec<(Operator, Expression)>),
    /// `if a > b { x } else { y }`: the comparison, x and y.
    If(Box<Comparison>, Box<[Expression; 2]>),
}

/// `a > b`, or one of the other three.
pub struct Comparison {
    /// The side that is larger where the comparison with `>` or `>=` holds.
    pub larger: Expression,
    /// The other side.
    pub smaller: Expression,
    /// Whether it also holds where both are equal.
    pub or_equal: bool,
    /// Whether it was written with `<` or `<=`.
    pub reversed: bool,
}

/// `i in 0..8`: the index runs from the first bound to the second, which is excluded.
pub struct Range {
    /// The index.
    pub index: Ident,
    /// Its first value.
    pub from: Expression,
    /// The value after its last.
    pub to: Expression,
}

/// The operators of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// `+`
    Plus,
    /// `-`
    Minus,
    /// `*`
    Times,
    /// `/`
    Over,
}

impl Expression {
    /// Parses one expression.
    ///
    /// # Errors
    /// A message at the unexpected token.
    pub fn parse(input: ParseStream) -> Result<Self> {
        Self::sum(input, 0)
    }

    /// Parses `i in 0..8`.
    pub(super) fn range(input: ParseStream, depth: usize) -> Result<Range> {
        let (index, expected) = (input.parse::<Ident>(), Message::Expected { what: "a range, as in `i in 0..8`" });
        let (Ok(index), true) = (index, input.peek(Token![in])) else {
            return Err(error(input.span(), &expected));
        };
        input.parse::<Token![in]>()?;
        let start = input.cursor();
        let from = Self::sum(input, depth)?;
        if input.peek(Token![..=]) {
            return Err(error(input.span(), &Message::Habit(Habit::InclusiveRange)));
        }
        if !input.peek(Token![..]) {
            return Err(unexpected::operator(input, start, "`..` and the end of the range"));
        }
        input.parse::<Token![..]>()?;
        Ok(Range { index, from, to: Self::sum(input, depth)? })
    }

    fn sum(input: ParseStream, depth: usize) -> Result<Self> {
        Self::chain(input, Self::product, depth, |input| {
            if input.peek(Token![+]) {
                input.parse::<Token![+]>().map(|_| Some(Operator::Plus))
            } else if input.peek(Token![-]) {
                input.parse::<Token![-]>().map(|_| Some(Operator::Minus))
            } else {
                Ok(None)
            }
        })
    }

    fn product(input: ParseStream, depth: usize) -> Result<Self> {
        Self::chain(input, Self::unary, depth, |input| {
            if input.peek(Token![*]) && input.peek2(Token![*]) {
                Err(error(input.span(), &Message::Habit(Habit::DoubleStar)))
            } else if input.peek(Token![*]) {
                input.parse::<Token![*]>().map(|_| Some(Operator::Times))
            } else if input.peek(Token![/]) {
                input.parse::<Token![/]>().map(|_| Some(Operator::Over))
            } else {
                Ok(None)
            }
        })
    }

    fn chain(
        input: ParseStream,
        operand: fn(ParseStream, usize) -> Result<Self>,
        depth: usize,
        operator: fn(ParseStream) -> Result<Option<Operator>>,
    ) -> Result<Self> {
        let first = operand(input, depth)?;
        let mut rest = Vec::new();
        while let Some(operator) = operator(input)? {
            rest.push((operator, operand(input, depth)?));
        }
        if rest.is_empty() {
            return Ok(first);
        }
        Ok(Self { span: first.span, kind: Kind::Chain(Box::new(first), rest) })
    }

    fn unary(input: ParseStream, depth: usize) -> Result<Self> {
        if depth >= DEPTH {
            return Err(error(input.span(), &Message::TooDeep { limit: DEPTH }));
        }
        let span = input.span();
        if input.peek(Token![-]) {
            input.parse::<Token![-]>()?;
            let operand = Self::unary(input, depth + 1)?;
            return Ok(Self { span, kind: Kind::Negative(Box::new(operand)) });
        }
        let base = Self::atom(input, depth)?;
        if input.peek(Token![^]) {
            if let Kind::Name(name) = &base.kind
                && unexpected::is_function(name)
            {
                return Err(error(name.span(), &Message::FunctionWithoutArguments { name: name.to_string() }));
            }
            input.parse::<Token![^]>()?;
            let exponent = Self::unary(input, depth + 1)?;
            if input.peek(Token![/]) && input.peek2(syn::LitInt) {
                exponent.is_no_numerator()?;
            }
            return Ok(Self { span, kind: Kind::Power(Box::new(base), Box::new(exponent)) });
        }
        Ok(base)
    }

    /// Rejects an exponent 1 or -1 followed by a division: `a^1/2` never means half of a.
    fn is_no_numerator(&self) -> Result<()> {
        let (number, exponent) = match &self.kind {
            Kind::Negative(positive) => (&positive.kind, "-1"),
            other => (other, "1"),
        };
        match number {
            Kind::Number(number) if number.is_one() => {
                Err(error(self.span, &Message::Habit(Habit::PowerOverNumber { exponent })))
            }
            _ => Ok(()),
        }
    }

    /// Each form has a function of its own: a stack frame that holds what all of them need would be repeated at each
    /// level of nesting.
    fn atom(input: ParseStream, depth: usize) -> Result<Self> {
        if input.cursor().literal().is_some() {
            Self::literal(input)
        } else if input.peek(syn::token::Paren) {
            Self::parenthesis(input, depth)
        } else if input.peek(Token![if]) {
            Self::condition(input, depth)
        } else if input.peek(syn::token::Bracket) {
            Self::vector(input, depth)
        } else {
            Self::named(input, depth)
        }
    }

    fn literal(input: ParseStream) -> Result<Self> {
        let literal = input.parse::<Literal>()?;
        Ok(Self { span: literal.span(), kind: Kind::Number(number(&literal)?) })
    }

    fn parenthesis(input: ParseStream, depth: usize) -> Result<Self> {
        let inner;
        syn::parenthesized!(inner in input);
        Self::alone(&inner, depth, "an operator or `)`")
    }

    fn vector(input: ParseStream, depth: usize) -> Result<Self> {
        let span = input.span();
        let inner;
        syn::bracketed!(inner in input);
        Ok(Self { span, kind: Kind::List(Self::list(&inner, depth + 1, INSIDE_LIST)?) })
    }

    /// A name, alone or before its indices or arguments.
    fn named(input: ParseStream, depth: usize) -> Result<Self> {
        let span = input.span();
        let Ok(name) = input.parse::<Ident>() else {
            return Err(unexpected::operand(input));
        };
        let kind = if input.peek(syn::token::Bracket) {
            let indices = Self::indices(input, depth)?;
            Kind::Entry(name, indices)
        } else if input.peek(syn::token::Paren) {
            Self::call(input, name, depth)?
        } else {
            Kind::Name(name)
        };
        Ok(Self { span, kind })
    }

    fn indices(input: ParseStream, depth: usize) -> Result<Vec<Self>> {
        let mut indices = Vec::new();
        while has_bracket(input, indices.len())? {
            let inner;
            syn::bracketed!(inner in input);
            indices.push(Self::alone(&inner, depth, INSIDE_BRACKETS)?);
        }
        Ok(indices)
    }

    fn call(input: ParseStream, name: Ident, depth: usize) -> Result<Kind> {
        let inner;
        syn::parenthesized!(inner in input);
        if name == "sum" {
            return Self::sum_over(&inner, depth);
        }
        if inner.peek(syn::Ident) && inner.peek2(Token![in]) {
            return Err(error(name.span(), &Message::Habit(Habit::RangeOf { function: name.to_string() })));
        }
        let arguments = Self::list(&inner, depth + 1, "an operator, `,` or `)`");
        // `Piecewise((x, x > 0), …)`: the name is the mistake, not what stands in the parentheses.
        let arguments = arguments.map_err(|failure| unexpected::call(&name).unwrap_or(failure))?;
        Ok(Kind::Call(name, arguments))
    }

    /// `i in 0..8, x`, between the parentheses of a `sum`. Several ranges are as deep as sums inside each other.
    fn sum_over(inner: ParseStream, mut depth: usize) -> Result<Kind> {
        let mut ranges = Vec::new();
        while ranges.is_empty() || inner.peek(syn::Ident) && inner.peek2(Token![in]) {
            depth += 1;
            ranges.push(Self::range(inner, depth)?);
            if !inner.peek(Token![,]) {
                return Err(error(inner.span(), &Message::Expected { what: "`,` and what is summed" }));
            }
            inner.parse::<Token![,]>()?;
        }
        let start = inner.cursor();
        let summand = Self::sum(inner, depth)?;
        if inner.peek(Token![,]) {
            inner.parse::<Token![,]>()?;
        }
        if !inner.is_empty() {
            return Err(unexpected::operator(inner, start, "an operator or `)`"));
        }
        Ok(Kind::Sum(ranges, Box::new(summand)))
    }

    /// `if a > b { x } else { y }`, with `else if` as the other arm.
    fn condition(input: ParseStream, depth: usize) -> Result<Self> {
        if depth >= DEPTH {
            return Err(error(input.span(), &Message::TooDeep { limit: DEPTH }));
        }
        let span = input.span();
        input.parse::<Token![if]>()?;
        let in_parentheses = input.peek(syn::token::Paren);
        if in_parentheses && (input.peek2(Token![&&]) || input.peek2(Token![||])) {
            input.parse::<TokenTree>()?;
            return Err(error(input.span(), &Message::Function(FunctionMistake::Comparison)));
        }
        let comparison = if in_parentheses && input.peek2(syn::token::Brace) {
            let inner;
            syn::parenthesized!(inner in input);
            Self::comparison(&inner, depth + 1, span)?
        } else {
            Self::comparison(input, depth + 1, span)?
        };
        let then = Self::arm(input, depth + 1)?;
        if !input.peek(Token![else]) {
            return Err(error(span, &Message::Function(FunctionMistake::Else)));
        }
        input.parse::<Token![else]>()?;
        let otherwise =
            if input.peek(Token![if]) { Self::condition(input, depth + 1)? } else { Self::arm(input, depth + 1)? };
        Ok(Self { span, kind: Kind::If(Box::new(comparison), Box::new([then, otherwise])) })
    }

    /// The comparison of an `if` at this place, up to a brace or the end.
    fn comparison(input: ParseStream, depth: usize, condition: Span) -> Result<Comparison> {
        let left = Self::sum(input, depth)?;
        let (reversed, or_equal) = if input.peek(Token![>=]) {
            input.parse::<Token![>=]>().map(|_| (false, true))?
        } else if input.peek(Token![<=]) {
            input.parse::<Token![<=]>().map(|_| (true, true))?
        } else if input.peek(Token![>]) && !input.peek(Token![>>]) {
            input.parse::<Token![>]>().map(|_| (false, false))?
        } else if input.peek(Token![<]) && !input.peek(Token![<<]) {
            input.parse::<Token![<]>().map(|_| (true, false))?
        } else {
            if input.cursor().ident().is_some_and(|(word, _)| word == "then") {
                return Err(error(input.span(), &Message::Function(FunctionMistake::Else)));
            }
            let is_end = input.is_empty() || input.peek(syn::token::Brace);
            let span = if is_end { condition } else { input.span() };
            return Err(error(span, &Message::Function(FunctionMistake::Comparison)));
        };
        let right = Self::sum(input, depth)?;
        if input.cursor().ident().is_some_and(|(word, _)| word == "then") {
            return Err(error(input.span(), &Message::Function(FunctionMistake::Else)));
        }
        if !(input.is_empty() || input.peek(syn::token::Brace)) {
            return Err(error(input.span(), &Message::Function(FunctionMistake::Comparison)));
        }
        let (larger, smaller) = if reversed { (right, left) } else { (left, right) };
        Ok(Comparison { larger, smaller, or_equal, reversed })
    }

    /// `{ x }`
    fn arm(input: ParseStream, depth: usize) -> Result<Self> {
        if !input.peek(syn::token::Brace) {
            return Err(error(input.span(), &Message::Function(FunctionMistake::Else)));
        }
        let inner;
        syn::braced!(inner in input);
        Self::alone(&inner, depth, "an operator or `}`")
    }

    /// The only expression between delimiters; `what` names the expected end.
    pub(super) fn alone(inner: ParseStream, depth: usize, what: &'static str) -> Result<Self> {
        let start = inner.cursor();
        let expression = Self::sum(inner, depth + 1)?;
        if inner.is_empty() { Ok(expression) } else { Err(unexpected::operator(inner, start, what)) }
    }

    /// Expressions between delimiters, separated by commas; `what` names the expected tokens.
    pub(super) fn list(inner: ParseStream, depth: usize, what: &'static str) -> Result<Vec<Self>> {
        let mut expressions = Vec::new();
        while !inner.is_empty() {
            let start = inner.cursor();
            expressions.push(Self::sum(inner, depth)?);
            if inner.is_empty() {
                break;
            }
            if !inner.peek(Token![,]) {
                return Err(unexpected::operator(inner, start, what));
            }
            inner.parse::<Token![,]>()?;
        }
        Ok(expressions)
    }
}

/// The exact value of a literal.
fn number(literal: &Literal) -> Result<Rational> {
    let span = literal.span();
    let text = literal.to_string();
    let based = ["0x", "0o", "0b"].iter().any(|base| text.starts_with(base));
    if based || !text.starts_with(|first: char| first.is_ascii_digit()) {
        let is_text = literal.to_string().starts_with('"');
        let text = Message::Function(FunctionMistake::Text);
        return Err(error(span, if is_text { &text } else { &Message::NotDecimal }));
    }
    if text.len() > DIGITS {
        return Err(error(span, &Message::NumberRange));
    }
    let text = text.replace('_', "");
    let (digits, suffix) = text.split_at(length(&text));
    if !suffix.is_empty() {
        return Err(error(span, &Message::Habit(Habit::of_suffix(digits, suffix))));
    }
    decimal(digits).ok_or_else(|| error(span, &Message::NumberRange))
}

/// The number of characters of a literal that form its number: `12.5e-3` of `12.5e-3kg`.
fn length(text: &str) -> usize {
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let mut length = digits(0);
    if text[length..].starts_with('.') {
        length += 1;
        length += digits(length);
    }
    if text[length..].starts_with(['e', 'E']) {
        let sign = usize::from(text[length + 1..].starts_with(['+', '-']));
        let exponent = digits(length + 1 + sign);
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    length
}

/// `12.5e-3` as 125/10000; `None` outside the range of `f64`.
fn decimal(digits: &str) -> Option<Rational> {
    let (mantissa, exponent) = digits.split_once(['e', 'E']).unwrap_or((digits, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let exponent: i64 = exponent.parse().ok()?;
    if exponent.abs() > EXPONENT {
        return None;
    }
    let places = exponent.checked_sub(i64::try_from(fraction.len()).ok()?)?;
    let value: BigInt = format!("{whole}{fraction}").parse().ok()?;
    let power = u32::try_from(places.unsigned_abs()).ok()?;
    let value = if places < 0 { over_power_of_ten(value, power) } else { (value * BigInt::from(10).pow(power)).into() };
    let rounded = value.to_f64()?;
    (rounded.is_finite() && (value.is_zero() || rounded.abs() >= f64::MIN_POSITIVE)).then_some(value)
}

/// `number / 10^power` in lowest terms. Only twos and fives can be common, and removing them is faster than a gcd.
fn over_power_of_ten(mut number: BigInt, power: u32) -> Rational {
    if number.is_zero() {
        return Rational::zero();
    }
    let twos = number.trailing_zeros().and_then(|twos| u32::try_from(twos).ok()).unwrap_or(u32::MAX).min(power);
    number >>= twos;
    let mut fives = 0;
    // Up to one machine integer at a time.
    for together in [FIVES, 1] {
        let divisor = BigInt::from(5).pow(together);
        while fives + together <= power && (&number % &divisor).is_zero() {
            number /= &divisor;
            fives += together;
        }
    }
    Rational::new_raw(number, BigInt::from(5).pow(power - fives) << (power - twos))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_exact() {
        assert_eq!(decimal("0.1"), Some(Rational::new(1.into(), 10.into())));
        assert_eq!(decimal("12.5e-3"), Some(Rational::new(1.into(), 80.into())));
        assert_eq!(decimal("3e2"), Some(Rational::from_integer(300.into())));
        assert_eq!(decimal("1"), Some(Rational::one()));
        assert_eq!(decimal("0.000"), Some(Rational::zero()));
        assert_eq!(decimal("1e309"), None);
        assert_eq!(decimal("1e-330"), None);
        assert_eq!(decimal("1e99999999999999999999"), None);
    }

    #[test]
    fn decimals_are_in_lowest_terms() {
        for (digits, power) in [(1_i64, 3), (125, 3), (16, 2), (390_625, 9), (1000, 2), (30, 2), (0, 5)] {
            let number = BigInt::from(digits) * BigInt::from(5).pow(60) * BigInt::from(2).pow(20);
            let found = over_power_of_ten(number.clone(), power + 70);
            let wanted = Rational::new(number, BigInt::from(10).pow(power + 70));
            assert_eq!((found.numer(), found.denom()), (wanted.numer(), wanted.denom()), "{digits}");
        }
    }

    #[test]
    fn a_number_ends_where_its_unit_begins() {
        for (text, length_of_number) in
            [("12", 2), ("1.5e-3kg", 6), ("2x", 1), ("2e", 1), ("1f64", 1), ("1.", 2), ("1e+x", 1)]
        {
            assert_eq!(length(text), length_of_number, "{text}");
        }
    }
}
