//! What the terms of a sum have in common.
//!
//! In: a sum. Out: a factor, what it multiplies, and what it does not. Factors are taken out where that saves products in
//! every step. Parameters are not: they are coefficients, computed once per run, whatever stands in them.

use super::lower::{Dependence, Lowering};
use crate::symbol::Symbol;
use num_traits::{One, Signed, Zero};
use std::collections::BTreeMap;
use vi_expr::{Expr, Node, Rational, Sum};

impl Lowering<'_> {
    /// The factor that most terms share, what it is multiplied by, and the other terms. Parameters are factors of what
    /// changes with the state at no cost, as coefficients computed once per run; they are taken out of sums of such only.
    pub(super) fn common_factor(&mut self, sum: &Sum) -> Option<(Expr, Expr, Option<Expr>)> {
        let mut counts: BTreeMap<Expr, usize> = BTreeMap::new();
        let varies = sum.terms.iter().any(|(term, _)| self.dependence(*term) > Dependence::Parameters);
        for (term, _) in &sum.terms {
            for base in self.bases(*term) {
                if !varies || self.dependence(base) > Dependence::Parameters {
                    *counts.entry(base).or_default() += 1;
                }
            }
        }
        // Of equally frequent ones the step, then the oldest.
        let step = self.pool.symbol(Symbol::Step);
        let (base, count) =
            counts.into_iter().max_by_key(|(base, count)| (*count, *base == step, core::cmp::Reverse(*base)))?;
        if count < 2 {
            return None;
        }
        let exponents = sum.terms.iter().filter_map(|(term, _)| self.exponent(*term, base));
        let exponent = exponents.min().unwrap_or_else(Rational::one);
        let inverse = self.pool.power(base, &-exponent.clone());
        let (mut inside, mut rest) = (Vec::new(), vec![self.pool.number(sum.constant.clone())]);
        for (term, coefficient) in &sum.terms {
            let scaled = self.pool.scale(*term, coefficient);
            if self.exponent(*term, base).is_some() {
                inside.push(self.pool.mul(scaled, inverse));
            } else {
                rest.push(scaled);
            }
        }
        let factor = self.pool.power(base, &exponent);
        // A bare sum left inside would dissolve in the sum of the quotients: e²/2 + e³/3 stays as it is.
        let dissolves = |quotient: &Expr| matches!(self.pool.node(*quotient), Node::Sum(sum) if sum.terms.len() > 1);
        if inside.iter().any(dissolves) {
            return None;
        }
        let (inside, rest) = (self.pool.sum(&inside), self.pool.sum(&rest));
        self.record_powers(&[inside, rest]);
        Some((factor, inside, (!self.pool.is_zero(rest)).then_some(rest)))
    }

    /// The positive integer exponent with which a term has a base.
    fn exponent(&self, term: Expr, base: Expr) -> Option<Rational> {
        let usable = |exponent: &Rational| exponent.is_integer() && exponent.is_positive();
        match self.pool.node(term) {
            Node::Product(product) => {
                product.factors.iter().find(|(found, e)| *found == base && usable(e)).map(|(_, e)| e.clone())
            }
            _ => (term == base).then(Rational::one),
        }
    }

    /// The bases that a term has with a positive integer exponent.
    fn bases(&self, term: Expr) -> Vec<Expr> {
        match self.pool.node(term) {
            Node::Product(product) => product
                .factors
                .iter()
                .filter(|(base, exponent)| {
                    exponent.is_integer() && exponent.is_positive() && self.pool.as_number(*base).is_none()
                })
                .map(|(base, _)| *base)
                .collect(),
            Node::Number(_) | Node::Pi | Node::Sum(_) => Vec::new(),
            Node::Symbol(_) | Node::Call(..) => vec![term],
        }
    }

    /// The coefficient that all terms share but for the sign, parameters in it, and the sum without it.
    pub(super) fn common_coefficient(&mut self, sum: &Sum) -> Option<(Expr, Expr)> {
        let (first, number) = sum.terms.first()?;
        let (number, parameters) = (number.abs(), self.parameters(*first));
        let same = |other: &Rational| other.abs() == number;
        if !(sum.constant.is_zero() || parameters == self.pool.one() && same(&sum.constant)) {
            return None;
        }
        if sum.terms.iter().any(|(term, other)| !same(other) || self.parameters(*term) != parameters) {
            return None;
        }
        let coefficient = self.pool.scale(parameters, &number);
        if coefficient == self.pool.one() {
            return None;
        }
        let inverse = self.pool.power(coefficient, &-Rational::one());
        let mut terms: Vec<Expr> = sum.terms.iter().map(|(term, c)| self.pool.scale(*term, c)).collect();
        terms.push(self.pool.number(sum.constant.clone()));
        let terms: Vec<Expr> = terms.into_iter().map(|term| self.pool.mul(term, inverse)).collect();
        Some((coefficient, self.pool.sum(&terms)))
    }

    /// The product of the parameters that a term which changes with the state has as factors.
    fn parameters(&mut self, term: Expr) -> Expr {
        let one = self.pool.one();
        let Node::Product(product) = self.pool.node(term).clone() else { return one };
        let fixed = |(base, _): &(Expr, Rational)| self.dependence(*base) == Dependence::Parameters;
        let (parameters, rest): (Vec<_>, Vec<_>) = product.factors.into_iter().partition(fixed);
        if rest.is_empty() {
            return one;
        }
        parameters.into_iter().fold(one, |product, (base, exponent)| {
            let power = self.pool.power(base, &exponent);
            self.pool.mul(product, power)
        })
    }
}
