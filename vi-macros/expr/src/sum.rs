//! Canonical sums.
//!
//! In: a linear combination of expressions. Out: `constant + Σ coefficient·term`, with nested sums flattened, equal
//! terms collected, numbers folded, and squares of sines and cosines merged (see `squares`).
//!
//! No term of the result is a number or a sum, and numeric coefficients exist only in a [`Sum`].

use std::hash::Hash;

use num_traits::{One, Zero};

use crate::effort::MADE;
use crate::{Expr, Node, Pool, Rational, Sum, number};

impl<S: Clone + Eq + Hash> Pool<S> {
    /// `left + right`. Use [`Pool::sum`] for many terms: repeated addition copies the terms each time.
    pub fn add(&mut self, left: Expr, right: Expr) -> Expr {
        self.sum(&[left, right])
    }

    /// `left - right`.
    pub fn sub(&mut self, left: Expr, right: Expr) -> Expr {
        self.combination([(left, Rational::one()), (right, -Rational::one())])
    }

    /// `-expr`.
    pub fn neg(&mut self, expr: Expr) -> Expr {
        self.scale(expr, &-Rational::one())
    }

    /// `Σ terms`, 0 if there are none.
    pub fn sum(&mut self, terms: &[Expr]) -> Expr {
        match terms {
            [only] => *only,
            _ => self.combination(terms.iter().map(|term| (*term, Rational::one()))),
        }
    }

    /// `factor·expr`, distributed over a sum.
    pub fn scale(&mut self, expr: Expr, factor: &Rational) -> Expr {
        if factor.is_one() {
            return expr;
        }
        self.combination([(expr, factor.clone())])
    }

    /// `Σ coefficient·term`; undefined if a term is, for any coefficient.
    pub fn combination(&mut self, parts: impl IntoIterator<Item = (Expr, Rational)>) -> Expr {
        let mut constant = Rational::zero();
        let Some(terms) = self.flattened(&mut constant, parts) else { return Expr::UNDEFINED };
        let mut terms = self.collected(terms);
        while let Some(parts) = self.without_squares(&terms) {
            let Some(flat) = self.flattened(&mut constant, parts) else { return Expr::UNDEFINED };
            terms = self.collected(flat);
        }
        self.intern_sum(constant, terms)
    }

    /// The terms of all parts, whose numbers are added to `constant`; `None` if a part is undefined.
    fn flattened(
        &self,
        constant: &mut Rational,
        parts: impl IntoIterator<Item = (Expr, Rational)>,
    ) -> Option<Vec<(Expr, Rational)>> {
        let mut terms = Vec::new();
        for (expr, coefficient) in parts {
            if self.is_undefined(expr) {
                return None;
            }
            if coefficient.is_zero() {
                continue;
            }
            match self.node(expr) {
                Node::Number(value) => {
                    *constant = number::sum(constant, &number::product(&coefficient, value));
                    self.spend_on(constant);
                }
                Node::Sum(sum) => {
                    *constant = number::sum(constant, &number::product(&coefficient, &sum.constant));
                    self.spend_on(constant);
                    for (term, inner) in &sum.terms {
                        let product = number::product(&coefficient, inner);
                        self.spend_on(&product);
                        terms.push((*term, product));
                    }
                }
                _ => terms.push((expr, coefficient)),
            }
            if self.is_exhausted() {
                return None;
            }
        }
        self.spend(MADE * terms.len());
        Some(terms)
    }

    fn intern_sum(&mut self, constant: Rational, terms: Vec<(Expr, Rational)>) -> Expr {
        match terms.as_slice() {
            [] => self.number(constant),
            [(term, coefficient)] if constant.is_zero() && coefficient.is_one() => *term,
            _ => self.intern(Node::Sum(Sum { constant, terms })),
        }
    }

    /// Merges equal terms, in ascending order.
    fn collected(&self, mut terms: Vec<(Expr, Rational)>) -> Vec<(Expr, Rational)> {
        terms.sort_by_key(|(term, _)| *term);
        let mut collected: Vec<(Expr, Rational)> = Vec::with_capacity(terms.len());
        for (term, coefficient) in terms {
            match collected.last_mut() {
                Some((last, sum)) if *last == term => {
                    *sum = number::sum(sum, &coefficient);
                    self.spend_on(sum);
                }
                _ => collected.push((term, coefficient)),
            }
            if self.is_exhausted() {
                break;
            }
        }
        collected.retain(|(_, coefficient)| !coefficient.is_zero());
        collected
    }
}
