//! Derivation of the discrete system of a model.
//!
//! In: a [`Model`]. Out: a [`DiscreteSystem`], or a message that the rule is invalid or the system too large.

use super::continuous::Continuous;
use super::fields::Fields;
use super::forces::discrete_forces;
use super::interval::in_step;
use super::slots::SlotDerivatives;
use super::{ByRule, Constraints, DiscreteSystem, constraints, continuous, slots, step};
use crate::limits::bounded;
use crate::messages::{Message, error};
use crate::model::{Model, Rule, rule};
use crate::rules::{NamedRule, RULES};
use crate::symbol::{Quantity, Symbol};
use syn::Result;
use vi_expr::{Expr, Pool, TooLarge};

/// Characters of an expression shown in a message.
const CHARACTERS: usize = 100;

/// Derives the motion of a model and, if it has a rule, its steps.
///
/// # Errors
/// A rule whose L_d does not depend on one end of the interval (reported at its line), and a system that grows too
/// large (reported at its name).
pub fn system(pool: &mut Pool<Symbol>, model: &Model) -> Result<DiscreteSystem> {
    let mut fields = Fields::new(pool, model);
    let too_large = |found: TooLarge| error(model.name.span(), &Message::TooLarge { size: found });
    let continuous = continuous::continuous(pool, &mut fields, model).map_err(too_large)?;
    check_derivatives(pool, &fields, &continuous, model)?;
    let constraints = constraints::constraints(pool, model).map_err(too_large)?;
    check_constraints(pool, constraints.as_ref(), model)?;
    let by_rule = match &model.rule {
        Some(rule) => Some(by_rule(pool, &mut fields, model, rule)?),
        None => None,
    };
    let point_derivatives = continuous::point_derivatives(pool, &mut fields, model.dimension()).map_err(too_large)?;
    bounded(pool).map_err(too_large)?;
    check_derivatives(pool, &fields, &continuous, model)?;
    Ok(DiscreteSystem { continuous, point_derivatives, constraints, fields, by_rule })
}

/// Discretizes a model with a rule.
fn by_rule(pool: &mut Pool<Symbol>, fields: &mut Fields, model: &Model, rule: &Rule) -> Result<ByRule> {
    let too_large = |found: TooLarge| error(model.name.span(), &Message::TooLarge { size: found });
    let known = known_rule(pool, model, rule)?;
    let slots = slots::slots(pool, fields, model, rule).map_err(too_large)?;
    bounded(pool).map_err(too_large)?;
    check_slots_used(pool, rule, &slots)?;
    let equations = step::equations(pool, fields, &slots).map_err(too_large)?;
    Ok(ByRule { rule: known, slots, equations })
}

/// Reports a derivative without a value in any state, such as the derivative of `0^x`, with the smallest expression
/// that has none.
fn check_derivatives(pool: &mut Pool<Symbol>, fields: &Fields, continuous: &Continuous, model: &Model) -> Result<()> {
    let (span, whole, by) = match (fields.undefined(pool), continuous.undefined(pool)) {
        (Some((Quantity::Lagrangian, whole, by)), _) => (model.lagrangian_span, whole, by),
        (Some((Quantity::Force(coordinate), whole, by)), _) => (model.coordinates[coordinate].name.span(), whole, by),
        (None, Some((whole, by))) => (model.name.span(), whole, by),
        (None, None) => return Ok(()),
    };
    bounded(pool).map_err(|found| error(model.name.span(), &Message::TooLarge { size: found }))?;
    let by = Symbol::Continuous(by);
    let part = pool.reachable(&[whole]).into_iter().find(|part| {
        let slope = pool.partial_derivative(*part, &by);
        pool.is_undefined(slope)
    });
    let expression = pool.render_within(CHARACTERS, part.unwrap_or(whole), &|symbol| model.spell(symbol));
    Err(error(span, &Message::NoDerivative { expression, by: model.spell(&by) }))
}

/// Reports a constraint with a derivative that has no value in any state.
fn check_constraints(pool: &mut Pool<Symbol>, found: Option<&Constraints>, model: &Model) -> Result<()> {
    let Some(constraint) = found.and_then(|found| found.undefined(pool)).map(|index| &model.constraints[index]) else {
        return Ok(());
    };
    bounded(pool).map_err(|found| error(model.name.span(), &Message::TooLarge { size: found }))?;
    let expression = pool.render_within(CHARACTERS, constraint.value, &|symbol| model.spell(symbol));
    let by = "a coordinate or the time".to_owned();
    Err(error(constraint.name.span(), &Message::NoDerivative { expression, by }))
}

/// The built-in rule that equals a rule of the system.
fn known_rule(pool: &mut Pool<Symbol>, model: &Model, ours: &Rule) -> Result<Option<&'static NamedRule>> {
    if ours.named.is_some() {
        return Ok(ours.named);
    }
    for known in &RULES {
        let resolved = rule::named(pool, known, model.dimension(), model.forced)?;
        if is_same_rule(pool, model, [&resolved, ours]).unwrap_or(false) {
            return Ok(Some(known));
        }
    }
    Ok(None)
}

/// Whether two rules are equal: the same L_d, and the same forces after expansion.
fn is_same_rule(
    pool: &mut Pool<Symbol>,
    model: &Model,
    [theirs, ours]: [&Rule; 2],
) -> core::result::Result<bool, TooLarge> {
    if theirs.ld != ours.ld || theirs.points != ours.points {
        return Ok(false);
    }
    let theirs = discrete_forces(pool, model, theirs)?;
    let ours = discrete_forces(pool, model, ours)?;
    for (theirs, ours) in theirs.expressions().zip(ours.expressions()) {
        if in_step(pool, theirs)? != in_step(pool, ours)? {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Reports an L_d that does not depend on one end of its interval: it defines no equations of a step.
fn check_slots_used(pool: &Pool<Symbol>, rule: &Rule, slots: &SlotDerivatives) -> Result<()> {
    let none = |derivatives: &[Expr]| derivatives.iter().all(|derivative| pool.is_zero(*derivative));
    let each: [(&'static str, &[Expr]); 4] =
        [("t0", &[slots.d1_ld]), ("q0", &slots.d2_ld), ("t1", &[slots.d3_ld]), ("q1", &slots.d4_ld)];
    match each.into_iter().find(|(_, derivatives)| none(derivatives)) {
        Some((name, _)) => Err(error(rule.span, &Message::UnusedSlot { name })),
        None => Ok(()),
    }
}
