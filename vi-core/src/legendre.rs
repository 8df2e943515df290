//! The Legendre transform: momenta from velocities, and velocities and the energy from momenta.
//!
//! At `(t, q, v)` it returns `p = ∂L/∂v`; at `(t, q, p)` the v with `∂L/∂v(t, q, v) = p`, and `H = v·p − L`.

use crate::error::StepError;
use crate::lagrangian::{Flow, Lagrangian};
use crate::linear::{self, Matrix};
use crate::newton::{self, Equations, Failure, worst};
use crate::node::Node;
use crate::real::{Real, Rounded, Scalar};
use crate::state::{Numbers, State};
use crate::vector::Vector;
use nalgebra::SVector;

impl<const N: usize, T: Real> State<N, T> {
    /// The state at time `t` with coordinates `q` and velocities `v`: `p = ∂L/∂v(t, q, v)`.
    pub fn at<S: Lagrangian<N, T>>(system: &S, t: T, q: impl Numbers<N, T>, v: impl Numbers<N, T>) -> Self {
        let (q, v) = (q.vector(), v.vector());
        Self { t, q, p: system.momentum(t, &q, &v) }
    }
}

impl<const N: usize, T: Scalar> State<N, T> {
    /// The velocity v at this state, the root of `∂L/∂v(t, q, v) = p`, in units of the coordinates over time.
    ///
    /// It differs from the velocity of the last interval, `(q1 − q0)/h`, by a term of order h.
    ///
    /// # Errors
    /// [`StepError::Singular`] if the mass matrix is singular, [`StepError::NotConverged`] if no velocity has these
    /// momenta, [`StepError::NonFinite`].
    pub fn velocity<S: Lagrangian<N, T>>(&self, system: &S) -> Result<SVector<T, N>, StepError> {
        self.raw_flow(system).map(|flow| flow.v)
    }

    /// The rates of change at this state: its velocity, `L_q + f`, and the power `f·v − L_t`.
    ///
    /// # Errors
    /// As [`State::velocity`]; [`StepError::NonFinite`] or [`StepError::Undefined`] if a rate is not finite.
    pub fn flow<S: Lagrangian<N, T>>(&self, system: &S) -> Result<Flow<N, T>, StepError> {
        let flow = self.raw_flow(system)?;
        if flow.power.is_finite() && flow.force.iter().all(|entry| entry.is_finite()) {
            return Ok(flow);
        }
        let failure = StepError::NonFinite { t: self.t.to_f64(), quantity: "flow", expression: None };
        Err(failure.explained(system, &Node::new(*self, T::zero()), T::zero(), &flow.v))
    }

    /// The flow without a check: forces and power may be infinite or NaN although the velocity is finite.
    ///
    /// # Errors
    /// As [`State::velocity`].
    pub(crate) fn raw_flow<S: Lagrangian<N, T>>(&self, system: &S) -> Result<Flow<N, T>, StepError> {
        let node = Node::new(*self, T::zero());
        let flow = node.check_finite(T::zero()).and_then(|()| system.flow(self.t, &self.q, &self.p));
        flow.map_err(|failure| failure.explained(system, &node, T::zero(), &SVector::zeros()))
    }

    /// The energy `H = v·∂L/∂v − L` at this state, in the units of L, with v the velocity of its momenta.
    ///
    /// Along a run of fixed steps it oscillates about the energy of the trajectory by a term of order h². It differs
    /// from the discrete energy of an interval, which the integrators report.
    ///
    /// # Errors
    /// As [`State::velocity`]; [`StepError::NonFinite`] if L is not finite, although its forces may be.
    pub fn energy<S: Lagrangian<N, T>>(&self, system: &S) -> Result<T, StepError> {
        let v = self.velocity(system)?;
        let energy = system.energy(self.t, &self.q, &v);
        if energy.is_finite() {
            return Ok(energy);
        }
        let failure = StepError::NonFinite { t: self.t.to_f64(), quantity: "energy", expression: None };
        Err(failure.explained(system, &Node::new(*self, T::zero()), T::zero(), &v))
    }
}

/// The acceleration a with `mass · a = applied`.
///
/// # Errors
/// [`StepError::NonFinite`] if a derivative of L or f is not finite at the time `t`, [`StepError::Singular`] if the
/// mass matrix is singular.
#[inline]
pub fn acceleration<T: Real, const N: usize>(
    t: T,
    mass: &impl Matrix<N, T>,
    applied: &SVector<T, N>,
) -> Result<SVector<T, N>, StepError> {
    let found = if const { N > INLINED } { solved_apart(mass, applied) } else { solved(mass, applied) };
    found.map_err(|failure| match failure {
        Failure::NonFinite => StepError::NonFinite { t: t.to_f64(), quantity: "acceleration", expression: None },
        other => other.at(t.to_f64(), 0.0, "mass matrix"),
    })
}

/// Checks that the step density is finite.
///
/// # Errors
/// [`StepError::NonFinite`] at the time `t` otherwise.
#[inline]
pub fn step_density<T: Real>(t: T, density: T) -> Result<T, StepError> {
    let lost = StepError::NonFinite { t: t.to_f64(), quantity: "step density", expression: None };
    if density.is_finite() { Ok(density) } else { Err(lost) }
}

/// The v with `mass · v = momentum`, without the momentum at rest.
///
/// # Errors
/// [`StepError::Singular`] if the mass matrix is singular at the time `t`, [`StepError::NonFinite`] if it or the
/// momentum is not finite.
#[inline]
pub fn velocity_by_mass<T: Real, const N: usize>(
    t: T,
    mass: &impl Matrix<N, T>,
    momentum: &SVector<T, N>,
) -> Result<SVector<T, N>, StepError> {
    solved(mass, momentum).map_err(|failure| failure.at(t.to_f64(), 0.0, "mass matrix"))
}

/// Systems with more coordinates solve for an acceleration out of line: LLVM 22 (rustc 1.95) crashes if it inlines the
/// one of `FpuChain` into the start of an energy-preserving run.
const INLINED: usize = 8;

/// [`solved`], not inlined.
#[inline(never)]
fn solved_apart<T: Real, const N: usize>(
    mass: &impl Matrix<N, T>,
    momentum: &SVector<T, N>,
) -> Result<SVector<T, N>, Failure> {
    solved(mass, momentum)
}

/// The v with `mass · v = momentum`; otherwise whether the matrix is singular or not finite.
#[inline]
fn solved<T: Real, const N: usize>(
    mass: &impl Matrix<N, T>,
    momentum: &SVector<T, N>,
) -> Result<SVector<T, N>, Failure> {
    linear::solve(mass, momentum).ok_or_else(|| {
        let is_finite = |entry: &T| entry.is_finite();
        if !momentum.iter().all(is_finite) {
            Failure::NonFinite
        } else if !mass.dense().iter().all(is_finite) {
            Failure::InfiniteJacobian
        } else {
            Failure::Singular
        }
    })
}

/// The equation `∂L/∂v(t, q, v) − p = 0` in v.
struct Momentum<'a, const N: usize, T, S, R, F> {
    system: &'a S,
    /// The same system over numbers with rounding-error bounds.
    rounded: &'a R,
    mass: F,
    t: T,
    q: &'a SVector<T, N>,
    p: &'a SVector<T, N>,
}

/// The equation at some velocity.
struct LegendreEvaluation<const N: usize, T, M> {
    residual: SVector<T, N>,
    mass: M,
    scale: SVector<T, N>,
}

impl<const N: usize, T: Real, S, R, M, F> Equations<T> for Momentum<'_, N, T, S, R, F>
where
    S: Lagrangian<N, T>,
    R: Lagrangian<N, Rounded>,
    M: Matrix<N, T>,
    F: Fn(&SVector<T, N>) -> M,
{
    type Unknowns = SVector<T, N>;
    type Evaluation = LegendreEvaluation<N, T, M>;

    fn at(&self, v: &SVector<T, N>) -> Self::Evaluation {
        let Self { t, q, p, .. } = self;
        let exact = |number: T| Rounded::exact(number.to_f64());
        let nearest = v.map(|number| Rounded::nearest(number.to_f64()));
        let rounded = self.rounded.momentum(exact(*t), &q.map(exact), &nearest) - p.map(exact);
        LegendreEvaluation {
            residual: self.system.momentum(*t, q, v) - *p,
            mass: (self.mass)(v),
            scale: rounded.map(|number| T::real(number.ulps())),
        }
    }

    fn roundings(&self, of: &Self::Evaluation, scales: &Self::Evaluation) -> [f64; 2] {
        [worst(&of.residual, &scales.scale), 0.0]
    }

    fn correction(&self, jacobian: &Self::Evaluation, residual: &Self::Evaluation) -> Result<SVector<T, N>, Failure> {
        solved(&jacobian.mass, &residual.residual)
    }
}

/// Sizes of initial velocities, for the case that Newton iteration from rest fails. Logarithms and roots are defined
/// for one sign only, and far from the root the iteration leaves their domain.
const SCALES: [f64; 9] = [1.0, 0.1, 10.0, 1e-2, 1e2, 1e-4, 1e4, 1e-8, 1e8];
/// Multiples of a velocity from which the search for another one starts, and the relative distance of different
/// velocities.
const PARTS: [f64; 3] = [1.0, 1.0 / 16.0, 16.0];
const APART: f64 = 1e-6;
/// Up to this number of coordinates the search tries all sign combinations; beyond, all signs at once and each alone.
const FEW: usize = 4;

/// The v with `∂L/∂v(t, q, v) = p`, and its mass matrix. `rounded` is the system over numbers with rounding-error
/// bounds.
///
/// Newton iteration starts from rest. If L has no value or slope there, it starts from p and from velocities of several
/// sizes and signs.
///
/// # Errors
/// [`StepError::Ambiguous`] if the search finds another velocity with the same momenta; [`StepError::Singular`],
/// [`StepError::NonFinite`] or [`StepError::NotConverged`] of the start from p if no start converges.
pub fn velocity<const N: usize, T: Real, M: Matrix<N, T>>(
    system: &impl Lagrangian<N, T>,
    rounded: &impl Lagrangian<N, Rounded>,
    mass: impl Fn(&SVector<T, N>) -> M,
    (t, q, p): (T, &SVector<T, N>, &SVector<T, N>),
) -> Result<SVector<T, N>, StepError> {
    let equations = Momentum { system, rounded, mass, t, q, p };
    let from = |guess: SVector<T, N>| newton::solve(&equations, guess).map(|root| root.u);
    if let Ok(v) = from(SVector::zeros()) {
        return Ok(v);
    }
    let sized = || SCALES.iter().flat_map(|scale| signed(SVector::repeat(T::real(*scale))));
    let v = from(*p).or_else(|failure| sized().find_map(|guess| from(guess).ok()).ok_or(failure));
    let v = v.map_err(|failure| failure.at(t.to_f64(), 0.0, "mass matrix"))?;
    // If L has no value at rest, it may have branches with the same momenta.
    let is_other = |guess| from(guess).is_ok_and(|other| (other - v).longest() > APART * v.longest());
    let mut guesses = PARTS.iter().flat_map(|part| signed(v * T::real(*part))).chain(sized());
    if guesses.any(is_other) { Err(StepError::Ambiguous { t: t.to_f64() }) } else { Ok(v) }
}

/// All vectors that differ from `v` in signs only.
fn signed<const N: usize, T: Real>(v: SVector<T, N>) -> impl Iterator<Item = SVector<T, N>> {
    let choices = if N <= FEW { 1 << N } else { N + 2 };
    (0..choices).map(move |choice: usize| {
        SVector::from_fn(|k, _| {
            let is_turned = if N <= FEW { choice >> k & 1 == 1 } else { choice == N + 1 || choice == k + 1 };
            if is_turned { -v[k] } else { v[k] }
        })
    })
}
