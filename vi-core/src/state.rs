//! States, intervals and steps.
//!
//! `q`, `p` and `v` are column vectors of N entries, in the order in which the system declares its coordinates and
//! in the system's own units.

use crate::{Lagrangian, Node, Real, Scalar, StepError, Stepping, momentum};
use nalgebra::SVector;

/// Where a system is: time, coordinates, momenta.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<const N: usize, T = f64> {
    /// Time.
    pub t: T,
    /// Coordinates.
    pub q: SVector<T, N>,
    /// Momenta, `p = ∂L/∂v`.
    pub p: SVector<T, N>,
}

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
    pub fn velocity<S: Stepping<N, T>>(&self, system: &S) -> Result<SVector<T, N>, StepError> {
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
    pub fn energy<S: Stepping<N, T>>(&self, system: &S) -> Result<T, StepError> {
        let v = self.velocity(system)?;
        let energy = system.energy(self.t, &self.q, &v);
        if energy.is_finite() {
            return Ok(energy);
        }
        let failure = StepError::NonFinite { t: self.t.to_f64(), quantity: "energy", expression: None };
        Err(failure.explained(system, &Node::new(*self, T::zero()), T::zero(), &v))
    }
}

/// The pair of nodes between which one discrete Lagrangian lives: `(t0, q0) → (t1, q1)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval<const N: usize, T = f64> {
    /// Time at the start.
    pub t0: T,
    /// Coordinates at the start.
    pub q0: SVector<T, N>,
    /// Time at the end.
    pub t1: T,
    /// Coordinates at the end.
    pub q1: SVector<T, N>,
}

/// One step of the energy-preserving integrator: the node reached, and the midpoint it was reached through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<const N: usize, T = f64> {
    /// Time of the node reached.
    pub t: T,
    /// Coordinates of the node reached.
    pub q: SVector<T, N>,
    /// Momenta of the node reached.
    pub p: SVector<T, N>,
    /// Discrete energy `E1 = −D3 L_d − g_d⁺` of the node reached, as the integrator carries it.
    pub energy: T,
    /// Length of the step.
    pub h: T,
    /// Middle of the interval: `(t0 + h/2, q0 + (h/2) v, v)`. The energy equation holds here.
    pub midpoint: (T, SVector<T, N>, SVector<T, N>),
    /// Step density D of the interval, from the determinant that the solution was found with.
    pub density: T,
    /// D in the middle of the next interval, were D to change as it did over the last two: where it does not have the sign
    /// of `density`, the next step is in danger. See [`Step::h_next`].
    pub density_next: T,
    /// Newton iterations on the n + 1 equations that found the step.
    pub iterations: u32,
    /// Largest residual left at the `(v, h)` that was taken, in roundings: one is an ulp of what the row is a sum of, or what
    /// running error analysis finds that its evaluation loses.
    pub residual: T,
    /// How the step was found.
    pub method: Method<T>,
}

impl<const N: usize, T: Scalar> Step<N, T> {
    /// Length of the next step by the step law, `h (D/D_next)^(1/3)`; `None` where D is about to change its sign, and no
    /// step may exist.
    pub fn h_next(&self) -> Option<T> {
        let ratio = self.density.to_f64() / self.density_next.to_f64();
        (ratio > 0.0 && ratio.is_finite()).then(|| self.h * T::real(ratio.cbrt()))
    }
}

/// How a step of the energy-preserving integrator was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method<T = f64> {
    /// From the momentum and the energy equation.
    EnergyPreserving,
    /// From both equations, the first after fixed steps, where no step had the energy of before: the energy to preserve
    /// was set to the discrete energy of the last fixed interval.
    Reseeded {
        /// By so much the energy to preserve has changed.
        energy_change: T,
    },
    /// From the momentum equation alone, its length given: no energy-preserving step was found, and
    /// [`Fallback::FixedSteps`](crate::energy_preserving::Fallback::FixedSteps) was chosen.
    FixedStep,
}
