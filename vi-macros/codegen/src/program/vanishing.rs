//! Products that have a limit at a state although a factor is infinite there.
//!
//! In: the factors of a product. Out: [`Limits`], if the product tends to zero although floating point gives `0·∞`:
//!
//! - A stepwise constant factor, made of `sign(…)`, numbers and parameters, is zero and does not jump at the state. So
//!   the product is zero around the state for any other factors, also for factors without a value such as a root of a
//!   negative number.
//! - A negative power `B^(-e)` multiplies factors that vanish with B. B is a sum of terms `c |u|^a`, so `|u| ≤ C
//!   B^(1/a)`. Factors of total order m in B have the limit 0 if `m > e`. The numbers c are positive. Parameters among
//!   them are tested at run time, and so is an exponent that depends on parameters.
//!
//! The other factors stay outside the part that is set to zero. If they are infinite too, the product stays `0·∞`.

use crate::symbol::{Symbol, Variable};
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::rc::Rc;
use vi_expr::{Expr, Function, Node, Pool, Rational, Table};

/// Maximum number of signs whose values are tried one by one.
const SIGNS: u32 = 4;
/// Search depth in operations.
const DEPTH: u32 = 4;
/// A sum of signs below this may be zero to rounding.
const ROUNDING: f64 = 1e-9;
/// Number of vanishing derivatives of a function that is zero around a state; larger than any count.
pub(super) const ALL: u8 = u8::MAX;

/// Dependence of an expression on the state.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum StateDependence {
    /// Made of numbers and parameters.
    Constant,
    /// It jumps, and is constant elsewhere.
    Stepwise,
    Varying,
}

/// Properties of an expression that hold in every product.
#[derive(Clone, Copy)]
struct Nature {
    change: StateDependence,
    /// It may be infinite at a finite state.
    singular: bool,
    /// It may have no value at a finite state.
    partial: bool,
    /// It contains a jump.
    jumps: bool,
}

/// Properties assumed by default.
const LEAST_KNOWN: Nature = Nature { change: StateDependence::Varying, singular: true, partial: true, jumps: true };

/// A product of powers.
type Factors = Vec<(Expr, Rational)>;

/// Factors whose product tends to 0 at zeros of `base`.
pub(super) struct Limit {
    pub(super) factors: Factors,
    pub(super) base: Expr,
    /// The number of their derivatives that tend to 0 too.
    pub(super) derivatives: u8,
}

/// A product split into its limits.
pub(super) struct Limits {
    pub(super) vanishing: Vec<Limit>,
    /// Factors outside all limits.
    pub(super) others: Factors,
    /// If one of these is zero, the product is zero around the state.
    pub(super) steps: Vec<Expr>,
}

/// Cached properties of products.
#[derive(Default)]
pub(super) struct Known {
    natures: Table<Expr, Nature>,
    /// Zeros of bases at which a limit is sought.
    zeros: Table<Expr, Option<Rc<Zeros>>>,
    /// Poles of L or f: common zeros of each list of expressions in `(t, q, v)`. No limit is sought there.
    poles: Vec<Vec<Expr>>,
}

impl Known {
    /// Records the poles of L and f.
    pub(super) fn of(pool: &mut Pool<Symbol>, sources: &[Expr]) -> Self {
        let mut known = Self::default();
        for node in pool.reachable(sources) {
            let Node::Product(product) = pool.node(node).clone() else { continue };
            let poles = Analysis { pool, known: &mut known }.poles(&product.factors);
            known.poles.extend(poles);
        }
        // Discards zeros found before the last pole was recorded.
        known.zeros = Table::default();
        known
    }

    /// The limits of a product, if it has any.
    pub(super) fn limits(&mut self, pool: &mut Pool<Symbol>, factors: &[(Expr, Rational)]) -> Option<Limits> {
        self.may_be_infinite(pool, factors).then(|| Analysis { pool, known: self }.limits(factors)).flatten()
    }

    /// Whether a term has a limit.
    pub(super) fn has_limit(&mut self, pool: &mut Pool<Symbol>, term: Expr) -> bool {
        let Node::Product(product) = pool.node(term) else { return false };
        if !self.may_be_infinite(pool, &product.factors) {
            return false;
        }
        let factors = product.factors.clone();
        Analysis { pool, known: self }.limits(&factors).is_some()
    }

    /// Whether a factor of a product may be infinite, or without a value, at a state at which a limit is sought.
    fn may_be_infinite(&mut self, pool: &Pool<Symbol>, factors: &[(Expr, Rational)]) -> bool {
        factors.len() > 1
            && factors.iter().any(|(base, exponent)| {
                let Nature { change, singular, partial, .. } = self.nature(pool, *base);
                let is_partial = exponent.is_negative() || !exponent.is_integer();
                singular || partial || is_partial && change == StateDependence::Varying
            })
    }

    /// The dependence of an expression on the state. Caches the result for all its parts.
    fn nature(&mut self, pool: &Pool<Symbol>, expr: Expr) -> Nature {
        if let Some(known) = self.natures.get(expr) {
            return *known;
        }
        let mut open = vec![expr];
        while let Some(last) = open.last().copied() {
            let first = open.len();
            let natures = &self.natures;
            pool.node(last).each_child(|child| open.extend((!natures.contains(child)).then_some(child)));
            if open.len() == first {
                open.pop();
                self.natures.insert(last, self.nature_by_operands(pool, last));
            }
        }
        self.natures.get(expr).copied().unwrap_or(LEAST_KNOWN)
    }

    fn nature_by_operands(&self, pool: &Pool<Symbol>, expr: Expr) -> Nature {
        let mut nature = Nature { change: StateDependence::Constant, singular: false, partial: false, jumps: false };
        let node = pool.node(expr);
        node.each_child(|child| {
            let of = self.natures.get(child).unwrap_or(&LEAST_KNOWN);
            nature.change = nature.change.max(of.change);
            nature.singular |= of.singular;
            nature.partial |= of.partial;
            nature.jumps |= of.jumps;
        });
        let is_varying = |base: &Expr| self.natures.get(*base).is_some_and(|of| of.change == StateDependence::Varying);
        match node {
            Node::Symbol(Symbol::Parameter { .. }) | Node::Number(_) | Node::Pi | Node::Sum(_) | Node::Opaque(..) => {}
            Node::Select(_) => nature.jumps = true,
            Node::Symbol(_) => nature.change = StateDependence::Varying,
            Node::Call(Function::Sign, _) => {
                let change = nature.change.min(StateDependence::Stepwise);
                nature = Nature { change, singular: false, partial: false, jumps: change == StateDependence::Stepwise };
            }
            Node::Call(function, _) => {
                nature.singular |= matches!(function, Function::Ln | Function::Pow);
                nature.partial |= matches!(function, Function::Asin | Function::Acos);
                nature.jumps |= *function == Function::Atan2;
            }
            Node::Product(product) => {
                nature.singular |= product.factors.iter().any(|(base, e)| e.is_negative() && is_varying(base));
                nature.partial |= product.factors.iter().any(|(base, e)| !e.is_integer() && is_varying(base));
            }
        }
        nature
    }
}

/// A power that may be infinite at zeros of its base.
struct Pole {
    base: Expr,
    zeros: Rc<Zeros>,
    exponent: Expr,
}

/// The zeros of a base: common zeros of `vanishing` and `fixed`, if all `coefficients` are positive.
#[derive(Default)]
struct Zeros {
    /// Each u with the exponent a of its term `c |u|^a`.
    vanishing: Factors,
    /// Terms made of parameters.
    fixed: Vec<Expr>,
    /// The coefficients c that contain parameters.
    coefficients: Vec<Expr>,
}

struct Analysis<'a> {
    pool: &'a mut Pool<Symbol>,
    known: &'a mut Known,
}

impl Analysis<'_> {
    fn limits(&mut self, factors: &[(Expr, Rational)]) -> Option<Limits> {
        let mut others = factors.to_vec();
        let mut vanishing = Vec::new();
        for (power, exponent) in factors {
            if let Some(pole) = self.pole(*power, exponent) {
                vanishing.extend(self.limit(*power, &pole, &mut others));
            }
        }
        let steps = self.steps(&others);
        (!vanishing.is_empty() || !steps.is_empty()).then_some(Limits { vanishing, others, steps })
    }

    /// The poles of a product: zeros of the bases for which it has no limit.
    fn poles(&mut self, factors: &[(Expr, Rational)]) -> Vec<Vec<Expr>> {
        let mut others = factors.to_vec();
        let mut poles = Vec::new();
        for (power, exponent) in factors {
            // A pole with a term or an exponent made of parameters may be finite.
            if let Some(pole) = self.pole(*power, exponent).filter(|_| exponent.is_negative())
                && pole.zeros.fixed.is_empty()
                && self.limit(*power, &pole, &mut others).is_none()
            {
                poles.push(pole.zeros.vanishing.iter().map(|(u, _)| *u).collect());
            }
        }
        if self.steps(&others).is_empty() { poles } else { Vec::new() }
    }

    /// Base and exponent of a power whose exponent may be negative.
    fn pole(&mut self, power: Expr, exponent: &Rational) -> Option<Pole> {
        let Nature { change, jumps, .. } = self.known.nature(self.pool, power);
        if change < StateDependence::Varying || jumps {
            return None;
        }
        if exponent.is_negative() {
            let zeros = self.zeros(power)?;
            return Some(Pole { base: power, zeros, exponent: self.pool.number(exponent.clone()) });
        }
        let Node::Call(Function::Pow, arguments) = self.pool.node(power) else { return None };
        let [base, inner] = arguments[..] else { return None };
        if self.known.nature(self.pool, inner).change > StateDependence::Constant {
            return None;
        }
        let zeros = self.zeros(base)?;
        Some(Pole { base, zeros, exponent: self.pool.scale(inner, exponent) })
    }

    /// Removes a power and the factors that vanish with its base from a product, if together they tend to 0.
    fn limit(&mut self, power: Expr, pole: &Pole, others: &mut Factors) -> Option<Limit> {
        let (mut factors, mut left, mut order) = (Vec::new(), Vec::new(), pole.exponent);
        for (factor, exponent) in others.iter().cloned() {
            let vanishing = self.order(factor, &pole.zeros, DEPTH) * &exponent;
            let vanishes = vanishing.is_positive();
            let vanishing = self.pool.number(vanishing);
            order = if vanishes { self.pool.add(order, vanishing) } else { order };
            if vanishes || factor == power { factors.push((factor, exponent)) } else { left.push((factor, exponent)) }
        }
        let known = self.pool.as_number(order).cloned();
        if factors.len() < 2 || known.as_ref().is_some_and(|order| !order.is_positive()) {
            return None;
        }
        *others = left;
        let in_distance = known.zip(self.least_power(&pole.zeros)).map(|(order, power)| order * power);
        // The largest integer below the order.
        let derivatives = in_distance.as_ref().and_then(|order| (order.ceil() - Rational::one()).to_u8()).unwrap_or(0);
        let Zeros { fixed, coefficients, .. } = &*pole.zeros;
        // A square may underflow. Then 0 is as accurate as any other value of the product, which is of the order of
        // |u|. This fails for a root of |u|.
        let is_plain =
            fixed.is_empty() && coefficients.is_empty() && in_distance.is_some_and(|order| order >= Rational::one());
        let base = if is_plain { pole.base } else { self.tested(&pole.zeros, order) };
        Some(Limit { factors, base, derivatives })
    }

    /// Whether L or f is infinite at these zeros.
    fn is_at_pole(&mut self, zeros: &Zeros) -> bool {
        if self.known.poles.is_empty() {
            return false;
        }
        let mut place = |u: Expr| self.pool.substitute(u, &mut |pool, symbol| Some(pool.symbol(in_state(symbol))));
        let zero: Vec<Expr> = zeros.vanishing.iter().map(|(u, _)| place(*u)).collect();
        self.known.poles.iter().any(|pole| pole.iter().all(|u| zero.contains(u)))
    }

    /// The power of the distance from its zeros that bounds a base from above, if its u are linear in the variables.
    fn least_power(&self, zeros: &Zeros) -> Option<Rational> {
        let is_variable = |expr: Expr| self.pool.as_symbol(expr).is_some();
        let is_linear = |(expr, _): &(Expr, Rational)| match self.pool.node(*expr) {
            Node::Sum(sum) => sum.terms.iter().all(|(term, _)| is_variable(*term)),
            _ => is_variable(*expr),
        };
        zeros.vanishing.iter().map(|of| is_linear(of).then_some(&of.1)).min().flatten().cloned()
    }

    /// `Σ |u| + Σ |fixed| + Σ (1 − sign(c)) + (1 − sign(order))`: zero exactly where a limit of this order exists.
    fn tested(&mut self, zeros: &Zeros, order: Expr) -> Expr {
        let mut terms = Vec::new();
        for expr in zeros.vanishing.iter().map(|(expr, _)| expr).chain(&zeros.fixed) {
            terms.push(self.pool.call(Function::Abs, &[*expr]));
        }
        for positive in zeros.coefficients.iter().chain([&order]) {
            let sign = self.pool.call(Function::Sign, &[*positive]);
            terms.push(self.pool.one());
            terms.push(self.pool.neg(sign));
        }
        self.pool.sum(&terms)
    }

    /// The zeros of a base, if a limit is sought there.
    fn zeros(&mut self, base: Expr) -> Option<Rc<Zeros>> {
        if let Some(known) = self.known.zeros.get(base) {
            return known.clone();
        }
        let found = self.find_zeros(base, DEPTH).filter(|zeros| !self.is_at_pole(zeros)).map(Rc::new);
        self.known.zeros.insert(base, found.clone());
        found
    }

    /// The zeros of a base, if none of its terms is negative.
    fn find_zeros(&mut self, base: Expr, depth: u32) -> Option<Zeros> {
        let one = Rational::one();
        let mut zeros = Zeros::default();
        match self.pool.node(base).clone() {
            _ if depth == 0 => return None,
            Node::Call(Function::Abs | Function::Hypot, arguments) => {
                for argument in arguments {
                    match self.known.nature(self.pool, argument).change {
                        StateDependence::Constant => zeros.fixed.push(argument),
                        _ => zeros.vanishing.push((argument, one.clone())),
                    }
                }
            }
            Node::Product(product) => self.add_zeros(&mut zeros, &product.factors, &one, depth)?,
            Node::Sum(sum) if sum.constant.is_zero() => {
                for (term, coefficient) in &sum.terms {
                    let factors = self.factors(*term);
                    self.add_zeros(&mut zeros, &factors, coefficient, depth)?;
                }
            }
            _ => return None,
        }
        let is_never_zero = zeros.fixed.iter().any(|fixed| self.pool.as_number(*fixed).is_some());
        (!zeros.vanishing.is_empty() && !is_never_zero).then_some(zeros)
    }

    /// Adds the zeros of one term.
    fn add_zeros(
        &mut self,
        zeros: &mut Zeros,
        factors: &[(Expr, Rational)],
        coefficient: &Rational,
        depth: u32,
    ) -> Option<()> {
        let is_fixed =
            |(base, _): &(Expr, Rational)| self.known.nature(self.pool, *base).change == StateDependence::Constant;
        let (fixed, moving): (Factors, Factors) = factors.iter().cloned().partition(is_fixed);
        let has_parameters = !fixed.is_empty();
        if moving.len() > 1 || moving.iter().any(|(_, exponent)| !exponent.is_positive()) {
            return None;
        }
        if has_parameters {
            let powers: Vec<Expr> = fixed.iter().map(|(base, exponent)| self.pool.power(*base, exponent)).collect();
            let fixed = self.pool.product(&powers);
            let fixed = self.pool.scale(fixed, coefficient);
            if moving.is_empty() { zeros.fixed.push(fixed) } else { zeros.coefficients.push(fixed) }
        } else if !coefficient.is_positive() {
            return None;
        }
        let Some((base, exponent)) = moving.first() else { return Some(()) };
        if (exponent / Rational::from_integer(2.into())).is_integer() {
            zeros.vanishing.push((*base, exponent.clone()));
            return Some(());
        }
        let inner = self.find_zeros(*base, depth - 1)?;
        zeros.vanishing.extend(inner.vanishing.into_iter().map(|(u, power)| (u, power * exponent)));
        zeros.fixed.extend(inner.fixed);
        zeros.coefficients.extend(inner.coefficients);
        Some(())
    }

    /// The factors of a term.
    fn factors(&self, term: Expr) -> Factors {
        match self.pool.node(term) {
            Node::Product(product) => product.factors.clone(),
            _ => vec![(term, Rational::one())],
        }
    }

    /// A lower bound of the power of a base with which an expression vanishes at its zeros; 0 if unknown.
    fn order(&mut self, expr: Expr, zeros: &Zeros, depth: u32) -> Rational {
        self.pool.spend(zeros.vanishing.len());
        if self.pool.is_exhausted() {
            return Rational::zero();
        }
        let orders = zeros.vanishing.iter().filter(|(u, _)| self.is_multiple(expr, *u)).map(|(_, power)| power.recip());
        let own = orders.max();
        if own.is_some() || depth == 0 || self.known.nature(self.pool, expr).singular {
            return own.unwrap_or_else(Rational::zero);
        }
        let order = match self.pool.node(expr).clone() {
            Node::Sum(sum) if sum.constant.is_zero() => {
                sum.terms.iter().map(|(term, _)| self.order(*term, zeros, depth - 1)).min()
            }
            Node::Product(product) => {
                let factors = product.factors.iter();
                Some(factors.map(|(base, exponent)| self.order(*base, zeros, depth - 1) * exponent).sum())
            }
            Node::Call(function, arguments) if vanishes_with_arguments(function) => {
                arguments.iter().map(|argument| self.order(*argument, zeros, depth - 1)).min()
            }
            _ => None,
        };
        order.unwrap_or_else(Rational::zero)
    }

    /// Whether an expression is a number times another.
    fn is_multiple(&self, expr: Expr, of: Expr) -> bool {
        if expr == of {
            return true;
        }
        let (Node::Sum(sum), Node::Sum(other)) = (self.pool.node(expr), self.pool.node(of)) else { return false };
        let (Some((_, first)), Some((_, second))) = (sum.terms.first(), other.terms.first()) else { return false };
        let alike = |((term, number), (of, other)): (&(Expr, Rational), &(Expr, Rational))| {
            term == of && number * second == other * first
        };
        sum.terms.len() == other.terms.len()
            && &sum.constant * second == &other.constant * first
            && sum.terms.iter().zip(&other.terms).all(alike)
    }

    /// Expressions that are zero at states around which a product vanishes although a factor is infinite.
    fn steps(&mut self, factors: &[(Expr, Rational)]) -> Vec<Expr> {
        if !self.known.may_be_infinite(self.pool, factors) {
            return Vec::new();
        }
        let is_step = |(base, exponent): &&(Expr, Rational)| {
            exponent.is_positive() && self.known.nature(self.pool, *base).change == StateDependence::Stepwise
        };
        let steps: Vec<Expr> = factors.iter().filter(is_step).map(|(base, _)| *base).collect();
        steps.into_iter().filter_map(|step| self.zero_between_jumps(step)).collect()
    }

    /// An expression whose zeros are the states at which a stepwise constant expression is zero and does not jump, if
    /// there is one: `|expr| + Σ (1 − sign²)`, or the expression itself if it is never zero at a jump.
    fn zero_between_jumps(&mut self, expr: Expr) -> Option<Expr> {
        let nodes = self.pool.reachable(&[expr]);
        let is_sign = |node: &Expr| matches!(self.pool.node(*node), Node::Call(Function::Sign, _));
        let signs: Vec<Expr> = nodes.iter().copied().filter(is_sign).collect();
        let few = u32::try_from(signs.len()).ok().filter(|count| *count <= SIGNS);
        self.pool.spend(few.map_or(0, |count| 3_usize.pow(count)) * nodes.len());
        let (mut between, mut at_jump) = (few.is_none(), few.is_none());
        for number in 0..few.map_or(0, |count| 3_u32.pow(count)) {
            let values = (0..SIGNS).map(|place| f64::from(number / 3_u32.pow(place) % 3) - 1.0);
            let known: Table<Expr, f64> = signs.iter().copied().zip(values).collect();
            let is_zero = self.may_be_zero(&nodes, expr, &known);
            let jumps = signs.iter().any(|sign| known.get(*sign) == Some(&0.0));
            between |= is_zero && !jumps;
            at_jump |= is_zero && jumps;
        }
        if !between || !at_jump {
            return between.then_some(expr);
        }
        let mut terms = vec![self.pool.call(Function::Abs, &[expr])];
        for sign in signs {
            let square = self.pool.mul(sign, sign);
            let jump = self.pool.neg(square);
            terms.extend([self.pool.one(), jump]);
        }
        Some(self.pool.sum(&terms))
    }

    /// Whether an expression may be zero for these values of its signs and any parameters.
    fn may_be_zero(&self, nodes: &[Expr], expr: Expr, signs: &Table<Expr, f64>) -> bool {
        let mut known = Table::default();
        for node in nodes {
            let value = || self.pool.node_value(*node, &known, &mut |_| f64::NAN);
            let value = signs.get(*node).copied().unwrap_or_else(value);
            known.insert(*node, value);
        }
        // NaN if a parameter contributes.
        !known.get(expr).is_some_and(|value| value.abs() > ROUNDING)
    }
}

/// The variable of L and f that a symbol evaluates at a point of a rule.
fn in_state(symbol: &Symbol) -> Symbol {
    Symbol::Continuous(match symbol {
        Symbol::AtPoint(_, variable) => *variable,
        Symbol::T0 | Symbol::T1 => Variable::Time,
        Symbol::Q0(index) | Symbol::Q1(index) => Variable::Coordinate(*index),
        Symbol::StepVelocity(index) => Variable::Velocity(*index),
        other => return other.clone(),
    })
}

/// Whether `|f(x)| ≤ C |x|` near zero, or `|f(x, y)| ≤ C max(|x|, |y|)`.
fn vanishes_with_arguments(function: Function) -> bool {
    use Function::{Abs, Asin, Atan, Hypot, Sin, Sinh, Tan, Tanh};
    matches!(function, Abs | Asin | Atan | Hypot | Sin | Sinh | Tan | Tanh)
}
