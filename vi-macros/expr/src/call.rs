//! Canonical function calls.
//!
//! In: a function and its arguments. Out: the exact value if there is one (`sin(0) = 0`, `abs(-2) = 2`), otherwise the
//! call with an argument of canonical sign, so that `sin(a - b)` and `sin(b - a)` share a node.
//! An even or odd function of the result never has an argument whose first coefficient is negative.

use core::cmp::Ordering;
use std::hash::Hash;

use num_integer::Integer;
use num_traits::{One, Signed, Zero};

use crate::function::Parity;
use crate::{Expr, Function, Node, Pool, Rational};

impl<S: Clone + Eq + Hash> Pool<S> {
    /// `function(arguments)`. The caller provides [`Function::arity`] arguments. `pow` with an exact exponent becomes
    /// [`Pool::power`]. `ln(x)` is undefined for numbers `x ≤ 0`, `asin(x)` and `acos(x)` for numbers beyond ±1.
    pub fn call(&mut self, function: Function, arguments: &[Expr]) -> Expr {
        if arguments.iter().any(|argument| self.is_undefined(*argument)) {
            return Expr::UNDEFINED;
        }
        match (function, arguments) {
            (Function::Pow, [base, exponent]) => self.call_pow(*base, *exponent),
            (Function::Hypot, [x, y]) => self.call_hypot(*x, *y),
            (_, [argument]) => self.call_unary(function, *argument),
            _ => self.intern(Node::Call(function, arguments.to_vec())),
        }
    }

    fn call_pow(&mut self, base: Expr, exponent: Expr) -> Expr {
        if let Some(exponent) = self.as_number(exponent).cloned() {
            return self.power(base, &exponent);
        }
        if base == Expr::ONE {
            return base;
        }
        self.intern(Node::Call(Function::Pow, vec![base, exponent]))
    }

    /// `hypot(x, y)`, which is symmetric and even in both arguments.
    fn call_hypot(&mut self, x: Expr, y: Expr) -> Expr {
        let (_, x) = self.canonical_sign(x);
        let (_, y) = self.canonical_sign(y);
        let (low, high) = (x.min(y), x.max(y));
        if low == Expr::ZERO {
            return self.call(Function::Abs, &[high]);
        }
        self.intern(Node::Call(Function::Hypot, vec![low, high]))
    }

    fn call_unary(&mut self, function: Function, argument: Expr) -> Expr {
        let parity = function.parity();
        let (negative, argument) =
            if parity == Parity::None { (false, argument) } else { self.canonical_sign(argument) };
        let sign = if negative && parity == Parity::Odd { -Rational::one() } else { Rational::one() };
        // abs(k x) = k abs(x) and sign(k x) = sign(x), with k > 0 here.
        let multiple = match self.node(argument) {
            Node::Sum(sum) => sum.as_multiple().map(|(factor, term)| (factor.clone(), term)),
            _ => None,
        };
        let (factor, argument) = match (function, multiple) {
            (Function::Abs, Some((factor, term))) => (factor, term),
            (Function::Sign, Some((_, term))) => (Rational::one(), term),
            _ => (Rational::one(), argument),
        };
        let value = self.exact_value(function, argument).or_else(|| self.value_at_quarter_turns(function, argument));
        let value = value.or_else(|| self.without_constant(function, argument));
        let value = value.unwrap_or_else(|| self.intern(Node::Call(function, vec![argument])));
        self.scale(value, &(sign * factor))
    }

    /// The value at an exact number, if that is exact or undefined.
    fn exact_value(&mut self, function: Function, argument: Expr) -> Option<Expr> {
        let x = self.as_number(argument)?.clone();
        let beyond_one = x.abs() > Rational::one();
        match function {
            Function::Abs => Some(self.number(x.abs())),
            Function::Sign => Some(self.number(x.signum())),
            Function::Ln if !x.is_positive() => Some(Expr::UNDEFINED),
            Function::Asin | Function::Acos if beyond_one => Some(Expr::UNDEFINED),
            Function::Exp | Function::Cos | Function::Cosh if x.is_zero() => Some(Expr::ONE),
            Function::Ln | Function::Acos if x.is_one() => Some(Expr::ZERO),
            Function::Sin | Function::Tan | Function::Asin | Function::Atan | Function::Sinh | Function::Tanh
                if x.is_zero() =>
            {
                Some(Expr::ZERO)
            }
            _ => None,
        }
    }

    /// `abs(c x) = ±c abs(x)` and `sign(c x) = ±sign(x)` for constants c that are not exact numbers.
    fn without_constant(&mut self, function: Function, argument: Expr) -> Option<Expr> {
        if !matches!(function, Function::Abs | Function::Sign) {
            return None;
        }
        let (constant, rest) = self.split(argument, &|child| child);
        if constant == Expr::ONE {
            return None;
        }
        let sign = match self.constant_sign(constant).ok()? {
            Ordering::Equal => return Some(Expr::ZERO),
            Ordering::Less => -Rational::one(),
            Ordering::Greater => Rational::one(),
        };
        let of_rest = self.call(function, &[rest]);
        let factor = if function == Function::Abs { constant } else { Expr::ONE };
        let signed = self.scale(factor, &sign);
        Some(self.mul(signed, of_rest))
    }

    /// The sine, cosine or tangent of a whole number of quarter turns.
    fn value_at_quarter_turns(&mut self, function: Function, argument: Expr) -> Option<Expr> {
        let half_turns = match self.node(argument) {
            Node::Pi => Rational::one(),
            Node::Sum(sum) => {
                let (factor, _) = sum.as_multiple().filter(|(_, term)| matches!(self.node(*term), Node::Pi))?;
                factor.clone()
            }
            _ => return None,
        };
        let quarters = &half_turns + &half_turns;
        if !quarters.is_integer() {
            return None;
        }
        let four = Rational::from_integer(4.into());
        let quarters = &quarters - (&quarters / &four).floor() * &four;
        let at = |k: i32| quarters == Rational::from_integer(k.into());
        let signed = |one: i32, minus_one: i32| i32::from(at(one)) - i32::from(at(minus_one));
        match function {
            Function::Sin => Some(self.number(Rational::from_integer(signed(1, 3).into()))),
            Function::Cos => Some(self.number(Rational::from_integer(signed(0, 2).into()))),
            Function::Tan => Some(if at(0) || at(2) { Expr::ZERO } else { Expr::UNDEFINED }),
            _ => None,
        }
    }

    /// The expression or its negative, whichever has the canonical sign, and whether it is the negative.
    ///
    /// The first coefficient gives the sign of a sum, the factors `sum^odd` that of a product.
    fn canonical_sign(&mut self, expr: Expr) -> (bool, Expr) {
        match &*self.shared_node(expr) {
            Node::Number(value) if value.is_negative() => (true, self.neg(expr)),
            Node::Product(product) => self.canonical_product_sign(expr, &product.factors),
            Node::Sum(sum) => match sum.as_multiple() {
                Some((factor, term)) => {
                    let (negative, term) = self.canonical_sign_of_term(term);
                    (negative != factor.is_negative(), self.scale(term, &factor.abs()))
                }
                None if is_signed(sum) => (true, self.neg(expr)),
                None => (false, expr),
            },
            _ => (false, expr),
        }
    }

    fn canonical_sign_of_term(&mut self, term: Expr) -> (bool, Expr) {
        match &*self.shared_node(term) {
            Node::Product(product) => self.canonical_product_sign(term, &product.factors),
            _ => (false, term),
        }
    }

    fn canonical_product_sign(&mut self, expr: Expr, factors: &[(Expr, Rational)]) -> (bool, Expr) {
        let mut negative = false;
        let mut changed = factors.to_vec();
        for (base, exponent) in &mut changed {
            let odd = exponent.is_integer() && exponent.numer().is_odd();
            if odd && matches!(self.node(*base), Node::Sum(sum) if is_signed(sum)) {
                *base = self.neg(*base);
                negative = !negative;
            }
        }
        (negative, if changed == factors { expr } else { self.powers(changed) })
    }
}

fn is_signed(sum: &crate::Sum) -> bool {
    sum.terms.first().is_some_and(|(_, coefficient)| coefficient.is_negative())
}
