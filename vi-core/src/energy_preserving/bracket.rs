//! The smallest forward step, where Newton's iteration has not found one.
//!
//! In: a node and the interval that led to it. Out: the root of `φ(h) = c(v(h), h)` with the smallest h > 0, where v(h)
//! solves the momentum equation, polished on all n + 1 equations; or why there is none. Since
//!
//! ```text
//! φ(0) = H − E = h² D/8        and        φ(h) = φ(0) − h² D/8        to leading order,
//! ```
//!
//! φ starts with the sign of D and the forward step is its first change of sign. Between two points of the search φ can
//! change its sign twice, where D is about to vanish: an extremum of φ that points to zero is followed to its bottom.

use super::equations::{self, EnergyStep, NoStep};
use super::interval::Last;
use crate::error::StepError;
use crate::method::bounds::RATIO;
use crate::momentum::newton as momentum;
use crate::newton::{Failure, roundings};
use crate::node::Node;
use crate::real::Scalar;
use crate::stepping::EnergyStepping;
use crate::vector::VelocityStep;
use nalgebra::SVector;

/// φ is looked at from `h_last/REACH` to `REACH · h_last`: wide enough to tell a step beyond the factor from none.
const REACH: f64 = RATIO * RATIO;
/// Points at which φ is looked at, in geometric progression: 1.15 from one to the next.
const POINTS: u32 = 32;
const BISECTIONS: u32 = 200;
/// Sections of an extremum: each leaves 0.62 of it.
const SECTIONS: u32 = 48;
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
    /// The point at `h`, v by Newton's iteration from `guess`.
    fn at<S: EnergyStepping<N, T>>(system: &S, node: &Node<N, T>, h: T, guess: SVector<T, N>) -> Result<Self, Failure> {
        let v = momentum::solve(system, node, h, guess)?.u;
        let equations = system.extended_system(node, h, &v);
        let scale = system.extended_rounding(node, h, &v).energy_residual;
        let size = roundings(equations.energy_residual, scale);
        let negative = equations.energy_residual.to_f64() < 0.0;
        let roundings = if negative { -size } else { size };
        if size.is_finite() { Ok(Self { v, h, roundings }) } else { Err(Failure::NonFinite) }
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

/// What the search for a change of sign comes to.
enum Search<const N: usize, T> {
    /// φ changes its sign between these.
    Change(Point<N, T>, Point<N, T>),
    /// It does not, as far as h reaches or the momentum equation has a solution.
    NoChange,
    /// It does not, up to an h at which the equations have no value.
    NonFinite(T),
}

/// The forward step with the smallest h.
///
/// # Errors
/// [`StepError::NoForwardStep`], [`StepError::DegenerateStep`], [`StepError::StepRatio`]; [`StepError::NotConverged`],
/// [`StepError::Singular`] and [`StepError::NonFinite`] where the momentum equation or D has no value at the node.
#[cold]
pub(crate) fn smallest_root<const N: usize, T: Scalar, S: EnergyStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    last: &Last<N, T>,
) -> Result<EnergyStep<N, T>, StepError> {
    let (t, h) = (node.t.to_f64(), last.h.to_f64());
    let v = momentum::velocity(system, node, [last.v, node.p])?;
    let energy = system.energy(node.t, &node.q, &v);
    let excess = (energy - node.energy - node.energy_low).to_f64();
    let density = system.step_density(node.t, &node.q, &v)?.to_f64();
    if !excess.is_finite() || !density.is_finite() {
        return Err(StepError::NonFinite { t, quantity: "energy or step density", expression: None });
    }
    let floor = T::EPSILON * (energy.to_f64().abs() + node.energy.to_f64().abs());
    let start = sign(excess / floor);
    let none = StepError::NoForwardStep { t, h, excess, density };
    if excess * density < 0.0 && start != 0 {
        return Err(none);
    }
    match first_change(system, node, last, v, start) {
        Search::Change(before, after) => polished(system, node, last, before, after),
        Search::NonFinite(at) if at <= last.h * T::real(RATIO) => {
            Err(StepError::NonFinite { t, quantity: "system of equations", expression: None })
        }
        _ if density == 0.0 && start == 0 => Err(StepError::DegenerateStep { t, h, density }),
        _ => Err(none),
    }
}

/// The first two neighbours between which φ changes its sign, from `start` at h = 0 with the velocity `v`.
fn first_change<const N: usize, T: Scalar, S: EnergyStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    last: &Last<N, T>,
    v: SVector<T, N>,
    start: i8,
) -> Search<N, T> {
    let factor = T::real((REACH * REACH).powf(1.0 / f64::from(POINTS)));
    let mut earlier = Point { v, h: T::zero(), roundings: f64::INFINITY.copysign(f64::from(start)) };
    let mut before = earlier;
    let mut known = start;
    let mut h = last.h / T::real(REACH);
    for _ in 0..=POINTS {
        // Where the momentum equation has no solution the curve ends, and with it the search.
        let point = match Point::at(system, node, h, before.v) {
            Ok(point) => point,
            Err(Failure::NonFinite) => return Search::NonFinite(h),
            Err(_) => return Search::NoChange,
        };
        if known * point.sign() < 0 {
            return Search::Change(before, point);
        }
        if point.sign() != 0 {
            known = point.sign();
        }
        let height = |point: &Point<N, T>| point.roundings * f64::from(known);
        if height(&before) <= height(&earlier)
            && height(&before) < height(&point)
            && let Some(bottom) = other_side(system, node, known, earlier, point)
        {
            return Search::Change(earlier, bottom);
        }
        (earlier, before) = (before, point);
        h *= factor;
    }
    Search::NoChange
}

/// A point between two at which φ does not have the sign `known`, by golden sections towards the extremum; none where φ
/// has that sign there as well.
fn other_side<const N: usize, T: Scalar, S: EnergyStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    known: i8,
    earlier: Point<N, T>,
    later: Point<N, T>,
) -> Option<Point<N, T>> {
    let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
    let at = |low: T, high: T, part: f64| Point::at(system, node, low + (high - low) * T::real(part), later.v).ok();
    let height = |point: &Point<N, T>| point.roundings * f64::from(known);
    let (mut low, mut high) = (earlier.h, later.h);
    let (mut left, mut right) = (at(low, high, 1.0 - golden)?, at(low, high, golden)?);
    for _ in 0..SECTIONS {
        if let Some(found) = [left, right].into_iter().find(|point| known * point.sign() < 0) {
            return Some(found);
        }
        if height(&left) < height(&right) {
            (high, right) = (right.h, left);
            left = at(low, high, 1.0 - golden)?;
        } else {
            (low, left) = (left.h, right);
            right = at(low, high, golden)?;
        }
    }
    None
}

/// The root between two points, by bisection and then on all equations.
fn polished<const N: usize, T: Scalar, S: EnergyStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    last: &Last<N, T>,
    mut before: Point<N, T>,
    mut after: Point<N, T>,
) -> Result<EnergyStep<N, T>, StepError> {
    let (t, previous) = (node.t.to_f64(), last.h.to_f64());
    let upper = after.sign();
    for _ in 0..BISECTIONS {
        let h = (before.h + after.h) * T::real(0.5);
        if h <= before.h || h >= after.h {
            break;
        }
        let Ok(middle) = Point::at(system, node, h, after.v) else { break };
        if middle.sign() == 0 {
            after = middle;
            break;
        }
        if middle.sign() == upper { after = middle } else { before = middle }
    }
    let beyond = |found: f64| found * RATIO < previous || found > previous * RATIO;
    let h = after.h.to_f64();
    let half = T::real(0.5);
    let trial = VelocityStep { v: after.v, h: after.h };
    let range = (after.h * half, after.h / half);
    let step = equations::solve(system, node, trial, range).map_err(|no_step| match no_step {
        NoStep::Degenerate { h, density } => StepError::DegenerateStep { t, h: h.to_f64(), density: density.to_f64() },
        NoStep::NoRoot(_) if beyond(h) => StepError::StepRatio { t, previous, found: h },
        NoStep::NoRoot(residuals) => {
            let residual = residuals.iter().last().unwrap_or(after.roundings.abs());
            StepError::NotConverged { t, h, iterations: BISECTIONS, residual, residuals }
        }
    })?;
    let found = step.h.to_f64();
    if beyond(found) { Err(StepError::StepRatio { t, previous, found }) } else { Ok(step) }
}
