//! The variational integrator with a given step.
//!
//! In: a system, a state and the step h (negative: backwards in time). Out: an iterator of states. One step solves
//!
//! ```text
//! −D2 L_d − f_d⁻ = p0       for v, with q1 = q0 + h v and t1 = t0 + h
//!  p1 = D4 L_d + f_d⁺       as p0 plus its gain; for the midpoint rule p1 = p0 + h (L_q + f)
//! ```
//!
//! The guess of v is extrapolated over the last three steps; the iteration ends at the rounding floor, and sums are
//! compensated. Where Newton's iteration fails from the guess, v is followed from the velocity that belongs to p by
//! continuation in h. AFTER AN ERROR the integrator holds the last good state and keeps returning that error.

use crate::momentum::{self, Solution};
use crate::{Node, Scalar, State, StepError, Stepping, continuation};
use nalgebra::SVector;

/// The variational integrator with a given step; see the [module](self).
#[derive(Clone, Debug)]
pub struct FixedStep<S, const N: usize, T = f64> {
    system: S,
    node: Node<N, T>,
    h: T,
    /// Velocities of the last three intervals, the newest first; before there are three the oldest stands in.
    velocities: [SVector<T, N>; 3],
    steps: u64,
    iterations: u32,
    failure: Option<StepError>,
}

impl<S, const N: usize, T> FixedStep<S, N, T>
where
    S: Stepping<N, T>,
    T: Scalar,
{
    /// The integrator of `system` from `state` with the step `h`, in units of time.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an h that is zero or not finite, [`StepError::NonFinite`] for such a state,
    /// [`StepError::Singular`] or [`StepError::NotConverged`] where no velocity belongs to its momenta.
    pub fn new(system: S, state: State<N, T>, h: T) -> Result<Self, StepError> {
        let value = h.to_f64();
        if !value.is_finite() || value == 0.0 {
            return Err(StepError::InvalidInput { input: "the step h", allowed: "finite and not zero", value });
        }
        let node = Node::new(state, T::zero());
        node.check_finite(T::zero())?;
        // Most Lagrangians give the velocity in one iteration from rest; where the mass matrix vanishes there,
        // any other start will do.
        let v = momentum::velocity(&system, &node, [SVector::zeros(), node.p])?;
        Ok(Self { system, node, h, velocities: [v; 3], steps: 0, iterations: 0, failure: None })
    }

    /// Takes one step and returns the state reached.
    ///
    /// # Errors
    /// [`StepError::NotConverged`] where the momentum equation has no solution that can be reached, with the iterations
    /// spent; [`StepError::NonFinite`], [`StepError::Singular`]. The same error again after an error.
    #[inline]
    pub fn step(&mut self) -> Result<State<N, T>, StepError> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        self.advance().inspect_err(|failure| self.failure = Some(*failure))
    }

    /// The state reached last.
    pub fn state(&self) -> State<N, T> {
        self.node.state()
    }

    /// The node reached last: the state with the low parts of its sums. Its energy has no meaning here; see
    /// [`FixedStep::discrete_energy`].
    pub fn node(&self) -> &Node<N, T> {
        &self.node
    }

    /// The system.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// The step, in units of time.
    pub fn h(&self) -> T {
        self.h
    }

    /// Velocity of the last interval, `(q1 − q0)/h` without its cancellation; before the first step the velocity that
    /// belongs to the momenta.
    pub fn v(&self) -> SVector<T, N> {
        let [v, ..] = self.velocities;
        v
    }

    /// Newton iterations of the last step.
    pub fn iterations(&self) -> u32 {
        self.iterations
    }

    /// Discrete energy of the last interval, `E1 = −D3 L_d − g_d⁺`; `None` before the first step.
    ///
    /// Evaluated from v inside the interval: from the stored nodes it would carry the cancellation of `(q1 − q0)/h`.
    pub fn discrete_energy(&self) -> Option<T> {
        let v = self.v();
        (self.steps > 0).then(|| {
            let mut start = self.node;
            start.shift(-self.h, &v);
            let start = start.leaving(&self.system, self.h, &v);
            start.energy + self.system.increment(&start, self.h, &v).energy
        })
    }

    #[inline]
    fn advance(&mut self) -> Result<State<N, T>, StepError> {
        let [v1, v2, v3] = self.velocities;
        let guess = (v1 - v2) * T::real(3.0) + v3;
        let Solution { v, iterations } = match momentum::solve(&self.system, &self.node, self.h, guess) {
            Ok(solution) => solution,
            Err(_) => continuation::solve(&self.system, &self.node, self.h, v1)?,
        };
        let gain = self.system.increment(&self.node, self.h, &v);
        let node = self.node.advanced(self.h, &v, &gain);
        node.check_finite(self.node.t)?;
        self.node = node;
        // One step knows no slope: it repeats v, and the next guess is v itself.
        self.velocities = match self.steps {
            0 => [v; 3],
            1 => [v, v1, v1 + v1 - v],
            _ => [v, v1, v2],
        };
        self.steps += 1;
        self.iterations = iterations;
        Ok(node.state())
    }
<<<<<<< HEAD
=======

    /// The root that is connected with the velocity belonging to p, followed from h = 0 in parts that double after a
    /// success and halve after a failure.
    #[cold]
    fn continued(&self) -> Result<Solution<N, T>, StepError> {
        let t = self.node.t.to_f64();
        let [v1, ..] = self.velocities;
        let mut v = momentum::velocity(&self.system, &self.node, [v1, self.node.p])?;
        let (mut reached, mut part, mut spent) = (0.0, 1.0, 0);
        while reached < 1.0 {
            let target = f64::min(reached + part, 1.0);
            match momentum::solve(&self.system, &self.node, self.h * T::real(target), v) {
                Ok(solution) => {
                    (v, reached, part) = (solution.v, target, 2.0 * part);
                    spent += solution.iterations;
                }
                Err(failure) if part <= LEAST_PART => {
                    let failure = match failure {
                        // On the way to the last root the Jacobian loses its inverse: there is no root beyond.
                        Failure::Singular => match self.residual(v) {
                            residual if residual.is_finite() => Failure::Stalled { iterations: spent, residual },
                            _ => Failure::NonFinite,
                        },
                        Failure::Stalled { iterations, residual } => {
                            Failure::Stalled { iterations: spent + iterations, residual }
                        }
                        Failure::NonFinite => failure,
                    };
                    return Err(failure.at(t, self.h.to_f64(), "derivative of the momentum equation"));
                }
                Err(_) => part /= 2.0,
            }
        }
        Ok(Solution { v, iterations: spent })
    }

    /// Residual at the whole step, in roundings.
    fn residual(&self, v: SVector<T, N>) -> f64 {
        let equation = self.system.momentum_equation(&self.node, self.h, &v);
        momentum::worst(&equation.residual, &equation.magnitude)
    }
>>>>>>> main
}

impl<S, const N: usize, T> Iterator for FixedStep<S, N, T>
where
    S: Stepping<N, T>,
    T: Scalar,
{
    type Item = Result<State<N, T>, StepError>;

    /// The next step; never `None`. After an error, the same error.
    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        Some(self.step())
    }
}
