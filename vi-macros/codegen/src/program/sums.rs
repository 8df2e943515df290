//! The form in which a sum is written.
//!
//! In: a sum. Out: the common factor of its terms, and the rest. Terms of order h are added first and joined to the
//! large ones last. A factor is extracted if this saves products in every step. Parameters are coefficients, computed
//! once per run, and are not extracted.

use super::lowering::{Dependence, Lowering, SumForm};
use crate::symbol::Symbol;
use num_traits::{One, Signed, Zero};
use std::collections::BTreeMap;
use vi_expr::{Expr, Node, Rational, Sum};

impl Lowering<'_> {
    /// The form of an expression.
    pub(super) fn sum_form(&mut self, expr: Expr) -> SumForm {
        if let Some(known) = self.sum_forms.get(expr) {
            return *known;
        }
        let form = self.known.sum_forms.get(expr).copied().unwrap_or_else(|| self.find_sum_form(expr));
        // The parts of the form are new expressions in each function.
        if let SumForm::Factor { inside, rest, .. } = form {
            self.record_powers(&[inside, rest.unwrap_or(inside)]);
        }
        self.known.sum_forms.insert(expr, form);
        self.sum_forms.insert(expr, form);
        form
    }

    fn find_sum_form(&mut self, expr: Expr) -> SumForm {
        let Node::Sum(sum) = self.pool.node(expr).clone() else { return SumForm::Term };
        if sum.terms.is_empty() || sum.constant.is_zero() && sum.terms.len() == 1 {
            return SumForm::Term;
        }
        let form = self.by_size(&sum).or_else(|| self.common_factor(&sum));
        form.or_else(|| self.common_coefficient(&sum)).unwrap_or(SumForm::Plain)
    }

    /// Large terms and terms of order h, if a sum has both.
    fn by_size(&mut self, sum: &Sum) -> Option<SumForm> {
        let (small, large): (Vec<_>, Vec<_>) = sum.terms.iter().cloned().partition(|(term, _)| self.is_small(*term));
        if small.is_empty() || (large.is_empty() && sum.constant.is_zero()) {
            return None;
        }
        let large = self.pool_sum(&Sum { constant: sum.constant.clone(), terms: large });
        Some(SumForm::BySize { large, small: self.pool_sum(&Sum { constant: Rational::zero(), terms: small }) })
    }

    /// The low part of a carried quantity, or a term with a factor h.
    fn is_small(&self, term: Expr) -> bool {
        match self.pool.node(term) {
            Node::Symbol(Symbol::Low(_) | Symbol::Step) => true,
            Node::Product(product) => product.factors.iter().any(|(base, exponent)| {
                exponent.is_positive() && matches!(self.pool.node(*base), Node::Symbol(Symbol::Low(_) | Symbol::Step))
            }),
            _ => false,
        }
    }

    fn pool_sum(&mut self, sum: &Sum) -> Expr {
        let constant = self.pool.number(sum.constant.clone());
        self.pool.combination(sum.terms.iter().cloned().chain([(constant, Rational::one())]))
    }

    /// The factor shared by most terms, its cofactor, and the other terms. Parameters cost nothing as factors of
    /// varying terms, because coefficients are computed once per run. They are extracted only from sums of constants.
    fn common_factor(&mut self, sum: &Sum) -> Option<SumForm> {
        let mut counts: BTreeMap<Expr, usize> = BTreeMap::new();
        let varies = sum.terms.iter().any(|(term, _)| self.dependence(*term) > Dependence::Parameters);
        // A product with a limit needs all its factors, so no factor of it is extracted.
        let Self { pool, known, .. } = self;
        let (whole, terms): (Vec<_>, Vec<_>) =
            sum.terms.iter().cloned().partition(|(term, _)| known.products.has_limit(pool, *term));
        for (term, _) in &terms {
            for base in self.bases(*term) {
                if !varies || self.dependence(base) > Dependence::Parameters {
                    *counts.entry(base).or_default() += 1;
                }
            }
        }
        // Among equally frequent factors, the step has priority, then the oldest expression.
        let step = self.pool.symbol(Symbol::Step);
        let (base, count) =
            counts.into_iter().max_by_key(|(base, count)| (*count, *base == step, core::cmp::Reverse(*base)))?;
        if count < 2 {
            return None;
        }
        let exponents = terms.iter().filter_map(|(term, _)| self.exponent(*term, base));
        let exponent = exponents.min().unwrap_or_else(Rational::one);
        let inverse = self.pool.power(base, &-exponent.clone());
        let (mut inside, mut rest) = (Vec::new(), Sum { constant: sum.constant.clone(), terms: whole });
        for (term, coefficient) in terms {
            if self.exponent(term, base).is_some() {
                let scaled = self.pool.scale(term, &coefficient);
                inside.push(self.pool.mul(scaled, inverse));
            } else {
                rest.terms.push((term, coefficient));
            }
        }
        let factor = self.pool.power(base, &exponent);
        if self.dissolves(&inside) {
            return None;
        }
        let (inside, rest) = (self.pool.sum(&inside), self.pool_sum(&rest));
        Some(SumForm::Factor { factor, inside, rest: (!self.pool.is_zero(rest)).then_some(rest) })
    }

    /// Whether a term is a bare sum. Factoring would merge it with the others and lose its differences. So e²/2 + e³/3
    /// stays.
    fn dissolves(&self, terms: &[Expr]) -> bool {
        terms.iter().any(|term| matches!(self.pool.node(*term), Node::Sum(sum) if sum.terms.len() > 1))
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
            Node::Symbol(_) | Node::Call(..) | Node::Opaque(..) | Node::Select(_) => vec![term],
        }
    }

    /// The coefficient shared by most terms up to sign, with parameters if all terms have the same, and the sum without
    /// it.
    fn common_coefficient(&mut self, sum: &Sum) -> Option<SumForm> {
        let mut parameters = self.parameters(sum.terms.first()?.0);
        let alike = |(term, _): &(Expr, Rational)| self.parameters(*term) == parameters;
        if !sum.constant.is_zero() && !parameters.is_empty() || !sum.terms.iter().all(alike) {
            return None;
        }
        let mut counts: BTreeMap<Rational, usize> = BTreeMap::new();
        let numbers = sum.terms.iter().map(|(_, number)| number).chain([&sum.constant]);
        for number in numbers.filter(|number| !number.is_zero()) {
            *counts.entry(number.abs()).or_default() += 1;
        }
        // Each other term remains a product, and the sum becomes one; terms without a coefficient become products too.
        let all: usize = counts.values().sum();
        let ones = counts.get(&Rational::one()).copied().unwrap_or(0);
        let (number, count) = counts.into_iter().max_by_key(|(_, count)| *count)?;
        let number = if count == all || count > ones + 1 { number } else { Rational::one() };
        if number.is_one() && parameters.is_empty() {
            return None;
        }
        let mut product = |sign: i32| {
            let power = |(base, exponent): &mut (Expr, Rational)| {
                self.pool.power(*base, &(&*exponent * Rational::from_integer(sign.into())))
            };
            let powers: Vec<Expr> = parameters.iter_mut().map(power).collect();
            powers.into_iter().fold(self.pool.one(), |product, power| self.pool.mul(product, power))
        };
        let (coefficient, inverse) = (product(1), product(-1));
        let coefficient = self.pool.scale(coefficient, &number);
        let mut terms = vec![self.pool.number(&sum.constant / &number)];
        for (term, c) in &sum.terms {
            let term = self.pool.mul(*term, inverse);
            terms.push(self.pool.scale(term, &(c / &number)));
        }
        (!self.dissolves(&terms)).then(|| SumForm::Coefficient { coefficient, inside: self.pool.sum(&terms) })
    }

    /// The powers of parameters in a term that changes with the state.
    fn parameters(&self, term: Expr) -> Vec<(Expr, Rational)> {
        let Node::Product(product) = self.pool.node(term) else { return Vec::new() };
        let fixed = |(base, _): &&(Expr, Rational)| self.is_parameter(*base);
        if product.factors.iter().all(|factor| fixed(&factor)) {
            return Vec::new();
        }
        product.factors.iter().filter(fixed).cloned().collect()
    }
}
