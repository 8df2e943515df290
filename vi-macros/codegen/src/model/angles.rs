//! Checks that every clause is 2π-periodic in each angle.
//!
//! In: the clauses of a system with angles. Out: nothing, or a message at the first clause that is not periodic, with
//! the angle. Each expression is evaluated at points of a fixed sequence, and at the same points with each angle moved
//! by whole turns. A difference beyond rounding at one point means that it is not periodic, for some values of the
//! parameters. An expression without a difference has to be periodic by its structure too: points miss a narrow peak.
//! There angles appear in functions with a period only, with factors of which a turn makes whole periods, or half ones
//! that leave the expression as it is.

use super::closed::Closed;
use super::context::{Clause, Context};
use super::point::Point;
use super::rule::Rule;
use super::{Coordinate, Parameter, Role, Space, probe, slope};
use crate::messages::Message;
use crate::symbol::{Symbol, Variable};
use num_traits::{One, Zero};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use vi_expr::{Expr, Function, Node, Pool, Rational, Rounded, Table};

/// Points at which expressions are compared.
const POINTS: u32 = 16;
/// The first points have numbers of about 1, the others of all sizes.
const NEAR: u32 = 8;
/// A difference below this multiple of its estimated rounding error counts as zero.
const MARGIN: f64 = 16.0;
/// Largest number of turns by which an angle moves.
const TURNS: u32 = 7;

/// Reports clauses that are not periodic in an angle.
pub(super) fn check(
    context: &mut Context,
    (coordinates, parameters): (&[Coordinate], &[Parameter]),
    rule: Option<&Rule>,
    clauses: &[Clause],
) {
    let are_angles: Vec<bool> = coordinates.iter().map(|coordinate| coordinate.space == Space::Circle).collect();
    if !are_angles.contains(&true) || !context.errors.is_empty() {
        return;
    }
    let written_out = rule.filter(|rule| rule.named.is_none());
    if let Some((rule, angle)) =
        written_out.and_then(|rule| Some((rule, angle_of_rule(context.pool, rule, &are_angles)?)))
    {
        let Coordinate { name, .. } = &coordinates[angle];
        let message = Message::NotPeriodic {
            what: "the rule".to_owned(),
            angle: coordinates[angle].text(),
            name: name.to_string(),
            ratio: None,
        };
        context.errors.at(rule.span, &message);
    }
    let closed = Closed::of(context.pool, context.scope.kept.as_deref().unwrap_or_default());
    for Clause { role, what, span, exprs } in clauses {
        let exprs: Vec<Expr> = exprs.iter().map(|expr| closed.expression(context.pool, *expr)).collect();
        let probe = |expr: &Expr| Probe { pool: context.pool, expr: *expr, are_angles: &are_angles, parameters };
        let failing = exprs.iter().find_map(|expr| probe(expr).failing_angle());
        let failing =
            failing.or_else(|| exprs.iter().find_map(|expr| outside_periods(context.pool, *expr, &are_angles)));
        if let Some(angle) = failing {
            let Coordinate { name, .. } = &coordinates[angle];
            let ratio = exprs.iter().find_map(|expr| ratio(context.pool, *expr, &are_angles));
            let ratio = ratio.filter(|_| *role == Role::Constraint).map(|index| parameters[index].text());
            let (what, angle, name) = (what.clone(), coordinates[angle].text(), name.to_string());
            context.errors.at(*span, &Message::NotPeriodic { what, angle, name, ratio });
        }
    }
}

/// An angle with which a written rule does not move: if both ends make the same turn, so has the angle at each point of
/// the rule, and nothing else may change. Points of about 1 suffice, since rules are linear in the ends.
fn angle_of_rule(pool: &Pool<Symbol>, rule: &Rule, are_angles: &[bool]) -> Option<usize> {
    let exprs: Vec<Expr> = rule.expressions().collect();
    // L_d comes first, discrete forces last.
    let arguments = rule.points.iter().flat_map(Point::arguments).map(|(variable, _)| Some(variable));
    let places = [None].into_iter().chain(arguments).chain(core::iter::repeat(None));
    let places: Vec<Option<Variable>> = places.take(exprs.len()).collect();
    let fails = |angle: &usize| {
        let values = |point: u32, turn: f64| {
            let mut drawn = BTreeMap::new();
            pool.evaluate_all(&exprs, &mut |symbol| {
                let index = drawn.len();
                let number = *drawn.entry(symbol.clone()).or_insert_with(|| probe::near_one(point, index));
                let is_moved = matches!(symbol, Symbol::Q0(end) | Symbol::Q1(end) if end == angle);
                if is_moved { number + turn } else { number }
            })
        };
        (0..NEAR).any(|point| {
            let (before, after) = (values(point, 0.0), values(point, 1.0));
            places.iter().zip(before).zip(after).any(|((place, before), after)| {
                let turn = f64::from(u8::from(*place == Some(Variable::Coordinate(*angle))));
                (after - before - turn).abs() > 1e-9 * (1.0 + before.abs())
            })
        })
    };
    (0..are_angles.len()).filter(|angle| are_angles[*angle]).find(fails)
}

/// An angle of which an expression is not periodic by its structure.
pub(super) fn outside_periods(pool: &mut Pool<Symbol>, expr: Expr, are_angles: &[bool]) -> Option<usize> {
    let is_moved = |symbol: &Symbol, angle: usize| *symbol == Symbol::Continuous(Variable::Coordinate(angle));
    let angles: Vec<usize> = (0..are_angles.len()).filter(|angle| are_angles[*angle]).collect();
    let any = |symbol: &Symbol| angles.iter().any(|angle| is_moved(symbol, *angle));
    // Nearly all systems end here, after one pass for all angles.
    if !Outside::of(pool, expr, &any, 1).is(expr) {
        return None;
    }
    let is_failing = |pool: &mut Pool<Symbol>, angle: usize| {
        let moved = |symbol: &Symbol| is_moved(symbol, angle);
        if !Outside::of(pool, expr, &moved, 1).is(expr) {
            return false;
        }
        // A turn changes the sign of sin(θ/2) and of cos(θ/2), and may leave a product or an even function of them.
        let outside = Outside::of(pool, expr, &moved, 2);
        let is_half = |pool: &Pool<Symbol>, node: &Expr| {
            let Node::Call(Function::Sin | Function::Cos, arguments) = pool.node(*node) else { return false };
            let factors = outside.factors(pool, arguments[0], &moved);
            factors.is_some_and(|factors| factors.iter().any(|factor| !factor.is_integer()))
        };
        let halves: Vec<Expr> = pool.reachable(&[expr]).into_iter().filter(|node| is_half(pool, node)).collect();
        let mut turned = expr;
        for half in halves {
            let negative = pool.neg(half);
            turned = pool.replace(turned, half, negative);
        }
        outside.is(expr) || turned != expr
    };
    angles.into_iter().find(|angle| is_failing(pool, *angle))
}

/// A parameter in the constant factor of an angle.
fn ratio(pool: &mut Pool<Symbol>, expr: Expr, are_angles: &[bool]) -> Option<usize> {
    (0..are_angles.len()).filter(|angle| are_angles[*angle]).find_map(|angle| {
        let symbols = slope(pool, expr, Variable::Coordinate(angle));
        let symbols = pool.symbols(symbols);
        let is_constant = !symbols.iter().any(|symbol| matches!(symbol, Symbol::Continuous(_)));
        symbols.into_iter().filter(|_| is_constant).find_map(|symbol| match symbol {
            Symbol::Parameter { index, .. } => Some(index),
            _ => None,
        })
    })
}

/// Which parts of an expression contain moved symbols outside of functions with a period.
struct Outside(Table<Expr, bool>);

impl Outside {
    /// The parts of an expression; `parts` of a period are enough: 1, or 2 for a half.
    fn of(pool: &Pool<Symbol>, expr: Expr, moved: &dyn Fn(&Symbol) -> bool, parts: i32) -> Self {
        let mut outside = Self(Table::default());
        for node in pool.reachable(&[expr]) {
            let mut is_here = matches!(pool.node(node), Node::Symbol(symbol) if moved(symbol));
            pool.node(node).each_child(|child| is_here |= outside.is(child));
            let is_here = is_here && !outside.is_periodic(pool, node, moved, parts);
            outside.0.insert(node, is_here);
        }
        outside
    }

    fn is(&self, expr: Expr) -> bool {
        self.0.get(expr).copied().unwrap_or(true)
    }

    /// Whether a function makes whole periods, or these parts of them, when a moved symbol makes a turn.
    fn is_periodic(&self, pool: &Pool<Symbol>, node: Expr, moved: &dyn Fn(&Symbol) -> bool, parts: i32) -> bool {
        let in_a_turn = match pool.node(node) {
            Node::Call(Function::Sin | Function::Cos, _) => parts,
            Node::Call(Function::Tan, _) => 2,
            // The stand-in of a table is a sine, for which a few points have decided.
            Node::Opaque(..) => 0,
            _ => return false,
        };
        let in_a_turn = Rational::from_integer(in_a_turn.into());
        let mut is_periodic = true;
        pool.node(node).each_child(|argument| {
            let factors = self.factors(pool, argument, moved);
            let is_whole = |factor: &Rational| in_a_turn.is_zero() || (factor * &in_a_turn).is_integer();
            is_periodic &= factors.is_some_and(|factors| factors.iter().all(is_whole));
        });
        is_periodic
    }

    /// The factors of the moved symbols in an argument that is linear in them; `None` for another.
    fn factors(&self, pool: &Pool<Symbol>, expr: Expr, moved: &dyn Fn(&Symbol) -> bool) -> Option<Vec<Rational>> {
        let of_term = |(term, factor): &(Expr, Rational)| match pool.as_symbol(*term) {
            Some(symbol) if moved(symbol) => Some(vec![factor.clone()]),
            _ => (!self.is(*term)).then(Vec::new),
        };
        let terms = match pool.node(expr) {
            Node::Sum(sum) => sum.terms.clone(),
            _ => vec![(expr, Rational::one())],
        };
        let factors: Option<Vec<_>> = terms.iter().map(of_term).collect();
        factors.map(|factors| factors.concat())
    }
}

/// An expression whose period is tested.
struct Probe<'a> {
    pool: &'a Pool<Symbol>,
    expr: Expr,
    are_angles: &'a [bool],
    parameters: &'a [Parameter],
}

impl Probe<'_> {
    /// An angle after whose turn the expression has another value; `None` if there is none.
    fn failing_angle(&self) -> Option<usize> {
        let depends = |index: &usize| {
            self.are_angles[*index]
                && self
                    .pool
                    .depends_on(self.expr, &|symbol| *symbol == Symbol::Continuous(Variable::Coordinate(*index)))
        };
        let angles: Vec<usize> = (0..self.are_angles.len()).filter(depends).collect();
        // All angles move together, by different turns; one by one only to name the one that fails.
        let differs = |turns: &dyn Fn(u32, usize) -> u32| (0..POINTS).any(|point| self.differs(point, turns));
        if angles.is_empty() || !differs(&scattered) {
            return None;
        }
        let alone = |angle: &usize| differs(&|_, index| u32::from(index == *angle));
        angles.iter().copied().find(alone).or(angles.first().copied())
    }

    /// Whether the value at a point changes beyond rounding if each angle moves by these turns.
    fn differs(&self, point: u32, turns: &dyn Fn(u32, usize) -> u32) -> bool {
        let start = self.value(point, &|_, angle| angle);
        let moved = |angle: f64, index: usize| TAU.mul_add(f64::from(turns(point, index)), angle);
        let end = self.value(point, &|index, angle| moved(angle, index));
        // The moved angle is rounded: its neighbour shows by how much the value may change.
        let neighbour = self.value(point, &|index, angle| {
            if turns(point, index) == 0 { angle } else { moved(angle, index) * 4.0_f64.mul_add(f64::EPSILON, 1.0) }
        });
        let rounding = start.error + end.error + (neighbour.value - end.value).abs();
        // False for NaN: without a value there is no difference.
        (end.value - start.value).abs() > MARGIN * rounding
    }

    /// The value at a point, with each angle passed through `moved`.
    fn value(&self, point: u32, moved: &dyn Fn(usize, f64) -> f64) -> Rounded {
        let mut drawn = BTreeMap::new();
        let values = self.pool.evaluate_rounded(&[self.expr], &mut |symbol| {
            let index = drawn.len();
            let number = *drawn.entry(symbol.clone()).or_insert_with(|| self.number(point, index, symbol));
            match symbol {
                Symbol::Continuous(Variable::Coordinate(index)) if self.are_angles[*index] => moved(*index, number),
                _ => number,
            }
        });
        values.first().copied().unwrap_or(Rounded::LOST)
    }

    /// The number of a symbol at a point. At every other point the parameters have their defaults.
    fn number(&self, point: u32, index: usize, symbol: &Symbol) -> f64 {
        let default = match symbol {
            Symbol::Parameter { index, .. } if point.is_multiple_of(2) => {
                self.parameters.get(*index).map(|parameter| parameter.default)
            }
            _ => None,
        };
        let is_angle = matches!(symbol, Symbol::Continuous(Variable::Coordinate(index)) if self.are_angles[*index]);
        match default.filter(|default| *default != 0.0) {
            Some(default) => default,
            None if is_angle || point < NEAR => probe::near_one(point, index),
            None => probe::of_any_size(point, index),
        }
    }
}

/// The turns of an angle at a point: 1 to [`TURNS`], by a hash, so that two angles differ at some points.
fn scattered(point: u32, index: usize) -> u32 {
    let index = u32::try_from(index).unwrap_or(u32::MAX);
    let mixed = (point ^ index.wrapping_mul(0x9E37_79B9)).wrapping_mul(0x85EB_CA6B);
    1 + (mixed >> 16) % TURNS
}
