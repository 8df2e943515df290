//! Sines and cosines of sums of angles.
//!
//! In: `cos(a ± b)` or `sin(a ± b)` in a function that also needs the sines or cosines of a and of b. Out: products of
//! these,
//!
//! ```text
//! cos(a ± b) = cos a cos b ∓ sin a sin b        sin(a ± b) = sin a cos b ± cos a sin b
//! ```
//!
//! This takes six operations; a sine and a cosine take about thirty. A pendulum with n links needs n sine pairs, not
//! n(n + 1)/2. The results are as accurate as direct evaluation, some ulps of 1, but a sine of nearly equal angles
//! loses relative accuracy. The rounding scale of a residual covers this: it counts the rounding of a and of b.

use super::lowering::Lowering;
use super::operations::{Operation, OperationId};
use num_traits::{Signed, Zero};
use vi_expr::{Expr, Function, Node};

impl Lowering<'_> {
    /// Records the angles whose sines or cosines these expressions contain.
    pub(super) fn record_angles(&mut self, exprs: &[Expr]) {
        for expr in self.pool.reachable(exprs) {
            if let Node::Call(Function::Sin | Function::Cos, arguments) = self.pool.node(expr) {
                self.angles.extend(arguments.iter().map(|angle| (*angle, ())));
            }
        }
    }

    /// The sine or cosine of a sum of two recorded angles.
    pub(super) fn of_two_angles(&mut self, function: Function, angle: Expr) -> Option<OperationId> {
        let Node::Sum(sum) = self.pool.node(angle).clone() else { return None };
        let [(left, left_factor), (right, right_factor)] = sum.terms.as_slice() else { return None };
        let (a, b) = (self.pool.scale(*left, &left_factor.abs()), self.pool.scale(*right, &right_factor.abs()));
        if !sum.constant.is_zero() || !self.angles.contains(a) || !self.angles.contains(b) {
            return None;
        }
        let same = left_factor.is_negative() == right_factor.is_negative();
        let (first, second, sums) = match function {
            Function::Cos => {
                let cosines = self.product_of(Function::Cos, a, Function::Cos, b);
                (cosines, self.product_of(Function::Sin, a, Function::Sin, b), !same)
            }
            Function::Sin => {
                let sine_first = self.product_of(Function::Sin, a, Function::Cos, b);
                (sine_first, self.product_of(Function::Cos, a, Function::Sin, b), same)
            }
            _ => return None,
        };
        // sin(−a ± b) = −sin(a ∓ b)
        let odd = function == Function::Sin && left_factor.is_negative();
        Some(match (sums, odd) {
            (false, false) => self.operations.add(Operation::Subtract(first, second)),
            (false, true) => self.operations.add(Operation::Subtract(second, first)),
            (true, _) => {
                let sum = self.operations.add(Operation::Add(first, second));
                if odd { self.operations.add(Operation::Negate(sum)) } else { sum }
            }
        })
    }

    fn product_of(&mut self, of_a: Function, a: Expr, of_b: Function, b: Expr) -> OperationId {
        let (left, right) = (self.pool.call(of_a, &[a]), self.pool.call(of_b, &[b]));
        let (left, right) = (self.value(left), self.value(right));
        self.operations.add(Operation::Multiply(left, right))
    }
}
