//! Newton's iteration on the momentum equation, the step h given.
//!
//! In: a node, h and a guess of v. Out: the v with `−D2 L_d − f_d⁻ = p0` to the rounding floor: each residual is at most
//! one rounding, or stopped decreasing within [`FLOOR`] of them. A rounding is what evaluating the row loses at most, by running
//! error analysis, with v the nearest number to the root ([`FixedStepping::momentum_rounding`]).
//! A Newton step that does not lessen the residual is halved; an absolute tolerance is used nowhere.
//! AFTER IT the matrix A at the root has an inverse.

use crate::error::Residuals;
use crate::error::StepError;
use crate::linear::{self, Matrix};
use crate::node::Node;
use crate::real::Scalar;
use crate::stepping::{FixedStepping, MomentumEquation};
use nalgebra::{SMatrix, SVector};

/// Residual, in roundings, below which an iteration that no longer gains is at the floor.
pub(crate) const FLOOR: f64 = 4.0;
const ITERATIONS: u32 = 40;
const HALVINGS: u32 = 12;

/// A velocity that solves the momentum equation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Solution<const N: usize, T> {
    pub(crate) v: SVector<T, N>,
    pub(crate) iterations: u32,
}

/// Why no velocity was found.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Failure {
    Singular,
    NonFinite,
    Stalled { iterations: u32, residual: f64 },
}

impl Failure {
    /// The error that this is, for the step h from time t.
    pub(crate) fn at(self, t: f64, h: f64, matrix: &'static str, residuals: Residuals) -> StepError {
        match self {
            Self::Singular => StepError::Singular { t, matrix },
            Self::NonFinite => StepError::NonFinite { t, quantity: "momentum equation", expression: None },
            Self::Stalled { iterations, residual } => StepError::NotConverged { t, h, iterations, residual, residuals },
        }
    }
}

/// Whether a row is solved: its residual is one rounding, or small and no longer halved by a Newton step, which close to
/// a root squares what is not rounding.
#[inline]
pub(crate) fn is_at_floor(residual: f64, before: f64) -> bool {
    residual <= 1.0 || (residual <= FLOOR && before <= FLOOR && residual >= 0.5 * before)
}

/// `|residual|` in units of one ulp of `scale`. Not a number where either is not finite.
#[inline]
pub(crate) fn roundings<T: Scalar>(residual: T, scale: T) -> f64 {
    let (residual, scale) = (residual.to_f64().abs(), scale.to_f64());
    if residual == 0.0 && scale.is_finite() {
        return 0.0;
    }
    // ∞/∞ is not a number, and x/∞ shall be none either: a scale that overflows proves nothing about x.
    if scale.is_finite() { residual / scale / T::EPSILON } else { f64::NAN }
}

/// The larger of two numbers; not a number where either is not.
#[inline]
pub(crate) fn worse(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

/// The largest residual in units of one ulp of its scale.
#[inline]
pub(crate) fn worst<T: Scalar, const N: usize>(residual: &SVector<T, N>, scale: &SVector<T, N>) -> f64 {
    residual.iter().zip(scale.iter()).fold(0.0, |worst, (r, s)| worse(roundings(*r, *s), worst))
}

/// The momentum equation at a trial velocity, with what its rounding is measured in.
#[derive(Clone, Copy, Debug)]
struct Trial<const N: usize, T, J> {
    equation: MomentumEquation<N, T, J>,
    scale: SVector<T, N>,
}

impl<const N: usize, T: Scalar, J: Matrix<N, T>> Trial<N, T, J> {
    fn at<S: FixedStepping<N, T, Jacobian = J>>(system: &S, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> Self {
        Self { equation: system.momentum_equation(node, h, v), scale: system.momentum_rounding(node, h, v) }
    }

    /// The largest residual, in roundings.
    fn residual(&self) -> f64 {
        worst(&self.equation.residual, &self.scale)
    }

    /// The Newton step that would follow from `residual`.
    fn step(&self, residual: &SVector<T, N>) -> Option<SVector<T, N>> {
        linear::solve(&self.equation.jacobian, residual)
    }

    /// Why there is none.
    #[cold]
    fn without_step(&self) -> Failure {
        let is_finite = self.equation.jacobian.dense().iter().all(|entry| entry.is_finite());
        if is_finite { Failure::Singular } else { Failure::NonFinite }
    }

    /// The same with pivoting.
    #[cold]
    fn pivoted(&self, residual: &SVector<T, N>) -> Option<SVector<T, N>> {
        linear::solve::<_, N, 1>(&self.equation.jacobian.dense() as &SMatrix<T, N, N>, residual)
    }
}

/// The largest residual of the momentum equation at `(v, h)`, in roundings.
pub(crate) fn residual<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> f64 {
    Trial::at(system, node, h, v).residual()
}

/// The velocity that solves the momentum equation at `h`, from the guess `v`.
pub(crate) fn solve<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    v: SVector<T, N>,
) -> Result<Solution<N, T>, Failure> {
    observed(system, node, h, v, &mut |_| ())
}

/// As [`solve`], with `observe` told the residual before each iteration, in roundings. Behind a pointer, that there is one copy of
/// this long function.
pub(crate) fn observed<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    mut v: SVector<T, N>,
    observe: &mut dyn FnMut(f64),
) -> Result<Solution<N, T>, Failure> {
    let mut last = Trial::at(system, node, h, &v);
    let mut iterations = 0;
    loop {
        let residual = last.residual();
        observe(residual);
        if !residual.is_finite() {
            return Err(Failure::NonFinite);
        }
        let mut step = last.step(&last.equation.residual).ok_or_else(|| last.without_step())?;
        if residual <= 1.0 {
            return Ok(Solution { v, iterations });
        }
        if iterations == ITERATIONS {
            return Err(Failure::Stalled { iterations, residual });
        }
        iterations += 1;
        let (mut halvings, mut pivoted) = (0, false);
        loop {
            let trial_v = v - step;
            let trial = Trial::at(system, node, h, &trial_v);
            // Measured in the scale at v: one far away would make any residual look small.
            if worst(&trial.equation.residual, &last.scale) < residual && trial.residual().is_finite() {
                (v, last) = (trial_v, trial);
                break;
            }
            if residual <= FLOOR {
                return Ok(Solution { v, iterations });
            }
            if halvings == 0 && contracts(&last, &trial, &step) {
                (v, last) = (trial_v, trial);
                break;
            }
            if halvings == HALVINGS {
                return Err(Failure::Stalled { iterations, residual });
            }
            // A pivot may have been lost, before the step is too long.
            match last.pivoted(&last.equation.residual) {
                Some(other) if !pivoted && other != step => (step, pivoted) = (other, true),
                _ => {
                    halvings += 1;
                    step *= T::real(0.5);
                    pivoted = true;
                }
            }
        }
    }
}

/// Whether the step that would follow, by the same matrix, is less than half as long: Newton's own measure (Deuflhard,
/// Newton Methods for Nonlinear Problems, section 3.3). It judges where a row has no terms at v, as at rest at the bottom
/// of a potential, and so no scale to measure its residual in.
#[cold]
fn contracts<const N: usize, T: Scalar, J: Matrix<N, T>>(
    last: &Trial<N, T, J>,
    trial: &Trial<N, T, J>,
    step: &SVector<T, N>,
) -> bool {
    let longest = |step: &SVector<T, N>| step.iter().fold(0.0, |longest, entry| worse(entry.abs().to_f64(), longest));
    trial.residual().is_finite()
        && last.step(&trial.equation.residual).is_some_and(|next| longest(&next) < 0.5 * longest(step))
}

/// The velocity that belongs to the momenta of a node: the root at h = 0.
///
/// # Errors
/// [`StepError::Singular`], [`StepError::NonFinite`] or [`StepError::NotConverged`] from the last guess.
pub(crate) fn velocity<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    guesses: [SVector<T, N>; 2],
) -> Result<SVector<T, N>, StepError> {
    let [first, second] = guesses;
    if let Ok(solution) = solve(system, node, T::zero(), first) {
        return Ok(solution.v);
    }
    let mut residuals = Residuals::new();
    observed(system, node, T::zero(), second, &mut |residual| residuals.push(residual))
        .map(|solution| solution.v)
        .map_err(|failure| failure.at(node.t.to_f64(), 0.0, "mass matrix", residuals))
}
