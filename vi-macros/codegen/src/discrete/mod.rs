//! The forced discrete system of a checked model.
//!
//! In: a [`Model`] with its rule. Out: a [`DiscreteSystem`]. Differentiating the rule treats L and f as opaque: their
//! partial derivatives at the points of the rule are symbols, [`Field`]s. So the leading terms of the equations cancel
//! exactly for every L, and L is differentiated once, in `(t, q, v)`.
//! The expressions of the result contain only fields, slots, the unknowns `(v, h)` and parameters.

mod constraints;
pub mod continuous;
mod fields;
mod forces;
mod interval;
mod slots;
mod step;
pub mod system;

pub use constraints::Constraints;
use continuous::{Continuous, PointDerivatives};
pub use fields::Fields;
pub use slots::SlotDerivatives;
pub use step::Equations;

use crate::model::Model;
use crate::rules::NamedRule;
use crate::symbol::{Field, Symbol, Variable};

/// The motion of a system, and its steps if it has a rule.
pub struct DiscreteSystem {
    /// The continuous functions: momentum, mass matrix, …
    pub continuous: Continuous,
    /// Derivatives of the continuous equations with respect to coordinates and velocities.
    pub point_derivatives: PointDerivatives,
    /// The functions of the constraints, if there are any.
    pub constraints: Option<Constraints>,
    /// Partial derivatives of L and f computed so far.
    pub fields: Fields,
    /// The discretization by the rule; `None` for a system with Gauss steps only.
    pub by_rule: Option<ByRule>,
}

/// A system discretized by a rule.
pub struct ByRule {
    /// The built-in rule that equals the system's rule, whether named or written out.
    pub rule: Option<&'static NamedRule>,
    /// L_d, its slot derivatives, discrete forces and powers.
    pub slots: SlotDerivatives,
    /// The equations of a step in the unknowns `(v, h)`.
    pub equations: Equations,
}

impl ByRule {
    /// Whether energy-preserving steps exist: the rule has a step density, or is not built in.
    #[must_use]
    pub fn has_energy_steps(&self) -> bool {
        self.rule.is_none_or(|rule| rule.step_density)
    }
}

impl DiscreteSystem {
    /// The number of points at which the rule evaluates L and f; 1 without a rule.
    #[must_use]
    pub fn points(&self) -> usize {
        self.by_rule.as_ref().map_or(1, |of| of.slots.points.len())
    }

    /// Whether energy-preserving steps of order 2 exist.
    #[must_use]
    pub fn has_energy_steps(&self) -> bool {
        self.by_rule.as_ref().is_some_and(ByRule::has_energy_steps)
    }

    /// A symbol in the user's names with its point: `L_v_x`, `x_mid`; `L_v_x_at2` for a rule with several points.
    #[must_use]
    pub fn spell(&self, model: &Model, symbol: &Symbol) -> String {
        let at = |point: usize| if self.points() == 1 { String::new() } else { format!("_at{}", point + 1) };
        match symbol {
            Symbol::Field(Field { point, .. }) => model.spell(symbol) + &at(*point),
            Symbol::AtPoint(point, variable) => {
                let place = if self.points() == 1 { "_mid".to_owned() } else { at(*point) };
                match variable {
                    Variable::Velocity(index) => format!("{}_dot{place}", model.coordinates[*index].text()),
                    _ => model.spell(&Symbol::Continuous(*variable)) + &place,
                }
            }
            _ => model.spell(symbol),
        }
    }
}
