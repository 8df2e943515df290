//! Derivatives.
//!
//! In: an expression and the derivative of each symbol. Out: the derivative of the expression by the chain rule,
//!
//! - `(Σ c u)' = Σ c u'`
//! - `(Π b^e)' = Σ e b' b^(e-1) Π others`
//! - `f(u, w)' = f_u u' + f_w w'`, and `sign' = 0`
//! - `(if c > 0 { a } else { b })' = if c > 0 { a' } else { b' }`
//!
//! One pass over the shared nodes differentiates each expression once. Products are flat, so that the derivative of n
//! nested calls has n factors, at a cost of n² steps.

use std::hash::Hash;

use num_bigint::BigInt;
use num_traits::One;

use crate::effort::MADE;
use crate::{Expr, Function, Node, Pool, Rational, Table};

impl<S: Clone + Eq + Hash> Pool<S> {
    /// Partial derivative of `expr` with respect to a symbol.
    pub fn partial_derivative<Q: ?Sized>(&mut self, expr: Expr, by: &Q) -> Expr
    where
        S: PartialEq<Q>,
    {
        self.derivative(expr, &mut |pool, symbol| if symbol == by { pool.one() } else { pool.zero() })
    }

    /// Derivative of `expr`. The closure gives the derivative of each symbol, once per symbol: the rates of all symbols
    /// give the total derivative.
    pub fn derivative(&mut self, expr: Expr, symbol_derivative: &mut dyn FnMut(&mut Self, &S) -> Expr) -> Expr {
        if self.is_undefined(expr) || self.is_exhausted() {
            return Expr::UNDEFINED;
        }
        // Nonzero derivatives only.
        let mut derivatives = Table::default();
        for node in self.reachable(&[expr]) {
            let shared = self.shared_node(node);
            let derivative = match &*shared {
                Node::Symbol(symbol) => symbol_derivative(self, symbol),
                constant if !constant.any_child(|child| derivatives.contains(child)) => Expr::ZERO,
                Node::Number(_) | Node::Pi => Expr::ZERO,
                Node::Sum(sum) => self
                    .combination(sum.terms.iter().filter_map(|(term, c)| Some((*derivatives.get(*term)?, c.clone())))),
                Node::Product(product) => self.product_derivative(&product.factors, &derivatives),
                Node::Call(function, arguments) => self.call_derivative(*function, arguments, node, &derivatives),
                Node::Opaque(function, arguments) => self.opaque_derivative(function, arguments, &derivatives),
                Node::Select([condition, then, otherwise]) => {
                    let of = |part: &Expr| derivatives.get(*part).copied().unwrap_or(Expr::ZERO);
                    self.select(*condition, of(then), of(otherwise))
                }
            };
            if derivative != Expr::ZERO {
                derivatives.insert(node, derivative);
            }
        }
        derivatives.get(expr).copied().unwrap_or(Expr::ZERO)
    }

    fn product_derivative(&mut self, factors: &[(Expr, Rational)], derivatives: &Table<Expr, Expr>) -> Expr {
        let mut terms = Vec::new();
        for (place, (base, exponent)) in factors.iter().enumerate() {
            let Some(derivative) = derivatives.get(*base) else { continue };
            self.spend(MADE * factors.len());
            if self.is_exhausted() {
                return Expr::UNDEFINED;
            }
            let mut powers = factors.to_vec();
            if let Some((_, lowered)) = powers.get_mut(place) {
                *lowered -= Rational::one();
            }
            powers.push((*derivative, Rational::one()));
            terms.push((self.powers(powers), exponent.clone()));
        }
        self.combination(terms)
    }

    fn call_derivative(
        &mut self,
        function: Function,
        arguments: &[Expr],
        value: Expr,
        derivatives: &Table<Expr, Expr>,
    ) -> Expr {
        let mut terms = Vec::new();
        for (slot, argument) in arguments.iter().enumerate() {
            let Some(derivative) = derivatives.get(*argument) else { continue };
            let partial = match arguments {
                [x] => self.unary_partial(function, *x, value),
                [x, y] => self.binary_partial(function, slot == 0, *x, *y, value),
                _ => Expr::UNDEFINED,
            };
            terms.push(self.mul(partial, *derivative));
        }
        self.sum(&terms)
    }

    /// `f'(x)`, given `value = f(x)`.
    fn unary_partial(&mut self, function: Function, x: Expr, value: Expr) -> Expr {
        match function {
            Function::Exp => value,
            Function::Ln => self.div(Expr::ONE, x),
            Function::Sin => self.call(Function::Cos, &[x]),
            Function::Cos => {
                let sin = self.call(Function::Sin, &[x]);
                self.neg(sin)
            }
            Function::Tan => self.one_plus_square(1, value),
            Function::Tanh => self.one_plus_square(-1, value),
            Function::Asin | Function::Acos => {
                let sign = Rational::from_integer(BigInt::from(if function == Function::Asin { 1 } else { -1 }));
                let square = self.one_plus_square(-1, x);
                let root = self.power(square, &Rational::new(BigInt::from(-1), BigInt::from(2)));
                self.scale(root, &sign)
            }
            Function::Atan => {
                let square = self.one_plus_square(1, x);
                self.div(Expr::ONE, square)
            }
            Function::Sinh => self.call(Function::Cosh, &[x]),
            Function::Cosh => self.call(Function::Sinh, &[x]),
            Function::Abs => self.call(Function::Sign, &[x]),
            Function::Sign => Expr::ZERO,
            Function::Atan2 | Function::Hypot | Function::Pow => Expr::UNDEFINED,
        }
    }

    /// Derivative of `f(x, y)` in its first or second slot, given `value = f(x, y)`.
    fn binary_partial(&mut self, function: Function, first: bool, x: Expr, y: Expr, value: Expr) -> Expr {
        match (function, first) {
            // The angle of the point (y, x), whose first slot is the ordinate.
            (Function::Atan2, true) => self.over_square_of_distance(y, x, y),
            (Function::Atan2, false) => {
                let ordinate = self.neg(x);
                self.over_square_of_distance(ordinate, x, y)
            }
            (Function::Hypot, true) => self.div(x, value),
            (Function::Hypot, false) => self.div(y, value),
            (Function::Pow, true) => {
                let lower = self.sub(y, Expr::ONE);
                let power = self.call(Function::Pow, &[x, lower]);
                self.mul(y, power)
            }
            (Function::Pow, false) => {
                let ln = self.call(Function::Ln, &[x]);
                self.mul(value, ln)
            }
            _ => Expr::UNDEFINED,
        }
    }

    /// `1 + sign·x^2`.
    fn one_plus_square(&mut self, sign: i32, x: Expr) -> Expr {
        let square = self.mul(x, x);
        self.combination([(Expr::ONE, Rational::one()), (square, Rational::from_integer(BigInt::from(sign)))])
    }

    /// `numerator / (x^2 + y^2)`.
    fn over_square_of_distance(&mut self, numerator: Expr, x: Expr, y: Expr) -> Expr {
        let squares = [self.mul(x, x), self.mul(y, y)];
        let sum = self.sum(&squares);
        self.div(numerator, sum)
    }
}
