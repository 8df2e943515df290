//! Expressions of which one of two applies: `if`, `max`, `min` and `clamp`.
//!
//! In: a comparison and two expressions. Out: one expression that is the first or the second, depending on a sign.
//! Both are computed, and one is selected. A comparison of constants is decided at once.

use super::scope::Scope;
use super::value::Value;
use crate::messages::{ArrayMistake, FunctionMistake, Message, error};
use crate::symbol::Symbol;
use crate::syntax::{Comparison, Expression};
use core::cmp::Ordering;
use proc_macro2::Ident;
use syn::Result;
use vi_expr::{Expr, Pool};

impl Scope {
    /// `if a > b { x } else { y }`. `a >= b` holds unless `b > a`.
    pub(super) fn condition(
        &mut self,
        pool: &mut Pool<Symbol>,
        comparison: &Comparison,
        arms: &[Expression; 2],
    ) -> Result<Value> {
        let Comparison { larger, smaller, or_equal, .. } = comparison;
        let sides = self.each_of(pool, [larger, smaller], Self::expression)?;
        let difference = if *or_equal { pool.sub(sides[1], sides[0]) } else { pool.sub(sides[0], sides[1]) };
        // Indices decide now: the other value may not exist for them, as `q[i - 1]` for i = 0.
        if let Ok(sign) = pool.constant_sign(difference) {
            let holds = (sign == Ordering::Greater) != *or_equal;
            return self.value(pool, &arms[usize::from(!holds)]);
        }
        let values = self.each_of(pool, arms, Self::value)?;
        let [then, otherwise] = <[Value; 2]>::try_from(values)
            .map_err(|_| error(arms[0].span, &Message::Function(FunctionMistake::Else)))?;
        if then.shape() != otherwise.shape() {
            let (left, right) = (then.shape().to_vec(), otherwise.shape().to_vec());
            return Err(error(arms[1].span, &Message::Array(ArrayMistake::Chosen { left, right })));
        }
        let (first, second) = if *or_equal { (otherwise, then) } else { (then, otherwise) };
        let mut others = second.entries().to_vec().into_iter();
        Ok(first.map(|entry| {
            let other = others.next().unwrap_or(entry);
            pool.select(difference, entry, other)
        }))
    }

    /// `max(a, b, …)`, `min(a, b, …)` or `clamp(x, a, b)`. Of equal numbers, `max` and `min` take the second.
    pub(super) fn choice(
        &mut self,
        pool: &mut Pool<Symbol>,
        function: &Ident,
        written: &[Expression],
    ) -> Result<Value> {
        let (name, given) = (function.to_string(), written.len());
        let is_clamp = name == "clamp";
        if is_clamp && given != 3 {
            let arguments = ["x", "a", "b"].map(str::to_owned).to_vec();
            return Err(error(function.span(), &Message::Function(FunctionMistake::Arity { name, arguments, given })));
        }
        if given < 2 {
            return Err(error(function.span(), &Message::Function(FunctionMistake::Few { name, given })));
        }
        let values = self.each_of(pool, written, Self::expression)?;
        let chosen = match values.as_slice() {
            [x, least, most] if is_clamp => {
                let raised = larger(pool, *x, *least);
                Some(smaller(pool, raised, *most))
            }
            _ if name == "max" => values.into_iter().reduce(|left, right| larger(pool, left, right)),
            _ => values.into_iter().reduce(|left, right| smaller(pool, left, right)),
        };
        Ok(Value::Number(chosen.unwrap_or(pool.one())))
    }
}

/// `max(a, b)`; b if both are equal.
fn larger(pool: &mut Pool<Symbol>, a: Expr, b: Expr) -> Expr {
    let difference = pool.sub(a, b);
    pool.select(difference, a, b)
}

/// `min(a, b)`; b if both are equal.
fn smaller(pool: &mut Pool<Symbol>, a: Expr, b: Expr) -> Expr {
    let difference = pool.sub(b, a);
    pool.select(difference, a, b)
}
