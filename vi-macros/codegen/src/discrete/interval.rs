//! The slots of an interval: t0, q0, t1, q1.
//!
//! In: expressions in the slots and the step h = t1 − t0. Out: their derivatives with respect to a slot, and the same
//! expressions in the step and its velocity, with `q1 = q0 + h v` and `t1 = t0 + h`.

use crate::symbol::Symbol;
use vi_expr::{Expr, Pool, TooLarge};

/// Derivative of a symbol with respect to a slot, including h = t1 − t0.
pub(super) fn by_slot(pool: &mut Pool<Symbol>, symbol: &Symbol, slot: &Symbol) -> Expr {
    match (symbol, slot) {
        _ if symbol == slot => pool.one(),
        (Symbol::Step, Symbol::T1) => pool.one(),
        (Symbol::Step, Symbol::T0) => pool.integer(-1),
        _ => pool.zero(),
    }
}

/// Substitutes h and v and expands, so that equal terms combine.
pub(super) fn in_step(pool: &mut Pool<Symbol>, expr: Expr) -> Result<Expr, TooLarge> {
    let expr = pool.substitute(expr, &mut |pool, symbol| match symbol {
        Symbol::T1 => {
            let start = pool.symbol(Symbol::T0);
            let step = pool.symbol(Symbol::Step);
            Some(pool.add(start, step))
        }
        Symbol::Q1(index) => {
            let start = pool.symbol(Symbol::Q0(*index));
            let step = pool.symbol(Symbol::Step);
            let velocity = pool.symbol(Symbol::StepVelocity(*index));
            let displacement = pool.mul(step, velocity);
            Some(pool.add(start, displacement))
        }
        _ => None,
    });
    pool.expand(expr)
}
