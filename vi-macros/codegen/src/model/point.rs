//! Evaluation points of a rule.

use crate::symbol::Variable;
use vi_expr::Expr;

/// The arguments of L and f at a point of a rule, in its slots.
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
    /// The arguments of L and f: time, coordinates, velocities.
    pub fn arguments(&self) -> impl Iterator<Item = (Variable, Expr)> + '_ {
        let coordinates = self.coordinates.iter().enumerate().map(|(i, e)| (Variable::Coordinate(i), *e));
        let velocities = self.velocities.iter().enumerate().map(|(i, e)| (Variable::Velocity(i), *e));
        [(Variable::Time, self.time)].into_iter().chain(coordinates).chain(velocities)
    }
}
