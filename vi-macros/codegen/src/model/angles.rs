//! Checks that L, the forces, the dissipation, the constraints and the time scale are 2π-periodic in each angle.
//!
//! In: the clauses of a system with angles. Out: nothing, or a message at the first clause that is not periodic, with
//! the angle. Each expression is evaluated at points of a fixed sequence, and at the same points with each angle moved
//! by whole turns. A difference beyond rounding at one point means that it is not periodic, for some values of the
//! parameters. An expression without a value at any point is left to other checks.

use super::context::Context;
use super::force::{self, Entries};
use super::lets::Closed;
use super::point::Point;
use super::rule::Rule;
use super::{Constraint, Coordinate, Parameter, probe};
use crate::messages::Message;
use crate::symbol::{Symbol, Variable};
use crate::syntax::{Definition, System};
use proc_macro2::Span;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use vi_expr::{Expr, Pool, Rounded};

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
    system: &System,
    (coordinates, parameters): (&[Coordinate], &[Parameter]),
    (lagrangian, time_scale, rule): (Option<Expr>, Option<Expr>, Option<&Rule>),
    constraints: &[Constraint],
) {
    let are_angles: Vec<bool> = coordinates.iter().map(|coordinate| coordinate.is_angle).collect();
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
        };
        context.errors.at(rule.span, &message);
    }
    let mut clauses = clauses(context, system, lagrangian, time_scale);
    clauses.extend(constraints.chunk_by(|left, right| left.name == right.name).filter_map(|array| {
        let name = &array.first()?.name;
        let exprs = array.iter().map(|constraint| constraint.value).collect();
        Some(Clause { exprs, span: name.span(), what: format!("the constraint `{name}`") })
    }));
    let closed = Closed::of(context.pool, context.scope.kept.as_deref().unwrap_or_default());
    for Clause { mut exprs, span, what } in clauses {
        for expr in &mut exprs {
            *expr = closed.expression(context.pool, *expr);
        }
        let probe = |expr: &Expr| Probe { pool: context.pool, expr: *expr, are_angles: &are_angles, parameters };
        if let Some(angle) = exprs.iter().find_map(|expr| probe(expr).failing_angle()) {
            let Coordinate { name, .. } = &coordinates[angle];
            let message = Message::NotPeriodic { what, angle: coordinates[angle].text(), name: name.to_string() };
            context.errors.at(span, &message);
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

/// A clause that has to be periodic.
struct Clause {
    exprs: Vec<Expr>,
    span: Span,
    what: String,
}

/// The clauses that have to be periodic.
fn clauses(context: &mut Context, system: &System, lagrangian: Option<Expr>, time_scale: Option<Expr>) -> Vec<Clause> {
    let clause = |exprs: Vec<Expr>, written: &Definition, what: &str| Clause {
        exprs,
        span: written.name.span(),
        what: what.to_owned(),
    };
    let mut all = Vec::new();
    let first = system.lagrangians.first().zip(lagrangian);
    all.extend(first.map(|(written, expr)| clause(vec![expr], written, "`L`")));
    for line in &system.forces {
        let entries = Entries::of_coordinate(context, &line.name.to_string());
        let unknown = |_: &Context, name: String| Message::ForceOnOther { name, near: None };
        let values = force::values(context, line, entries, &unknown).unwrap_or_default();
        let exprs = values.into_iter().map(|(_, expr)| expr).collect();
        all.push(clause(exprs, line, &format!("the force on `{}`", line.name)));
    }
    if let Some(written) = system.dissipations.first() {
        all.push(clause(vec![context.value(&written.value)], written, "the dissipation"));
    }
    let first = system.time_scales.first().zip(time_scale);
    all.extend(first.map(|(written, expr)| clause(vec![expr], written, "the time scale")));
    all
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
        let beside = self.value(point, &|index, angle| {
            if turns(point, index) == 0 { angle } else { moved(angle, index) * 4.0_f64.mul_add(f64::EPSILON, 1.0) }
        });
        let rounding = start.error + end.error + (beside.value - end.value).abs();
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
