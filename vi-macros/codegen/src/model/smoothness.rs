//! The smoothness of L and f: how many derivatives are continuous across conditions and the knots of tables.
//!
//! In: L and f. Out: [`Smoothness`], or the condition at whose border L jumps. A force counts one derivative less than
//! L, since the equations contain the derivative of L. The border of a condition is sought between points of a fixed
//! sequence. There the expression, and its derivatives along a fixed direction, are evaluated with either arm of the
//! condition. Parameters have their defaults.

use super::{FunctionKind, Model, Outside, Parameter, TableKind, probe};
use crate::symbol::Symbol;
use std::collections::BTreeMap;
use vi_expr::{Expr, Node, Pool};

/// Pairs of points between which a border is sought.
const PAIRS: u32 = 40;
/// Borders at which both expressions are compared.
const BORDERS: usize = 10;
/// Bisections of the way between two points: the bits of a number.
const BISECTIONS: u32 = 60;
/// Difference at a border that counts as a jump, relative to the differences around it. A root has an infinite slope
/// there, and differs by 1e-8.
const JUMP: f64 = 1e-6;
/// Difference of two expressions that are equal but for roundings, relative to them.
const ROUNDING: f64 = 1e-12;
/// Number of continuous derivatives that leave nothing to say: a quintic spline has four.
const SMOOTH: usize = 5;

/// The number of continuous derivatives of L.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Smoothness {
    /// Continuous derivatives; 0 if L is only continuous.
    pub derivatives: usize,
    /// What breaks the next derivative, in words: a table or a condition.
    pub cause: String,
}

/// The smoothness of a system with tables or conditions; `None` if all derivatives that matter are continuous.
pub(super) fn smoothness(pool: &mut Pool<Symbol>, model: &Model) -> Option<Smoothness> {
    let mut found: Vec<Smoothness> = Vec::new();
    let of_lagrangian = [(model.lagrangian, 0)];
    let of_forces = model.forces.iter().map(|force| (*force, 1));
    // Its derivatives are forces.
    let of_dissipation = model.dissipation.map(|rayleigh| (rayleigh, 0));
    for (expr, more) in of_lagrangian.into_iter().chain(of_forces).chain(of_dissipation) {
        let reachable = pool.reachable(&[expr]);
        for node in &reachable {
            let Node::Opaque(function, _) = pool.node(*node) else { continue };
            let known = model.functions.iter().find(|known| known.name == function.name.as_ref());
            if let Some(FunctionKind::Table(table)) = known.map(|known| &known.kind) {
                let of = |smoothness: usize| (smoothness + more).saturating_sub(function.order());
                let cause = format!("the table `{}`", function.name);
                found.push(Smoothness { derivatives: of(table.kind.smoothness()), cause });
                let at_the_ends = match table.outside {
                    Outside::Hold => 0,
                    Outside::Extend => 1,
                    Outside::Nothing | Outside::Periodic => SMOOTH,
                };
                let cause = format!("the ends of the table `{}`", function.name);
                found.push(Smoothness { derivatives: of(at_the_ends), cause });
            }
        }
        let mut slope = expr;
        for order in 0..SMOOTH {
            if let Some(condition) = jump(pool, slope, &model.parameters) {
                let condition = pool.render_within(CHARACTERS, condition, &|symbol| model.spell(symbol));
                let derivatives = (order + more).saturating_sub(1);
                found.push(Smoothness { derivatives, cause: format!("the condition `{condition} > 0`") });
                break;
            }
            if !reachable.iter().any(|node| matches!(pool.node(*node), Node::Select(_))) {
                break;
            }
            slope = directional(pool, slope);
        }
    }
    found.into_iter().filter(|found| found.derivatives < SMOOTH).min_by_key(|found| found.derivatives)
}

/// The linear tables in L: their slope jumps at each place, where an infinite force would act.
pub(super) fn linear_table(pool: &Pool<Symbol>, model: &Model) -> Option<String> {
    pool.reachable(&[model.lagrangian]).into_iter().find_map(|node| {
        let Node::Opaque(function, _) = pool.node(node) else { return None };
        let known = model.functions.iter().find(|known| known.name == function.name.as_ref())?;
        match &known.kind {
            FunctionKind::Table(table) if table.kind == TableKind::Linear => Some(function.name.to_string()),
            _ => None,
        }
    })
}

/// Characters of a condition in words.
const CHARACTERS: usize = 60;

/// The derivative along a fixed direction in time, coordinates and velocities.
fn directional(pool: &mut Pool<Symbol>, expr: Expr) -> Expr {
    let mut directions: BTreeMap<Symbol, i64> = BTreeMap::new();
    pool.derivative(expr, &mut |pool, symbol| {
        if !matches!(symbol, Symbol::Continuous(_)) {
            return pool.zero();
        }
        let next = i64::try_from(directions.len()).unwrap_or(0);
        // Neighbours differ, so that no difference of two coordinates stays constant.
        let direction = *directions.entry(symbol.clone()).or_insert(1 + next * next);
        pool.integer(direction)
    })
}

/// A condition of an expression at whose border the expression jumps.
///
/// The border is sought between points of a fixed sequence. There the expression is evaluated with either arm of the
/// condition. Parameters have their defaults. A condition with tables or Rust functions is not judged: their values are
/// not known here.
pub(super) fn jump(pool: &mut Pool<Symbol>, expr: Expr, parameters: &[Parameter]) -> Option<Expr> {
    let selects: Vec<(Expr, [Expr; 3])> = pool
        .reachable(&[expr])
        .into_iter()
        .filter_map(|node| if let Node::Select(parts) = pool.node(node) { Some((node, *parts)) } else { None })
        .collect();
    for (select, [condition, then, otherwise]) in selects {
        let parts = pool.reachable(&[condition, then, otherwise]);
        if parts.into_iter().any(|node| matches!(pool.node(node), Node::Opaque(..))) {
            continue;
        }
        let [then, otherwise] = [then, otherwise].map(|arm| pool.replace(expr, select, arm));
        // What both have in common cancels, however large it is.
        let difference = pool.sub(then, otherwise);
        let mut borders = 0;
        for pair in 0..PAIRS {
            let Some(values) = border(pool, condition, pair, &[difference, then, otherwise], parameters) else {
                continue;
            };
            let [difference, around, size] = values;
            if difference > JUMP * around && difference > ROUNDING * size {
                return Some(condition);
            }
            // Where another condition hides this one, both are equal all around.
            borders += usize::from(around > 0.0);
            if borders == BORDERS {
                break;
            }
        }
    }
    None
}

/// The absolute difference of two expressions at a point where a condition changes its sign, the largest one around it,
/// and the size of both; `None` if the condition does not change its sign between the two points of this pair, or if a
/// value is not finite.
fn border(
    pool: &Pool<Symbol>,
    condition: Expr,
    pair: u32,
    exprs: &[Expr; 3],
    parameters: &[Parameter],
) -> Option<[f64; 3]> {
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
    let values = at(high, exprs);
    let [difference, then, otherwise] = values[..] else { return None };
    let mut around = difference.abs();
    for way in [0.0, 1.0] {
        let size = at(way, &exprs[..1]).first().map_or(0.0, |value| value.abs());
        around = around.max(if size.is_finite() { size } else { 0.0 });
    }
    let is_finite = values.iter().all(|value| value.is_finite());
    is_finite.then_some([difference.abs(), around, then.abs().max(otherwise.abs())])
}
