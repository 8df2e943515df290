//! The forced discrete system, from a checked model and its rule.
//!
//! In: a [`Model`]. Out: a [`DiscreteSystem`]. The rule is differentiated with L and f closed:
//! their partial derivatives at the points of the rule are symbols, [`Field`]s. So the leading
//! terms of the equations cancel exactly, whatever L is, and L itself is differentiated once, in `(t, q, v)`.
//! AFTER THIS every expression is one in fields, slots, the unknowns `(v, h)` and parameters.

mod continuous;
mod fields;
mod midpoint;
mod rule;
mod slots;
mod step;
pub mod system;
mod trapezoidal;

pub use continuous::Continuous;
pub use fields::Fields;
pub use slots::Slots;
pub use step::Equations;

use crate::model::Model;
use crate::symbol::{Field, Symbol, Variable};
use crate::syntax::{Rule, parse};
use vi_expr::{Expr, Pool, TooLarge};

/// Distinct terms that the expressions of one system may have together, those of all stages.
pub(crate) const NODES: usize = 75_000;

/// Steps of algebra that one system may take, those of all stages: half a second, and 3 s in a build without optimisation.
pub(crate) const WORK: usize = 40_000_000;

/// Whether a system is still within its size.
pub(crate) fn bounded(pool: &Pool<Symbol>) -> Result<(), TooLarge> {
    pool.within_work()?;
    if pool.len() > NODES { Err(TooLarge::Terms { limit: NODES }) } else { Ok(()) }
}

/// The rules that have a name.
pub(crate) const RULES: [&str; 2] = ["midpoint", "trapezoidal"];

/// A rule by its name.
pub(crate) fn named_rule(name: &str) -> Option<syn::Result<Rule>> {
    match name {
        "midpoint" => Some(parse::rule(midpoint::RULE)),
        "trapezoidal" => Some(parse::rule(trapezoidal::RULE)),
        _ => None,
    }
}

/// A discretized system.
pub struct DiscreteSystem {
    /// The named rule that the system's rule is, written out or not.
    pub rule: Option<&'static str>,
    /// The continuous functions: momentum, mass matrix, …
    pub continuous: Continuous,
    /// Partial derivatives of L and f, as far as they were asked for.
    pub fields: Fields,
    /// L_d, its slot derivatives, discrete forces and powers.
    pub slots: Slots,
    /// The equations of a step in the unknowns `(v, h)`.
    pub equations: Equations,
}

impl DiscreteSystem {
    /// Whether the step density of the rule keeps its sign along a motion. That of the trapezoidal rule, `|V_q|² − 2 v·V_qq v`, changes
    /// it in every swing of an oscillator.
    pub fn has_energy_steps(&self) -> bool {
        self.rule != Some("trapezoidal")
    }

    /// A symbol as the user wrote it, and where it is evaluated: `L_v_x`, `x_mid`; `L_v_x_at2` where the rule has
    /// several points.
    #[must_use]
    pub fn spell(&self, model: &Model, symbol: &Symbol) -> String {
        let at = |point: usize| if self.slots.points.len() == 1 { String::new() } else { format!("_at{}", point + 1) };
        match symbol {
            Symbol::Field(Field { point, .. }) => model.spell(symbol) + &at(*point),
            Symbol::AtPoint(point, variable) => {
                let place = if self.slots.points.len() == 1 { "_mid".to_owned() } else { at(*point) };
                match variable {
                    Variable::Velocity(index) => format!("{}_dot{place}", model.coordinates[*index].text()),
                    _ => model.spell(&Symbol::Continuous(*variable)) + &place,
                }
            }
            _ => model.spell(symbol),
        }
    }
}

/// Where a rule evaluates L and f.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Point {
    /// Time.
    pub time: Expr,
    /// Coordinates.
    pub coordinates: Vec<Expr>,
    /// Velocities.
    pub velocities: Vec<Expr>,
}

impl Point {
    /// The arguments of L and f there: the time, the coordinates, the velocities.
    pub(crate) fn arguments(&self) -> impl Iterator<Item = (Variable, Expr)> + '_ {
        let coordinates = self.coordinates.iter().enumerate().map(|(i, e)| (Variable::Coordinate(i), *e));
        let velocities = self.velocities.iter().enumerate().map(|(i, e)| (Variable::Velocity(i), *e));
        [(Variable::Time, self.time)].into_iter().chain(coordinates).chain(velocities)
    }
}
