//! From a model to its discrete system.
//!
//! In: a [`Model`]. Out: a [`DiscreteSystem`], or the message that a rule is written wrongly or the system too large.

use super::{DiscreteSystem, Fields, continuous, rule, slots, step};
use crate::messages::{Message, error};
use crate::model::Model;
use crate::symbol::Symbol;
use syn::Result;
use vi_expr::{Pool, TooLarge};

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
    let mut fields = Fields::new(model);
    let continuous = continuous::continuous(pool, &mut fields, model);
    let evaluated = rule::evaluate(pool, &model.rule, model.dimension(), model.forced)?;
    let too_large = |found: TooLarge| error(model.name.span(), &Message::TooLarge { limit: found.limit });
    let slots = slots::slots(pool, &mut fields, evaluated, model.dimension()).map_err(too_large)?;
    let equations = step::equations(pool, &mut fields, &slots).map_err(too_large)?;
    Ok(DiscreteSystem { continuous, fields, slots, equations })
}
