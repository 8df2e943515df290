//! Canonical products and powers.
//!
//! In: powers of any expressions with exact exponents. Out: `coefficient · Π base^exponent`, products flattened, exponents
//! of equal bases added, numbers folded into the coefficient:
//!
//! - `(b^e)^n = b^(e n)` for integers `n`; `(x^2)^(1/2)` stays, since it is not `x`
//! - `(b c)^n = b^n c^n` for integers `n`
//! - `(k b)^e = k^e b^e` for numbers `k` with `e` an integer or `k^e` exact: `(4x)^(1/2) = 2 x^(1/2)`
//!
//! Exponents add regardless of the domain: `x·x^-1 = 1`.
//!
//! The coefficient of the result is outside (see [`crate::Sum`]), and its factors satisfy [`Product`].

use std::hash::Hash;

use num_traits::{One, Signed, Zero};

use crate::effort::MADE;
use crate::number::{self, Power};
use crate::{Expr, Node, Pool, Product, Rational};

/// A reduced power.
enum Reduction {
    /// Canonical as it is.
    Canonical,
    /// A number times other powers.
    Parts(Rational, Vec<(Expr, Rational)>),
    Undefined,
}

impl<S: Clone + Eq + Hash> Pool<S> {
    /// `left·right`. Use [`Pool::product`] for many factors, as [`Pool::sum`] for sums.
    pub fn mul(&mut self, left: Expr, right: Expr) -> Expr {
        self.product(&[left, right])
    }

    /// `numerator / denominator`; undefined if the denominator is the number 0.
    pub fn div(&mut self, numerator: Expr, denominator: Expr) -> Expr {
        self.powers([(numerator, Rational::one()), (denominator, -Rational::one())])
    }

    /// `Π factors`, 1 if there are none.
    pub fn product(&mut self, factors: &[Expr]) -> Expr {
        match factors {
            [only] => *only,
            _ if factors.contains(&Expr::ZERO) && !factors.contains(&Expr::UNDEFINED) => Expr::ZERO,
            _ => self.powers(factors.iter().map(|factor| (*factor, Rational::one()))),
        }
    }

    /// `base^exponent`; `x^0 = 1` for every `x` except the undefined one, and the square root is the power 1/2.
    /// Negative powers of 0 and fractional powers of negative numbers are undefined.
    pub fn power(&mut self, base: Expr, exponent: &Rational) -> Expr {
        if exponent.is_one() {
            return base;
        }
        self.powers([(base, exponent.clone())])
    }

    /// `Π base^exponent`.
    pub(crate) fn powers(&mut self, factors: impl IntoIterator<Item = (Expr, Rational)>) -> Expr {
        let mut factors: Vec<_> = factors.into_iter().collect();
        let has_no_value = |(base, exponent): &(Expr, Rational)| {
            self.is_undefined(*base) || *base == Expr::ZERO && exponent.is_negative()
        };
        if factors.iter().any(has_no_value) {
            return Expr::UNDEFINED;
        }
        let (mut coefficient, mut canonical) = (Rational::one(), false);
        while !canonical {
            self.spend(MADE * factors.len());
            if self.is_exhausted() {
                return Expr::UNDEFINED;
            }
            canonical = true;
            let mut reduced = Vec::with_capacity(factors.len());
            for (base, exponent) in gathered(factors) {
                match self.reduce(base, &exponent, &coefficient) {
                    Reduction::Canonical => reduced.push((base, exponent)),
                    Reduction::Parts(number, parts) => {
                        coefficient = number::product(&coefficient, &number);
                        self.spend_on(&coefficient);
                        reduced.extend(parts);
                        canonical = false;
                    }
                    Reduction::Undefined => return Expr::UNDEFINED,
                }
            }
            factors = reduced;
        }
        if coefficient.is_zero() {
            return Expr::ZERO;
        }
        let body = self.intern_product(factors);
        self.scale(body, &coefficient)
    }

    /// Splits one power; numbers fold as long as they fit beside `coefficient`.
    fn reduce(&mut self, base: Expr, exponent: &Rational, coefficient: &Rational) -> Reduction {
        match &*self.shared_node(base) {
            Node::Number(value) => self.reduce_number(value, exponent, coefficient),
            Node::Product(product) if exponent.is_integer() => {
                let parts =
                    product.factors.iter().map(|(base, inner)| (*base, number::product(inner, exponent))).collect();
                Reduction::Parts(Rational::one(), parts)
            }
            Node::Sum(sum) => match sum.as_multiple() {
                Some((factor, term)) => self.reduce_multiple(factor, term, exponent, coefficient),
                None => Reduction::Canonical,
            },
            _ => Reduction::Canonical,
        }
    }

    fn reduce_number(&mut self, value: &Rational, exponent: &Rational, coefficient: &Rational) -> Reduction {
        match number::power(value, exponent) {
            Power::Undefined => Reduction::Undefined,
            Power::TooLarge => Reduction::Canonical,
            Power::Folded { coefficient: exact, roots } => match roots.as_slice() {
                [(root, fraction)] if root == value && fraction == exponent => Reduction::Canonical,
                _ if !fits(coefficient, &exact) => Reduction::Canonical,
                _ => Reduction::Parts(exact, roots.into_iter().map(|(root, e)| (self.number(root), e)).collect()),
            },
        }
    }

    /// `(factor·term)^exponent`.
    fn reduce_multiple(&mut self, factor: &Rational, term: Expr, e: &Rational, coefficient: &Rational) -> Reduction {
        match number::exact_power(factor, e) {
            Some(exact) if fits(coefficient, &exact) => Reduction::Parts(exact, vec![(term, e.clone())]),
            _ if e.is_integer() => {
                let factor = self.number(factor.clone());
                Reduction::Parts(Rational::one(), vec![(factor, e.clone()), (term, e.clone())])
            }
            _ => Reduction::Canonical,
        }
    }

    fn intern_product(&mut self, factors: Vec<(Expr, Rational)>) -> Expr {
        match factors.as_slice() {
            [] => Expr::ONE,
            [(base, exponent)] if exponent.is_one() => *base,
            _ => self.intern(Node::Product(Product { factors })),
        }
    }
}

/// Merges equal bases, in ascending order, and drops those with exponent 0.
fn gathered(mut factors: Vec<(Expr, Rational)>) -> Vec<(Expr, Rational)> {
    factors.sort_by_key(|(base, _)| *base);
    let mut gathered: Vec<(Expr, Rational)> = Vec::with_capacity(factors.len());
    for (base, exponent) in factors {
        match gathered.last_mut() {
            Some((last, sum)) if *last == base => *sum = number::sum(sum, &exponent),
            _ => gathered.push((base, exponent)),
        }
    }
    gathered.retain(|(_, exponent)| !exponent.is_zero());
    gathered
}

/// Whether the product of two numbers is small enough; zero and one always are.
fn fits(left: &Rational, right: &Rational) -> bool {
    left.is_one() && number::bits(right) <= number::MAX_BITS
        || right.is_one()
        || right.is_zero()
        || number::bits(left) + number::bits(right) <= number::MAX_BITS
}
