//! Discrete forces and powers: the virtual work of f over an interval.
//!
//! In: a [`Rule`]. Out: f_d^± and g_d^±, as written or derived. L_d evaluates L at its points with the weights
//! w_k = ∂L_d/∂L_k. The work of f uses the same points and weights. With coordinates Q_k, velocities V_k and time τ_k
//! of point k,
//!
//! ```text
//! W = Σ_k w_k f_k·(δQ_k − V_k δτ_k)
//! f_d⁻ = ∂W/∂δq0    f_d⁺ = ∂W/∂δq1    g_d⁻ = ∂W/∂δt0    g_d⁺ = ∂W/∂δt1
//! ```

use super::fields::{Arguments, changes};
use super::interval::by_slot;
use crate::limits::bounded;
use crate::model::{DiscreteForces, Model, Rule};
use crate::symbol::{Field, Quantity, Symbol, Variable};
use vi_expr::{Expr, Pool, TooLarge};

/// The discrete forces of a rule; zero for a system without forces.
pub(super) fn discrete_forces(pool: &mut Pool<Symbol>, model: &Model, rule: &Rule) -> Result<DiscreteForces, TooLarge> {
    let dimension = model.dimension();
    if let Some(written) = &rule.forces {
        return Ok(written.clone());
    }
    if !model.forced {
        let zero = pool.zero();
        let zeros = vec![zero; dimension];
        return Ok(DiscreteForces { fd_minus: zeros.clone(), fd_plus: zeros, gd_minus: zero, gd_plus: zero });
    }
    let work = Work::of(pool, rule, dimension);
    let fd_minus = (0..dimension).map(|i| work.by(pool, &Symbol::Q0(i))).collect::<Result<_, _>>()?;
    let fd_plus = (0..dimension).map(|i| work.by(pool, &Symbol::Q1(i))).collect::<Result<_, _>>()?;
    let gd_minus = work.by(pool, &Symbol::T0)?;
    let gd_plus = work.by(pool, &Symbol::T1)?;
    Ok(DiscreteForces { fd_minus, fd_plus, gd_minus, gd_plus })
}

/// The virtual work W, point by point.
struct Work {
    arguments: Vec<Arguments>,
    /// w_k f_k per point and coordinate.
    forces: Vec<Vec<Expr>>,
    /// −w_k f_k·V_k per point.
    powers: Vec<Expr>,
}

impl Work {
    fn of(pool: &mut Pool<Symbol>, rule: &Rule, dimension: usize) -> Self {
        let mut forces = Vec::with_capacity(rule.points.len());
        let mut powers = Vec::with_capacity(rule.points.len());
        for (index, point) in rule.points.iter().enumerate() {
            let field = |quantity| Symbol::Field(Field { quantity, derivatives: Vec::new(), point: index });
            let lagrangian = field(Quantity::Lagrangian);
            let weight = pool.partial_derivative(rule.ld, &lagrangian);
            let weighted = (0..dimension).map(|i| {
                let force = pool.symbol(field(Quantity::Force(i)));
                pool.mul(weight, force)
            });
            let weighted: Vec<Expr> = weighted.collect();
            let products = weighted.iter().zip(&point.velocities).map(|(force, velocity)| pool.mul(*force, *velocity));
            let products: Vec<Expr> = products.collect();
            let power = pool.sum(&products);
            powers.push(pool.neg(power));
            forces.push(weighted);
        }
        Self { arguments: Arguments::of(pool, &rule.points), forces, powers }
    }

    /// ∂W/∂δ for one slot.
    fn by(&self, pool: &mut Pool<Symbol>, slot: &Symbol) -> Result<Expr, TooLarge> {
        bounded(pool)?;
        let changes = changes(pool, &self.arguments, &|pool, symbol| by_slot(pool, symbol, slot));
        let mut terms = Vec::new();
        for (point, changes) in changes.into_iter().enumerate() {
            for (variable, change) in changes {
                match variable {
                    Variable::Coordinate(i) => terms.push(pool.mul(self.forces[point][i], change)),
                    Variable::Time => terms.push(pool.mul(self.powers[point], change)),
                    Variable::Velocity(_) => {}
                }
            }
        }
        Ok(pool.sum(&terms))
    }
}
