//! From expressions to operations.
//!
//! In: expressions without fields. Out: operations, shared over everything that one function evaluates. Sums are
//! factored by what their terms have in common, and products start with what is constant over a run: numbers,
//! parameters and the step. In sums with terms of order h, those are added up first and joined to the large ones last,
//! so that no digit of theirs is lost early.

use super::operations::{Operation, OperationId, Operations};
use super::powers::{Factor, Occurrence};
use crate::symbol::{Symbol, Variable};
use num_traits::{One, Signed, Zero};
use std::collections::{BTreeMap, BTreeSet};
use vi_expr::{Expr, Node, Pool, Rational, Sum};

/// What an expression depends on, the widest last.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Dependence {
    /// Nothing: it is a number.
    None,
    /// Parameters: it is constant over a run.
    Parameters,
    /// Parameters and the step: it is constant over a run of fixed steps.
    Run,
    /// What changes from step to step.
    Step,
}

/// The lowering of one function.
pub(super) struct Lowering<'a> {
    pub(super) pool: &'a mut Pool<Symbol>,
    pub(super) operations: Operations,
    pub(super) occurrences: BTreeMap<Expr, Occurrence>,
    /// The arguments of sines and cosines.
    pub(super) angles: BTreeSet<Expr>,
    values: BTreeMap<Expr, OperationId>,
    dependences: BTreeMap<Expr, Dependence>,
    arguments: &'a BTreeMap<(usize, Variable), Expr>,
}

impl<'a> Lowering<'a> {
    /// A function with these arguments of the points.
    pub(super) fn new(pool: &'a mut Pool<Symbol>, arguments: &'a BTreeMap<(usize, Variable), Expr>) -> Self {
        let (operations, occurrences, angles) = (Operations::default(), BTreeMap::new(), BTreeSet::new());
        let (values, dependences) = (BTreeMap::new(), BTreeMap::new());
        Self { pool, operations, occurrences, angles, values, dependences, arguments }
    }

    /// Lowers expressions and all that they need, children first.
    pub(super) fn lower(&mut self, exprs: &[Expr]) -> Vec<OperationId> {
        let used: Vec<Expr> = exprs.iter().copied().chain(self.arguments.values().copied()).collect();
        self.record_powers(&used);
        self.record_angles(&used);
        for expr in self.pool.reachable(&used) {
            self.value(expr);
        }
        exprs.iter().map(|expr| self.value(*expr)).collect()
    }

    /// The operation of an expression whose children are lowered.
    pub(super) fn value(&mut self, expr: Expr) -> OperationId {
        if let Some(known) = self.values.get(&expr) {
            return *known;
        }
        let node = self.pool.node(expr).clone();
        let value = if self.dependence(expr) == Dependence::None {
            let number = match &node {
                Node::Number(number) => Self::number(number),
                _ => self.pool.evaluate(expr, &mut |_| f64::NAN),
            };
            self.operations.constant(number)
        } else {
            match node {
                Node::Symbol(symbol) => self.symbol(symbol),
                Node::Sum(sum) => self.sum(&sum),
                Node::Product(product) => self.product(&product.factors, &Rational::one()),
                Node::Call(function, arguments) => self.call(function, &arguments),
                Node::Number(_) | Node::Pi => self.operations.constant(f64::NAN),
            }
        };
        self.values.insert(expr, value);
        value
    }

    /// What an expression depends on; its children are known but for those that lowering made.
    pub(super) fn dependence(&mut self, expr: Expr) -> Dependence {
        if let Some(known) = self.dependences.get(&expr) {
            return *known;
        }
        let children: Vec<Expr> = match self.pool.node(expr) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => Vec::new(),
            Node::Sum(sum) => sum.terms.iter().map(|(term, _)| *term).collect(),
            Node::Product(product) => product.factors.iter().map(|(base, _)| *base).collect(),
            Node::Call(_, arguments) => arguments.clone(),
        };
        let found = match self.pool.node(expr) {
            Node::Symbol(Symbol::Parameter(_)) => Dependence::Parameters,
            Node::Symbol(Symbol::Step) => Dependence::Run,
            Node::Symbol(_) => Dependence::Step,
            _ => children.into_iter().map(|child| self.dependence(child)).max().unwrap_or(Dependence::None),
        };
        self.dependences.insert(expr, found);
        found
    }

    fn symbol(&mut self, symbol: Symbol) -> OperationId {
        let Symbol::AtPoint(point, variable) = symbol else {
            return self.operations.add(Operation::Input(symbol));
        };
        let Some(argument) = self.arguments.get(&(point, variable)).copied() else {
            return self.operations.add(Operation::Input(Symbol::AtPoint(point, variable)));
        };
        let value = self.value(argument);
        self.operations.call_it(value, Symbol::AtPoint(point, variable));
        value
    }

    fn call(&mut self, function: vi_expr::Function, arguments: &[Expr]) -> OperationId {
        if let Some(value) = arguments.first().and_then(|angle| self.of_two_angles(function, *angle)) {
            return value;
        }
        let values: Vec<OperationId> = arguments.iter().map(|argument| self.value(*argument)).collect();
        match values[..] {
            [only] => self.operations.add(Operation::Call(function, only)),
            [first, second] => self.operations.add(Operation::Call2(function, first, second)),
            // No function of the language takes another number of arguments.
            _ => self.operations.constant(f64::NAN),
        }
    }

    /// Σ coefficient·term + constant.
    fn sum(&mut self, sum: &Sum) -> OperationId {
        if sum.constant.is_zero() && sum.terms.len() == 1 {
            let (term, coefficient) = &sum.terms[0];
            return self.term(*term, coefficient);
        }
        if let Some((large, small)) = self.by_size(sum) {
            return self.join(&large, &small);
        }
        if let Some((factor, inside, rest)) = self.common_factor(sum) {
            let inside = self.value(inside);
            let factor = self.value(factor);
            let product = self.operations.add(Operation::Multiply(inside, factor));
            return match rest {
                Some(rest) if self.leads_negative(rest) => {
                    let positive = self.pool.neg(rest);
                    let positive = self.value(positive);
                    self.operations.add(Operation::Subtract(product, positive))
                }
                Some(rest) => {
                    let rest = self.value(rest);
                    self.operations.add(Operation::Add(rest, product))
                }
                None => product,
            };
        }
        if let Some((coefficient, inside)) = self.common_coefficient(sum) {
            let (inside, coefficient) = (self.value(inside), self.value(coefficient));
            return self.operations.add(Operation::Multiply(inside, coefficient));
        }
        self.plain_sum(sum)
    }

    /// Term by term, positive ones first.
    fn plain_sum(&mut self, sum: &Sum) -> OperationId {
        let (mut positive, mut negative) = (Vec::new(), Vec::new());
        for (term, coefficient) in &sum.terms {
            let value = self.term(*term, &coefficient.abs());
            if coefficient.is_negative() { negative.push(value) } else { positive.push(value) }
        }
        if !sum.constant.is_zero() {
            let value = self.operations.constant(Self::number(&sum.constant.abs()));
            if sum.constant.is_negative() { negative.push(value) } else { positive.push(value) }
        }
        let add = |operations: &mut Operations, terms: Vec<OperationId>| {
            terms.into_iter().reduce(|left, right| operations.add(Operation::Add(left, right)))
        };
        if let Some(first) = add(&mut self.operations, positive) {
            let subtract = |left, right| self.operations.add(Operation::Subtract(left, right));
            return negative.into_iter().fold(first, subtract);
        }
        let all = add(&mut self.operations, negative);
        let zero = self.operations.constant(0.0);
        self.operations.add(Operation::Negate(all.unwrap_or(zero)))
    }

    /// Large terms and those of order h, where a sum has both.
    fn by_size(&mut self, sum: &Sum) -> Option<(Sum, Sum)> {
        let (small, large): (Vec<_>, Vec<_>) = sum.terms.iter().cloned().partition(|(term, _)| self.is_small(*term));
        if small.is_empty() || (large.is_empty() && sum.constant.is_zero()) {
            return None;
        }
        let large = Sum { constant: sum.constant.clone(), terms: large };
        Some((large, Sum { constant: Rational::zero(), terms: small }))
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

    fn join(&mut self, large: &Sum, small: &Sum) -> OperationId {
        let large = self.pool_sum(large);
        let small = self.pool_sum(small);
        let left = self.value(large);
        if self.leads_negative(small) {
            let positive = self.pool.neg(small);
            let right = self.value(positive);
            return self.operations.add(Operation::Subtract(left, right));
        }
        let right = self.value(small);
        self.operations.add(Operation::Add(left, right))
    }

    /// No term of a sum is positive: its negative reads better.
    fn leads_negative(&self, expr: Expr) -> bool {
        match self.pool.node(expr) {
            Node::Sum(sum) => {
                !sum.constant.is_positive() && sum.terms.iter().all(|(_, coefficient)| coefficient.is_negative())
            }
            _ => false,
        }
    }

    fn pool_sum(&mut self, sum: &Sum) -> Expr {
        let mut terms: Vec<Expr> = sum.terms.iter().map(|(term, c)| self.pool.scale(*term, c)).collect();
        terms.push(self.pool.number(sum.constant.clone()));
        self.pool.sum(&terms)
    }

    /// coefficient·term.
    fn term(&mut self, term: Expr, coefficient: &Rational) -> OperationId {
        if coefficient.is_negative() {
            let positive = self.term(term, &coefficient.abs());
            return self.operations.add(Operation::Negate(positive));
        }
        match self.pool.node(term).clone() {
            Node::Product(product) => self.product(&product.factors, coefficient),
            _ => self.product(&[(term, Rational::one())], coefficient),
        }
    }

    /// coefficient·Π base^exponent; what is constant over a run first.
    fn product(&mut self, factors: &[(Expr, Rational)], coefficient: &Rational) -> OperationId {
        let (mut constant, mut number) = (Vec::new(), Self::number(coefficient));
        let (mut varying, mut below) = (Vec::new(), Vec::new());
        for (base, exponent) in factors {
            let dependence = self.dependence(*base);
            if dependence == Dependence::None {
                let value = self.pool.evaluate(*base, &mut |_| f64::NAN);
                number *= value.powf(Self::number(exponent));
                continue;
            }
            let fixed = dependence <= Dependence::Run;
            match self.factor(*base, exponent) {
                Factor::Above(value) if fixed => constant.push(value),
                Factor::Above(value) => varying.push(value),
                Factor::Below(value) => below.push(value),
            }
        }
        let multiply = |operations: &mut Operations, left, right| operations.add(Operation::Multiply(left, right));
        // A number alone before a varying factor stands behind it; with a parameter it is constant over a run.
        let number = self.operations.constant(number);
        let numerator = if constant.is_empty() {
            let product = varying.into_iter().reduce(|left, right| multiply(&mut self.operations, left, right));
            product.map_or(number, |product| multiply(&mut self.operations, product, number))
        } else {
            constant.push(number);
            let all = constant.into_iter().chain(varying);
            all.reduce(|left, right| multiply(&mut self.operations, left, right)).unwrap_or(number)
        };
        match below.into_iter().reduce(|left, right| multiply(&mut self.operations, left, right)) {
            Some(denominator) => self.operations.add(Operation::Divide(numerator, denominator)),
            None => numerator,
        }
    }
}
