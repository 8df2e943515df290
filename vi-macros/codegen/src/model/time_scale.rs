//! The time scale: g of the time transformation dt = g(t, q) dτ.
//!
//! In: the lines `time_scale = g;`. Out: g, an expression in time, coordinates and parameters, if declared.

use super::Role;
use super::context::Context;
use crate::messages::Message;
use crate::symbol::{Symbol, Variable};
use crate::syntax::Definition;
use core::cmp::Ordering;
use vi_expr::Expr;

/// The time scale of a system, if it has one.
pub(super) fn time_scale(context: &mut Context, written: &[Definition]) -> Option<Expr> {
    let (first, others) = written.split_first()?;
    for other in others {
        context.errors.at(other.name.span(), &Message::SecondTimeScale);
    }
    let mut scope = context.scope.without_velocities(context.pool, "time_scale");
    let value = scope.expression(context.pool, &first.value);
    let value = context.report(value)?;
    let closed = context.closed(value);
    let moves = |symbol: &Symbol| matches!(symbol, Symbol::Continuous(Variable::Velocity(_)));
    if context.pool.depends_on(closed, &moves) && !context.is_too_large() {
        let name = context.scope.array_in(context.pool, value).unwrap_or_default();
        context.errors.at(first.value.span, &Message::VelocityIn { name, clause: "time_scale" });
    }
    let is_number = context.pool.is_constant(closed) && !context.is_too_large();
    if is_number && matches!(context.pool.constant_sign(closed), Ok(Ordering::Less | Ordering::Equal)) {
        context.errors.at(first.value.span, &Message::TimeScaleNotPositive);
    }
    context.defines(Role::TimeScale, "the time scale".to_owned(), first.name.span(), vec![value]);
    Some(value)
}
