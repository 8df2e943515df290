//! Functions that are known by name only, and expressions of which one of two applies.
//!
//! In: an [`Opaque`] function with its arguments, or a condition with two expressions. Out: their canonical nodes, their
//! derivatives and their values. The derivative of an opaque function is the same function with a higher order; that of
//! `if c > 0 { a } else { b }` is `if c > 0 { a' } else { b' }`, without a product that could turn 0 into NaN.
//!
//! No value of an opaque function is known here. Checks that evaluate expressions use a stand-in: the sine
//! `sin(Σ w x + b)`, whose derivatives of all orders are consistent.

use core::cmp::Ordering;
use core::f64::consts::FRAC_PI_2;
use std::hash::Hash;
use std::sync::Arc;

use num_traits::{Signed, Zero};

use crate::{Expr, Node, Pool, Rational, Rounded, Table};

/// Maximum number of arguments in which an opaque function has derivatives.
pub const MAX_ARGUMENTS: usize = 3;

/// Ratio of the frequencies of the stand-in in one argument and in the one before.
const RATIO: f64 = 1.3;
/// Phase of the stand-in at zero, per unit of the sum of the bytes of its name.
const FIRST_PHASE: f64 = 0.025;
/// Ratio of the frequency in further arguments to that in the first.
const FURTHER: f64 = 0.1;

/// A partial derivative of a function that is known by name.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Opaque {
    /// Name in the language of systems.
    pub name: Arc<str>,
    /// Number of arguments in which it has derivatives, at most [`MAX_ARGUMENTS`]. Further arguments are constants of a
    /// run.
    pub arity: usize,
    /// Order of the derivative in each of these arguments.
    pub orders: [u8; MAX_ARGUMENTS],
    /// Bits of the frequency of the stand-in in the first argument. A function with a period needs a multiple of its own.
    frequency: u64,
}

impl Opaque {
    /// A function itself. `frequency` is that of its stand-in, which is periodic with the period `2π/frequency`.
    #[must_use]
    pub fn new(name: &str, arity: usize, frequency: f64) -> Self {
        Self { name: name.into(), arity, orders: [0; MAX_ARGUMENTS], frequency: frequency.to_bits() }
    }

    /// The total order of the derivative.
    #[must_use]
    pub fn order(&self) -> usize {
        self.orders.iter().map(|order| usize::from(*order)).sum()
    }

    /// Its derivative in an argument; `None` beyond the largest order.
    fn raised(&self, slot: usize) -> Option<Self> {
        let mut raised = self.clone();
        let order = raised.orders.get_mut(slot)?;
        *order = order.checked_add(1)?;
        Some(raised)
    }

    /// The name with the order: `cl`, `cl''`, `cp^(1,0)`.
    #[must_use]
    pub fn text(&self) -> String {
        match (self.arity, self.order()) {
            (_, 0) => self.name.to_string(),
            (1, order) => format!("{}{}", self.name, "'".repeat(order)),
            (arity, _) => {
                let orders: Vec<String> = self.orders[..arity].iter().map(u8::to_string).collect();
                format!("{}^({})", self.name, orders.join(","))
            }
        }
    }

    /// The frequency of the stand-in in an argument.
    fn frequency_in(&self, slot: usize) -> f64 {
        let first = f64::from_bits(self.frequency);
        if slot >= self.arity {
            return FURTHER;
        }
        (0..slot).fold(first, |frequency, _| frequency * RATIO)
    }

    /// The value of the stand-in.
    #[must_use]
    pub fn value(&self, arguments: &[f64]) -> f64 {
        let phase = FIRST_PHASE * f64::from(self.name.bytes().fold(0_u8, u8::wrapping_add));
        let phase = arguments.iter().enumerate().fold(phase, |phase, (slot, x)| phase + self.frequency_in(slot) * x);
        let quarter_turns = f64::from(self.orders.iter().map(|order| order % 4).sum::<u8>() % 4);
        self.scale() * (phase + quarter_turns * FRAC_PI_2).sin()
    }

    /// The amplitude of the stand-in.
    fn scale(&self) -> f64 {
        let of = |(slot, order): (usize, &u8)| self.frequency_in(slot).powi(i32::from(*order));
        self.orders.iter().enumerate().map(of).product()
    }

    /// The value of the stand-in with its error.
    pub(crate) fn rounded(&self, arguments: &[Rounded]) -> Rounded {
        let numbers: Vec<f64> = arguments.iter().map(|argument| argument.value).collect();
        let errors = arguments
            .iter()
            .enumerate()
            .map(|(slot, of)| self.frequency_in(slot) * (of.error + f64::EPSILON * of.value.abs()));
        let error = self.scale() * (errors.sum::<f64>() + f64::EPSILON);
        Rounded { value: self.value(&numbers), error }
    }
}

impl<S: Clone + Eq + Hash> Pool<S> {
    /// A partial derivative of an opaque function at its arguments. It is no constant, even of constant arguments.
    pub fn opaque(&mut self, function: Opaque, arguments: Vec<Expr>) -> Expr {
        if arguments.iter().any(|argument| self.is_undefined(*argument)) {
            return Expr::UNDEFINED;
        }
        self.intern(Node::Opaque(function, arguments))
    }

    /// `if condition > 0 { then } else { otherwise }`.
    pub fn select(&mut self, condition: Expr, then: Expr, otherwise: Expr) -> Expr {
        if [condition, then, otherwise].into_iter().any(|part| self.is_undefined(part)) {
            return Expr::UNDEFINED;
        }
        if then == otherwise {
            return then;
        }
        if self.is_constant(condition)
            && let Ok(sign) = self.constant_sign(condition)
        {
            return if sign == Ordering::Greater { then } else { otherwise };
        }
        // A positive factor changes no sign.
        let factor = match self.node(condition) {
            Node::Sum(sum) if sum.constant.is_zero() => sum.terms.first().map(|(_, factor)| factor.abs()),
            _ => None,
        };
        let is_common = |factor: &Rational| match self.node(condition) {
            Node::Sum(sum) => sum.terms.iter().all(|(_, own)| own.abs() == *factor),
            _ => false,
        };
        let condition = match factor.filter(is_common) {
            Some(factor) => self.scale(condition, &factor.recip()),
            None => condition,
        };
        self.intern(Node::Select([condition, then, otherwise]))
    }

    /// The derivative of an opaque function, given those of its arguments.
    pub(crate) fn opaque_derivative(
        &mut self,
        function: &Opaque,
        arguments: &[Expr],
        derivatives: &Table<Expr, Expr>,
    ) -> Expr {
        let mut terms = Vec::new();
        for (slot, argument) in arguments.iter().enumerate() {
            let Some(derivative) = derivatives.get(*argument).copied() else { continue };
            let Some(raised) = function.raised(slot).filter(|_| slot < function.arity) else { return Expr::UNDEFINED };
            let partial = self.opaque(raised, arguments.to_vec());
            terms.push(self.mul(partial, derivative));
        }
        self.sum(&terms)
    }
}
