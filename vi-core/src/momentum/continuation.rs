//! Continuation of the root of the momentum equation from h = 0: there it is the velocity of p.
//!
//! In: a node, a step h and a guess of the velocity at h = 0. Out: the root v(h) on the branch that is connected with
//! h = 0. The parts of h double after a success and halve after a failure. The branch ends at a singular Jacobian:
//! then no part is small enough and the step has no such root. At the turning point the determinant changes its sign.
//!
//! [`is_connected`] shows with five evaluations that a root is on this branch, if the step is not long.

use super::newton;
use crate::error::{Residuals, StepError};
use crate::linear::{self, Matrix};
use crate::newton::Failure;
use crate::node::Node;
use crate::real::Scalar;
use crate::stepping::{FixedStepping, MomentumEquation};
use crate::vector::length_squared;
use nalgebra::SVector;

/// Parameters of the continuation: the parts of h, and the allowed distance between two roots.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    largest_part: f64,
    /// Smallest part of h before the continuation fails.
    least_part: f64,
    /// Newton iterations above the rounding floor from one root to the next; more may lead to another branch.
    iterations: u32,
    /// Whether the determinant must keep its sign.
    signed: bool,
}

impl Pace {
    /// Finds a root after Newton iteration from the guess has failed. May change the branch.
    const RESCUE: Self = Self { largest_part: 1.0, least_part: 1.0 / 64.0, iterations: u32::MAX, signed: false };
    /// Stays on the branch.
    pub(crate) const CLOSE: Self =
        Self { largest_part: 1.0 / 16.0, least_part: 1.0 / 1_073_741_824.0, iterations: 3, signed: true };
}

/// A velocity, and the number of iterations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BranchPoint<const N: usize, T> {
    pub(crate) v: SVector<T, N>,
    pub(crate) iterations: u32,
}

/// The root that Newton iteration reaches from `guess`; if it fails, the root at `h` on the branch connected with h =
/// 0, where v is near `start`.
///
/// # Errors
/// As [`solve`].
#[cold]
pub(crate) fn nearest<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    guess: SVector<T, N>,
    start: SVector<T, N>,
) -> Result<BranchPoint<N, T>, StepError> {
    match newton::solve(system, node, h, guess) {
        Ok(root) => Ok(BranchPoint { v: root.u, iterations: root.iterations }),
        Err(_) => solve(system, node, h, start, Pace::RESCUE),
    }
}

/// Margin of the length to try if a branch ends: close to its end a root is hardly determined.
const MARGIN: f64 = 0.8;
/// Most solved parts of a continuation that stays on the branch.
const SOLVES: u32 = 256;
/// Ratio of the last slope of a branch to its mean from which it counts as vertical.
const STEEP: f64 = 30.0;
/// Bounds of the change of the Jacobian in a step, in masses, for a root that needs no continuation.
const STIFFNESS: [f64; 2] = [-0.3, 1.0];
/// Largest distance of the roots of shorter steps from the line to such a root, in changes of the velocity.
const BEND: f64 = 0.25;
/// The shorter steps.
const SHORTER: [f64; 3] = [0.25, 0.5, 0.75];

/// Whether the roots of shorter steps are close to the line from the velocity of p to this root, and the Jacobian on this
/// line is close to the mass matrix: then the root is connected with h = 0. A root of a long step may fail although it
/// is connected.
///
/// Lengths of velocities are those of the kinetic energy, so that coordinates may have different units.
#[cold]
fn is_connected<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> bool {
    let MomentumEquation { residual, jacobian: mass } = system.momentum_equation(node, T::zero(), v);
    // The change from v to the velocity of p.
    let Some(change) = linear::solve(&mass, &residual) else { return false };
    let size = |matrix: &S::Jacobian, u: &SVector<T, N>| matrix.multiply(u).dot(u);
    let moved = size(&mass, &change);
    let rounding = size(&mass, v) * T::real(T::EPSILON);
    // Along the change of the velocity and along each coordinate.
    let is_regular = |matrix: &S::Jacobian, part: f64| {
        let [least, most] = STIFFNESS.map(|stiffness| T::real(1.0 + part * stiffness));
        let is_within = |along: T, mass: T| mass * least <= along && along <= mass * most;
        is_within(size(matrix, &change), moved) && (0..N).all(|i| is_within(matrix.entry(i, i), mass.entry(i, i)))
    };
    let is_on_line = |part: f64| {
        let line = v - change * T::real(1.0 - part);
        let MomentumEquation { residual, jacobian } = system.momentum_equation(node, h * T::real(part), &line);
        let off = linear::solve(&jacobian, &residual);
        is_regular(&jacobian, part)
            && off.is_some_and(|off| size(&mass, &off) <= moved * T::real(BEND * BEND) + rounding)
    };
    if !SHORTER.into_iter().all(is_on_line) {
        return false;
    }
    let ended = system.momentum_equation(node, h, v).jacobian;
    let sign = |matrix: &S::Jacobian| linear::determinant_sign(&matrix.dense());
    is_regular(&ended, 1.0) && sign(&ended) == sign(&mass)
}

/// Parts of a length at which a constant Jacobian is evaluated.
const PARTS: u32 = 32;
/// Bisections of the part from which on it is singular.
const BISECTIONS: u32 = 60;

/// Checks the length h of all steps with a constant Jacobian: it is regular for shorter steps.
///
/// # Errors
/// [`StepError::TooLong`].
pub(crate) fn check_linear<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
) -> Result<(), StepError> {
    if !system.has_constant_jacobian() {
        return Ok(());
    }
    let jacobian =
        |part: f64| system.momentum_equation(&Node::zeros(), h * T::real(part), &SVector::zeros()).jacobian.dense();
    let mass = jacobian(0.0);
    let sign = linear::determinant_sign(&mass);
    let is_regular = |part: f64| {
        let at = jacobian(part);
        // If two eigenvalues change their signs at once, the determinant does not, but the diagonal of a symmetric
        // matrix does.
        let is_negative = |i: usize| at[(i, i)] * mass[(i, i)] < T::zero();
        linear::determinant_sign(&at) == sign && (at != at.transpose() || !(0..N).any(is_negative))
    };
    let width = f64::from(PARTS).recip();
    let mut parts = (1..=PARTS).map(|part| width * f64::from(part));
    let Some(mut singular) = parts.find(|part| !is_regular(*part)) else { return Ok(()) };
    let mut regular = singular - width;
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (regular + singular);
        if is_regular(middle) { regular = middle } else { singular = middle }
    }
    let (t, h) = (node.t.to_f64(), h.to_f64());
    Err(StepError::TooLong { t, h, longest: (MARGIN * regular * h).abs() })
}

/// The root that is connected with h = 0, if it is not `v`.
///
/// # Errors
/// [`StepError::TooLong`] if there is none.
#[cold]
pub(crate) fn connected<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> Result<Option<BranchPoint<N, T>>, StepError> {
    if system.has_constant_jacobian() || is_connected(system, node, h, v) {
        return Ok(None);
    }
    match solve(system, node, h, *v, Pace::CLOSE) {
        Ok(found) if !are_one(&found.v, v) => Ok(Some(found)),
        Err(failure @ StepError::TooLong { .. }) => Err(failure),
        // The continuation finds the same root, or ends without a turn of the branch: a force jumps, or the momenta
        // have no velocity.
        _ => Ok(None),
    }
}

/// Whether two roots agree to half of the digits: rounding moves the root of a nearly singular equation that far.
fn are_one<const N: usize, T: Scalar>(one: &SVector<T, N>, other: &SVector<T, N>) -> bool {
    let size = length_squared(one) + length_squared(other);
    length_squared(&(one - other)) <= size * T::real(T::EPSILON)
}

/// The root at `h` on the branch connected with h = 0.
///
/// # Errors
/// [`StepError::TooLong`] if the pace stays on the branch and it turns back before h; [`StepError::NotConverged`] if no
/// root is found; [`StepError::NonFinite`], [`StepError::Singular`].
#[cold]
pub(crate) fn solve<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    guess: SVector<T, N>,
    pace: Pace,
) -> Result<BranchPoint<N, T>, StepError> {
    let mut v = newton::velocity(system, node, [guess, node.p])?;
    let sign = |h: T, v: &SVector<T, N>| {
        if pace.signed { linear::determinant_sign(&system.momentum_equation(node, h, v).jacobian.dense()) } else { 1 }
    };
    let (start, forward) = (v, sign(T::zero(), &v));
    // Shorter parts would not change h.
    let least_part = pace.least_part.max(16.0 * T::EPSILON);
    let (mut reached, mut part, mut spent) = (0.0, pace.largest_part, 0);
    // The change of v over the last part, and this part.
    let mut last = (SVector::zeros(), 1.0);
    let too_long = |reached: f64| {
        let (t, h) = (node.t.to_f64(), h.to_f64());
        StepError::TooLong { t, h, longest: (MARGIN * reached * h).abs() }
    };
    let mut solves = 0;
    while reached < 1.0 {
        solves += 1;
        if pace.signed && solves > SOLVES && reached > 0.0 {
            return Err(too_long(reached));
        }
        let target = f64::min(reached + part, 1.0);
        let at = h * T::real(target);
        let guess = v + last.0 * T::real((target - reached) / last.1);
        let root = newton::solve(system, node, at, guess);
        // The root is close to its guess, or the root of half of the part is close to the middle.
        let stays = |next: &SVector<T, N>| {
            let allowed = bend([&start, &v, next], (target - reached) / target);
            let is_far = |root: &SVector<T, N>, guess: &SVector<T, N>| length_squared(&(root - guess)) > allowed;
            let middle = || newton::solve(system, node, h * T::real(0.5 * (reached + target)), v);
            let is_between = |middle: &SVector<T, N>| !is_far(middle, &((v + next) * T::real(0.5)));
            !is_far(next, &guess)
                || middle().is_ok_and(|root| root.above_floor <= pace.iterations && is_between(&root.u))
        };
        match root {
            Ok(root)
                if root.above_floor <= pace.iterations
                    && sign(at, &root.u) == forward
                    && (!pace.signed || stays(&root.u)) =>
            {
                last = (root.u - v, target - reached);
                (v, reached, part) = (root.u, target, pace.largest_part.min(2.0 * part));
                spent += root.iterations;
            }
            _ if part > least_part => part /= 2.0,
            _ if pace.signed && is_vertical(&(last.0 * T::real(reached / last.1)), &(v - start)) => {
                return Err(too_long(reached));
            }
            _ => {
                // The residual of the last root in the whole step, or the residual of the stalled iteration.
                let residual = newton::residual(system, node, h, &v);
                let failure = match root {
                    Ok(root) => Failure::Stalled { iterations: spent, residual, residuals: root.residuals },
                    // The Jacobian becomes singular toward the last root: the branch ends.
                    Err(Failure::Singular) if residual.is_finite() => {
                        Failure::Stalled { iterations: spent, residual, residuals: Residuals::new() }
                    }
                    Err(Failure::Stalled { iterations, residual, residuals }) => {
                        Failure::Stalled { iterations: spent + iterations, residual, residuals }
                    }
                    Err(Failure::InfiniteJacobian) if residual.is_finite() => Failure::InfiniteJacobian,
                    Err(_) => Failure::NonFinite,
                };
                return Err(failure.at(node.t.to_f64(), h.to_f64(), "derivative of the momentum equation"));
            }
        }
    }
    Ok(BranchPoint { v, iterations: spent })
}

/// Whether a branch turns back: there it is vertical over h. At a jump of a force it ends otherwise, and steps may take
/// the root past the jump.
fn is_vertical<const N: usize, T: Scalar>(slope: &SVector<T, N>, mean: &SVector<T, N>) -> bool {
    length_squared(slope) > length_squared(mean) * T::real(STEEP * STEEP)
}

/// The square of the allowed distance of a root from a line, in a part of a branch with this start, the root before and
/// the next one. A jump to another branch does not get shorter with the part, and has no root in its middle.
fn bend<const N: usize, T: Scalar>([start, before, next]: [&SVector<T, N>; 3], part: f64) -> T {
    // At an extremum of v only the mean slope is not zero. Roots that differ by rounding are the same.
    let mean = length_squared(&(next - start)) * T::real(part * part);
    (length_squared(&(next - before)) + mean) * T::real(BEND * BEND) + length_squared(next) * T::real(T::EPSILON)
}
