//! Parses the notation of `Pool::render`, for tables of tests.

use vi_expr::{Expr, Function, Rational};

use crate::Pool;

/// Parses `text`; the first call creates the symbols in alphabetical order, so that tables are independent.
pub(crate) fn read(pool: &mut Pool, text: &str) -> Expr {
    for letter in 'a'..='z' {
        pool.symbol(letter.to_string());
    }
    let mut reader = Reader { pool, rest: text.trim() };
    let expr = reader.sum();
    assert!(reader.rest.is_empty(), "`{}` is left of `{text}`", reader.rest);
    expr
}

/// Writes with the symbols as they are.
pub(crate) fn write(pool: &Pool, expr: Expr) -> String {
    pool.render(expr, &String::clone)
}

struct Reader<'a> {
    pool: &'a mut Pool,
    rest: &'a str,
}

impl<'a> Reader<'a> {
    fn take(&mut self, token: char) -> bool {
        let Some(rest) = self.rest.strip_prefix(token) else { return false };
        self.rest = rest.trim_start();
        true
    }

    fn word(&mut self, member: impl Fn(char) -> bool) -> &'a str {
        let end = self.rest.find(|character| !member(character)).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest.trim_start();
        word
    }

    /// The optional rest of a number: digits after a point, and a power of ten.
    fn scale(&mut self) -> (&'a str, i32) {
        let fraction = if self.take('.') { self.word(|character| character.is_ascii_digit()) } else { "" };
        if !self.take('e') {
            return (fraction, 0);
        }
        let sign = if self.take('-') { -1 } else { 1 };
        let power: i32 = self.word(|character| character.is_ascii_digit()).parse().expect("a power of ten");
        (fraction, sign * power)
    }

    fn sum(&mut self) -> Expr {
        // A leading minus applies to the whole first term.
        let mut left = if self.take('-') {
            let first = self.product();
            self.pool.neg(first)
        } else {
            self.product()
        };
        loop {
            if self.take('+') {
                let right = self.product();
                left = self.pool.add(left, right);
            } else if self.take('-') {
                let right = self.product();
                left = self.pool.sub(left, right);
            } else {
                return left;
            }
        }
    }

    fn product(&mut self) -> Expr {
        let mut left = self.signed();
        loop {
            if self.take('*') {
                let right = self.signed();
                left = self.pool.mul(left, right);
            } else if self.take('/') {
                let right = self.signed();
                left = self.pool.div(left, right);
            } else {
                return left;
            }
        }
    }

    fn signed(&mut self) -> Expr {
        if self.take('-') {
            let expr = self.signed();
            return self.pool.neg(expr);
        }
        let base = self.atom();
        if self.take('^') {
            let exponent = self.signed();
            return self.pool.call(Function::Pow, &[base, exponent]);
        }
        base
    }

    fn atom(&mut self) -> Expr {
        if self.take('(') {
            let expr = self.sum();
            assert!(self.take(')'), "no `)` before `{}`", self.rest);
            return expr;
        }
        if self.rest.starts_with(|character: char| character.is_ascii_digit()) {
            let digits = self.word(|character| character.is_ascii_digit());
            let (fraction, power) = self.scale();
            let number = Rational::from_integer(format!("{digits}{fraction}").parse().expect("digits"));
            let places = i32::try_from(fraction.len()).expect("few digits");
            return self.pool.number(number * Rational::from_integer(10.into()).pow(power - places));
        }
        let name = self.word(char::is_alphanumeric);
        assert!(!name.is_empty(), "no operand before `{}`", self.rest);
        if !self.take('(') {
            return if name == "pi" { self.pool.pi() } else { self.pool.symbol(name.to_owned()) };
        }
        let mut arguments = vec![self.sum()];
        while self.take(',') {
            arguments.push(self.sum());
        }
        assert!(self.take(')'), "no `)` before `{}`", self.rest);
        if name == "sqrt" {
            return self.pool.power(arguments[0], &crate::ratio(1, 2));
        }
        let function = Function::from_name(name).unwrap_or_else(|| panic!("no function `{name}`"));
        assert_eq!(function.arity(), arguments.len(), "arguments of `{name}`");
        self.pool.call(function, &arguments)
    }
}
