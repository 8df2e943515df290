//! A state on the constraints from a far guess, by continuation in their residual.
//!
//! ```text
//! g(t, x) = (1 − τ) g(t, q)        τ from 0, at the guess q, to 1
//! ```
//!
//! Each step of τ moves x to the nearest place with these values. A step that fails is halved; after a success the next
//! one is doubled.

use super::{Constrained, ConvertibleConstrained, Projected, Projection};
use crate::error::StepError;
use crate::linear::Rectangular;
use crate::state::{Numbers, State};
use nalgebra::SVector;

/// The first step of τ, and the shortest.
const FIRST: f64 = 0.125;
const SHORTEST: f64 = 1e-6;
/// Largest number of steps.
const STEPS: u32 = 400;

impl<const N: usize> State<N> {
    /// A state on the constraints from a far guess, for example of a closed loop that is not closed: the nearest state
    /// as by [`State::projected`], otherwise by a continuation in which the residuals of all constraints shrink
    /// together. [`Projection::holding`] holds coordinates.
    ///
    /// A linkage may have several assemblies. The guess chooses one, which is not always the nearest.
    ///
    /// # Errors
    /// [`StepError::NotAssembled`] if the residuals cannot shrink further, with the constraint that is farthest from
    /// being satisfied; [`StepError::Singular`] if the constraints are redundant at the guess, as in a linkage that is
    /// flat; [`StepError::NonFinite`].
    pub fn assembled<S: Constrained<N> + ConvertibleConstrained<N>>(
        system: &S,
        t: f64,
        q: impl Numbers<N>,
        v: impl Numbers<N>,
    ) -> Result<Projected<N>, StepError> {
        Projection::of(system).assembled(t, q, v)
    }
}

impl<S: Constrained<N> + ConvertibleConstrained<N>, const N: usize> Projection<'_, S, N> {
    /// As [`State::assembled`], with the held coordinates.
    ///
    /// # Errors
    /// As [`State::assembled`].
    pub fn assembled(&self, t: f64, q: impl Numbers<N>, v: impl Numbers<N>) -> Result<Projected<N>, StepError> {
        let (q, v) = (q.vector(), v.vector());
        self.explained((t, &q, &v), || {
            let place = (t, &q, &v);
            let x = match self.nearest(place, &q, None) {
                Ok(Some(x)) => x,
                Err(failure @ StepError::NonFinite { .. }) => return Err(failure),
                _ => self.continued(place)?,
            };
            self.with_velocities(t, [&q, &x], &v)
        })
    }

    /// The end of the continuation from q.
    fn continued(&self, (t, q, v): (f64, &SVector<f64, N>, &SVector<f64, N>)) -> Result<SVector<f64, N>, StepError> {
        let initial = self.system.constraints(t, q);
        let (mut x, mut passed, mut step) = (*q, 0.0_f64, FIRST);
        for _ in 0..STEPS {
            let next = (passed + step).min(1.0);
            let mut target = initial;
            for value in target.as_mut() {
                *value *= 1.0 - next;
            }
            match self.nearest((t, q, v), &x, Some(&target)) {
                Ok(Some(_)) if next >= 1.0 => break,
                Ok(Some(found)) => (x, passed, step) = (found, next, 2.0 * step),
                Err(StepError::Singular { t, matrix }) if passed == 0.0 && step < SHORTEST => {
                    return Err(StepError::Singular { t, matrix });
                }
                _ if step < SHORTEST => return Err(self.open(t, &x, passed)),
                _ => step *= 0.5,
            }
        }
        self.nearest((t, q, v), &x, None).ok().flatten().ok_or_else(|| self.open(t, &x, passed))
    }

    /// The error of a linkage that stays open at x.
    pub(super) fn open(&self, t: f64, x: &SVector<f64, N>, passed: f64) -> StepError {
        let values = self.system.constraints(t, x);
        let (gradients, _) = self.system.constraint_gradients(t, x);
        let gaps = values.as_ref().iter().zip(gradients.rows()).take(S::HOLONOMIC);
        let gaps = gaps.map(|(value, gradient)| match gradient.dense::<N>().norm() {
            length if length > 0.0 => value.abs() / length,
            _ => value.abs(),
        });
        let (worst, gap) = gaps.enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b)).unwrap_or((0, 0.0));
        let (constraint, residual) = (S::CONSTRAINTS[worst], values.as_ref()[worst]);
        StepError::NotAssembled { t, constraint, residual, gap, passed }
    }
}
