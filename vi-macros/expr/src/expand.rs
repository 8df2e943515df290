//! Expansion of products and powers.
//!
//! In: an expression. Out: an equal one without sums as factors of products and without positive integer powers of
//! sums, so that polynomials in symbols, functions and roots cancel exactly. Sums in denominators and arguments are
//! expanded internally and remain factors. The work is bounded: an expansion over the limit is an error.

use std::hash::Hash;

use num_traits::{One, Signed, ToPrimitive};

use crate::{Expr, Node, Pool, Rational, Table, TooLarge, number};

/// Maximum number of terms in one expansion.
const LIMIT: usize = 50_000;

/// Largest power of a constant sum that is expanded, so that it cancels exactly.
const HIGH: u32 = 20;

/// Bits of a coefficient that count as one more term.
const BITS_OF_A_TERM: usize = 16;

/// Remaining number of terms.
struct Budget(usize);

impl Budget {
    fn spend(&mut self, terms: usize) -> Result<(), TooLarge> {
        self.0 = self.0.checked_sub(terms).ok_or(TooLarge::Terms { limit: LIMIT })?;
        Ok(())
    }
}

impl<S: Clone + Eq + Hash> Pool<S> {
    /// The expanded expression.
    ///
    /// # Errors
    /// [`TooLarge::Terms`] if the expansion would write more than 50 000 terms, including intermediate ones.
    /// [`TooLarge::Work`] if the pool is exhausted.
    pub fn expand(&mut self, expr: Expr) -> Result<Expr, TooLarge> {
        let mut budget = Budget(LIMIT);
        let mut current = expr;
        // A product of terms with roots can expose a new sum: (1 + c*(a + b)^(1/2))^2. Then repeat.
        loop {
            let next = self.expand_once(current, &mut budget)?;
            self.within_work()?;
            if next == current {
                return Ok(current);
            }
            current = next;
        }
    }

    fn expand_once(&mut self, expr: Expr, budget: &mut Budget) -> Result<Expr, TooLarge> {
        // Changed nodes only.
        let mut expanded: Table<Expr, Expr> = Table::default();
        for node in self.reachable(&[expr]) {
            let new = |child: &Expr| expanded.get(*child).copied().unwrap_or(*child);
            let shared = self.shared_node(node);
            let changes = shared.any_child(|child| expanded.contains(child));
            let result = match &*shared {
                Node::Sum(sum) => {
                    budget.spend(sum.terms.iter().map(|(term, _)| self.term_count(new(term))).sum())?;
                    if changes {
                        let constant = self.number(sum.constant.clone());
                        let parts = sum.terms.iter().map(|(term, c)| (new(term), c.clone()));
                        self.combination(parts.chain([(constant, Rational::one())]))
                    } else {
                        node
                    }
                }
                Node::Product(product) if changes || product.factors.iter().any(|factor| self.is_open(factor)) => {
                    let factors: Vec<_> = product.factors.iter().map(|(base, e)| (new(base), e.clone())).collect();
                    self.expand_product(factors, budget)?
                }
                Node::Call(function, arguments) if changes => {
                    let arguments: Vec<Expr> = arguments.iter().map(new).collect();
                    self.call(*function, &arguments)
                }
                Node::Opaque(..) | Node::Select(_) if changes => self.rebuild(&shared, &|child| new(&child)),
                _ => node,
            };
            if result != node {
                expanded.insert(node, result);
            }
        }
        Ok(expanded.get(expr).copied().unwrap_or(expr))
    }

    /// Product of powers of expanded bases.
    fn expand_product(&mut self, factors: Vec<(Expr, Rational)>, budget: &mut Budget) -> Result<Expr, TooLarge> {
        let (sums, others): (Vec<_>, Vec<_>) = factors.into_iter().partition(|factor| self.is_open(factor));
        let mut result = self.powers(others);
        for (base, exponent) in sums {
            // An exponent beyond a machine integer exceeds the budget.
            let exponent = exponent.to_usize().unwrap_or(usize::MAX);
            for _ in 0..exponent {
                result = self.multiply_out(result, base, budget)?;
            }
        }
        Ok(result)
    }

    /// A power that is expanded. High powers of constants are not: they are rounded as a whole.
    fn is_open(&self, (base, exponent): &(Expr, Rational)) -> bool {
        let is_high = || self.is_constant(*base) && *exponent > Rational::from_integer(HIGH.into());
        exponent.is_integer() && exponent.is_positive() && self.term_count(*base) > 1 && !is_high()
    }

    /// Product of two expanded expressions, term by term.
    fn multiply_out(&mut self, left: Expr, right: Expr, budget: &mut Budget) -> Result<Expr, TooLarge> {
        let (left, right) = (self.terms(left), self.terms(right));
        budget.spend(left.len().saturating_mul(right.len()))?;
        let mut products = Vec::new();
        for (left, left_coefficient) in &left {
            for (right, right_coefficient) in &right {
                let coefficient = number::product(left_coefficient, right_coefficient);
                budget.spend(usize::try_from(number::bits(&coefficient)).unwrap_or(usize::MAX) / BITS_OF_A_TERM)?;
                products.push((self.mul(*left, *right), coefficient));
            }
        }
        Ok(self.combination(products))
    }

    /// The parts of a sum, with the constant as a multiple of 1; any other expression is its only part.
    fn terms(&self, expr: Expr) -> Vec<(Expr, Rational)> {
        match self.node(expr) {
            Node::Sum(sum) => {
                let constant = (!num_traits::Zero::is_zero(&sum.constant)).then(|| (Expr::ONE, sum.constant.clone()));
                sum.terms.iter().cloned().chain(constant).collect()
            }
            _ => vec![(expr, Rational::one())],
        }
    }

    fn term_count(&self, expr: Expr) -> usize {
        match self.node(expr) {
            Node::Sum(sum) => sum.terms.len() + usize::from(!num_traits::Zero::is_zero(&sum.constant)),
            _ => 1,
        }
    }
}
