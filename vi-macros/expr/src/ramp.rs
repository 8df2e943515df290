//! Ramps: functions that are zero on one side of a point.
//!
//! In: `c |u| ± c u`, and products of these. Out: `c u (sign(u) ± 1)`, which has the same value but is exactly 0 on one
//! side for any rounding of u. Its derivative has the factor `sign(u) ± 1`, which is 0 there too. If u is a symbol,
//! both hold unchanged.

use std::hash::Hash;

use num_traits::One;

use crate::{Expr, Function, Node, Pool, Rational};

impl<S: Clone + Eq + Hash> Pool<S> {
    /// The expression with its ramps as products: the expression or its factors are ramps, or stay unchanged.
    pub fn with_ramps(&mut self, expr: Expr) -> Expr {
        match &*self.shared_node(expr) {
            Node::Product(product) => {
                let factors: Vec<_> =
                    product.factors.iter().map(|(base, exponent)| (self.ramp(*base), exponent.clone())).collect();
                self.powers(factors)
            }
            _ => self.ramp(expr),
        }
    }

    fn ramp(&mut self, expr: Expr) -> Expr {
        let shared = self.shared_node(expr);
        let Node::Sum(sum) = &*shared else { return expr };
        for (term, coefficient) in &sum.terms {
            let Some((argument, mut factors)) = self.absolute_value(*term) else { continue };
            let odd = self.powers(factors.clone());
            let odd = self.scale(odd, coefficient);
            let rest = self.combination([(expr, Rational::one()), (*term, -coefficient.clone())]);
            let opposite = self.neg(odd);
            if rest == odd || rest == opposite {
                let side = if rest == odd { Rational::one() } else { -Rational::one() };
                let sign = self.call(Function::Sign, &[argument]);
                let jump = self.combination([(sign, Rational::one()), (Expr::ONE, side)]);
                factors.push((jump, Rational::one()));
                let ramp = self.powers(factors);
                return self.scale(ramp, coefficient);
            }
        }
        expr
    }

    /// The u of a product with the factor |u|, and its factors with u in place of |u|.
    fn absolute_value(&self, term: Expr) -> Option<(Expr, Vec<(Expr, Rational)>)> {
        let mut factors = match self.node(term) {
            Node::Product(product) => product.factors.clone(),
            _ => vec![(term, Rational::one())],
        };
        let (base, _) = factors
            .iter_mut()
            .find(|(base, exponent)| exponent.is_one() && matches!(self.node(*base), Node::Call(Function::Abs, _)))?;
        let Node::Call(_, arguments) = self.node(*base) else { return None };
        let argument = arguments.first().filter(|argument| !matches!(self.node(**argument), Node::Symbol(_)))?;
        *base = *argument;
        Some((*argument, factors))
    }
}
