//! Checks that Rayleigh's function dissipates energy.
//!
//! In: R as written and as an expression, and its derivatives with respect to the velocities. Out: nothing, or a
//! message at the first wrong summand. A term linear in the velocities is a force independent of them. R adds energy if
//! the power −v·∂R/∂v is positive, beyond rounding, at every point of a fixed sequence, with all velocities or with one
//! alone. Parameters have their defaults. All other symbols have either sign and sizes from 1e-6 to 1e6, so that an R
//! of indefinite sign is accepted.

use super::context::Context;
use super::{Parameter, probe, slope};
use crate::messages::Message;
use crate::symbol::{Symbol, Variable};
use crate::syntax::{Expression, Kind, Operator};
use std::collections::BTreeMap;
use vi_expr::{Expr, Node, Pool};

/// Points at which the power is evaluated.
const POINTS: u32 = 32;
/// Minimum number of points with a power, to decide its sign.
const LEAST: usize = 2;

/// Reports an R that is a constant force or adds energy.
pub(super) fn check(
    context: &mut Context,
    written: &Expression,
    (rayleigh, losses): (Expr, &[Expr]),
    parameters: &[Parameter],
) {
    let wrong = wrong(context.pool, rayleigh, losses, parameters);
    let Some(message) = wrong.filter(|_| !context.is_too_large()) else { return };
    let span = summands(written).into_iter().find(|(is_negative, summand)| {
        let Ok(value) = context.scope.expression(context.pool, summand) else { return false };
        let value = context.closed(value);
        let value = if *is_negative { context.pool.neg(value) } else { value };
        let losses: Vec<Expr> =
            (0..losses.len()).map(|index| slope(context.pool, value, Variable::Velocity(index))).collect();
        self::wrong(context.pool, value, &losses, parameters).as_ref() == Some(&message)
    });
    context.errors.at(span.map_or(written.span, |(_, summand)| summand.span), &message);
}

/// The summands of a written expression, each with whether it is negated.
fn summands(written: &Expression) -> Vec<(bool, &Expression)> {
    match &written.kind {
        Kind::Chain(first, rest) => {
            let rest = rest.iter().map(|(operator, summand)| (*operator, summand));
            let signed = [(Operator::Plus, &**first)].into_iter().chain(rest);
            signed
                .map(|(operator, summand)| match operator {
                    Operator::Plus => Some((false, summand)),
                    Operator::Minus => Some((true, summand)),
                    Operator::Times | Operator::Over => None,
                })
                .collect::<Option<_>>()
                .unwrap_or_default()
        }
        _ => Vec::new(),
    }
}

/// The error of an R with these derivatives.
fn wrong(pool: &mut Pool<Symbol>, rayleigh: Expr, losses: &[Expr], parameters: &[Parameter]) -> Option<Message> {
    let terms = match pool.node(rayleigh) {
        Node::Sum(sum) => sum.terms.iter().map(|(term, _)| *term).collect(),
        _ => vec![rayleigh],
    };
    if terms.into_iter().any(|term| is_linear(pool, term)) {
        return Some(Message::ConstantDissipation);
    }
    let alone = losses.iter().enumerate().filter(|(_, loss)| !pool.is_zero(**loss)).map(|(index, _)| Some(index));
    let adds_energy = [None].into_iter().chain(alone).any(|moving| adds_energy(pool, losses, moving, parameters));
    adds_energy.then_some(Message::FeedingDissipation)
}

/// Whether a term is linear in the velocities: it has a derivative with respect to one, and no derivative depends on
/// any.
fn is_linear(pool: &mut Pool<Symbol>, term: Expr) -> bool {
    let is_velocity = |symbol: &Symbol| matches!(symbol, Symbol::Continuous(Variable::Velocity(_)));
    let mut is_there = false;
    for symbol in pool.symbols(term) {
        let Symbol::Continuous(Variable::Velocity(index)) = symbol else { continue };
        let slope = slope(pool, term, Variable::Velocity(index));
        if pool.depends_on(slope, &is_velocity) {
            return false;
        }
        is_there |= !pool.is_zero(slope);
    }
    is_there
}

/// Whether the power is positive at every point with a value, for all velocities or for one velocity alone.
fn adds_energy(pool: &Pool<Symbol>, losses: &[Expr], moving: Option<usize>, parameters: &[Parameter]) -> bool {
    let of_moving = moving.map_or(losses, |index| &losses[index..=index]);
    let first = moving.unwrap_or(0);
    let mut positive = 0;
    for point in 0..POINTS {
        let mut drawn = BTreeMap::new();
        let mut value = |symbol: &Symbol| match symbol {
            Symbol::Parameter { index, .. } => parameters.get(*index).map_or(f64::NAN, |parameter| parameter.default),
            Symbol::Continuous(Variable::Velocity(index)) if moving.is_some_and(|moving| moving != *index) => 0.0,
            other => {
                let number = probe::of_any_size(point, drawn.len());
                *drawn.entry(other.clone()).or_insert(number)
            }
        };
        let values = pool.evaluate_rounded(of_moving, &mut value);
        let velocity = |index: usize| Symbol::Continuous(Variable::Velocity(index));
        let speeds: Vec<f64> = (first..first + of_moving.len()).map(|index| value(&velocity(index))).collect();
        let (mut power, mut error) = (0.0, 0.0);
        for (speed, loss) in speeds.into_iter().zip(values) {
            power -= speed * loss.value;
            error += speed.abs() * (loss.error + f64::EPSILON * loss.value.abs());
        }
        if power <= error {
            return false;
        }
        positive += usize::from(power > error);
    }
    positive >= LEAST
}
