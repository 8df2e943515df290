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
//! coordinate, whatever the force is, and nothing for h.

use super::Function;
use super::assemble::{Assembled, Assembly, Expressions};
use crate::discrete::Equations;
use crate::symbol::{Symbol, Variable};
use vi_expr::{Expr, Pool, TooLarge};

/// Operations of the momentum equation up to which steps are told the place of L: in longer ones, which are loops, to read it
/// costs more than to find it.
pub(super) const TOLD: usize = 1000;

/// Operations up to which gains are carried by slopes that are no diagonal matrix: it takes longer to compile.
const CARRIED: usize = 1000;

/// Coordinates up to which such slopes are looked at.
const SHORT: usize = 32;

/// Coordinates up to which the quotient of a momentum step is foretold: that step does not make r zero to all digits, so that r
/// cannot stand for what it changes.
const FORETOLD: usize = 2;

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
    let mut of_momentum = vec![Carrying::new(pool, 0, by_v(&by_gains), dimension)];
    if dimension > FORETOLD {
        of_momentum.push(Carrying::new(pool, 2, by_v(&by_kicks), dimension));
    }
    // The energy has slopes of its own, or gains nothing.
    let zero = pool.zero();
    let nothing = (gains[1] == [zero]).then(|| vec![zero; dimension + 1]);
    let of_energy = by_gains.last().cloned().or(nothing);
    let by_both = of_energy.map_or_else(Vec::new, |row| by_kicks.into_iter().chain([row]).collect());
    let of_both = vec![Carrying::new(pool, 0, by_gains, dimension), Carrying::new(pool, 2, by_both, dimension)];

    let steps = [
        ("momentum_step", momentum, &gains[..1], of_momentum, evaluated[0]),
        ("extended_step", extended, gains, of_both, evaluated[1]),
    ];
    let mut functions = Vec::with_capacity(steps.len());
    for (name, equations, gains, ways, evaluated) in steps {
        match cheapest(assembly, name, (&equations, gains), &ways, evaluated)? {
            Some(step) => functions.push(step),
            None if place.is_some() => functions.push(assembly.function(name, &equations)?),
            None => {}
        }
    }
    Ok(functions)
}

/// The step with the gains carried in the cheapest way, where that costs no more than `evaluated`.
fn cheapest(
    assembly: &mut Assembly,
    name: &'static str,
    (equations, gains): (&[Vec<Expr>], &[Vec<Expr>]),
    ways: &[Carrying],
    evaluated: usize,
) -> core::result::Result<Option<(Function, Expressions)>, TooLarge> {
    let (mut least, mut cheapest) = (evaluated, None);
    for way in ways.iter().filter(|way| way.is_looked_at()) {
        let groups: Vec<_> =
            equations.iter().chain(gains).chain([&way.residuals]).chain(&way.slopes).cloned().collect();
        let step = assembly.function(name, &groups)?;
        let cost = step.0.cost() + way.products;
        if cost <= least && (step.0.operation_count() <= CARRIED || way.is_diagonal) {
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
    dimension: usize,
}

impl Carrying {
    fn new(pool: &mut Pool<Symbol>, residuals: i64, slopes: Vec<Vec<Expr>>, dimension: usize) -> Self {
        let zero = pool.zero();
        let filled = slopes.iter().flatten().filter(|slope| **slope != zero).count();
        let products = 2 * filled + if residuals == 0 { 0 } else { 2 * dimension };
        let is_diagonal = filled <= dimension;
        Self { residuals: vec![pool.integer(residuals)], slopes, products, is_diagonal, dimension }
    }

    /// Whether the slopes are there, and not too many to be looked at.
    fn is_looked_at(&self) -> bool {
        !self.slopes.is_empty() && (self.dimension <= SHORT || self.is_diagonal)
    }
}
