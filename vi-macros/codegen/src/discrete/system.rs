//! From a model to its discrete system.
//!
//! In: a [`Model`]. Out: a [`DiscreteSystem`], or the message that a rule is written wrongly or the system too large.

use super::fields::Fields;
use super::forces::discrete_forces;
use super::interval::in_step;
use super::slots::Slots;
use super::{DiscreteSystem, continuous, slots, step};
use crate::limits::bounded;
use crate::messages::{Message, error};
use crate::model::{Model, Rule, rule};
use crate::rules::{NamedRule, RULES};
use crate::symbol::Symbol;
use syn::Result;
use vi_expr::{Expr, Pool, TooLarge};

/// Discretizes a model by its rule.
///
/// # Errors
/// A rule whose L_d leaves an end of the interval out, at that line; a system that grows too large, at its name.
pub fn system(pool: &mut Pool<Symbol>, model: &Model) -> Result<DiscreteSystem> {
    let mut fields = Fields::new(pool, model);
    let too_large = |found: TooLarge| error(model.name.span(), &Message::TooLarge(found));
    let continuous = continuous::continuous(pool, &mut fields, model).map_err(too_large)?;
    let rule = known_rule(pool, model)?;
    let slots = slots::slots(pool, &mut fields, model, &model.rule).map_err(too_large)?;
    bounded(pool).map_err(too_large)?;
    every_slot_acts(pool, model, &slots)?;
    let equations = step::equations(pool, &mut fields, &slots).map_err(too_large)?;
    let point_derivatives = continuous::point_derivatives(pool, &mut fields, model.dimension()).map_err(too_large)?;
    bounded(pool).map_err(too_large)?;
    Ok(DiscreteSystem { rule, continuous, point_derivatives, fields, slots, equations })
}

/// The rule of the table that the system's rule is: by its name, or written out.
fn known_rule(pool: &mut Pool<Symbol>, model: &Model) -> Result<Option<&'static NamedRule>> {
    if model.rule.named.is_some() {
        return Ok(model.rule.named);
    }
    for known in &RULES {
        let resolved = rule::named(pool, known, model.dimension(), model.forced)?;
        if says_the_same(pool, model, &resolved).unwrap_or(false) {
            return Ok(Some(known));
        }
    }
    Ok(None)
}

/// Whether a rule is the system's: its L_d, and its forces once they are multiplied out.
fn says_the_same(pool: &mut Pool<Symbol>, model: &Model, rule: &Rule) -> core::result::Result<bool, TooLarge> {
    if rule.ld != model.rule.ld || rule.points != model.rule.points {
        return Ok(false);
    }
    let theirs = discrete_forces(pool, model, rule)?;
    let ours = discrete_forces(pool, model, &model.rule)?;
    for (theirs, ours) in theirs.expressions().zip(ours.expressions()) {
        if in_step(pool, theirs)? != in_step(pool, ours)? {
            return Ok(false);
        }
    }
    Ok(true)
}

/// A discrete Lagrangian that leaves an end of its interval out has no equations of a step.
fn every_slot_acts(pool: &Pool<Symbol>, model: &Model, slots: &Slots) -> Result<()> {
    let none = |derivatives: &[Expr]| derivatives.iter().all(|derivative| pool.is_zero(*derivative));
    let each: [(&'static str, &[Expr]); 4] =
        [("t0", &[slots.d1_ld]), ("q0", &slots.d2_ld), ("t1", &[slots.d3_ld]), ("q1", &slots.d4_ld)];
    match each.into_iter().find(|(_, derivatives)| none(derivatives)) {
        Some((name, _)) => Err(error(model.rule.span, &Message::UnusedSlot { name })),
        None => Ok(()),
    }
}
