//! Squares of sines and cosines with equal coefficients.
//!
//! In: the terms of a canonical sum. Out: the same sum with fewer terms, for any product P without these functions of u:
//!
//! - `c P sin(u)^2 + c P cos(u)^2 = c P`
//! - `c P cosh(u)^2 - c P sinh(u)^2 = c P`
//!
//! Squares with different coefficients stay: `2 sin(u)^2 + cos(u)^2` has no form with fewer terms. Higher powers stay, too:
//! with them, sums that are equal could take forms whose difference is not seen to be zero.

use std::hash::Hash;

use rustc_hash::FxHashMap;

use crate::{Expr, Function, Node, Pool, Product, Rational};

/// The argument of two squares, whether they are hyperbolic, and the product beside them.
type Key<S> = (Expr, bool, Node<S>);

/// The terms with the square of the sine and of the cosine, by their places.
type Pair = [Option<usize>; 2];

impl<S: Clone + Eq + Hash> Pool<S> {
    /// Whether the power is a square of such a function.
    pub(crate) fn is_square(&self, (base, exponent): &(Expr, Rational)) -> bool {
        *exponent == Rational::from_integer(2.into()) && self.of_circle(*base).is_some()
    }

    /// Place in a [`Pair`], whether the function is hyperbolic, and its argument.
    fn of_circle(&self, base: Expr) -> Option<(usize, bool, Expr)> {
        let Node::Call(function, arguments) = self.node(base) else { return None };
        let (place, is_hyperbolic) = match function {
            Function::Sin => (0, false),
            Function::Cos => (1, false),
            Function::Sinh => (0, true),
            Function::Cosh => (1, true),
            _ => return None,
        };
        Some((place, is_hyperbolic, *arguments.first()?))
    }

    /// The parts of an equal sum with fewer terms; `None` if no squares have equal coefficients. Nothing else enters the pool,
    /// so that handles, and with them the order of all later sums, do not depend on the search.
    pub(crate) fn without_squares(&mut self, terms: &[(Expr, Rational)]) -> Option<Vec<(Expr, Rational)>> {
        if !self.has_squares || terms.len() < 2 {
            return None;
        }
        let mut pairs: FxHashMap<Key<S>, Pair> = FxHashMap::default();
        let mut is_merged = vec![false; terms.len()];
        let mut merged = Vec::new();
        for (place, (term, coefficient)) in terms.iter().enumerate() {
            let Node::Product(Product { factors }) = &*self.shared_node(*term) else { continue };
            for (index, factor) in factors.iter().enumerate().filter(|(_, factor)| self.is_square(factor)) {
                let Some((side, is_hyperbolic, argument)) = self.of_circle(factor.0) else { continue };
                let mut rest = factors.clone();
                rest.remove(index);
                self.spend(rest.len());
                let is_of_same = |(base, _): &(Expr, Rational)| {
                    self.of_circle(*base)
                        .is_some_and(|(_, hyperbolic, of)| (hyperbolic, of) == (is_hyperbolic, argument))
                };
                if rest.iter().any(is_of_same) {
                    continue;
                }
                let key = (argument, is_hyperbolic, Node::Product(Product { factors: rest.clone() }));
                let pair = pairs.entry(key).or_default();
                pair[side] = Some(place);
                let Some(other) = pair[1 - side] else { continue };
                if is_merged[place] || is_merged[other] {
                    continue;
                }
                let of_other = &terms[other].1;
                let is_equal = if is_hyperbolic { *coefficient == -of_other } else { coefficient == of_other };
                if is_equal {
                    (is_merged[place], is_merged[other]) = (true, true);
                    let of_cosine = if side == 1 { coefficient } else { of_other };
                    merged.push((rest, of_cosine.clone()));
                }
            }
        }
        if merged.is_empty() {
            return None;
        }
        let left = terms.iter().zip(is_merged).filter(|(_, is_merged)| !is_merged).map(|(term, _)| term.clone());
        let mut parts: Vec<_> = left.collect();
        for (rest, coefficient) in merged {
            parts.push((self.powers(rest), coefficient));
        }
        Some(parts)
    }
}
