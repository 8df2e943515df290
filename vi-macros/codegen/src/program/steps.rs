//! The Newton steps, with what momentum and energy gain over the step that they give.
//!
//! In: the equations and the gains, opened. Out: `momentum_step` and `extended_step`, where they pay: the equations at a trial,
//! and the gains at its end, carried there by the cheaper of two ways, or left to be evaluated there.
//!
//! ```text
//! by the slopes of a gain      gain + ∂gain·δ
//! by the slopes of a kick      gain + ∂(gain + 2 r)·δ + 2 r,   since the Newton step makes r zero
//! ```
//!
//! For the midpoint rule gain + 2 r is 2 (L_v − p0): where the mass is constant the second way takes two products for each
//! coordinate, whatever the force is. It serves `momentum_step` only: in both unknowns what either way leaves out adds up, and
//! Kepler's problem, whose gains are evaluated else, drifts by 1e-12 of angular momentum in a million steps instead of 1e-14.

use super::Function;
use super::assemble::{Assembled, Assembly, Expressions};
use crate::discrete::Equations;
use crate::symbol::{Symbol, Variable};
use vi_expr::{Expr, Pool, TooLarge};

/// Operations of a short function. Long steps are not told the place of L: they are loops, in which to read it costs more than to
/// find it. And they carry gains by a diagonal matrix only: any other takes longer to compile, and gains nothing.
pub(super) const SHORT: usize = 1000;

/// Both steps, which cost less than `evaluated`: the equations, and the gains evaluated for themselves. Short ones are told the
/// place of L, where there is one.
pub(super) fn steps(
    assembly: &mut Assembly,
    of: &Equations,
    [momentum, extended]: [Vec<Vec<Expr>>; 2],
    gains: &[Vec<Expr>],
    (short, evaluated): (bool, [usize; 2]),
) -> Assembled {
    let dimension = of.residual.len();
    let [by_gains, by_kicks] = [&of.increment_slopes, &of.kick_slopes]
        .map(|slopes| slopes.iter().map(|row| assembly.open_all(row)).collect::<Vec<_>>());
    let place = of.place.as_ref().filter(|_| short);
    if let Some((place, _)) = place {
        let told = |point: &usize, variable: &Variable| point == place && matches!(variable, Variable::Coordinate(_));
        assembly.arguments.retain(|(point, variable), _| !told(point, variable));
    }
    let by_v = |rows: &[Vec<Expr>]| rows.iter().take(dimension).map(|row| row[..dimension].to_vec()).collect();
    let pool = &mut *assembly.pool;
    let of_momentum =
        vec![Carrying::new(pool, 0, by_v(&by_gains), dimension), Carrying::new(pool, 2, by_kicks, dimension)];
    let of_both = vec![Carrying::new(pool, 0, by_gains, dimension)];

    let steps = [
        ("momentum_step", momentum, &gains[..1], of_momentum, evaluated[0]),
        ("extended_step", extended, gains, of_both, evaluated[1]),
    ];
    let mut functions = Vec::with_capacity(steps.len());
    for (name, equations, gains, ways, evaluated) in steps {
        let ways = ways.iter().filter(|way| !way.slopes.is_empty() && (short || way.is_diagonal));
        match cheapest(assembly, name, (&equations, gains), ways, evaluated)? {
            Some(step) => functions.push(step),
            None if place.is_some() => functions.push(assembly.function(name, &equations)?),
            None => {}
        }
    }
    Ok(functions)
}

/// The step with the gains carried in the cheapest way, where that costs no more than `evaluated`.
fn cheapest<'a>(
    assembly: &mut Assembly,
    name: &'static str,
    (equations, gains): (&[Vec<Expr>], &[Vec<Expr>]),
    ways: impl Iterator<Item = &'a Carrying>,
    evaluated: usize,
) -> core::result::Result<Option<(Function, Expressions)>, TooLarge> {
    let (mut least, mut cheapest) = (evaluated, None);
    for way in ways {
        let groups: Vec<_> =
            equations.iter().chain(gains).chain([&way.residuals]).chain(&way.slopes).cloned().collect();
        let step = assembly.function(name, &groups)?;
        let cost = step.0.cost() + way.products;
        if cost <= least && (step.0.operation_count() <= SHORT || way.is_diagonal) {
            (least, cheapest) = (cost, Some(step));
        }
    }
    Ok(cheapest)
}

/// A way to carry gains: each changes by its slopes times the Newton step, and by so many residuals.
struct Carrying {
    /// One number.
    residuals: Vec<Expr>,
    /// A row for each gain.
    slopes: Vec<Vec<Expr>>,
    /// What the products cost besides the slopes.
    products: usize,
    /// Whether no more slopes than coordinates are there.
    is_diagonal: bool,
}

impl Carrying {
    fn new(pool: &mut Pool<Symbol>, residuals: i64, slopes: Vec<Vec<Expr>>, dimension: usize) -> Self {
        let zero = pool.zero();
        let filled = slopes.iter().flatten().filter(|slope| **slope != zero).count();
        let products = 2 * filled + if residuals == 0 { 0 } else { 2 * dimension };
        let is_diagonal = filled <= dimension;
        Self { residuals: vec![pool.integer(residuals)], slopes, products, is_diagonal }
    }
}
