//! The Legendre transform: momenta of velocities, and velocities and the energy of momenta.
//!
//! In: a system, and `(t, q, v)` or `(t, q, p)`. Out: `p = ∂L/∂v`; the v with `∂L/∂v(t, q, v) = p`; `H = v·p − L`.

use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::linear::{self, Matrix};
use crate::momentum;
use crate::node::Node;
use crate::real::{Real, Scalar};
use crate::state::State;
use crate::stepping::FixedStepping;
use nalgebra::SVector;

impl<const N: usize, T: Real> State<N, T> {
    /// The state at time `t` with coordinates `q` and velocities `v`: `p = ∂L/∂v(t, q, v)`.
    pub fn at<S: Lagrangian<N, T>>(system: &S, t: T, q: impl Into<SVector<T, N>>, v: impl Into<SVector<T, N>>) -> Self {
        let (q, v) = (q.into(), v.into());
        Self { t, q, p: system.momentum(t, &q, &v) }
    }
}

impl<const N: usize, T: Scalar> State<N, T> {
    /// The velocity v at this node, the root of `∂L/∂v(t, q, v) = p`: in the coordinates' units by time.
    ///
    /// Not the velocity of the last interval, `(q1 − q0)/h`, which differs from it by a term of order h.
    ///
    /// # Errors
    /// [`StepError::Singular`] where the mass matrix cannot be inverted, [`StepError::NotConverged`] where no velocity has
    /// these momenta, [`StepError::NonFinite`].
    pub fn velocity<S: FixedStepping<N, T>>(&self, system: &S) -> Result<SVector<T, N>, StepError> {
        let node = Node::new(*self, T::zero());
        let explained = |failure: StepError| failure.explained(system, &node, T::zero(), &SVector::zeros());
        node.check_finite(T::zero()).map_err(explained)?;
        // Most Lagrangians give the velocity in one iteration from rest; where the mass matrix vanishes there,
        // any other start will do.
        momentum::velocity(system, &node, [SVector::zeros(), self.p]).map_err(explained)
    }

    /// The energy `H = v·∂L/∂v − L` at this node, in the units of L, v the velocity that belongs to its momenta.
    ///
    /// Along a run of fixed steps it oscillates about the energy of the motion by a term of order h²; the discrete energy of
    /// an interval, which the integrators report, is another number.
    ///
    /// # Errors
    /// Those of [`State::velocity`]; [`StepError::NonFinite`] where L is not finite, though its forces may be.
    pub fn energy<S: FixedStepping<N, T>>(&self, system: &S) -> Result<T, StepError> {
        let v = self.velocity(system)?;
        let energy = system.energy(self.t, &self.q, &v);
        if energy.is_finite() {
            return Ok(energy);
        }
        let failure = StepError::NonFinite { t: self.t.to_f64(), quantity: "energy", expression: None };
        Err(failure.explained(system, &Node::new(*self, T::zero()), T::zero(), &v))
    }
}

/// The acceleration a with `mass · a = applied`, as generated code asks for it.
///
/// # Errors
/// [`StepError::Singular`] where the mass matrix cannot be inverted at the time `t`.
#[inline]
pub fn acceleration<T: Real, const N: usize>(
    t: T,
    mass: &impl Matrix<N, T>,
    applied: &SVector<T, N>,
) -> Result<SVector<T, N>, StepError> {
    linear::solve(mass, applied).ok_or(StepError::Singular { t: t.to_f64(), matrix: "mass matrix" })
}
