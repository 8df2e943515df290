//! Where the first step comes from.
//!
//! In: the middle of the first interval, or its two ends, or the state of an earlier run. Out: an integrator whose node is
//! the end of that interval, with the p1 and E1 of the slot derivatives.

use super::equations::Elimination;
use super::fallback::check_step;
use super::interval::Last;
use super::run::Run;
use super::stepper::EnergyPreserving;
use crate::called::Called;
use crate::error::StepError;
use crate::node::Node;
use crate::real::Scalar;
use crate::state::{Numbers, State};
use crate::stepping::EnergyStepping;
use nalgebra::SVector;

impl<S, const N: usize, T> EnergyPreserving<S, N, T>
where
    S: EnergyStepping<N, T>,
    T: Scalar,
{
    /// The midpoint start: `(t0, q0, v0)` becomes the middle of the first interval, of length `h0`. For the midpoint rule
    ///
    /// ```text
    /// t1 = t0 + h0/2      q1 = q0 + (h0/2) v0      p1 = L_v + (h0/2)(L_q + f)      E1 = H0 − (h0/2)(L_t − f·v)
    /// ```
    ///
    /// Explicit, and without the paper's bias of `h0² D/8` in the energy: every midpoint lies on `H = H0` to rounding.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an h0 that is not positive and finite; [`StepError::NonFinite`] where an input is
    /// not finite or the system has no value there; [`StepError::Singular`].
    pub fn from_midpoint(
        system: S,
        t0: T,
        q0: impl Numbers<N, T>,
        v0: impl Numbers<N, T>,
        h0: T,
    ) -> Result<Self, StepError> {
        check_step("the step h0", h0)?;
        let (q, v) = (q0.vector(), v0.vector());
        let mut start = Node::new(State { t: t0, q, p: SVector::zeros() }, T::zero());
        start.shift(h0 * T::real(-0.5), &v);
        Self::after(system, start, h0, v)
    }

    /// The paper's start: the first interval by its ends `(t0, q0)` and `(t1, q1)`, q1 from an accurate solution.
    /// `p1 = D4 L_d + f_d⁺`, `E1 = −D3 L_d − g_d⁺`.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for a t1 − t0 that is not positive and finite; otherwise as
    /// [`EnergyPreserving::from_midpoint`].
    pub fn from_points(
        system: S,
        (t0, q0): (T, impl Numbers<N, T>),
        (t1, q1): (T, impl Numbers<N, T>),
    ) -> Result<Self, StepError> {
        let (h, q, q1) = (t1 - t0, q0.vector(), q1.vector());
        check_step("the interval t1 − t0", h)?;
        let v = (q1 - q).map(|distance| distance / h);
        let mut integrator = Self::after(system, Node::new(State { t: t0, q, p: SVector::zeros() }, T::zero()), h, v)?;
        // The end is the point given, not the start plus h v with its roundings.
        let node = &mut integrator.run.node;
        (node.t, node.t_low, node.q, node.q_low) = (t1, T::zero(), q1, SVector::zeros());
        Ok(integrator)
    }

    /// Resumes from a node with its discrete energy, and the length `h` and velocity `v` of the interval that led there.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an h that is not positive and finite; otherwise as
    /// [`EnergyPreserving::from_midpoint`].
    pub fn from_state(
        system: S,
        state: State<N, T>,
        energy: T,
        h: T,
        v: impl Numbers<N, T>,
    ) -> Result<Self, StepError> {
        check_step("the step h", h)?;
        let (node, v) = (Node::new(state, energy), v.vector());
        let mut start = node;
        start.shift(-h, &v);
        let mut integrator = Self::after(system, start, h, v)?;
        integrator.run.node = node;
        Ok(integrator)
    }

    /// The integrator at the end of the step `(v, h)` from the place of `start`.
    fn after(system: S, start: Node<N, T>, h: T, v: SVector<T, N>) -> Result<Self, StepError> {
        match first_interval(&Called(system), start, h, v) {
            Ok(run) => Ok(Self { system, run, failure: None }),
            Err(failure) => Err(failure.explained(&system, &start, h, &v)),
        }
    }
}

/// The run at the end of the step `(v, h)` from the place of `start`.
fn first_interval<const N: usize, T: Scalar, S: EnergyStepping<N, T>>(
    system: &S,
    start: Node<N, T>,
    h: T,
    v: SVector<T, N>,
) -> Result<Run<N, T>, StepError> {
    let t = if start.t.to_f64().is_finite() { start.t } else { T::zero() };
    start.check_finite(t)?;
    let start = start.leaving(system, h, &v);
    let node = start.advanced::<S>(h, &v, &system.extended_residual(&start, h, &v).increment);
    node.check_finite(t)?;
    let singular = StepError::Singular { t: t.to_f64(), matrix: "derivative of the momentum equation" };
    let infinite = StepError::NonFinite { t: t.to_f64(), quantity: "step density", expression: None };
    let elimination = Elimination::finite(&system.extended_system(&start, h, &v)).ok_or(singular)?;
    let density = elimination.density().ok_or(infinite)?;
    let (t_mid, q_mid) = start.midpoint(h, &v);
    // Only the first guess depends on the acceleration: where it has none, v is guessed constant.
    let acceleration = system.acceleration(t_mid, &q_mid, &v).unwrap_or_else(|_| SVector::zeros());
    Ok(Run::new(node, Last { v, h, previous: h, density, change: acceleration * h, is_step: false }))
}
