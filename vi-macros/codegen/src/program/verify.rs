//! Verifies that the operations compute their expressions.
//!
//! In: a function and the expressions that it was lowered from. Out: nothing, or an error at the name of the system: a
//! constant that is not finite or, in builds with debug assertions only, an internal error if function and expressions
//! differ at one point of a fixed sequence.

use super::operations::Operation;
use super::results::Results;
use super::{Function, OperationId};
use crate::messages::{Message, error};
use crate::symbol::{Symbol, Variable};
use proc_macro2::Ident;
use std::collections::BTreeMap;
use syn::Result;
use vi_expr::{Expr, Pool, Rounded, Table, selected};

/// Relative difference that reordering may cause, including cancellation in the residuals.
const TOLERANCE: f64 = 1e-7;
/// Ratio of the rounding of the operations to that of the expression: an angle of 1e15 leaves few digits to its cosine.
const MARGIN: f64 = 16.0;

/// The expressions of a function, and the arguments of the points in them.
pub(super) struct Expressions {
    pub(super) results: Results<Expr>,
    pub(super) arguments: BTreeMap<(usize, Variable), Expr>,
}

/// Reports constants of a function that are not finite, such as exponents multiplied by differentiation.
pub(super) fn has_finite_constants(function: &Function, system: &Ident) -> Result<()> {
    let finite = |id| match function.operations.get(id) {
        Operation::Constant(bits) => f64::from_bits(*bits).is_finite(),
        _ => true,
    };
    if function.needed().into_iter().all(finite) {
        return Ok(());
    }
    Err(error(system.span(), &Message::CoefficientRange))
}

/// Compares a function with its expressions.
pub(super) fn agrees(
    pool: &Pool<Symbol>,
    function: &Function,
    expressions: &Expressions,
    system: &Ident,
) -> Result<()> {
    if !cfg!(debug_assertions) {
        return Ok(());
    }
    let mut inputs = BTreeMap::new();
    let mut input = |symbol: &Symbol| {
        let position = u32::try_from(inputs.len()).map_or(0.0, |n| f64::from(n) + 1.0);
        *inputs.entry(symbol.clone()).or_insert_with(|| 0.2 + (position * 0.618_033_988_749_894_9).fract())
    };
    let arguments: Vec<Expr> = expressions.arguments.values().copied().collect();
    let at_points = pool.evaluate_all(&arguments, &mut input);
    let at_points: BTreeMap<_, _> = expressions.arguments.keys().zip(at_points).collect();
    let results: Vec<Expr> = expressions.results.entries().copied().collect();
    let wanted = pool.evaluate_rounded(&results, &mut |symbol| match symbol {
        Symbol::AtPoint(point, variable) => {
            at_points.get(&(*point, *variable)).copied().unwrap_or_else(|| input(symbol))
        }
        _ => input(symbol),
    });
    let found = function.evaluate(&mut input);
    let numbers = wanted.iter().map(|wanted| wanted.value).chain(found.iter().copied());
    let scale = numbers.filter(|x| x.is_finite()).fold(1.0_f64, |scale, x| scale.max(x.abs()));
    let equal = |(wanted, found): (&Rounded, &f64)| {
        let off = (wanted.value - found).abs();
        off <= TOLERANCE * scale + MARGIN * wanted.error || !off.is_finite()
    };
    if wanted.iter().zip(&found).all(equal) {
        return Ok(());
    }
    Err(error(system.span(), &Message::Internal { what: function.id.name() }))
}

impl Function {
    /// The results in order, for these inputs.
    pub fn evaluate(&self, input: &mut dyn FnMut(&Symbol) -> f64) -> Vec<f64> {
        let mut values: Table<OperationId, f64> = Table::default();
        for id in self.needed() {
            let of = |id: &OperationId| values.get(*id).copied().unwrap_or(f64::NAN);
            let value = match self.operations.get(id) {
                Operation::Constant(bits) => f64::from_bits(*bits),
                Operation::Input(symbol) => input(symbol),
                Operation::Negate(a) => -of(a),
                Operation::Add(a, b) => of(a) + of(b),
                Operation::Subtract(a, b) => of(a) - of(b),
                Operation::Multiply(a, b) => of(a) * of(b),
                Operation::Divide(a, b) => of(a) / of(b),
                Operation::SquareRoot(a) => of(a).sqrt(),
                Operation::Reciprocal(a) => of(a).recip(),
                Operation::Call(function, a) => function.value(of(a), 0.0),
                Operation::Call2(function, a, b) => function.value(of(a), of(b)),
                Operation::Opaque(function, arguments) => function.value(&arguments.iter().map(of).collect::<Vec<_>>()),
                Operation::Select(a, b, c) => selected(of(a), of(b), of(c)),
                Operation::ZeroWhere(a, b, _) => {
                    if of(b) == 0.0 {
                        0.0
                    } else {
                        of(a)
                    }
                }
            };
            values.insert(id, value);
        }
        self.results.entries().map(|id| values.get(*id).copied().unwrap_or(f64::NAN)).collect()
    }

    /// The number of operations that the results need: additions, products, divisions, roots and calls.
    #[must_use]
    pub fn operation_count(&self) -> usize {
        let needed = self.needed();
        needed.into_iter().filter(|id| self.operations.get(*id).is_work()).count()
    }

    /// The cost of these operations, in additions.
    #[must_use]
    pub fn cost(&self) -> usize {
        let needed = self.needed();
        needed.into_iter().map(|id| self.operations.get(id).cost()).sum()
    }
}
