//! From a model to its discrete system.
//!
//! In: a [`Model`]. Out: a [`DiscreteSystem`], or the message that a rule is written wrongly or the system too large.

use super::rule::Evaluated;
use super::{DiscreteSystem, Fields, RULES, Slots, bounded, continuous, named_rule, rule, slots, step};
use crate::messages::{Message, error};
use crate::model::Model;
use crate::symbol::Symbol;
use syn::Result;
use vi_expr::{Expr, Pool, TooLarge};

/// Discretizes a model by its rule.
///
/// # Errors
/// Mistakes in a rule that is written out, at the token; a system that grows too large, at its name.
pub fn system(model: &mut Model) -> Result<DiscreteSystem> {
    let mut pool: Pool<Symbol> = core::mem::take(&mut model.pool);
    let derived = derive(model, &mut pool);
    model.pool = pool;
    derived
}

fn derive(model: &Model, pool: &mut Pool<Symbol>) -> Result<DiscreteSystem> {
    let mut fields = Fields::new(pool, model);
    let too_large = |found: TooLarge| error(model.name.span(), &Message::TooLarge(found));
    let continuous = continuous::continuous(pool, &mut fields, model).map_err(too_large)?;
    let evaluated = rule::evaluate(pool, &model.rule, model.dimension(), model.forced)?;
    let rule = known_rule(pool, model, &evaluated);
    let slots = slots::slots(pool, &mut fields, evaluated, model.dimension()).map_err(too_large)?;
    bounded(pool).map_err(too_large)?;
    every_slot_acts(pool, model, &slots)?;
    let equations = step::equations(pool, &mut fields, &slots).map_err(too_large)?;
    bounded(pool).map_err(too_large)?;
    Ok(DiscreteSystem { rule, continuous, fields, slots, equations })
}

/// The named rule that says the same as the system's.
fn known_rule(pool: &mut Pool<Symbol>, model: &Model, evaluated: &Evaluated) -> Option<&'static str> {
    let by_name = RULES.into_iter().find(|name| *name == model.rule_name);
    by_name.or_else(|| {
        RULES.into_iter().find(|name| {
            let named = named_rule(name).and_then(Result::ok);
            let named = named.and_then(|rule| rule::evaluate(pool, &rule, model.dimension(), model.forced).ok());
            named.is_some_and(|named| named == *evaluated)
        })
    })
}

/// A discrete Lagrangian that leaves an end of its interval out has no equations of a step.
fn every_slot_acts(pool: &Pool<Symbol>, model: &Model, slots: &Slots) -> Result<()> {
    let none = |derivatives: &[Expr]| derivatives.iter().all(|derivative| pool.is_zero(*derivative));
    let written = model.rule.lines.iter().find(|line| line.name == "Ld");
    let span = written.map_or(model.rule.span, |line| line.name.span());
    let each: [(&'static str, &[Expr]); 4] =
        [("t0", &[slots.d1_ld]), ("q0", &slots.d2_ld), ("t1", &[slots.d3_ld]), ("q1", &slots.d4_ld)];
    match each.into_iter().find(|(_, derivatives)| none(derivatives)) {
        Some((name, _)) => Err(error(span, &Message::UnusedSlot { name })),
        None => Ok(()),
    }
}
