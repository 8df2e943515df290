//! Powers as products, roots and one division.
//!
//! In: the exponents of each base in one function. Out: operations. Integer powers are products of squares.
//! Half-integer powers multiply them by one root, quarter powers by the root of that root. A base with several
//! divisions gets one reciprocal. A negative root is a root times a reciprocal, `x^(−3/2) = (1/x)² √x`: the two are
//! independent.

use super::lowering::{Factor, Lowering};
use super::operations::{Operation, OperationId};
use num_traits::{One, ToPrimitive, Zero};
use vi_expr::{Expr, Function, Node, Rational};

impl Lowering<'_> {
    /// Records the exponents of bases in these expressions.
    pub(super) fn record_powers(&mut self, exprs: &[Expr]) {
        for expr in self.pool.reachable(exprs) {
            if let Node::Product(product) = self.pool.node(expr) {
                for (base, exponent) in &product.factors {
                    self.occurrences.entry(*base).record(exponent);
                }
            }
        }
    }

    /// `base^exponent` as a factor of a product.
    pub(super) fn factor(&mut self, base: Expr, exponent: &Rational) -> Factor {
        let value = self.value(base);
        let occurrence = self.occurrences.get(base).copied().unwrap_or_default();
        let Some(halves) = multiple(exponent, 2) else {
            if let Some(quarters) = multiple(exponent, 4) {
                return Factor::Above(self.quarters(value, quarters));
            }
            let exponent = self.operations.constant(exponent.to_f64().unwrap_or(f64::NAN));
            return Factor::Above(self.operations.add(Operation::Call2(Function::Pow, value, exponent)));
        };
        let count = halves.unsigned_abs();
        if halves < 0 && occurrence.has_root {
            let inverse = self.operations.add(Operation::Reciprocal(value));
            let power = self.integer_power(inverse, count.div_ceil(2));
            if count.is_multiple_of(2) {
                return Factor::Above(power);
            }
            let root = self.operations.add(Operation::SquareRoot(value));
            return Factor::Above(self.operations.add(Operation::Multiply(power, root)));
        }
        let whole = |lowering: &mut Self, value| {
            let even = (count > 1).then(|| lowering.integer_power(value, count / 2));
            if count.is_multiple_of(2) {
                return even.unwrap_or(value);
            }
            let root = lowering.operations.add(Operation::SquareRoot(value));
            even.map_or(root, |even| lowering.operations.add(Operation::Multiply(even, root)))
        };
        if halves > 0 {
            return Factor::Above(whole(self, value));
        }
        if occurrence.uses_below > 1 {
            let inverse = self.operations.add(Operation::Reciprocal(value));
            return Factor::Above(whole(self, inverse));
        }
        Factor::Below(whole(self, value))
    }

    /// `value^(quarters/4)` for odd `quarters`: whole powers of the value or its reciprocal, times roots.
    fn quarters(&mut self, value: OperationId, quarters: i32) -> OperationId {
        let root = self.operations.add(Operation::SquareRoot(value));
        let mut power = self.operations.add(Operation::SquareRoot(root));
        if quarters.rem_euclid(4) == 3 {
            power = self.operations.add(Operation::Multiply(root, power));
        }
        let whole = quarters.div_euclid(4);
        if whole == 0 {
            return power;
        }
        let base = if whole < 0 { self.operations.add(Operation::Reciprocal(value)) } else { value };
        let whole = self.integer_power(base, whole.unsigned_abs());
        self.operations.add(Operation::Multiply(whole, power))
    }

    /// `value^count` by squaring; `count` is at least one.
    fn integer_power(&mut self, value: OperationId, count: u32) -> OperationId {
        if count <= 1 {
            return value;
        }
        let rest = (count % 2 == 1).then_some(value);
        let half = self.integer_power(value, count / 2);
        let even = self.operations.add(Operation::Multiply(half, half));
        match rest {
            Some(value) => self.operations.add(Operation::Multiply(even, value)),
            None => even,
        }
    }

    /// The nearest `f64` to the rational. NaN if it is not normal, which is reported at the end.
    pub(super) fn number(value: &Rational) -> f64 {
        if value.is_zero() {
            0.0
        } else if value.is_one() {
            1.0
        } else {
            value.to_f64().filter(|number| number.is_normal()).unwrap_or(f64::NAN)
        }
    }
}

/// An exponent times `parts`, if that is an integer.
fn multiple(exponent: &Rational, parts: i32) -> Option<i32> {
    let product = exponent * Rational::from_integer(parts.into());
    if product.is_integer() { product.numer().to_i32() } else { None }
}
