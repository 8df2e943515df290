//! The slots of an interval: t0, q0, t1, q1.
//!
//! In: expressions in the slots and the step h = t1 − t0. Out: how their symbols change with a slot, and the same expressions in the step
//! and its velocity, where `q1 = q0 + h v` and `t1 = t0 + h`.

use crate::symbol::Symbol;
use vi_expr::{Expr, Pool, TooLarge};

/// How a symbol changes with a slot: itself by 1, and h = t1 − t0 with its ends.
pub(super) fn by_slot(pool: &mut Pool<Symbol>, symbol: &Symbol, slot: &Symbol) -> Expr {
    match (symbol, slot) {
        _ if symbol == slot => pool.one(),
        (Symbol::Step, Symbol::T1) => pool.one(),
        (Symbol::Step, Symbol::T0) => pool.integer(-1),
        _ => pool.zero(),
    }
}

/// The same in h and v, multiplied out so that equal terms meet.
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
