//! Expressions of which one of two applies: `if`, `max`, `min` and `clamp`.
//!
//! In: a comparison and two expressions. Out: one expression that is the first or the second, depending on a sign.
//! Both are computed, and one is selected. Also checks that L does not jump where the sign changes.

use super::resolve::Value;
use super::scope::Scope;
use super::{Parameter, probe};
use crate::messages::{Message, error};
use crate::symbol::Symbol;
use crate::syntax::{Comparison, Expression};
use proc_macro2::Ident;
use std::collections::BTreeMap;
use syn::Result;
use vi_expr::{Expr, Node, Pool};

/// The functions that select one of their arguments.
pub(super) const CHOICES: [&str; 3] = ["max", "min", "clamp"];

/// Pairs of points between which a border is sought.
const PAIRS: u32 = 40;
/// Borders at which both expressions are compared.
const BORDERS: usize = 10;
/// Bisections of the way between two points: the bits of a number.
const BISECTIONS: u32 = 60;
/// Relative difference at a border that counts as a jump. A root has an infinite slope there, and differs by 1e-8.
const JUMP: f64 = 1e-6;

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
        let values = self.each_of(pool, arms, Self::value)?;
        let [then, otherwise] =
            <[Value; 2]>::try_from(values).map_err(|_| error(arms[0].span, &Message::MissingElse))?;
        if !then.has_shape_of(&otherwise) {
            let needs = if matches!(then, Value::Number(_)) { "number" } else { "vector" };
            return Err(error(arms[1].span, &Message::Shape { needs }));
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
        if is_clamp && given != 3 || given < 2 {
            let arguments: &[&str] = if is_clamp { &["x", "a", "b"] } else { &["a", "b"] };
            let arguments = arguments.iter().map(|&argument| argument.to_owned()).collect();
            return Err(error(function.span(), &Message::FunctionArity { name, arguments, given }));
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

/// A condition of an expression at whose border the expression jumps.
///
/// The border is sought between points of a fixed sequence. There the expression is evaluated with either arm of the
/// condition. Parameters have their defaults.
pub(super) fn jump(pool: &mut Pool<Symbol>, expr: Expr, parameters: &[Parameter]) -> Option<Expr> {
    let selects: Vec<(Expr, [Expr; 3])> = pool
        .reachable(&[expr])
        .into_iter()
        .filter_map(|node| if let Node::Select(parts) = pool.node(node) { Some((node, *parts)) } else { None })
        .collect();
    for (select, [condition, then, otherwise]) in selects {
        let sides = [then, otherwise].map(|arm| pool.replace(expr, select, arm));
        let mut borders = 0;
        for pair in 0..PAIRS {
            let Some(values) = border(pool, condition, pair, &sides, parameters) else { continue };
            let [then, otherwise] = values;
            if (then - otherwise).abs() > JUMP * (then.abs() + otherwise.abs()) {
                return Some(condition);
            }
            borders += 1;
            if borders == BORDERS {
                break;
            }
        }
    }
    None
}

/// The values of two expressions at a point where a condition changes its sign; `None` if it does not between the two
/// points of this pair, or if a value is not finite.
fn border(
    pool: &Pool<Symbol>,
    condition: Expr,
    pair: u32,
    sides: &[Expr; 2],
    parameters: &[Parameter],
) -> Option<[f64; 2]> {
    let mut ends: BTreeMap<Symbol, [f64; 2]> = BTreeMap::new();
    let mut at = |way: f64, exprs: &[Expr]| {
        pool.evaluate_all(exprs, &mut |symbol| {
            if let Symbol::Parameter { index, .. } = symbol {
                return parameters.get(*index).map_or(f64::NAN, |parameter| parameter.default);
            }
            let drawn = ends.len();
            let [from, to] = *ends.entry(symbol.clone()).or_insert_with(|| {
                let draw = if pair.is_multiple_of(2) { probe::near_one } else { probe::of_any_size };
                [draw(2 * pair, 2 * drawn), draw(2 * pair + 1, 2 * drawn + 1)]
            });
            from + way * (to - from)
        })
    };
    let mut sign = |way: f64| at(way, &[condition]).first().map_or(f64::NAN, |value| *value);
    let (mut low, mut high) = (0.0, 1.0);
    let first = sign(low) > 0.0;
    if (sign(high) > 0.0) == first {
        return None;
    }
    for _ in 0..BISECTIONS {
        let middle = f64::midpoint(low, high);
        if (sign(middle) > 0.0) == first { low = middle } else { high = middle }
    }
    let values = at(high, sides);
    let [then, otherwise] = values[..] else { return None };
    (then.is_finite() && otherwise.is_finite()).then_some([then, otherwise])
}
