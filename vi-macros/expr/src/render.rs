//! Plain text.
//!
//! In: an expression and a name for each symbol. Out: text as in a textbook, `m*v^2/2 - k*x^2/2`, with necessary
//! parentheses only, subtraction, division and `sqrt`; `1e150` for a number with many digits. The text ends with `…`
//! after [`MAX_CHARACTERS`] or a smaller limit: the text of a shared expression can be exponentially long.

use std::hash::Hash;

use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};

use crate::{Expr, Node, Pool, Rational};

/// Maximum number of characters.
pub const MAX_CHARACTERS: usize = 100_000;

/// Digits of the longest number that is always written out.
const DIGITS: u32 = 17;

/// Binding strength of an expression.
#[derive(Copy, Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Power,
    Atom,
}

/// Pending output.
enum Piece {
    Text(&'static str),
    Owned(String),
    /// An expression, in parentheses if it binds less tightly.
    Inside(Expr, Binding),
}

impl<S: Clone + Eq + Hash> Pool<S> {
    /// The expression as text.
    #[must_use]
    pub fn render(&self, expr: Expr, name: &dyn Fn(&S) -> String) -> String {
        self.render_within(MAX_CHARACTERS, expr, name)
    }

    /// The expression as text of at most `limit` characters, then `…`.
    #[must_use]
    pub fn render_within(&self, limit: usize, expr: Expr, name: &dyn Fn(&S) -> String) -> String {
        let mut text = String::new();
        let mut characters = 0;
        let mut open = vec![Piece::Inside(expr, Binding::Sum)];
        while let Some(piece) = open.pop() {
            let written = match piece {
                Piece::Text(part) => part.to_owned(),
                Piece::Owned(part) => part,
                Piece::Inside(expr, least) => {
                    let (binding, mut pieces) = self.pieces(expr, name);
                    if binding < least {
                        pieces.insert(0, Piece::Text("("));
                        pieces.push(Piece::Text(")"));
                    }
                    open.extend(pieces.into_iter().rev());
                    continue;
                }
            };
            for character in written.chars() {
                if characters == limit {
                    text.push('…');
                    return text;
                }
                text.push(character);
                characters += 1;
            }
        }
        text
    }

    fn pieces(&self, expr: Expr, name: &dyn Fn(&S) -> String) -> (Binding, Vec<Piece>) {
        match self.node(expr) {
            Node::Number(value) => {
                let mut pieces = Vec::new();
                if value.is_negative() {
                    pieces.push(Piece::Text("-"));
                }
                let binding = write_multiple(&value.abs(), &[], &mut pieces);
                (if value.is_negative() { Binding::Sum } else { binding }, pieces)
            }
            Node::Pi => (Binding::Atom, vec![Piece::Text("pi")]),
            Node::Symbol(symbol) => (Binding::Atom, vec![Piece::Owned(name(symbol))]),
            Node::Sum(sum) => self.sum_pieces(sum),
            Node::Product(product) => {
                let mut pieces = Vec::new();
                let binding = write_multiple(&Rational::one(), &product.factors, &mut pieces);
                (binding, pieces)
            }
            Node::Call(function, arguments) => {
                let mut pieces = vec![Piece::Text(function.name()), Piece::Text("(")];
                for (slot, argument) in arguments.iter().enumerate() {
                    if slot > 0 {
                        pieces.push(Piece::Text(", "));
                    }
                    pieces.push(Piece::Inside(*argument, Binding::Sum));
                }
                pieces.push(Piece::Text(")"));
                (Binding::Atom, pieces)
            }
            Node::Opaque(function, arguments) => {
                let mut pieces = vec![Piece::Owned(function.text()), Piece::Text("(")];
                for (slot, argument) in arguments.iter().take(function.arity).enumerate() {
                    pieces.extend((slot > 0).then_some(Piece::Text(", ")));
                    pieces.push(Piece::Inside(*argument, Binding::Sum));
                }
                pieces.push(Piece::Text(")"));
                (Binding::Atom, pieces)
            }
            Node::Select([condition, then, otherwise]) => {
                let pieces = [
                    Piece::Text("if "),
                    Piece::Inside(*condition, Binding::Sum),
                    Piece::Text(" > 0 { "),
                    Piece::Inside(*then, Binding::Sum),
                    Piece::Text(" } else { "),
                    Piece::Inside(*otherwise, Binding::Sum),
                    Piece::Text(" }"),
                ];
                (Binding::Sum, pieces.into())
            }
        }
    }

    /// The terms in order, but the first positive one comes first: `q1 - q0`.
    fn sum_pieces(&self, sum: &crate::Sum) -> (Binding, Vec<Piece>) {
        let mut terms: Vec<(Rational, Vec<(Expr, Rational)>)> =
            sum.terms.iter().map(|(term, coefficient)| (coefficient.clone(), self.factors(*term))).collect();
        if !sum.constant.is_zero() {
            terms.push((sum.constant.clone(), Vec::new()));
        }
        if let Some(place) = terms.iter().position(|(coefficient, _)| coefficient.is_positive())
            && let Some(leading) = terms.get_mut(..=place)
        {
            leading.rotate_right(1);
        }
        let mut pieces = Vec::new();
        let mut binding = Binding::Sum;
        for (place, (coefficient, factors)) in terms.iter().enumerate() {
            match (place, coefficient.is_negative()) {
                (0, false) => {}
                (0, true) => pieces.push(Piece::Text("-")),
                (_, false) => pieces.push(Piece::Text(" + ")),
                (_, true) => pieces.push(Piece::Text(" - ")),
            }
            let term = write_multiple(&coefficient.abs(), factors, &mut pieces);
            if terms.len() == 1 && coefficient.is_positive() {
                binding = term;
            }
        }
        (binding, pieces)
    }

    fn factors(&self, term: Expr) -> Vec<(Expr, Rational)> {
        match self.node(term) {
            Node::Product(product) => product.factors.clone(),
            _ => vec![(term, Rational::one())],
        }
    }
}

/// `coefficient·Π base^exponent` as one fraction; the coefficient is not negative.
fn write_multiple(coefficient: &Rational, factors: &[(Expr, Rational)], pieces: &mut Vec<Piece>) -> Binding {
    let above = factors.iter().filter(|(_, exponent)| exponent.is_positive());
    let below = factors.iter().filter(|(_, exponent)| exponent.is_negative());
    let below: Vec<_> = below.map(|(base, exponent)| (*base, -exponent)).collect();
    let above = above.map(|(base, exponent)| (*base, exponent.clone()));
    let integer = |number: &BigInt| scientific(&number.clone().into()).unwrap_or_else(|| number.to_string());
    let written = |number: &BigInt| (!number.is_one()).then(|| integer(number));
    let (number, divisor) = match scientific(coefficient) {
        Some(short) => (Some(short), None),
        None => (written(coefficient.numer()), written(coefficient.denom())),
    };
    let numerator = write_factors(number, above, pieces);
    if below.is_empty() && divisor.is_none() {
        return numerator;
    }
    let mut denominator = Vec::new();
    if write_factors(divisor, below, &mut denominator) > Binding::Product {
        pieces.push(Piece::Text("/"));
        pieces.extend(denominator);
    } else {
        pieces.push(Piece::Text("/("));
        pieces.extend(denominator);
        pieces.push(Piece::Text(")"));
    }
    Binding::Product
}

/// `1.5e150` for a number with more than [`DIGITS`] digits above or below, if exact and not longer.
fn scientific(number: &Rational) -> Option<String> {
    let long = BigInt::from(10).pow(DIGITS);
    if number.numer().abs() < long && *number.denom() < long {
        return None;
    }
    // number = mantissa/10^places requires a denominator of twos and fives.
    let twos = u32::try_from(number.denom().trailing_zeros()?).ok()?;
    let mut rest = number.denom() >> twos;
    let mut fives = 0;
    while !rest.is_one() {
        if !(&rest % BigInt::from(5)).is_zero() {
            return None;
        }
        rest /= 5;
        fives += 1;
    }
    let places = twos.max(fives);
    let mantissa = (number.numer() * BigInt::from(10).pow(places) / number.denom()).to_string();
    let digits = mantissa.trim_end_matches('0');
    if digits.len() > usize::try_from(DIGITS).ok()? {
        return None;
    }
    let exponent = i64::try_from(mantissa.len()).ok()? - 1 - i64::from(places);
    let (first, others) = digits.split_at(1);
    let point = if others.is_empty() { "" } else { "." };
    Some(format!("{first}{point}{others}e{exponent}"))
}

/// Number and powers with positive exponents, joined by `*`; 1 if there are none.
fn write_factors(
    number: Option<String>,
    factors: impl IntoIterator<Item = (Expr, Rational)>,
    pieces: &mut Vec<Piece>,
) -> Binding {
    let start = pieces.len();
    let mut binding = Binding::Atom;
    let mut count = 0;
    if let Some(number) = number {
        pieces.push(Piece::Owned(number));
        count += 1;
    }
    for (base, exponent) in factors {
        if count > 0 {
            pieces.push(Piece::Text("*"));
        }
        binding = write_power(base, &exponent, pieces);
        count += 1;
    }
    if pieces.len() == start {
        pieces.push(Piece::Text("1"));
    }
    if count > 1 { Binding::Product } else { binding }
}

fn write_power(base: Expr, exponent: &Rational, pieces: &mut Vec<Piece>) -> Binding {
    if exponent.is_one() {
        pieces.push(Piece::Inside(base, Binding::Power));
        return Binding::Power;
    }
    if *exponent == Rational::new(BigInt::one(), BigInt::from(2)) {
        pieces.extend([Piece::Text("sqrt("), Piece::Inside(base, Binding::Sum), Piece::Text(")")]);
        return Binding::Atom;
    }
    pieces.push(Piece::Inside(base, Binding::Atom));
    let exponent = match scientific(exponent) {
        Some(short) => short,
        None if exponent.is_integer() => exponent.to_string(),
        None => format!("({exponent})"),
    };
    pieces.push(Piece::Owned(format!("^{exponent}")));
    Binding::Power
}
