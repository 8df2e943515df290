//! Slot derivatives of the discrete Lagrangian.
//!
//! In: a [`Rule`]. Out: L_d, D1…D4 L_d, f_d^±, g_d^± in fields at the points, the step h and its velocity
//! v = (q1 − q0)/h. For the midpoint rule
//!
//! ```text
//! D1 L_d = v·L_v − L + (h/2) L_t     D3 L_d = −(v·L_v − L) + (h/2) L_t
//! D2 L_d = (h/2) L_q − L_v           D4 L_d =  (h/2) L_q + L_v
//! ```

use super::fields::{Arguments, Fields, changes};
use super::forces::discrete_forces;
use super::interval::{by_slot, in_step};
use crate::limits::bounded;
use crate::model::{DiscreteForces, Model, Point, Rule};
use crate::symbol::Symbol;
use vi_expr::{Expr, Pool, TooLarge};

/// The discrete system in its slots.
pub struct SlotDerivatives {
    /// The points at which L and f are evaluated, as expressions in t0, q0, t1, q1 and h.
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
    /// f_d^± and g_d^±; zero without a force.
    pub forces: DiscreteForces,
}

/// Differentiates L_d with respect to its slots.
pub(super) fn slots(
    pool: &mut Pool<Symbol>,
    fields: &mut Fields,
    model: &Model,
    rule: &Rule,
) -> Result<SlotDerivatives, TooLarge> {
    let dimension = model.dimension();
    let arguments = Arguments::of(pool, &rule.points);
    let mut derivative = |pool: &mut Pool<Symbol>, slot: Symbol| {
        bounded(pool)?;
        let direct = |pool: &mut Pool<Symbol>, symbol: &Symbol| by_slot(pool, symbol, &slot);
        let changes = changes(pool, &arguments, &direct);
        let slope = fields.derivative(pool, rule.ld, &direct, &changes);
        in_step(pool, slope)
    };
    let d1_ld = derivative(pool, Symbol::T0)?;
    let d3_ld = derivative(pool, Symbol::T1)?;
    let d2_ld = (0..dimension).map(|i| derivative(pool, Symbol::Q0(i))).collect::<Result<_, _>>()?;
    let d4_ld = (0..dimension).map(|i| derivative(pool, Symbol::Q1(i))).collect::<Result<_, _>>()?;
    let DiscreteForces { fd_minus, fd_plus, gd_minus, gd_plus } = discrete_forces(pool, model, rule)?;
    let mut inline = |pool: &mut Pool<Symbol>, expr: Expr| {
        let inlined = fields.inline_constants(pool, expr);
        in_step(pool, inlined)
    };
    let fd_minus = fd_minus.into_iter().map(|entry| inline(pool, entry)).collect::<Result<_, _>>()?;
    let fd_plus = fd_plus.into_iter().map(|entry| inline(pool, entry)).collect::<Result<_, _>>()?;
    let ld = inline(pool, rule.ld)?;
    let gd_minus = inline(pool, gd_minus)?;
    let gd_plus = inline(pool, gd_plus)?;
    let forces = DiscreteForces { fd_minus, fd_plus, gd_minus, gd_plus };
    Ok(SlotDerivatives { points: rule.points.clone(), ld, d1_ld, d2_ld, d3_ld, d4_ld, forces })
}
