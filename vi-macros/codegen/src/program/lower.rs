//! Translation of expressions to operations.
//!
//! In: expressions without fields. Out: operations, shared over everything that one function evaluates. Sums are
//! factored by common factors. Products start with their constant part: numbers, parameters and the step. In sums with
//! terms of order h, these are added first and joined to the large ones last, so that they lose no digits early.

use super::lowering::{Dependence, Factor, Lowering, SumForm};
use super::operations::{Operation, OperationId, Operations};
use super::results::Results;
use super::vanishing::{ALL, Limits};
use crate::symbol::Symbol;
use num_traits::{One, Signed, Zero};
use vi_expr::{Expr, Node, Rational, Sum};

impl Lowering<'_> {
    /// Lowers expressions and their subexpressions, children first; NaN if the pool is exhausted.
    pub(super) fn lower(&mut self, exprs: &Results<Expr>) -> Results<OperationId> {
        let used: Vec<Expr> = exprs.entries().chain(self.arguments.values()).copied().collect();
        self.record_powers(&used);
        self.record_angles(&used);
        // Children first bounds the recursion; products are lowered on demand with their coefficients.
        for expr in self.pool.reachable(&used) {
            self.value(expr);
        }
        exprs.map(|expr| self.value(*expr))
    }

    /// The operation of an expression whose children are lowered.
    pub(super) fn value(&mut self, expr: Expr) -> OperationId {
        if let Some(known) = self.values.get(expr) {
            return *known;
        }
        if self.pool.is_exhausted() {
            return self.operations.constant(f64::NAN);
        }
        let node = self.pool.node(expr).clone();
        let value = if self.dependence(expr) == Dependence::None {
            let number = self.constant(expr);
            self.operations.constant(number)
        } else {
            match node {
                Node::Symbol(symbol) => self.symbol(symbol),
                Node::Sum(sum) => self.sum(expr, &sum),
                Node::Product(product) => self.product(&product.factors, &Rational::one()),
                Node::Call(function, arguments) => self.call(function, &arguments),
                Node::Opaque(function, arguments) => {
                    let arguments = arguments.into_iter().map(|argument| self.value(argument)).collect();
                    self.operations.add(Operation::Opaque(function, arguments))
                }
                Node::Select(parts) => {
                    let [condition, then, otherwise] = parts.map(|part| self.value(part));
                    self.operations.add(Operation::Select(condition, then, otherwise))
                }
                Node::Number(_) | Node::Pi => self.operations.constant(f64::NAN),
            }
        };
        self.values.insert(expr, value);
        value
    }

    /// The nearest `f64` to a constant expression. NaN if no normal number is near, which is reported at the end.
    fn constant(&self, expr: Expr) -> f64 {
        self.pool.constant(expr).unwrap_or(f64::NAN)
    }

    /// The dependence of an expression. Children are known, except those made by lowering.
    pub(super) fn dependence(&mut self, expr: Expr) -> Dependence {
        if let Some(known) = self.known.dependences.get(expr) {
            return *known;
        }
        let children: Vec<Expr> = match self.pool.node(expr) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => Vec::new(),
            Node::Sum(sum) => sum.terms.iter().map(|(term, _)| *term).collect(),
            Node::Product(product) => product.factors.iter().map(|(base, _)| *base).collect(),
            Node::Call(_, arguments) | Node::Opaque(_, arguments) => arguments.clone(),
            Node::Select(parts) => parts.to_vec(),
        };
        let found = match self.pool.node(expr) {
            Node::Symbol(Symbol::Parameter { .. }) => Dependence::Parameters,
            Node::Symbol(Symbol::Step) => Dependence::Run,
            Node::Symbol(_) => Dependence::Step,
            // A function is called at run time, even if its argument is constant.
            Node::Opaque(..) => {
                children.into_iter().map(|child| self.dependence(child)).fold(Dependence::Parameters, Ord::max)
            }
            _ => children.into_iter().map(|child| self.dependence(child)).max().unwrap_or(Dependence::None),
        };
        self.known.dependences.insert(expr, found);
        found
    }

    /// Whether the base of a term is made of parameters and not of numbers alone. Cached when the base was lowered,
    /// before the term.
    pub(super) fn is_parameter(&self, expr: Expr) -> bool {
        self.known.dependences.get(expr) == Some(&Dependence::Parameters)
    }

    fn symbol(&mut self, symbol: Symbol) -> OperationId {
        let Symbol::AtPoint(point, variable) = symbol else {
            return self.operations.add(Operation::Input(symbol));
        };
        let Some(argument) = self.arguments.get(&(point, variable)).copied() else {
            return self.operations.add(Operation::Input(Symbol::AtPoint(point, variable)));
        };
        let value = self.value(argument);
        self.operations.set_name(value, Symbol::AtPoint(point, variable));
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
            // Elementary functions have one or two arguments.
            _ => self.operations.constant(f64::NAN),
        }
    }

    /// Σ coefficient·term + constant.
    fn sum(&mut self, expr: Expr, sum: &Sum) -> OperationId {
        match self.sum_form(expr) {
            SumForm::Term => match sum.terms.first() {
                Some((term, coefficient)) => self.term(*term, coefficient),
                None => self.operations.constant(Self::number(&sum.constant)),
            },
            SumForm::BySize { large, small } => {
                let large = self.value(large);
                self.plus(large, small)
            }
            SumForm::Factor { factor, inside, rest } => {
                let product = if matches!(self.sum_form(inside), SumForm::Coefficient { .. }) {
                    self.product(&[(inside, Rational::one()), (factor, Rational::one())], &Rational::one())
                } else {
                    let (inside, factor) = (self.value(inside), self.value(factor));
                    self.multiply(inside, factor)
                };
                match rest {
                    Some(rest) if self.leads_negative(rest) => self.plus(product, rest),
                    Some(rest) => {
                        let rest = self.value(rest);
                        self.operations.add(Operation::Add(rest, product))
                    }
                    None => product,
                }
            }
            SumForm::Coefficient { coefficient, inside } => {
                let (inside, coefficient) = (self.value(inside), self.value(coefficient));
                self.multiply(inside, coefficient)
            }
            SumForm::Plain => self.plain_sum(sum),
        }
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

    /// Adds an expression to an operation.
    fn plus(&mut self, left: OperationId, right: Expr) -> OperationId {
        if self.leads_negative(right) {
            let positive = self.pool.neg(right);
            let positive = self.value(positive);
            return self.operations.add(Operation::Subtract(left, positive));
        }
        let right = self.value(right);
        self.operations.add(Operation::Add(left, right))
    }

    /// Whether a sum has no positive term: its negative reads better.
    fn leads_negative(&self, expr: Expr) -> bool {
        match self.pool.node(expr) {
            Node::Sum(sum) => {
                !sum.constant.is_positive() && sum.terms.iter().all(|(_, coefficient)| coefficient.is_negative())
            }
            _ => false,
        }
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

    /// coefficient·Π base^exponent; zero at states at which the limit of the product is zero.
    fn product(&mut self, factors: &[(Expr, Rational)], coefficient: &Rational) -> OperationId {
        let Some(Limits { vanishing, others, steps }) = self.known.products.limits(self.pool, factors) else {
            return self.product_with(factors, coefficient, Vec::new());
        };
        let values = vanishing.into_iter().map(|limit| {
            let product = self.product_with(&limit.factors, &Rational::one(), Vec::new());
            let base = self.value(limit.base);
            self.operations.add(Operation::ZeroWhere(product, base, limit.derivatives))
        });
        let values = values.collect();
        let product = self.product_with(&others, coefficient, values);
        steps.into_iter().fold(product, |product, step| {
            let step = self.value(step);
            self.operations.add(Operation::ZeroWhere(product, step, ALL))
        })
    }

    /// coefficient·Π base^exponent·Π varying.
    fn product_with(
        &mut self,
        factors: &[(Expr, Rational)],
        coefficient: &Rational,
        varying: Vec<OperationId>,
    ) -> OperationId {
        let mut gathered = Gathered { varying, ..Gathered::of(coefficient) };
        for (base, exponent) in factors {
            self.gather(&mut gathered, *base, exponent);
        }
        let below = core::mem::take(&mut gathered.below);
        let numerator = self.numerator(gathered);
        match below.into_iter().reduce(|left, right| self.multiply(left, right)) {
            Some(denominator) => self.operations.add(Operation::Divide(numerator, denominator)),
            None => numerator,
        }
    }

    fn gather(&mut self, into: &mut Gathered, base: Expr, exponent: &Rational) {
        let dependence = self.dependence(base);
        if dependence == Dependence::None {
            into.constants.push(self.pool.power(base, exponent));
            return;
        }
        // Merges a number before a sum into the coefficient.
        let value = match self.sum_form(base) {
            SumForm::Coefficient { coefficient, inside } if exponent.is_one() => {
                match self.pool.as_number(coefficient).cloned() {
                    Some(number) => into.coefficient *= number,
                    None => into.parameters.push(self.value(coefficient)),
                }
                Factor::Above(self.value(inside))
            }
            _ => self.factor(base, exponent),
        };
        match (value, dependence) {
            (Factor::Below(value), _) => into.below.push(value),
            (Factor::Above(value), Dependence::Step) => into.varying.push(value),
            (Factor::Above(value), Dependence::Run) => into.step.push(value),
            (Factor::Above(value), _) => into.parameters.push(value),
        }
    }

    /// The product of the constant factors, computed once per run, unless the rest already exists.
    fn numerator(&mut self, of: Gathered) -> OperationId {
        let Gathered { coefficient, constants, parameters, step, varying, .. } = of;
        let number = if constants.is_empty() {
            Self::number(&coefficient)
        } else {
            // Rounds once.
            let product = self.pool.product(&constants);
            let product = self.pool.scale(product, &coefficient);
            self.constant(product)
        };
        let plain = number.to_bits() == 1.0_f64.to_bits() && step.is_empty();
        let number = self.operations.constant(number);
        if !plain && !varying.is_empty() && parameters.len() + varying.len() > 1 {
            let mut rest = parameters.iter().chain(&varying).copied().map(Some);
            let first = rest.next().flatten();
            let find = |left: Option<OperationId>, right: Option<OperationId>| {
                self.operations.find(&Operation::Multiply(left?, right?))
            };
            if let Some(there) = rest.fold(first, find) {
                let constant = step.into_iter().chain([number]).reduce(|left, right| self.multiply(left, right));
                return self.multiply(there, constant.unwrap_or(number));
            }
        }
        // A lone number before a varying factor moves behind it; with a parameter it is constant over a run.
        let mut all: Vec<OperationId> = parameters.into_iter().chain(step).collect();
        if all.is_empty() {
            let product = varying.into_iter().reduce(|left, right| self.multiply(left, right));
            return product.map_or(number, |product| self.multiply(product, number));
        }
        all.push(number);
        all.extend(varying);
        all.into_iter().reduce(|left, right| self.multiply(left, right)).unwrap_or(number)
    }

    fn multiply(&mut self, left: OperationId, right: OperationId) -> OperationId {
        self.operations.add(Operation::Multiply(left, right))
    }
}

/// The factors of a product, grouped by dependence.
struct Gathered {
    coefficient: Rational,
    /// Constant factors.
    constants: Vec<Expr>,
    parameters: Vec<OperationId>,
    /// Factors that depend on h, but not on the state.
    step: Vec<OperationId>,
    varying: Vec<OperationId>,
    /// Divisors.
    below: Vec<OperationId>,
}

impl Gathered {
    fn of(coefficient: &Rational) -> Self {
        Self {
            coefficient: coefficient.clone(),
            constants: Vec::new(),
            parameters: Vec::new(),
            step: Vec::new(),
            varying: Vec::new(),
            below: Vec::new(),
        }
    }
}
