//! Merges terms that differ by constant factors.
//!
//! In: expressions. Out: equal ones whose sums have no two terms that differ by constant factors only, so that each
//! coefficient is rounded once: `x - cos(1e-8)*x` becomes `(1 - cos(1e-8))*x`, and `x + sqrt(2) - 1` becomes `x` plus
//! the nearest `f64`.

use std::hash::Hash;

use core::cmp::Ordering;
use num_traits::{One, Zero};

use crate::{Expr, Node, Pool, Product, Rational, Sum, Table};

/// The terms of a sum with one symbolic factor: unchanged, and as constant factors with coefficients.
struct Group {
    factor: Expr,
    terms: Vec<(Expr, Rational)>,
    constants: Vec<(Expr, Rational)>,
}

impl<S: Clone + Eq + Hash> Pool<S> {
    /// The expressions with merged terms; undefined if a constant has no normal `f64`.
    pub fn collect_constants(&mut self, exprs: &[Expr]) -> Vec<Expr> {
        // Changed nodes only.
        let mut changed: Table<Expr, Expr> = Table::default();
        let nodes = if self.has_irrational { self.reachable(exprs) } else { Vec::new() };
        for node in nodes.into_iter().filter(|node| !self.is_constant(*node)).collect::<Vec<_>>() {
            let shared = self.shared_node(node);
            let new = |child: Expr| changed.get(child).copied().unwrap_or(child);
            let collected = match &*shared {
                Node::Sum(sum) if sum.terms.iter().any(|(term, _)| self.has_constant(*term)) => {
                    self.collect_sum(sum, &new)
                }
                shared if shared.any_child(|child| changed.contains(child)) => self.rebuild(shared, &new),
                _ => node,
            };
            if collected != node {
                changed.insert(node, collected);
            }
        }
        exprs.iter().map(|expr| changed.get(*expr).copied().unwrap_or(*expr)).collect()
    }

    /// Whether a term contains a constant that is not an exact number.
    fn has_constant(&self, term: Expr) -> bool {
        match self.node(term) {
            Node::Product(product) => product.factors.iter().any(|(base, _)| self.is_constant(*base)),
            _ => self.is_constant(term),
        }
    }

    fn collect_sum(&mut self, sum: &Sum, new: &dyn Fn(Expr) -> Expr) -> Expr {
        let mut groups: Vec<Group> = Vec::new();
        let mut places: Table<Expr, usize> = Table::default();
        let rational = (!sum.constant.is_zero()).then(|| (Expr::ONE, sum.constant.clone()));
        for (term, coefficient) in sum.terms.iter().cloned().chain(rational) {
            let (constant, factor) = self.split(term, new);
            let place = places.get(factor).copied().unwrap_or(groups.len());
            if place == groups.len() {
                places.insert(factor, place);
                groups.push(Group { factor, terms: Vec::new(), constants: Vec::new() });
            }
            groups[place].terms.push((new(term), coefficient.clone()));
            groups[place].constants.push((constant, coefficient));
        }
        let mut parts = Vec::new();
        for Group { factor, terms, constants } in groups {
            let is_rounded = match constants.as_slice() {
                // Rounds it with the coefficient if it is out of range by itself.
                [(constant, _)] if self.constant(*constant).is_ok() => {
                    parts.extend(terms);
                    continue;
                }
                [_] => true,
                _ => factor == Expr::ONE,
            };
            let constant = self.combination(constants);
            let constant = if is_rounded { self.rounded(constant) } else { self.signed(constant) };
            parts.push((self.mul(constant, factor), Rational::one()));
        }
        self.combination(parts)
    }

    /// A product without its constant factors; 1 for a constant that is not an exact number.
    pub fn without_constants(&mut self, expr: Expr) -> Expr {
        if self.has_irrational && self.has_constant(expr) { self.split(expr, &|child| child).1 } else { expr }
    }

    /// Constant and symbolic factor of a term.
    pub(crate) fn split(&mut self, term: Expr, new: &dyn Fn(Expr) -> Expr) -> (Expr, Expr) {
        if self.is_constant(term) {
            return (term, Expr::ONE);
        }
        let Node::Product(Product { factors }) = &*self.shared_node(term) else { return (Expr::ONE, new(term)) };
        let (constant, symbolic): (Vec<_>, Vec<_>) =
            factors.iter().cloned().partition(|(base, _)| self.is_constant(*base));
        if constant.is_empty() {
            return (Expr::ONE, new(term));
        }
        let constant = self.powers(constant);
        (constant, self.powers(symbolic.into_iter().map(|(base, exponent)| (new(base), exponent))))
    }

    /// A constant as the nearest `f64`.
    fn rounded(&mut self, constant: Expr) -> Expr {
        match self.constant(constant).ok().and_then(Rational::from_float) {
            Some(number) => self.number(number),
            None => Expr::UNDEFINED,
        }
    }

    /// The constant, or 0 if its terms cancel.
    fn signed(&mut self, constant: Expr) -> Expr {
        match self.constant_sign(constant) {
            Ok(Ordering::Equal) => Expr::ZERO,
            Ok(_) => constant,
            Err(_) => Expr::UNDEFINED,
        }
    }
}
