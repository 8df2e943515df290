//! Values of constant expressions, rounded once.
//!
//! In: an expression without symbols. Out: the nearest `f64`, its sign, or the reason for which it has none
//! ([`NoConstant`]). Ziv's strategy: ball arithmetic doubles its bits until the ball determines the sign or the
//! rounding. A value below 2^-2000 of its cancelling terms is zero, as for `sqrt(2)*sqrt(3) - sqrt(6)`.

use core::cmp::Ordering;
use std::hash::Hash;

use num_bigint::BigInt;
use num_traits::Zero;

use crate::ball::Ball;
use crate::elementary::{Elementary, LARGEST_ANGLE, NEGLIGIBLE, NoConstant, decided, nonzero};
use crate::{Expr, Function, Node, Pool, number};

/// Bits of the first attempt.
const FIRST_BITS: u64 = 128;
/// Bits of the last attempt.
const LAST_BITS: u64 = 4096;

impl<S: Clone + Eq + Hash> Pool<S> {
    /// Whether the expression has no symbols.
    ///
    /// # Panics
    /// If the handle is of another, larger pool.
    #[must_use]
    pub fn is_constant(&self, expr: Expr) -> bool {
        self.constant[expr.0]
    }

    /// The `f64` that is nearest to a constant expression.
    ///
    /// # Errors
    /// The constant has no value, is out of the range of normal numbers, or would take more than 4096 bits.
    pub fn constant(&self, expr: Expr) -> Result<f64, NoConstant> {
        if let Some(number) = self.as_number(expr) {
            return normal(number::nearest(number), number.is_zero());
        }
        self.attempts(|bits| {
            let ball = self.ball(expr, bits)?;
            let exact = ball.radius_magnitude() < ball.magnitude().saturating_sub(NEGLIGIBLE);
            normal(ball.nearest(exact).ok_or(NoConstant::Undecided)?, ball.is_zero())
        })
    }

    /// The comparison of a constant expression with 0.
    ///
    /// # Errors
    /// The constant has no value, or its sign would take more than 4096 bits.
    pub fn constant_sign(&self, expr: Expr) -> Result<Ordering, NoConstant> {
        let sign = self.attempts(|bits| self.ball(expr, bits).map(|ball| ball.middle))?;
        Ok(sign.cmp(&BigInt::zero()))
    }

    fn attempts<R>(&self, mut attempt: impl FnMut(u64) -> Result<R, NoConstant>) -> Result<R, NoConstant> {
        let mut bits = FIRST_BITS;
        loop {
            match attempt(bits) {
                Err(NoConstant::Undecided) if bits < LAST_BITS && !self.is_exhausted() => bits *= 2,
                found => return found,
            }
        }
    }

    /// A ball around a constant, with a known sign; cached for expressions that contain it.
    fn ball(&self, expr: Expr, bits: u64) -> Result<Ball, NoConstant> {
        let mut open = if self.known_ball(expr, bits).is_some() { Vec::new() } else { vec![expr] };
        while let Some(last) = open.last().copied() {
            let first = open.len();
            let missing = |child: Expr| self.known_ball(child, bits).is_none();
            self.node(last).each_child(|child| open.extend(missing(child).then_some(child)));
            if open.len() == first {
                open.pop();
                let ball = self.computed(last, bits)?;
                self.balls.borrow_mut().insert(last, (bits, ball));
            }
        }
        self.known_ball(expr, bits).ok_or(NoConstant::Undefined)
    }

    fn known_ball(&self, expr: Expr, bits: u64) -> Option<Ball> {
        let balls = self.balls.borrow();
        balls.get(expr).filter(|(known, _)| *known >= bits).map(|(_, ball)| ball.clone())
    }

    /// The ball of an expression whose operands have balls.
    fn computed(&self, expr: Expr, bits: u64) -> Result<Ball, NoConstant> {
        let node = self.node(expr);
        self.spend_on_balls(bits, 1 + node.operands());
        if self.is_exhausted() || self.is_undefined(expr) {
            return Err(NoConstant::Undefined);
        }
        let of = |child: Expr| self.known_ball(child, bits).ok_or(NoConstant::Undefined);
        let functions = Elementary { bits };
        match node {
            Node::Number(value) => Ok(Ball::rational(value, bits)),
            Node::Pi => Ok(functions.pi()),
            Node::Symbol(_) | Node::Opaque(..) => Err(NoConstant::Undefined),
            // A condition whose sign is known was decided at construction.
            Node::Select(_) => Err(NoConstant::Undecided),
            Node::Sum(sum) => {
                let mut total = Ball::rational(&sum.constant, bits);
                let mut largest = total.magnitude();
                for (term, coefficient) in &sum.terms {
                    let part = of(*term)?.times(&Ball::rational(coefficient, bits), bits);
                    largest = largest.max(part.magnitude());
                    total = total.plus(&part, bits);
                }
                decided(total, largest)
            }
            Node::Product(product) => {
                let mut total = Ball::integer(1);
                for (base, exponent) in &product.factors {
                    if *exponent.denom() > 2.into() {
                        self.spend_on_functions(bits, 2);
                    }
                    total = nonzero(total.times(&functions.power(&of(*base)?, exponent)?, bits))?;
                }
                Ok(total)
            }
            Node::Call(function, arguments) => {
                let arguments = arguments.iter().map(|argument| of(*argument)).collect::<Result<Vec<_>, _>>()?;
                // The reduction of an angle needs as many extra bits as precede its binary point.
                let more = match (function, arguments.as_slice()) {
                    (Function::Sin | Function::Cos | Function::Tan, [angle]) => {
                        angle.magnitude().clamp(0, LARGEST_ANGLE)
                    }
                    _ => 0,
                };
                self.spend_on_functions(bits + more.unsigned_abs(), function.arity());
                functions.call(*function, &arguments)
            }
        }
    }
}

/// A number rounded, if it is 0 or normal.
fn normal(rounded: f64, is_zero: bool) -> Result<f64, NoConstant> {
    if is_zero || rounded.is_normal() {
        Ok(rounded)
    } else if rounded.is_infinite() {
        Err(NoConstant::TooLarge)
    } else {
        Err(NoConstant::TooSmall)
    }
}
