//! Slot derivatives of the discrete Lagrangian.
//!
//! In: a rule, evaluated. Out: L_d, D1…D4 L_d, f_d^±, g_d^± in fields at the points, the step h and its velocity
//! v = (q1 − q0)/h. For the midpoint rule
//!
//! ```text
//! D1 L_d = v·L_v − L + (h/2) L_t     D3 L_d = −(v·L_v − L) + (h/2) L_t
//! D2 L_d = (h/2) L_q − L_v           D4 L_d =  (h/2) L_q + L_v
//! ```

use super::fields::{Arguments, Changes, changes};
use super::rule::Evaluated;
use super::{Fields, Point, bounded};
use crate::symbol::Symbol;
use vi_expr::{Expr, Pool, TooLarge};

/// The discrete system in its slots.
pub struct Slots {
    /// Where L and f are evaluated, in the slots t0, q0, t1, q1 and h.
    pub points: Vec<Point>,
    /// L_d.
    pub ld: Expr,
    /// ∂L_d/∂t0.
    pub d1_ld: Expr,
    /// ∂L_d/∂q0.
    pub d2_ld: Vec<Expr>,
    /// ∂L_d/∂t1.
    pub d3_ld: Expr,
    /// ∂L_d/∂q1.
    pub d4_ld: Vec<Expr>,
    /// Discrete force on δq0; zeros without a force.
    pub fd_minus: Vec<Expr>,
    /// Discrete force on δq1; zeros without a force.
    pub fd_plus: Vec<Expr>,
    /// Discrete power on δt0; zero without a force.
    pub gd_minus: Expr,
    /// Discrete power on δt1; zero without a force.
    pub gd_plus: Expr,
}

/// Differentiates L_d by its slots.
pub(super) fn slots(
    pool: &mut Pool<Symbol>,
    fields: &mut Fields,
    rule: Evaluated,
    dimension: usize,
) -> Result<Slots, TooLarge> {
    let Evaluated { ld, fd: [fd_minus, fd_plus], gd: [gd_minus, gd_plus], points } = rule;
    let arguments = Arguments::of(pool, &points);
    let mut by_slot = |pool: &mut Pool<Symbol>, slot: Symbol| {
        bounded(pool)?;
        let changes = changes(pool, &arguments, &|pool, symbol| direct(pool, symbol, &slot));
        let slope = derivative(pool, fields, ld, &slot, &changes);
        in_step(pool, slope)
    };
    let d1_ld = by_slot(pool, Symbol::T0)?;
    let d3_ld = by_slot(pool, Symbol::T1)?;
    let d2_ld = (0..dimension).map(|i| by_slot(pool, Symbol::Q0(i))).collect::<Result<_, _>>()?;
    let d4_ld = (0..dimension).map(|i| by_slot(pool, Symbol::Q1(i))).collect::<Result<_, _>>()?;
    let mut settle = |pool: &mut Pool<Symbol>, expr: Expr| {
        let settled = fields.settle(pool, expr);
        in_step(pool, settled)
    };
    let zero = pool.zero();
    let mut settle_all = |pool: &mut Pool<Symbol>, vector: Vec<Expr>| {
        if vector.is_empty() {
            return Ok(vec![zero; dimension]);
        }
        vector.into_iter().map(|entry| settle(pool, entry)).collect::<Result<Vec<_>, _>>()
    };
    let (fd_minus, fd_plus) = (settle_all(pool, fd_minus)?, settle_all(pool, fd_plus)?);
    let scalars = settle_all(pool, vec![ld, gd_minus, gd_plus])?;
    let (ld, gd_minus, gd_plus) = (scalars[0], scalars[1], scalars[2]);
    Ok(Slots { points, ld, d1_ld, d2_ld, d3_ld, d4_ld, fd_minus, fd_plus, gd_minus, gd_plus })
}

fn derivative(pool: &mut Pool<Symbol>, fields: &mut Fields, ld: Expr, slot: &Symbol, changes: &Changes) -> Expr {
    fields.derivative(pool, ld, &|pool, symbol| direct(pool, symbol, slot), changes)
}

/// How a symbol changes with a slot: itself by 1, and h = t1 − t0 with its ends.
fn direct(pool: &mut Pool<Symbol>, symbol: &Symbol, slot: &Symbol) -> Expr {
    match (symbol, slot) {
        _ if symbol == slot => pool.one(),
        (Symbol::Step, Symbol::T1) => pool.one(),
        (Symbol::Step, Symbol::T0) => pool.integer(-1),
        _ => pool.zero(),
    }
}

/// The same in h and v: `q1 = q0 + h v`, `t1 = t0 + h`, multiplied out so that equal terms meet.
fn in_step(pool: &mut Pool<Symbol>, expr: Expr) -> Result<Expr, TooLarge> {
    let expr = pool.substitute(expr, &mut |pool, symbol| match symbol {
        Symbol::T1 => {
            let (start, step) = (pool.symbol(Symbol::T0), pool.symbol(Symbol::Step));
            Some(pool.add(start, step))
        }
        Symbol::Q1(index) => {
            let (start, step) = (pool.symbol(Symbol::Q0(*index)), pool.symbol(Symbol::Step));
            let velocity = pool.symbol(Symbol::StepVelocity(*index));
            let way = pool.mul(step, velocity);
            Some(pool.add(start, way))
        }
        _ => None,
    });
    pool.expand(expr)
}
