//! The smallest forward step, where Newton's iteration has not found one.
//!
//! In: a node and the interval that led to it. Out: the root of `φ(h) = c(v(h), h)` with the smallest h > 0, where v(h)
//! solves the momentum equation, polished on all n + 1 equations; or why there is none. Since
//!
//! ```text
//! φ(0) = H − E = h² D/8        and        φ(h) = φ(0) − h² D/8        to leading order,
//! ```
//!
//! φ starts with the sign of D and the forward step is its first change of sign.

use super::newton::{self, Failure, Root, Trial};
use super::{Last, RATIO};
use crate::momentum;
use crate::{Node, Scalar, StepError, Stepping};
use nalgebra::SVector;

/// φ is looked at from `h_last/REACH` to `REACH · h_last`: wide enough to tell a step beyond the factor from none.
const REACH: f64 = RATIO * RATIO;
/// Points at which φ is looked at, in geometric progression: 1.15 from one to the next.
const POINTS: u32 = 32;
const BISECTIONS: u32 = 200;
/// Roundings within which φ counts as zero.
const NOISE: f64 = 16.0;

/// A point of the curve `(v(h), h)`, and φ there.
#[derive(Clone, Copy, Debug)]
struct Point<const N: usize, T> {
    v: SVector<T, N>,
    h: T,
    /// φ in roundings of its terms.
    roundings: f64,
}

impl<const N: usize, T: Scalar> Point<N, T> {
    /// The point at `h`, v sought from `guess`.
    fn at<S: Stepping<N, T>>(system: &S, node: &Node<N, T>, h: T, guess: SVector<T, N>) -> Option<Self> {
        let v = momentum::solve(system, node, h, guess).ok()?.v;
        let equations = system.extended_system(node, h, &v);
        let size = momentum::roundings(equations.energy_residual, equations.energy_magnitude);
        let negative = equations.energy_residual.to_f64() < 0.0;
        size.is_finite().then_some(Self { v, h, roundings: if negative { -size } else { size } })
    }

    /// −1 or 1; 0 where φ is not to be told from rounding.
    fn sign(&self) -> i8 {
        sign(self.roundings)
    }
}

/// −1 or 1; 0 at the rounding floor.
fn sign(roundings: f64) -> i8 {
    match roundings {
        x if x > NOISE => 1,
        x if x < -NOISE => -1,
        _ => 0,
    }
}

/// The forward step with the smallest h.
///
/// # Errors
/// [`StepError::NoForwardStep`], [`StepError::DegenerateStep`], [`StepError::StepRatio`]; [`StepError::NotConverged`],
/// [`StepError::Singular`] and [`StepError::NonFinite`] where the momentum equation or D has no value at the node.
#[cold]
pub(super) fn smallest_root<const N: usize, T: Scalar, S: Stepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    last: &Last<N, T>,
) -> Result<Root<N, T>, StepError> {
    let (t, h) = (node.t.to_f64(), last.h.to_f64());
    let v = momentum::velocity(system, node, [last.v, node.p])?;
    let energy = system.energy(node.t, &node.q, &v);
    let excess = (energy - node.energy - node.energy_low).to_f64();
    let density = system.step_density(node.t, &node.q, &v)?.to_f64();
    if !excess.is_finite() || !density.is_finite() {
        return Err(StepError::NonFinite { t, quantity: "energy or step density" });
    }
    let floor = T::EPSILON * (energy.to_f64().abs() + node.energy.to_f64().abs());
    let start = sign(excess / floor);
    let none = StepError::NoForwardStep { t, h, excess, density };
    if excess * density < 0.0 && start != 0 {
        return Err(none);
    }
    match first_change(system, node, last, v, start) {
        Some((before, after)) => polished(system, node, last, before, after),
        None if density == 0.0 && start == 0 => Err(StepError::DegenerateStep { t, h, density }),
        None => Err(none),
    }
}

/// The first two neighbours between which φ changes its sign, from `start` at h = 0 with the velocity `v`.
fn first_change<const N: usize, T: Scalar, S: Stepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    last: &Last<N, T>,
    v: SVector<T, N>,
    start: i8,
) -> Option<(Point<N, T>, Point<N, T>)> {
    let factor = T::real((REACH * REACH).powf(1.0 / f64::from(POINTS)));
    let mut before = Point { v, h: T::zero(), roundings: f64::INFINITY.copysign(f64::from(start)) };
    let mut known = start;
    let mut h = last.h / T::real(REACH);
    for _ in 0..=POINTS {
        // Where the momentum equation has no solution the curve ends, and with it the search.
        let point = Point::at(system, node, h, before.v)?;
        if known * point.sign() < 0 {
            return Some((before, point));
        }
        if point.sign() != 0 {
            known = point.sign();
        }
        before = point;
        h *= factor;
    }
    None
}

/// The root between two points, by bisection and then on all equations.
fn polished<const N: usize, T: Scalar, S: Stepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    last: &Last<N, T>,
    mut before: Point<N, T>,
    mut after: Point<N, T>,
) -> Result<Root<N, T>, StepError> {
    let (t, previous) = (node.t.to_f64(), last.h.to_f64());
    let upper = after.sign();
    for _ in 0..BISECTIONS {
        let h = (before.h + after.h) * T::real(0.5);
        if h <= before.h || h >= after.h {
            break;
        }
        let Some(middle) = Point::at(system, node, h, after.v) else { break };
        if middle.sign() == 0 {
            after = middle;
            break;
        }
        if middle.sign() == upper { after = middle } else { before = middle }
    }
    let h = after.h.to_f64();
    let half = T::real(0.5);
    let root = newton::solve(system, node, Trial { v: after.v, h: after.h }, (after.h * half, after.h / half));
    let root = root.map_err(|failure| match failure {
        Failure::Degenerate { h, density } => StepError::DegenerateStep { t, h: h.to_f64(), density: density.to_f64() },
        Failure::NoRoot => StepError::NotConverged { t, h, iterations: BISECTIONS, residual: after.roundings.abs() },
    })?;
    let found = root.h.to_f64();
    if found * RATIO >= previous && found <= previous * RATIO {
        Ok(root)
    } else {
        Err(StepError::StepRatio { t, previous, found })
    }
}
