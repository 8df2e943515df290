//! A state on the constraints from a far guess, by continuation in their residual.
//!
//! ```text
//! g(t, x) = (1 − τ) g(t, q)        τ from 0, at the guess q, to 1
//! ```
//!
//! Each step of τ moves x to the nearest place with these values. A step that fails is halved; after a success the next
//! one is doubled.
//!
//! If the continuation ends early, as beside the centre of a circle, damped Gauss–Newton iteration (Levenberg and
//! Marquardt) reduces the sum of the squares of the residuals over their sizes, with masses W on the diagonal:
//!
//! ```text
//! δ = −W⁻¹ Aᵀ (A W⁻¹ Aᵀ + λ)⁻¹ g
//! ```

use super::{Projected, Projection};
use crate::error::StepError;
use crate::linear::Rectangular;
use crate::state::{Numbers, State};
use crate::stepping::Convertible;
use crate::vector::weights;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector, SVector};

/// The first step of τ, and the shortest.
const FIRST: f64 = 0.125;
const SHORTEST: f64 = 1e-6;
/// Largest number of steps.
const STEPS: u32 = 400;
/// Damping λ at the start of the Gauss–Newton iteration, its factor after a trial that failed, and the number of trials:
/// from 1e-300 beside a centre, λ has to reach 1e300.
const DAMPING: f64 = 1e-3;
const HARDER: f64 = 8.0;
const TRIALS: u32 = 1500;
/// Residuals over their sizes from which the nearest place is close.
const CLOSE: f64 = 1e-6;

impl<const N: usize> State<N> {
    /// A state on the constraints from a far guess, for example of a closed loop that is not closed: the nearest state
    /// as by [`State::projected`], otherwise by a continuation in which the residuals of all constraints shrink
    /// together, or by least squares of the residuals. [`Projection::holding`] holds coordinates.
    ///
    /// A linkage may have several assemblies. The guess chooses one, which is not always the nearest.
    ///
    /// # Errors
    /// [`StepError::NotAssembled`] if the residuals cannot shrink further, with the constraint that is farthest from
    /// being satisfied; [`StepError::Singular`] if the constraints are redundant at the guess, as in a linkage that is
    /// flat; [`StepError::NonFinite`].
    pub fn assembled<S: Convertible<N>>(
        system: &S,
        t: f64,
        q: impl Numbers<N>,
        v: impl Numbers<N>,
    ) -> Result<Projected<N>, StepError> {
        Projection::of(system).assembled(t, q, v)
    }
}

impl<S: Convertible<N>, const N: usize> Projection<'_, S, N> {
    /// As [`State::assembled`], with the held coordinates.
    ///
    /// # Errors
    /// As [`State::assembled`].
    pub fn assembled(&self, t: f64, q: impl Numbers<N>, v: impl Numbers<N>) -> Result<Projected<N>, StepError> {
        let (q, v) = (q.vector(), v.vector());
        self.explained((t, &q, &v), || self.found((t, &q, &v), true))
    }

    /// The end of the continuation from q.
    pub(super) fn continued(
        &self,
        (t, q, v): (f64, &SVector<f64, N>, &SVector<f64, N>),
    ) -> Result<SVector<f64, N>, StepError> {
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

    /// The place on the constraints that damped Gauss–Newton iteration finds from q. `None` if the residuals do not
    /// decrease.
    pub(super) fn relaxed(&self, place: (f64, &SVector<f64, N>, &SVector<f64, N>)) -> Option<SVector<f64, N>> {
        self.least_squares(
            place,
            |x, left| {
                if left < CLOSE { self.nearest(place, x, None).ok().flatten() } else { None }
            },
        )
    }

    /// The first result of `end` for a place of damped Gauss–Newton iteration from q, with the norm of the residuals
    /// over their sizes. `None` if the residuals do not decrease.
    pub(super) fn least_squares<R>(
        &self,
        place: (f64, &SVector<f64, N>, &SVector<f64, N>),
        end: impl Fn(&SVector<f64, N>, f64) -> Option<R>,
    ) -> Option<R> {
        let (t, q, _) = place;
        let weights = weights(&self.metric(place).diagonal());
        let fixed = self.fixed(&self.gradients(t, q).0);
        let rows: Vec<usize> =
            (0..self.system.holonomic()).filter(|r| !fixed[*r] && !self.system.is_dropped(*r)).collect();
        // g, and A over the weights.
        let at = |x: &SVector<f64, N>| {
            let (values, gradients) = (self.system.constraints(t, x), self.gradients(t, x).0);
            let g = DVector::from_iterator(rows.len(), rows.iter().map(|r| values.as_ref()[*r]));
            let mut a = DMatrix::zeros(rows.len(), N);
            for (row, r) in rows.iter().enumerate() {
                gradients.row(*r).iter().for_each(|(column, slope)| a[(row, column)] = slope / weights[column]);
            }
            (g, a)
        };
        let length = q.component_mul(&weights).norm();
        let (g, a) = at(q);
        let sizes = DVector::from_fn(rows.len(), |row, _| {
            let size = g[row].abs() + a.row(row).norm() * length;
            if size > 0.0 { size } else { 1.0 }
        });
        let over = |(g, mut a): (DVector<f64>, DMatrix<f64>)| {
            a.row_iter_mut().zip(&sizes).for_each(|(mut row, size)| row /= *size);
            (g.component_div(&sizes), a)
        };
        let (mut x, mut damping) = (*q, DAMPING);
        let (mut g, mut a) = over((g, a));
        let found = end(&x, g.norm());
        if found.is_some() {
            return found;
        }
        for _ in 0..TRIALS {
            // Divided by the largest entry: products of tiny ones underflow.
            let largest = a.amax();
            if largest == 0.0 || !damping.is_finite() {
                return None;
            }
            let unit = &a / largest;
            let mut normal = &unit * unit.transpose();
            let added = damping * normal.diagonal().amax();
            (0..rows.len()).for_each(|row| normal[(row, row)] += added);
            let step = normal.cholesky().map(|factors| unit.transpose() * factors.solve(&(&g / largest)));
            let next = step.map(|step| x - SVector::from_fn(|i, _| step[i] / weights[i]));
            let next = next.map(|next| (next, over(at(&next)))).filter(|(_, (there, _))| there.norm() < g.norm());
            let Some((there, (g_there, a_there))) = next else {
                damping *= HARDER;
                continue;
            };
            (x, g, a, damping) = (there, g_there, a_there, (damping / HARDER).min(1.0));
            let found = end(&x, g.norm());
            if found.is_some() {
                return found;
            }
        }
        None
    }

    /// The error of a linkage that stays open at x.
    pub(super) fn open(&self, t: f64, x: &SVector<f64, N>, passed: f64) -> StepError {
        let values = self.system.constraints(t, x);
        let (gradients, _) = self.system.constraint_gradients(t, x);
        let gaps = values.as_ref().iter().zip(gradients.rows()).take(self.system.holonomic());
        let gaps = gaps.map(|(value, gradient)| match gradient.dense::<N>().norm() {
            length if length > 0.0 => value.abs() / length,
            _ => value.abs(),
        });
        let (worst, gap) = gaps.enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b)).unwrap_or((0, 0.0));
        let (constraint, residual) = (self.system.constraint_names()[worst], values.as_ref()[worst]);
        StepError::NotAssembled { t, constraint, residual, gap, passed }
    }
}
