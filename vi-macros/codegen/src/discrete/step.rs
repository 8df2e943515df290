//! The equations of one step, in the unknowns (v, h).
//!
//! In: the slot derivatives. Out, with `q1 = q0 + h v`, `t1 = t0 + h` and the low parts of what is carried:
//!
//! ```text
//! r = −D2 L_d − f_d⁻ − p0            momentum row
//! e =  D1 L_d + g_d⁻ − E0            energy row
//! c =  e − v·r                       combined row; its terms of order one have cancelled
//! A = ∂r/∂v    ∂r/∂h    (∂e/∂v − v·A)/h    (∂e/∂h − v·∂r/∂h)/h
//! p1 − p0 = D2 L_d + D4 L_d + f_d⁻ + f_d⁺      E1 − E0 = −D1 L_d − D3 L_d − g_d⁻ − g_d⁺      and their derivatives
//! ∂(p1 − p0 + 2 r)/∂v                another way to the derivative of p1 − p0 where r becomes zero
//! ```

use super::fields::{Arguments, Changes, Variables, changes};
use super::{Fields, Point, Slots, bounded};
use crate::symbol::{Symbol, Variable};
use std::collections::BTreeSet;
use vi_expr::{Expr, Pool, Rational, TooLarge};

/// The equations of one step.
pub struct Equations {
    /// Where L and f are evaluated, in the node and the unknowns.
    pub points: Vec<Point>,
    /// The one point that moves with v, where there is one: its number, and c where its coordinates are q0 + c h v.
    pub place: Option<(usize, Rational)>,
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
    /// The derivatives of p1 − p0 and, last, of E1 − E0: entry (i, j) by v_j, and by h where j is N. None for systems so large
    /// that no function would use them.
    pub increment_slopes: Vec<Vec<Expr>>,
    /// The derivatives of p1 − p0 + 2 r, which for the midpoint rule is 2 (L_v − p0) and knows no force: entry (i, j) by v_j. A
    /// Newton step in v makes r zero: it changes p1 − p0 by these times the step, and by 2 r. None for systems so small that it does not.
    pub kick_slopes: Vec<Vec<Expr>>,
}

/// Coordinates up to which the quotient of a momentum step is foretold: that step does not make r zero to all digits, so that r
/// cannot stand for what it changes, and kicks are of no use.
const FORETOLD_COORDINATES: usize = 2;

/// Coordinates up to which the derivatives of the increments may be used.
const CARRIED_COORDINATES: usize = 32;

/// Derives the equations of a step.
pub(super) fn equations(pool: &mut Pool<Symbol>, fields: &mut Fields, slots: &Slots) -> Result<Equations, TooLarge> {
    let dimension = slots.d2_ld.len();
    let points: Vec<Point> = slots.points.iter().map(|point| at_node(pool, point)).collect();
    let velocities: Vec<Expr> = (0..dimension).map(|i| pool.symbol(Symbol::StepVelocity(i))).collect();
    let mut residual = Vec::with_capacity(dimension);
    for i in 0..dimension {
        let start = carried(pool, Symbol::P0(i));
        let terms = [slots.d2_ld[i], slots.fd_minus[i], start];
        residual.push(negative_sum(pool, &terms)?);
    }
    let start = carried(pool, Symbol::E0);
    let power = pool.add(slots.d1_ld, slots.gd_minus);
    let energy = pool.sub(power, start);
    let energy_residual = combined(pool, energy, &velocities, &residual)?;

    let momentum_increment = momentum_increment(pool, slots)?;
    let energy_increment = negative_sum(pool, &[slots.d1_ld, slots.d3_ld, slots.gd_minus, slots.gd_plus])?;

    let kicked = if dimension > FORETOLD_COORDINATES { dimension } else { 0 };
    let kicks = kicks(pool, &momentum_increment[..kicked], &residual)?;

    let (equations, increments) =
        (residual.iter().chain([&energy]), momentum_increment.iter().chain([&energy_increment]));
    let carried = if dimension <= CARRIED_COORDINATES { dimension + 1 } else { 0 };
    let rows = equations.chain(increments.take(carried)).chain(&kicks);
    let rows = rows.map(|row| Row::new(pool, fields, *row, points.len())).collect::<Vec<_>>();
    let arguments = Arguments::of(pool, &points);
    let mut residual_dv = vec![Vec::with_capacity(dimension); dimension];
    let mut increment_slopes = vec![Vec::with_capacity(dimension + 1); carried];
    let mut kick_slopes = vec![Vec::with_capacity(dimension); kicked];
    let mut energy_dv = Vec::with_capacity(dimension);
    for j in 0..dimension {
        let column = by_unknown(pool, fields, &arguments, (&rows, [dimension, carried]), &Symbol::StepVelocity(j))?;
        energy_dv.push(over_step(pool, column.energy, &velocities, &column.residual)?);
        residual_dv.iter_mut().zip(column.residual).for_each(|(row, entry)| row.push(entry));
        increment_slopes.iter_mut().zip(column.increments).for_each(|(row, entry)| row.push(entry));
        kick_slopes.iter_mut().zip(column.kicks).for_each(|(row, entry)| row.push(entry));
    }
    let rows = &rows[..rows.len() - kicked];
    let column = by_unknown(pool, fields, &arguments, (rows, [dimension, carried]), &Symbol::Step)?;
    let energy_dh = over_step(pool, column.energy, &velocities, &column.residual)?;
    increment_slopes.iter_mut().zip(column.increments).for_each(|(row, entry)| row.push(entry));

    Ok(Equations {
        place: place(pool, &points),
        points,
        residual,
        residual_dv,
        residual_dh: column.residual,
        energy_residual,
        energy_dv,
        energy_dh,
        momentum_increment,
        energy_increment,
        increment_slopes,
        kick_slopes,
    })
}

/// A carried quantity: the number and its low part.
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
                    let way = pool.mul(step, velocity);
                    Some(pool.add(start, way))
                }
                _ => None,
            }
        })
    };
    let time = place(point.time);
    let coordinates = point.coordinates.iter().map(|e| place(*e)).collect();
    let velocities: Vec<Expr> = point.velocities.iter().map(|e| place(*e)).collect();
    // (q0 + h v − q0)/h is v once multiplied out.
    let velocities = velocities.into_iter().map(|e| pool.expand(e).unwrap_or(e)).collect();
    Point { time, coordinates, velocities }
}

/// The point whose coordinates move with v, where there is only one and it lies on the way to the end.
fn place(pool: &mut Pool<Symbol>, points: &[Point]) -> Option<(usize, Rational)> {
    let moves = |pool: &Pool<Symbol>, expr: Expr| {
        pool.symbols(expr).iter().any(|symbol| matches!(symbol, Symbol::Step | Symbol::StepVelocity(_)))
    };
    let mut moving = (0..points.len()).filter(|k| points[*k].coordinates.iter().any(|e| moves(pool, *e)));
    let point = moving.next().filter(|_| moving.next().is_none())?;
    let parts = [(1, 2), (1, 1)].map(|(over, under)| Rational::new(over.into(), under.into()));
    parts.into_iter().find(|part| lies_at(pool, &points[point], part)).map(|part| (point, part))
}

/// Whether the coordinates of a point are q0 + c h v.
fn lies_at(pool: &mut Pool<Symbol>, point: &Point, part: &Rational) -> bool {
    let (step, zero) = (pool.symbol(Symbol::Step), pool.zero());
    let factor = pool.number(part.clone());
    point.coordinates.iter().enumerate().all(|(i, coordinate)| {
        let (start, velocity) = (carried(pool, Symbol::Q0(i)), pool.symbol(Symbol::StepVelocity(i)));
        let way = pool.product(&[factor, step, velocity]);
        let there = pool.add(start, way);
        let difference = pool.sub(*coordinate, there);
        pool.expand(difference).is_ok_and(|difference| difference == zero)
    })
}

/// p1 − p0, multiplied out.
fn momentum_increment(pool: &mut Pool<Symbol>, slots: &Slots) -> Result<Vec<Expr>, TooLarge> {
    let gain = |i: usize| [slots.d2_ld[i], slots.d4_ld[i], slots.fd_minus[i], slots.fd_plus[i]];
    (0..slots.d2_ld.len())
        .map(|i| {
            let sum = pool.sum(&gain(i));
            pool.expand(sum)
        })
        .collect()
}

/// `p1 − p0 + 2 r`, multiplied out.
fn kicks(pool: &mut Pool<Symbol>, increments: &[Expr], residuals: &[Expr]) -> Result<Vec<Expr>, TooLarge> {
    let two = pool.integer(2);
    let rows = increments.iter().zip(residuals);
    rows.map(|(increment, residual)| {
        let twice = pool.mul(two, *residual);
        let kick = pool.add(*increment, twice);
        pool.expand(kick)
    })
    .collect()
}

/// The derivatives of all rows by one unknown: those of momentum, that of energy, the increments of both, the kicks.
struct Column {
    residual: Vec<Expr>,
    energy: Expr,
    increments: Vec<Expr>,
    kicks: Vec<Expr>,
}

/// An equation, and what it knows: most of those of a long chain do not know most unknowns.
struct Row {
    expr: Expr,
    symbols: BTreeSet<Symbol>,
    /// Of the arguments of each point.
    read: Vec<Variables>,
}

impl Row {
    fn new(pool: &Pool<Symbol>, fields: &Fields, expr: Expr, points: usize) -> Self {
        let symbols = pool.symbols(expr);
        let read = fields.read(&symbols, points);
        Self { expr, symbols, read }
    }

    /// Whether it changes with an unknown, by which the arguments change so.
    fn varies(&self, unknown: &Symbol, changes: &Changes) -> bool {
        let reads = |(changes, read): (&Vec<(Variable, Expr)>, &Variables)| {
            changes.iter().any(|(variable, _)| read.contains(variable))
        };
        self.symbols.contains(unknown) || changes.iter().zip(&self.read).any(reads)
    }
}

fn by_unknown(
    pool: &mut Pool<Symbol>,
    fields: &mut Fields,
    arguments: &[Arguments],
    (rows, [dimension, carried]): (&[Row], [usize; 2]),
    unknown: &Symbol,
) -> Result<Column, TooLarge> {
    bounded(pool)?;
    let direct = |pool: &mut Pool<Symbol>, symbol: &Symbol| {
        if symbol == unknown { pool.one() } else { pool.zero() }
    };
    let changes = changes(pool, arguments, &direct);
    let mut column = Vec::with_capacity(rows.len());
    for row in rows {
        let varies = row.varies(unknown, &changes);
        let slope = if varies { fields.derivative(pool, row.expr, &direct, &changes) } else { pool.zero() };
        column.push(pool.expand(slope)?);
    }
    let mut energy = column.split_off(dimension);
    let mut increments = energy.split_off(1);
    let kicks = increments.split_off(carried);
    Ok(Column { residual: column, energy: energy.pop().unwrap_or(pool.zero()), increments, kicks })
}

/// `row − v·column`, multiplied out.
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

/// `(row − v·column)/h`, multiplied out.
fn over_step(pool: &mut Pool<Symbol>, row: Expr, velocities: &[Expr], column: &[Expr]) -> Result<Expr, TooLarge> {
    let row = combined(pool, row, velocities, column)?;
    let step = pool.symbol(Symbol::Step);
    let inverse = pool.power(step, &Rational::from_integer((-1).into()));
    let scaled = pool.mul(row, inverse);
    pool.expand(scaled)
}
