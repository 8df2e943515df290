//! State of the lowering of a function.
//!
//! In: the pool, the arguments of the points, and cached properties of expressions. Out: a [`Lowering`]. Its passes
//! have their own files: `lower` visits expressions, `sums` chooses the form of a sum, `powers` expands exponents,
//! `angles` combines sines, `vanishing` handles products of zero and infinite factors.

use super::operations::{OperationId, Operations};
use super::vanishing;
use crate::symbol::{Symbol, Variable};
use num_traits::{Signed, ToPrimitive};
use std::collections::BTreeMap;
use vi_expr::{Expr, Pool, Rational, Table};

/// Quantities that an expression depends on, in ascending order.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Dependence {
    /// Nothing: a number.
    None,
    /// Parameters: constant over a run.
    Parameters,
    /// Parameters and the step: constant over a run of fixed steps.
    Run,
    /// Quantities that change from step to step.
    Step,
}

/// Properties of expressions that hold in all functions.
#[derive(Default)]
pub(super) struct Known {
    pub(super) dependences: Table<Expr, Dependence>,
    pub(super) sum_forms: Table<Expr, SumForm>,
    pub(super) products: vanishing::Known,
}

/// The lowering of one function.
pub(super) struct Lowering<'a> {
    pub(super) pool: &'a mut Pool<Symbol>,
    pub(super) operations: Operations,
    pub(super) occurrences: Table<Expr, Occurrence>,
    /// The arguments of sines and cosines.
    pub(super) angles: Table<Expr, ()>,
    pub(super) values: Table<Expr, OperationId>,
    /// The forms of the sums in this function.
    pub(super) sum_forms: Table<Expr, SumForm>,
    pub(super) known: &'a mut Known,
    pub(super) arguments: &'a BTreeMap<(usize, Variable), Expr>,
}

impl<'a> Lowering<'a> {
    /// The lowering of a function with these arguments of the points.
    pub(super) fn new(
        pool: &'a mut Pool<Symbol>,
        known: &'a mut Known,
        arguments: &'a BTreeMap<(usize, Variable), Expr>,
    ) -> Self {
        Self {
            pool,
            operations: Operations::default(),
            occurrences: Table::default(),
            angles: Table::default(),
            values: Table::default(),
            sum_forms: Table::default(),
            known,
            arguments,
        }
    }
}

/// The exponents of a base.
#[derive(Clone, Copy, Default)]
pub(super) struct Occurrence {
    /// Some exponent is an odd multiple of 1/2 or of 1/4.
    pub(super) has_root: bool,
    pub(super) uses_below: usize,
}

impl Occurrence {
    pub(super) fn record(&mut self, exponent: &Rational) {
        self.uses_below += usize::from(exponent.is_negative());
        self.has_root |= matches!(exponent.denom().to_u32(), Some(2 | 4));
    }
}

/// A factor of a product: a multiplier or a divisor.
pub(super) enum Factor {
    Above(OperationId),
    Below(OperationId),
}

/// The form in which a sum is written.
#[derive(Clone, Copy)]
pub(super) enum SumForm {
    /// It is one term, or no sum.
    Term,
    /// Large terms, and terms of order h.
    BySize { large: Expr, small: Expr },
    /// factor·inside + rest
    Factor { factor: Expr, inside: Expr, rest: Option<Expr> },
    /// coefficient·inside, the coefficient of numbers and parameters
    Coefficient { coefficient: Expr, inside: Expr },
    /// Term by term.
    Plain,
}
