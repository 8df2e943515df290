//! The summands of L, each with its force and its energy.
//!
//! In: a checked system. Out: for each summand T of L the force `T_q − d/dt T_v` and the energy `v·T_v − T`, and how many
//! operations the equations of motion have without it. So a program can measure along a motion which terms matter.

use crate::discrete::{continuous, system};
use crate::limits::bounded;
use crate::messages::{Message, error};
use crate::model::{Model, slope};
use crate::program::{self, Function, FunctionId};
use crate::symbol::{Symbol, Variable};
use syn::Result;
use vi_expr::{Expr, Pool};

/// A summand of L.
#[derive(Clone, Debug)]
pub struct Term {
    /// The summand.
    pub value: Expr,
    /// Its generalized force, one component for each coordinate; it contains accelerations.
    pub force: Vec<Expr>,
    /// Its part of the energy.
    pub energy: Expr,
    /// The operations of the equations of motion at one point without it; `None` if there are no equations without it.
    pub operations_without: Option<usize>,
}

/// The summands of L, in its order; a single one for a product.
///
/// # Errors
/// A system that is too large.
pub fn terms(pool: &mut Pool<Symbol>, model: &mut Model) -> Result<Vec<Term>> {
    let whole = model.lagrangian;
    let summands = continuous::summands(pool, whole);
    let mut terms = Vec::with_capacity(summands.len());
    for value in summands {
        let force = (0..model.dimension()).map(|index| force(pool, value, index)).collect();
        let energy = continuous::energy(pool, value, model.dimension());
        model.lagrangian = pool.sub(whole, value);
        let operations_without = operations(pool, model).ok();
        terms.push(Term { value, force, energy, operations_without });
    }
    model.lagrangian = whole;
    bounded(pool).map_err(|found| error(model.name.span(), &Message::TooLarge { size: found }))?;
    Ok(terms)
}

/// The operations of the equations of motion at one point.
///
/// # Errors
/// A system that is too large.
pub fn operations(pool: &mut Pool<Symbol>, model: &mut Model) -> Result<usize> {
    // The functions of a step are not needed.
    model.rule = None;
    let system = system::system(pool, model)?;
    let program = program::program(pool, model, &system)?;
    Ok(program.function(FunctionId::Point).map_or(0, Function::operation_count))
}

/// `T_q − d/dt T_v` for one coordinate.
fn force(pool: &mut Pool<Symbol>, term: Expr, index: usize) -> Expr {
    let momentum = slope(pool, term, Variable::Velocity(index));
    let rate = pool.derivative(momentum, &mut |pool, symbol| match symbol {
        Symbol::Continuous(Variable::Time) => pool.one(),
        Symbol::Continuous(Variable::Coordinate(index)) => pool.symbol(Symbol::Continuous(Variable::Velocity(*index))),
        Symbol::Continuous(Variable::Velocity(index)) => pool.symbol(Symbol::Acceleration(*index)),
        _ => pool.zero(),
    });
    let applied = slope(pool, term, Variable::Coordinate(index));
    pool.sub(applied, rate)
}
