//! A system with constraints as an ordinary differential equation.

use super::{accelerations, bordered, constrained_flow};
use crate::error::StepError;
use crate::forward;
use crate::kind::Kind;
use crate::lagrangian::{Flow, Lagrangian};
use crate::motion::Motion;
use crate::real::Real;
use nalgebra::SVector;

/// A system whose acceleration is extended to any (t, q, v), also off its constraints: its motions keep the
/// rates `A v + a`, whatever they are. On the constraints it is that of the system, which refuses other
/// points.
///
/// Solvers of ordinary differential equations need it, because their stages leave the constraints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extended<S>(pub S);

impl<const N: usize, T: Real, S: Motion<N, T>> Lagrangian<N, T> for Extended<S> {
    forward! { [N T S] self => &self.0; [#[inline]] lagrangian_facts lagrangian }

    fn acceleration(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<SVector<T, N>, StepError> {
        if const { S::Kind::COUNT == 0 } {
            return self.0.acceleration(t, q, v);
        }
        accelerations(&self.0, (t, q, v), &mut bordered(&self.0)).map(|(acceleration, _)| acceleration)
    }

    fn flow(&self, t: T, q: &SVector<T, N>, p: &SVector<T, N>) -> Result<Flow<N, T>, StepError> {
        if const { S::Kind::COUNT == 0 } { self.0.flow(t, q, p) } else { constrained_flow(&self.0, t, q, p) }
    }
}
