//! The equations of one step, in the unknowns (v, h).
//!
//! In: the slot derivatives. Out, with `q1 = q0 + h v`, `t1 = t0 + h` and the low parts of the carried numbers:
//!
//! ```text
//! r = −D2 L_d − f_d⁻ − p0            momentum row
//! e =  D1 L_d + g_d⁻ − E0            energy row
//! c =  e − v·r                       combined row; its terms of order one have cancelled
//! A = ∂r/∂v    ∂r/∂h    (∂e/∂v − v·A)/h    (∂e/∂h − v·∂r/∂h)/h
//! p1 − p0 = D2 L_d + D4 L_d + f_d⁻ + f_d⁺      E1 − E0 = −D1 L_d − D3 L_d − g_d⁻ − g_d⁺      E1 = −D3 L_d − g_d⁺
//! ```
//!
//! and, for sensitivities, `∂r/∂q0`, `∂e/∂q0 − v·∂r/∂q0`, and the derivatives of p1 − p0 and E1 − E0 with respect to
//! q0, v and h.

use super::fields::{Arguments, Changes, Fields, Variables, changes};
use super::slots::SlotDerivatives;
use crate::limits::bounded;
use crate::model::Point;
use crate::symbol::{Symbol, Variable};
use std::collections::BTreeSet;
use vi_expr::{Expr, Pool, Rational, TooLarge};

/// The equations of one step.
pub struct Equations {
    /// The points at which L and f are evaluated, as expressions in the node and the unknowns.
    pub points: Vec<Point>,
    /// r.
    pub residual: Vec<Expr>,
    /// A, row by row: entry (i, j) is ∂r_i/∂v_j.
    pub residual_dv: Vec<Vec<Expr>>,
    /// ∂r/∂h.
    pub residual_dh: Vec<Expr>,
    /// c.
    pub energy_residual: Expr,
    /// (∂e/∂v − v·A)/h.
    pub energy_dv: Vec<Expr>,
    /// (∂e/∂h − v·∂r/∂h)/h.
    pub energy_dh: Expr,
    /// p1 − p0.
    pub momentum_increment: Vec<Expr>,
    /// E1 − E0.
    pub energy_increment: Expr,
    /// E1.
    pub discrete_energy: Expr,
    /// ∂r/∂q0, row by row.
    pub residual_dq: Vec<Vec<Expr>>,
    /// ∂e/∂q0 − v·∂r/∂q0.
    pub energy_dq: Vec<Expr>,
    /// ∂(p1 − p0)/∂q0, row by row.
    pub momentum_increment_dq: Vec<Vec<Expr>>,
    /// ∂(p1 − p0)/∂v, row by row.
    pub momentum_increment_dv: Vec<Vec<Expr>>,
    /// ∂(p1 − p0)/∂h.
    pub momentum_increment_dh: Vec<Expr>,
    /// ∂(E1 − E0)/∂q0.
    pub energy_increment_dq: Vec<Expr>,
    /// ∂(E1 − E0)/∂v.
    pub energy_increment_dv: Vec<Expr>,
    /// ∂(E1 − E0)/∂h.
    pub energy_increment_dh: Expr,
}

/// Derives the equations of a step.
pub(super) fn equations(
    pool: &mut Pool<Symbol>,
    fields: &mut Fields,
    slots: &SlotDerivatives,
) -> Result<Equations, TooLarge> {
    let dimension = slots.d2_ld.len();
    let points: Vec<Point> = slots.points.iter().map(|point| at_node(pool, point)).collect();
    let velocities: Vec<Expr> = (0..dimension).map(|i| pool.symbol(Symbol::StepVelocity(i))).collect();
    let mut residual = Vec::with_capacity(dimension);
    for i in 0..dimension {
        let start = carried(pool, Symbol::P0(i));
        let terms = [slots.d2_ld[i], slots.forces.fd_minus[i], start];
        residual.push(negative_sum(pool, &terms)?);
    }
    let start = carried(pool, Symbol::E0);
    let power = pool.add(slots.d1_ld, slots.forces.gd_minus);
    let energy = pool.sub(power, start);
    let energy_residual = combined(pool, energy, &velocities, &residual)?;

    let momentum_increment = momentum_increment(pool, slots)?;
    let energy_increment =
        negative_sum(pool, &[slots.d1_ld, slots.d3_ld, slots.forces.gd_minus, slots.forces.gd_plus])?;

    let discrete_energy = negative_sum(pool, &[slots.d3_ld, slots.forces.gd_plus])?;

    let in_rows_of = |expr: &Expr| Row::new(pool, fields, *expr, points.len());
    let rows: Vec<Row> = residual.iter().chain([&energy]).map(in_rows_of).collect();
    let arguments = Arguments::of(pool, &points);
    let mut by_velocities = Vec::with_capacity(dimension);
    let mut energy_dv = Vec::with_capacity(dimension);
    for j in 0..dimension {
        let column = by_unknown(pool, fields, &arguments, &rows, &Symbol::StepVelocity(j))?;
        energy_dv.push(over_step(pool, column.energy, &velocities, &column.momentum)?);
        by_velocities.push(column);
    }
    let by_step = by_unknown(pool, fields, &arguments, &rows, &Symbol::Step)?;
    let energy_dh = over_step(pool, by_step.energy, &velocities, &by_step.momentum)?;

    let mut by_coordinates = Vec::with_capacity(dimension);
    let mut energy_dq = Vec::with_capacity(dimension);
    for j in 0..dimension {
        let column = by_unknown(pool, fields, &arguments, &rows, &Symbol::Q0(j))?;
        energy_dq.push(combined(pool, column.energy, &velocities, &column.momentum)?);
        by_coordinates.push(column);
    }
    let in_rows_of = |expr: &Expr| Row::new(pool, fields, *expr, points.len());
    let increments: Vec<Row> = momentum_increment.iter().chain([&energy_increment]).map(in_rows_of).collect();
    let mut gain = |pool: &mut Pool<Symbol>, by: Symbol| by_unknown(pool, fields, &arguments, &increments, &by);
    let gain_by_coordinates =
        (0..dimension).map(|j| gain(pool, Symbol::Q0(j))).collect::<Result<Vec<DerivativeColumn>, _>>()?;
    let gain_by_velocities =
        (0..dimension).map(|j| gain(pool, Symbol::StepVelocity(j))).collect::<Result<Vec<DerivativeColumn>, _>>()?;
    let gain_by_step = gain(pool, Symbol::Step)?;

    Ok(Equations {
        points,
        residual,
        residual_dv: in_rows(&by_velocities),
        residual_dh: by_step.momentum,
        energy_residual,
        energy_dv,
        energy_dh,
        momentum_increment,
        energy_increment,
        discrete_energy,
        residual_dq: in_rows(&by_coordinates),
        energy_dq,
        momentum_increment_dq: in_rows(&gain_by_coordinates),
        momentum_increment_dv: in_rows(&gain_by_velocities),
        momentum_increment_dh: gain_by_step.momentum,
        energy_increment_dq: gain_by_coordinates.iter().map(|column| column.energy).collect(),
        energy_increment_dv: gain_by_velocities.iter().map(|column| column.energy).collect(),
        energy_increment_dh: gain_by_step.energy,
    })
}

/// Transposes the momentum part of the columns of a matrix.
fn in_rows(columns: &[DerivativeColumn]) -> Vec<Vec<Expr>> {
    (0..columns.len()).map(|row| columns.iter().map(|column| column.momentum[row]).collect()).collect()
}

/// A carried quantity: the number plus its low part.
fn carried(pool: &mut Pool<Symbol>, symbol: Symbol) -> Expr {
    let low = pool.symbol(Symbol::Low(Box::new(symbol.clone())));
    let high = pool.symbol(symbol);
    pool.add(high, low)
}

fn negative_sum(pool: &mut Pool<Symbol>, terms: &[Expr]) -> Result<Expr, TooLarge> {
    let sum = pool.sum(terms);
    let negative = pool.neg(sum);
    pool.expand(negative)
}

/// A point of the rule in the node and the unknowns.
fn at_node(pool: &mut Pool<Symbol>, point: &Point) -> Point {
    let mut place = |expr: Expr| {
        pool.substitute(expr, &mut |pool, symbol| {
            let step = pool.symbol(Symbol::Step);
            match symbol {
                Symbol::T0 | Symbol::Q0(_) => Some(carried(pool, symbol.clone())),
                Symbol::T1 => {
                    let start = carried(pool, Symbol::T0);
                    Some(pool.add(start, step))
                }
                Symbol::Q1(index) => {
                    let start = carried(pool, Symbol::Q0(*index));
                    let velocity = pool.symbol(Symbol::StepVelocity(*index));
                    let displacement = pool.mul(step, velocity);
                    Some(pool.add(start, displacement))
                }
                _ => None,
            }
        })
    };
    let time = place(point.time);
    let coordinates = point.coordinates.iter().map(|e| place(*e)).collect();
    let velocities: Vec<Expr> = point.velocities.iter().map(|e| place(*e)).collect();
    // Expansion reduces (q0 + h v − q0)/h to v.
    let velocities = velocities.into_iter().map(|e| pool.expand(e).unwrap_or(e)).collect();
    Point { time, coordinates, velocities }
}

/// p1 − p0, expanded.
fn momentum_increment(pool: &mut Pool<Symbol>, slots: &SlotDerivatives) -> Result<Vec<Expr>, TooLarge> {
    let gain = |i: usize| [slots.d2_ld[i], slots.d4_ld[i], slots.forces.fd_minus[i], slots.forces.fd_plus[i]];
    (0..slots.d2_ld.len())
        .map(|i| {
            let sum = pool.sum(&gain(i));
            pool.expand(sum)
        })
        .collect()
}

/// Derivatives of the momentum rows and of one energy row with respect to one variable.
struct DerivativeColumn {
    momentum: Vec<Expr>,
    energy: Expr,
}

/// An equation with the variables that it contains. In a long chain most equations contain few unknowns.
struct Row {
    expr: Expr,
    symbols: BTreeSet<Symbol>,
    /// Variables of the fields at each point.
    read: Vec<Variables>,
}

impl Row {
    fn new(pool: &Pool<Symbol>, fields: &Fields, expr: Expr, points: usize) -> Self {
        let symbols = pool.symbols(expr);
        let read = fields.read(&symbols, points);
        Self { expr, symbols, read }
    }

    /// Whether the equation depends on an unknown that changes the arguments by `changes`.
    fn varies(&self, unknown: &Symbol, changes: &Changes) -> bool {
        let reads = |(changes, read): (&Vec<(Variable, Expr)>, &Variables)| {
            changes.iter().any(|(variable, _)| read.contains(variable))
        };
        self.symbols.contains(unknown) || changes.iter().zip(&self.read).any(reads)
    }
}

/// The derivatives of the momentum rows and then of the energy row.
fn by_unknown(
    pool: &mut Pool<Symbol>,
    fields: &mut Fields,
    arguments: &[Arguments],
    rows: &[Row],
    unknown: &Symbol,
) -> Result<DerivativeColumn, TooLarge> {
    bounded(pool)?;
    let direct = |pool: &mut Pool<Symbol>, symbol: &Symbol| {
        if symbol == unknown { pool.one() } else { pool.zero() }
    };
    let changes = changes(pool, arguments, &direct);
    let mut momentum = Vec::with_capacity(rows.len());
    for row in rows {
        let varies = row.varies(unknown, &changes);
        let slope = if varies { fields.derivative(pool, row.expr, &direct, &changes) } else { pool.zero() };
        momentum.push(pool.expand(slope)?);
    }
    let energy = momentum.pop().unwrap_or(pool.zero());
    Ok(DerivativeColumn { momentum, energy })
}

/// `row − v·column`, expanded.
fn combined(pool: &mut Pool<Symbol>, row: Expr, velocities: &[Expr], column: &[Expr]) -> Result<Expr, TooLarge> {
    let mut terms = vec![row];
    let zero = pool.zero();
    for (velocity, entry) in velocities.iter().zip(column).filter(|(_, entry)| **entry != zero) {
        let product = pool.mul(*velocity, *entry);
        terms.push(pool.neg(product));
    }
    let sum = pool.sum(&terms);
    pool.expand(sum)
}

/// `(row − v·column)/h`, expanded.
fn over_step(pool: &mut Pool<Symbol>, row: Expr, velocities: &[Expr], column: &[Expr]) -> Result<Expr, TooLarge> {
    let row = combined(pool, row, velocities, column)?;
    let step = pool.symbol(Symbol::Step);
    let inverse = pool.power(step, &Rational::from_integer((-1).into()));
    let scaled = pool.mul(row, inverse);
    pool.expand(scaled)
}
