//! Expressions in LaTeX.
//!
//! In: an expression, and the LaTeX of each symbol. Out: mathematics for `$…$`: quotients as fractions, fractional
//! powers as roots, `\sin^{2}\left(x\right)`. No pass recurses, and the text ends with `\ldots` beyond
//! [`vi_expr::MAX_CHARACTERS`].

use num_traits::{One, Signed, Zero};
use std::hash::Hash;
use vi_expr::{Expr, Function, MAX_CHARACTERS, Node, Opaque, Pool, Rational, Sum};

/// Binding strength of an expression.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    /// A power, a fraction in braces, or an atom that cannot take an exponent.
    Power,
    Atom,
}

/// Pending output.
enum Piece {
    Text(String),
    /// An expression, in parentheses if it binds less tightly.
    Inside(Expr, Binding),
}

fn text(part: impl Into<String>) -> Piece {
    Piece::Text(part.into())
}

/// An expression in LaTeX.
#[must_use]
pub fn expression<S: Clone + Eq + Hash>(pool: &Pool<S>, expr: Expr, name: &dyn Fn(&S) -> String) -> String {
    let writer = Writer { pool, name };
    let mut written = String::new();
    let mut open = vec![Piece::Inside(expr, Binding::Sum)];
    while let Some(piece) = open.pop() {
        match piece {
            Piece::Text(part) => written.push_str(&part),
            Piece::Inside(expr, least) => {
                let (binding, mut pieces) = writer.pieces(expr);
                if binding < least {
                    pieces.insert(0, text("\\left("));
                    pieces.push(text("\\right)"));
                }
                open.extend(pieces.into_iter().rev());
            }
        }
        if written.len() > MAX_CHARACTERS {
            // Truncates at a point without open braces: a formula this long is unreadable anyway.
            return "\\ldots".to_owned();
        }
    }
    written
}

/// Escapes the characters that are special in LaTeX.
#[must_use]
pub fn plain(words: &str) -> String {
    let escape = |letter: char| match letter {
        '_' | '%' | '#' | '&' | '$' | '{' | '}' => format!("\\{letter}"),
        '\\' => "\\textbackslash{}".to_owned(),
        '^' => "\\textasciicircum{}".to_owned(),
        '~' => "\\textasciitilde{}".to_owned(),
        _ => super::name::greek(letter).map_or_else(|| letter.to_string(), |command| format!("${command}$")),
    };
    words.chars().map(escape).collect()
}

struct Writer<'a, S> {
    pool: &'a Pool<S>,
    name: &'a dyn Fn(&S) -> String,
}

/// Bases with their exponents.
type Factors = Vec<(Expr, Rational)>;

impl<S: Clone + Eq + Hash> Writer<'_, S> {
    fn pieces(&self, expr: Expr) -> (Binding, Vec<Piece>) {
        match self.pool.node(expr) {
            Node::Number(value) if value.is_negative() => {
                let (_, mut pieces) = self.multiple(&value.abs(), &Vec::new());
                pieces.insert(0, text("-"));
                (Binding::Sum, pieces)
            }
            Node::Number(value) => self.multiple(value, &Vec::new()),
            Node::Pi => (Binding::Atom, vec![text("\\pi")]),
            Node::Symbol(symbol) => (Binding::Atom, vec![text((self.name)(symbol))]),
            Node::Sum(sum) => self.sum(sum),
            Node::Product(product) => self.multiple(&Rational::one(), &product.factors),
            Node::Call(function, arguments) => Self::call(*function, arguments, None),
            Node::Opaque(function, arguments) => {
                let mut pieces = vec![text(opaque(function)), text("\\left(")];
                for (place, argument) in arguments.iter().take(function.arity).enumerate() {
                    pieces.extend((place > 0).then(|| text(", ")));
                    pieces.push(Piece::Inside(*argument, Binding::Sum));
                }
                pieces.push(text("\\right)"));
                (Binding::Power, pieces)
            }
            Node::Select([condition, then, otherwise]) => {
                let pieces = [
                    text("\\begin{cases}"),
                    Piece::Inside(*then, Binding::Sum),
                    text(" & \\text{if } "),
                    Piece::Inside(*condition, Binding::Sum),
                    text(" > 0 \\\\ "),
                    Piece::Inside(*otherwise, Binding::Sum),
                    text(" & \\text{otherwise} \\end{cases}"),
                ];
                (Binding::Sum, pieces.into())
            }
        }
    }

    /// The terms in order, but the first positive one comes first.
    fn sum(&self, sum: &Sum) -> (Binding, Vec<Piece>) {
        let mut terms: Vec<(Rational, Factors)> =
            sum.terms.iter().map(|(term, coefficient)| (coefficient.clone(), self.factors(*term))).collect();
        if !sum.constant.is_zero() {
            terms.push((sum.constant.clone(), Vec::new()));
        }
        if let Some(place) = terms.iter().position(|(coefficient, _)| coefficient.is_positive())
            && let Some(leading) = terms.get_mut(..=place)
        {
            leading.rotate_right(1);
        }
        if let [(coefficient, factors)] = terms.as_slice()
            && coefficient.is_positive()
        {
            return self.multiple(coefficient, factors);
        }
        let mut pieces = Vec::new();
        for (place, (coefficient, factors)) in terms.iter().enumerate() {
            match (place, coefficient.is_negative()) {
                (0, false) => {}
                (0, true) => pieces.push(text("-")),
                (_, false) => pieces.push(text(" + ")),
                (_, true) => pieces.push(text(" - ")),
            }
            pieces.extend(self.multiple(&coefficient.abs(), factors).1);
        }
        (Binding::Sum, pieces)
    }

    fn factors(&self, term: Expr) -> Factors {
        match self.pool.node(term) {
            Node::Product(product) => product.factors.clone(),
            _ => vec![(term, Rational::one())],
        }
    }

    /// `coefficient·Π base^exponent` as one fraction; the coefficient is not negative.
    fn multiple(&self, coefficient: &Rational, factors: &Factors) -> (Binding, Vec<Piece>) {
        let (above, below): (Factors, Factors) = factors.iter().cloned().partition(|(_, e)| e.is_positive());
        let below: Factors = below.into_iter().map(|(base, exponent)| (base, -exponent)).collect();
        let (binding, numerator) = self.product(&coefficient.numer().to_string(), &above);
        if below.is_empty() && coefficient.denom().is_one() {
            return (binding, numerator);
        }
        let (_, denominator) = self.product(&coefficient.denom().to_string(), &below);
        let mut pieces = vec![text("\\frac{")];
        // A sum that fills one side of a fraction needs no parentheses.
        pieces.extend(bare(numerator));
        pieces.push(text("}{"));
        pieces.extend(bare(denominator));
        pieces.push(text("}"));
        (Binding::Product, pieces)
    }

    /// Number and powers with positive exponents; the number 1 only if there is nothing else.
    fn product(&self, number: &str, factors: &Factors) -> (Binding, Vec<Piece>) {
        if factors.is_empty() {
            return (Binding::Atom, vec![text(number)]);
        }
        let mut pieces = Vec::new();
        let mut last = Binding::Atom;
        if number != "1" {
            pieces.push(text(number));
        }
        let alone = pieces.is_empty() && factors.len() == 1;
        for (base, exponent) in factors {
            // Adjacent digits would read as one number.
            let digits = matches!(self.pool.node(*base), Node::Number(_));
            if !pieces.is_empty() {
                pieces.push(text(if digits { " \\cdot " } else { " " }));
            }
            let (binding, power) = self.power(*base, exponent);
            pieces.extend(power);
            last = binding;
        }
        (if alone { last } else { Binding::Product }, pieces)
    }

    fn power(&self, base: Expr, exponent: &Rational) -> (Binding, Vec<Piece>) {
        if exponent.is_one() {
            return (Binding::Power, vec![Piece::Inside(base, Binding::Power)]);
        }
        if exponent.numer().is_one() {
            let degree = exponent.denom().to_string();
            let root = if degree == "2" { "\\sqrt{".to_owned() } else { format!("\\sqrt[{degree}]{{") };
            return (Binding::Power, vec![text(root), Piece::Inside(base, Binding::Sum), text("}")]);
        }
        if let Node::Call(function, arguments) = self.pool.node(base)
            && exponent.is_integer()
            && exponent.is_positive()
            && command(*function).is_some()
        {
            return Self::call(*function, arguments, Some(exponent));
        }
        (Binding::Power, vec![Piece::Inside(base, Binding::Atom), text(format!("^{{{exponent}}}"))])
    }

    /// A function of its arguments, to a power: `\sin^{2}\left(x\right)`.
    fn call(function: Function, arguments: &[Expr], exponent: Option<&Rational>) -> (Binding, Vec<Piece>) {
        if let (Function::Pow, [base, exponent]) = (function, arguments) {
            let pieces = vec![Piece::Inside(*base, Binding::Atom), text("^{"), Piece::Inside(*exponent, Binding::Sum)];
            return (Binding::Power, pieces.into_iter().chain([text("}")]).collect());
        }
        if let (Function::Abs, [argument]) = (function, arguments) {
            return (Binding::Atom, vec![text("\\left|"), Piece::Inside(*argument, Binding::Sum), text("\\right|")]);
        }
        let exponent = exponent.map(|exponent| format!("^{{{exponent}}}")).unwrap_or_default();
        let mut pieces = vec![text(format!("{}{exponent}\\left(", command(function).unwrap_or_default()))];
        for (place, argument) in arguments.iter().enumerate() {
            if place > 0 {
                pieces.push(text(", "));
            }
            pieces.push(Piece::Inside(*argument, Binding::Sum));
        }
        pieces.push(text("\\right)"));
        (Binding::Power, pieces)
    }
}

/// A partial derivative of a function that is known by name.
fn opaque(function: &Opaque) -> String {
    let orders: Vec<String> = function.orders[..function.arity].iter().map(u8::to_string).collect();
    let name = format!("\\operatorname{{{}}}", plain(&function.name));
    match (function.arity, function.order()) {
        (_, 0) => name,
        (1, order) => name + &"'".repeat(order),
        _ => format!("{name}^{{({})}}", orders.join(",")),
    }
}

/// The command of a function; `None` for functions with their own notation.
fn command(function: Function) -> Option<&'static str> {
    Some(match function {
        Function::Exp => "\\exp",
        Function::Ln => "\\ln",
        Function::Sin => "\\sin",
        Function::Cos => "\\cos",
        Function::Tan => "\\tan",
        Function::Asin => "\\arcsin",
        Function::Acos => "\\arccos",
        Function::Atan => "\\arctan",
        Function::Atan2 => "\\operatorname{atan2}",
        Function::Sinh => "\\sinh",
        Function::Cosh => "\\cosh",
        Function::Tanh => "\\tanh",
        Function::Sign => "\\operatorname{sgn}",
        Function::Hypot => "\\operatorname{hypot}",
        Function::Abs | Function::Pow => return None,
    })
}

/// One expression between braces: no parentheses.
fn bare(mut pieces: Vec<Piece>) -> Vec<Piece> {
    if let [Piece::Inside(_, least)] = pieces.as_mut_slice() {
        *least = Binding::Sum;
    }
    pieces
}
