//! The integrator that solves for its own step, so that the discrete energy is preserved.
//!
//! In: a system and the first interval. Out: an iterator of [`Step`]s. One step solves, in the unknowns `(v, h)` with
//! q1 = q0 + h v, t1 = t0 + h, h > 0,
//!
//! ```text
//! −D2 L_d − f_d⁻ = p0       p1 =  D4 L_d + f_d⁺
//!  D1 L_d + g_d⁻ = E0       E1 = −D3 L_d − g_d⁺
//! ```
//!
//! where p1 and E1 are carried as p0 and E0 plus their gains, every sum compensated. The pair `(v, −h)` of the last step
//! solves these equations always, and is no step.
//!
//! | file | part of a step |
//! |---|---|
//! | `starts` | the node and the interval that the first step follows |
//! | `guess` | v by extrapolation, h by the step law `h D^(1/3) = constant` |
//! | `newton` | the n + 1 equations to the rounding floor |
//! | `bracket` | where that fails: the smallest h > 0 that solves them, or the proof that there is none |
//!
//! AFTER AN ERROR the integrator holds the last good state and keeps returning that error.

mod bracket;
mod guess;
mod newton;
mod starts;

use crate::{Node, Scalar, State, Step, StepError, Stepping};
use nalgebra::SVector;
use newton::{Failure, Root};

/// A step may be longer or shorter than the last one by this factor at most.
const RATIO: f64 = 3.0;

/// The interval that the next step follows.
#[derive(Clone, Copy, Debug)]
struct Last<const N: usize, T> {
    v: SVector<T, N>,
    h: T,
    /// Step density D of the interval.
    density: T,
    /// Change of v by time, between the middles of the last two intervals.
    slope: SVector<T, N>,
}

/// The integrator that solves for its own step; see the [module](self).
#[derive(Clone, Debug)]
pub struct EnergyPreserving<S, const N: usize, T = f64> {
    system: S,
    node: Node<N, T>,
    last: Last<N, T>,
    failure: Option<StepError>,
}

impl<S, const N: usize, T> EnergyPreserving<S, N, T>
where
    S: Stepping<N, T>,
    T: Scalar,
{
    /// Takes one step and returns it.
    ///
    /// # Errors
    /// [`StepError::NoForwardStep`] where no step exists, [`StepError::StepRatio`] where the only one is beyond a factor
    /// of 3 of the last, [`StepError::DegenerateStep`] where every length would do; [`StepError::NotConverged`],
    /// [`StepError::Singular`], [`StepError::NonFinite`]. The same error again after an error.
    #[inline]
    pub fn step(&mut self) -> Result<Step<N, T>, StepError> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        self.advance().inspect_err(|failure| self.failure = Some(*failure))
    }

    /// The state reached last.
    pub fn state(&self) -> State<N, T> {
        self.node.state()
    }

    /// The node reached last: the state and the discrete energy with the low parts of their sums.
    pub fn node(&self) -> &Node<N, T> {
        &self.node
    }

    /// The system.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// Discrete energy of the node reached last, as it is carried.
    pub fn energy(&self) -> T {
        self.node.energy
    }

    /// Length of the last step, in units of time.
    pub fn h(&self) -> T {
        self.last.h
    }

    /// Velocity of the last interval, `(q1 − q0)/h` without its cancellation.
    pub fn v(&self) -> SVector<T, N> {
        self.last.v
    }

    /// Step density D of the last interval.
    pub fn density(&self) -> T {
        self.last.density
    }

    #[inline]
    fn advance(&mut self) -> Result<Step<N, T>, StepError> {
        let root = self.root()?;
        let Root { v, h, density, iterations, residual } = root;
        let gain = self.system.increment(&self.node, h, &v);
        let node = self.node.advanced(h, &v, &gain);
        node.check_finite(self.node.t)?;
        let (t_mid, q_mid) = self.node.midpoint(h, &v);
        let slope = (v - self.last.v) * (T::real(2.0) / (h + self.last.h));
        self.node = node;
        self.last = Last { v, h, density, slope };
        Ok(Step {
            t: node.t,
            q: node.q,
            p: node.p,
            energy: node.energy,
            h,
            midpoint: (t_mid, q_mid, v),
            density,
            iterations,
            residual: T::real(residual),
        })
    }

    /// The forward step from the node.
    #[inline]
    fn root(&self) -> Result<Root<N, T>, StepError> {
        let Self { system, node, last, .. } = self;
        let start = guess::predict(system, node, last);
        let ratio = T::real(RATIO);
        match newton::solve(system, node, start, (last.h / ratio, last.h * ratio), |_| ()) {
            // At the smallest root D has the sign that it had: past a change of sign lies another root.
            Ok(root) if root.density.to_f64() * last.density.to_f64() > 0.0 => Ok(root),
            Err(Failure::Degenerate { h, density }) => {
                Err(StepError::DegenerateStep { t: node.t.to_f64(), h: h.to_f64(), density: density.to_f64() })
            }
            _ => bracket::smallest_root(system, node, last),
        }
    }
}

impl<S, const N: usize, T> Iterator for EnergyPreserving<S, N, T>
where
    S: Stepping<N, T>,
    T: Scalar,
{
    type Item = Result<Step<N, T>, StepError>;

    /// The next step; never `None`. After an error, the same error.
    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        Some(self.step())
    }
}
