//! The smoothness of L and f: how many derivatives are continuous across conditions and the knots of tables.
//!
//! In: L and f. Out: [`Smoothness`], or the condition at whose border L jumps. A force counts one derivative less than
//! L, since the equations contain the derivative of L. The border of a condition is sought between points of a fixed
//! sequence. There the expression, and its derivatives along a fixed direction, are evaluated with either arm of the
//! condition. Parameters have their defaults.

use super::{FunctionKind, Model, Outside, Parameter, TableKind, probe};
use crate::symbol::Symbol;
use num_traits::Signed;
use std::collections::BTreeMap;
use vi_expr::{Expr, Function, Node, Pool, Rational};

/// Pairs of points between which a border is sought.
const PAIRS: u32 = 40;
/// Pairs of points from which the zero of a condition is sought by iteration.
const NARROW: u32 = 8;
/// Iterations for a zero, and the step of their difference quotients.
const ITERATIONS: u32 = 60;
const QUOTIENT: f64 = 1e-6;
/// Part of the way between two points beside a border.
const OUTSIDE: f64 = 1e-9;
/// Growth of a difference from there to the border that shows a pole.
const POLE: f64 = 1e3;
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
    for (role, expr) in model.expressions() {
        let Some(more) = role.order() else { continue };
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

/// An expression with conditions in place of those of its `abs` and `sign` that satisfy `is_replaced`.
pub(super) fn with_conditions(
    pool: &mut Pool<Symbol>,
    expr: Expr,
    is_replaced: &dyn Fn(&Pool<Symbol>, Expr) -> bool,
) -> Expr {
    rewritten(pool, expr, |pool, node| {
        let (function, argument) = match pool.node(node) {
            Node::Call(function @ (Function::Abs | Function::Sign), arguments) if is_replaced(pool, node) => {
                (*function, *arguments.first()?)
            }
            _ => return None,
        };
        let one = pool.integer(1);
        let then = if function == Function::Abs { argument } else { one };
        let otherwise = pool.neg(then);
        Some(pool.select(argument, then, otherwise))
    })
}

/// An expression with absolute values in place of the roots of squares, `abs(x)` for `sqrt(x^2)`.
fn with_absolute_values(pool: &mut Pool<Symbol>, expr: Expr) -> Expr {
    let is_even = |(_, exponent): &(Expr, Rational)| (exponent / Rational::from_integer(2.into())).is_integer();
    rewritten(pool, expr, |pool, node| {
        let Node::Product(product) = pool.node(node) else { return None };
        let mut others = product.factors.clone();
        let (place, squares) = others.iter().enumerate().find_map(|(place, (base, _))| match pool.node(*base) {
            Node::Product(squares) if squares.factors.iter().all(is_even) => Some((place, squares.factors.clone())),
            _ => None,
        })?;
        let (_, root) = others.remove(place);
        let mut factors: Vec<Expr> = others.iter().map(|(base, exponent)| pool.power(*base, exponent)).collect();
        for (base, exponent) in squares {
            let size = pool.call(Function::Abs, &[base]);
            factors.push(pool.power(size, &(exponent * &root)));
        }
        Some(pool.product(&factors))
    })
}

/// An expression in which `rewrite` replaces nodes until it returns `None` for all.
fn rewritten(
    pool: &mut Pool<Symbol>,
    mut expr: Expr,
    rewrite: impl Fn(&mut Pool<Symbol>, Expr) -> Option<Expr>,
) -> Expr {
    while let Some((node, by)) = pool.reachable(&[expr]).into_iter().find_map(|node| Some((node, rewrite(pool, node)?)))
    {
        expr = pool.replace(expr, node, by);
    }
    expr
}

/// A condition at whose border L jumps: of an `if`, of a `sign`, or of an `abs` or a root of a square that is divided by
/// what it vanishes with. Other absolute values are continuous.
pub(super) fn jump_of_lagrangian(pool: &mut Pool<Symbol>, model: &Model) -> Option<Expr> {
    let lagrangian = with_absolute_values(pool, model.lagrangian);
    let mut divided: Vec<Expr> = Vec::new();
    for node in pool.reachable(&[lagrangian]) {
        let Node::Product(product) = pool.node(node) else { continue };
        if product.factors.iter().any(|(_, exponent)| exponent.is_negative()) {
            let is_absolute = |base: &Expr| matches!(pool.node(*base), Node::Call(Function::Abs, _));
            divided.extend(product.factors.iter().map(|(base, _)| *base).filter(is_absolute));
        }
    }
    let is_replaced = |pool: &Pool<Symbol>, node: Expr| {
        matches!(pool.node(node), Node::Call(Function::Sign, _)) || divided.contains(&node)
    };
    let lagrangian = with_conditions(pool, lagrangian, &is_replaced);
    jump(pool, lagrangian, &model.parameters)
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
        let exprs = [difference, then, otherwise];
        for (pair, is_narrow) in (0..PAIRS).map(|pair| (pair, false)).chain((0..NARROW).map(|pair| (pair, true))) {
            // The points miss a condition that holds between close borders only: there an iteration finds its zero.
            if is_narrow && borders > 0 {
                break;
            }
            let found = if is_narrow { narrow_change(pool, condition, pair, parameters) } else { Some(Ends::new()) };
            let Some(values) = found.and_then(|ends| border(pool, condition, (pair, ends), &exprs, parameters)) else {
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

/// The values of symbols at two points.
type Ends = BTreeMap<Symbol, [f64; 2]>;

/// The values of the next symbol at the two points of a pair.
fn drawn(pair: u32, index: usize) -> [f64; 2] {
    let draw = if pair.is_multiple_of(2) { probe::near_one } else { probe::of_any_size };
    [draw(2 * pair, 2 * index), draw(2 * pair + 1, 2 * index + 1)]
}

/// The default of a parameter; `None` for another symbol.
fn default(symbol: &Symbol, parameters: &[Parameter]) -> Option<f64> {
    let Symbol::Parameter { index, .. } = symbol else { return None };
    Some(parameters.get(*index).map_or(f64::NAN, |parameter| parameter.default))
}

/// Two points between which a condition changes its sign, though it may have one sign at nearly all points. The first is
/// that of a pair. Newton's iteration, with steps along the gradient, leads to a zero of the condition, of one of its sums,
/// such as the distance in `exp(-distance) > 1/2`, or of all sums in turn, as at the centre of a narrow ellipse.
fn narrow_change(pool: &Pool<Symbol>, condition: Expr, pair: u32, parameters: &[Parameter]) -> Option<Ends> {
    let symbols: Vec<Symbol> =
        pool.symbols(condition).into_iter().filter(|symbol| default(symbol, parameters).is_none()).collect();
    let value = |expr: Expr, point: &[f64]| {
        pool.evaluate(expr, &mut |symbol| {
            let place = || symbols.iter().position(|other| other == symbol);
            default(symbol, parameters).or_else(|| place().map(|place| point[place])).unwrap_or(f64::NAN)
        })
    };
    let start: Vec<f64> = (0..symbols.len()).map(|index| drawn(pair, index)[0]).collect();
    let is_positive = value(condition, &start) > 0.0;
    let is_beyond = |point: &[f64]| (value(condition, point) > 0.0) != is_positive;
    let is_sum = |node: &Expr| matches!(pool.node(*node), Node::Sum(_));
    let sums: Vec<Expr> = pool.reachable(&[condition]).into_iter().filter(is_sum).collect();
    let alone = [condition].into_iter().chain(sums.clone()).map(|function| vec![function]);
    let end = alone.chain([sums]).find_map(|functions| {
        let mut point = start.clone();
        let mut along = vec![0.0; point.len()];
        for function in (0..ITERATIONS).flat_map(|_| functions.iter().copied()) {
            let mut next = point.clone();
            for (index, slope) in along.iter_mut().enumerate() {
                let step = QUOTIENT * point[index].abs().max(1.0);
                let mut shifted = |side: f64| {
                    next[index] = side.mul_add(step, point[index]);
                    value(function, &next)
                };
                *slope = (shifted(1.0) - shifted(-1.0)) / (2.0 * step);
                next[index] = point[index];
            }
            let size: f64 = along.iter().map(|slope| slope * slope).sum();
            let step = value(function, &point) / size;
            next.iter_mut().zip(&along).for_each(|(entry, slope)| *entry -= step * slope);
            if !next.iter().all(|entry| entry.is_finite()) {
                break;
            }
            point = next;
            if is_beyond(&point) {
                return Some(point);
            }
        }
        let size = along.iter().map(|slope| slope * slope).sum::<f64>().sqrt();
        let nearby = (1..15).flat_map(|power| [1.0, -1.0].map(|side| side * 10.0_f64.powi(-power) / size));
        let moved = |way: f64| point.iter().zip(&along).map(|(entry, slope)| way.mul_add(*slope, *entry)).collect();
        let mut nearby = nearby.map(moved);
        nearby.find(|point: &Vec<f64>| is_beyond(point))
    })?;
    Some(symbols.into_iter().zip(start.into_iter().zip(end).map(|(start, end)| [start, end])).collect())
}

/// Two expressions where a condition changes its sign: their absolute difference there, their largest absolute
/// difference around that point, and the size of both. `None` if the condition does not change its sign between the two
/// points of this pair, or if a value is not finite. Symbols without `ends` have those of the pair.
fn border(
    pool: &Pool<Symbol>,
    condition: Expr,
    (pair, mut ends): (u32, Ends),
    exprs: &[Expr; 3],
    parameters: &[Parameter],
) -> Option<[f64; 3]> {
    let mut at = |way: f64, exprs: &[Expr]| {
        pool.evaluate_all(exprs, &mut |symbol| {
            default(symbol, parameters).unwrap_or_else(|| {
                let index = ends.len();
                let [from, to] = *ends.entry(symbol.clone()).or_insert_with(|| drawn(pair, index));
                from + way * (to - from)
            })
        })
    };
    let mut sign = |way: f64| at(way, &[condition]).first().map_or(f64::NAN, |value| *value);
    let [mut low, mut high] = [0.0, 1.0];
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
    // A pole has no two sides that could agree.
    let outside = at(high + OUTSIDE, &exprs[..1]).first().map_or(0.0, |value| f64::abs(*value));
    if difference.abs() > POLE * outside {
        return None;
    }
    // A root vanishes slowly: it is less at the border, but not small.
    let difference = if difference.abs() < outside / 2.0 { 0.0 } else { difference };
    let mut around = difference.abs();
    for way in [0.0, 1.0] {
        let size = at(way, &exprs[..1]).first().map_or(0.0, |value| f64::abs(*value));
        around = around.max(if size.is_finite() { size } else { 0.0 });
    }
    let is_finite = values.iter().all(|value| value.is_finite());
    is_finite.then_some([difference.abs(), around, then.abs().max(otherwise.abs())])
}
