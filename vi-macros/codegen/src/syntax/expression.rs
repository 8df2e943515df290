//! Expressions, and the parser that gives `^` its mathematical precedence.
//!
//! In: tokens up to the end of an expression. Out: an [`Expression`] whose depth is bounded by [`DEPTH`]; sums and
//! products are chains, not nested pairs, so that a sum of a thousand terms is one level deep.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = unary { ("*" | "/") unary }
//! unary   = "-" unary | power
//! power   = atom [ "^" unary ]                  binds tightest, right-associative
//! atom    = number | name | name "[" sum "]" | name "(" sum { "," sum } ")" | "sum" "(" range "," sum ")" | "(" sum ")"
//! range   = name "in" sum ".." sum
//! ```

use crate::messages::{Message, error};
use num_traits::Zero;
use proc_macro2::{Ident, Span};
use syn::parse::ParseStream;
use syn::punctuated::Punctuated;
use syn::{Lit, Result, Token};
use vi_expr::Rational;

/// Levels of nesting that an expression may have.
pub(crate) const DEPTH: usize = 100;
/// Powers of ten that a literal may have, in absolute value; `f64` ends at 308.
const EXPONENT: i64 = 400;
/// Digits that a literal may have.
const DIGITS: usize = 800;

/// An expression as written, with the span of its first token.
pub struct Expression {
    /// The smallest token that names it.
    pub span: Span,
    /// What it is.
    pub kind: Kind,
}

/// What an expression can be.
pub enum Kind {
    /// An exact number.
    Number(Rational),
    /// A name.
    Name(Ident),
    /// An entry of an array.
    Entry(Ident, Box<Expression>),
    /// A function of its arguments.
    Call(Ident, Vec<Expression>),
    /// The sum of an expression over a range.
    Sum(Box<Range>, Box<Expression>),
    /// Minus an expression.
    Negative(Box<Expression>),
    /// Base and exponent.
    Power(Box<Expression>, Box<Expression>),
    /// Operands of one precedence, from left to right.
    Chain(Box<Expression>, Vec<(Operator, Expression)>),
}

/// `i in 0..8`: the index runs from the first bound up to, and without, the second.
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
    /// The message at the token that does not fit.
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
        let from = Self::sum(input, depth)?;
        if !input.peek(Token![..]) || input.peek(Token![..=]) {
            return Err(error(input.span(), &Message::Expected { what: "`..` and the end of the range" }));
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
            if input.peek(Token![*]) {
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
            input.parse::<Token![^]>()?;
            let exponent = Self::unary(input, depth + 1)?;
            return Ok(Self { span, kind: Kind::Power(Box::new(base), Box::new(exponent)) });
        }
        Ok(base)
    }

    fn atom(input: ParseStream, depth: usize) -> Result<Self> {
        let span = input.span();
        if input.peek(Lit) {
            return Ok(Self { span, kind: Kind::Number(number(&input.parse()?)?) });
        }
        if input.peek(syn::token::Paren) {
            let inner;
            syn::parenthesized!(inner in input);
            let expression = Self::sum(&inner, depth + 1)?;
            return end(&inner, "an operator or `)`").map(|()| expression);
        }
        let Ok(name) = input.parse::<Ident>() else {
            return Err(error(span, &Message::Expected { what: "a number, a name or `(`" }));
        };
        if input.peek(syn::token::Bracket) {
            let inner;
            syn::bracketed!(inner in input);
            let index = Self::sum(&inner, depth + 1)?;
            end(&inner, "an operator or `]`")?;
            return Ok(Self { span, kind: Kind::Entry(name, Box::new(index)) });
        }
        if !input.peek(syn::token::Paren) {
            return Ok(Self { span, kind: Kind::Name(name) });
        }
        let inner;
        syn::parenthesized!(inner in input);
        if name == "sum" {
            let range = Self::range(&inner, depth + 1)?;
            if !inner.peek(Token![,]) {
                return Err(error(inner.span(), &Message::Expected { what: "`,` and what is summed" }));
            }
            inner.parse::<Token![,]>()?;
            let summand = Self::sum(&inner, depth + 1)?;
            end(&inner, "an operator or `)`")?;
            return Ok(Self { span, kind: Kind::Sum(Box::new(range), Box::new(summand)) });
        }
        let mut arguments = Punctuated::<Self, Token![,]>::new();
        while !inner.is_empty() {
            arguments.push_value(Self::sum(&inner, depth + 1)?);
            if inner.is_empty() {
                break;
            }
            if !inner.peek(Token![,]) {
                return Err(error(inner.span(), &Message::Expected { what: "an operator, `,` or `)`" }));
            }
            arguments.push_punct(inner.parse()?);
        }
        Ok(Self { span, kind: Kind::Call(name, arguments.into_iter().collect()) })
    }
}

/// Nothing may be left in the parentheses.
fn end(inner: ParseStream, what: &'static str) -> Result<()> {
    if inner.is_empty() {
        return Ok(());
    }
    Err(error(inner.span(), &Message::Expected { what }))
}

/// The exact value of a literal.
fn number(literal: &Lit) -> Result<Rational> {
    let (digits, suffix, written) = match literal {
        Lit::Int(integer) => (integer.base10_digits().to_owned(), integer.suffix().to_owned(), integer.to_string()),
        Lit::Float(float) => (float.base10_digits().to_owned(), float.suffix().to_owned(), float.to_string()),
        _ => return Err(error(literal.span(), &Message::NotDecimal)),
    };
    if !suffix.is_empty() {
        return Err(error(literal.span(), &Message::NumberSuffix { digits, suffix }));
    }
    if written.starts_with("0x") || written.starts_with("0o") || written.starts_with("0b") {
        return Err(error(literal.span(), &Message::NotDecimal));
    }
    decimal(&digits).ok_or_else(|| error(literal.span(), &Message::NumberRange))
}

/// `12.5e-3` as 125/10000; `None` beyond the range of `f64`.
fn decimal(digits: &str) -> Option<Rational> {
    let (mantissa, exponent) = digits.split_once(['e', 'E']).unwrap_or((digits, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let exponent: i64 = exponent.parse().ok()?;
    let places = exponent.checked_sub(i64::try_from(fraction.len()).ok()?)?;
    if digits.len() > DIGITS || exponent.abs() > EXPONENT {
        return None;
    }
    let value = Rational::from_integer(format!("{whole}{fraction}").parse().ok()?);
    let power = num_traits::pow(Rational::from_integer(10.into()), usize::try_from(places.unsigned_abs()).ok()?);
    let value = if places < 0 { value / power } else { value * power };
    let rounded = num_traits::ToPrimitive::to_f64(&value)?;
    (rounded.is_finite() && (value.is_zero() || rounded.abs() >= f64::MIN_POSITIVE)).then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_traits::One;

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
}
