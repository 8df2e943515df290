//! A system with constraints as an ordinary differential equation.

use super::{Constrained, accelerations, bordered, constrained_flow};
use crate::error::StepError;
use crate::forward;
use crate::lagrangian::{Flow, Lagrangian};
use crate::real::Real;
use nalgebra::SVector;

/// A system with constraints whose acceleration is extended to any (t, q, v): its motions keep the
/// rates `A v + a`, whatever they are. On the constraints it is that of the system, which refuses other
/// points.
///
/// Solvers of ordinary differential equations need it, because their stages leave the constraints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extended<S>(pub S);

impl<const N: usize, T: Real, S: Constrained<N, T>> Lagrangian<N, T> for Extended<S> {
    forward! { [N T S] self => &self.0; [] lagrangian_constants non_finite undefined }
    forward! { [N T S] self => &self.0; [#[inline]] lagrangian energy momentum force }

    fn acceleration(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<SVector<T, N>, StepError> {
        accelerations(&self.0, (t, q, v), &mut bordered::<S, N, T>()).map(|(acceleration, _)| acceleration)
    }

    fn flow(&self, t: T, q: &SVector<T, N>, p: &SVector<T, N>) -> Result<Flow<N, T>, StepError> {
        constrained_flow(&self.0, t, q, p)
    }
}
