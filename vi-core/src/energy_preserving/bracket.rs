//! The smallest forward step, if Newton iteration has failed.
//!
//! In: a node and the last interval. Out: the root of `φ(h) = c(v(h), h)` with the smallest h > 0, or the reason why
//! there is none. v(h) solves the momentum equation, and Newton iteration on all n + 1 equations polishes the root.
//! Since
//!
//! ```text
//! φ(0) = H − E = h² D/8        and        φ(h) = φ(0) − h² D/8        to leading order,
//! ```
//!
//! φ starts with the sign of D, and the forward step is its first change of sign: a [`Search`] over the momentum
//! equation.

use super::equations::{self, EnergyStep, NoStep};
use super::interval::Last;
use crate::error::StepError;
use crate::method::bounds::RATIO;
use crate::method::length::{Search, Trial};
use crate::momentum::newton as momentum;
use crate::newton::roundings;
use crate::node::Node;
use crate::real::Scalar;
use crate::stepping::EnergyStepping;
use crate::vector::VelocityStep;
use nalgebra::SVector;

/// |φ| in roundings that counts as zero.
const NOISE: f64 = 16.0;

/// A point of the curve `(v(h), h)`, and φ there.
#[derive(Clone, Copy, Debug)]
struct CurvePoint<const N: usize, T> {
    v: SVector<T, N>,
    h: T,
    residual: f64,
    /// One rounding of φ.
    rounding: f64,
}

impl<const N: usize, T: Scalar> CurvePoint<N, T> {
    /// The point at `h`, with v by Newton iteration from `guess`.
    ///
    /// # Errors
    /// The reason why v(h) does not exist; [`StepError::NonFinite`] if φ is not finite.
    fn at<S: EnergyStepping<N, T>>(
        system: &S,
        node: &Node<N, T>,
        h: T,
        guess: SVector<T, N>,
    ) -> Result<Self, StepError> {
        let t = node.t.to_f64();
        let matrix = "derivative of the momentum equation";
        let v = momentum::solve(system, node, h, guess).map_err(|failure| failure.at(t, h.to_f64(), matrix))?.u;
        let residual = system.extended_system(node, h, &v).energy_residual;
        let scale = system.extended_rounding(node, h, &v).energy_residual;
        if roundings(residual, scale).is_finite() {
            Ok(Self { v, h, residual: residual.to_f64(), rounding: scale.to_f64() })
        } else {
            Err(StepError::NonFinite { t, quantity: "system of equations", expression: None })
        }
    }
}

impl<const N: usize, T: Scalar> Trial for CurvePoint<N, T> {
    fn h(&self) -> f64 {
        self.h.to_f64()
    }

    fn residual(&self) -> f64 {
        self.residual
    }

    fn size(&self) -> f64 {
        self.rounding
    }

    fn roundings(&self) -> f64 {
        roundings(self.residual, self.rounding) * (f64::EPSILON / T::EPSILON)
    }
}

/// The forward step with the smallest h.
///
/// # Errors
/// [`StepError::NoForwardStep`], [`StepError::DegenerateStep`], [`StepError::StepRatio`]; [`StepError::NotConverged`],
/// [`StepError::Singular`] and [`StepError::NonFinite`] if the momentum equation or D has no value at the node.
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
    let none = StepError::NoForwardStep { t, h, excess, density };
    if excess.abs() <= NOISE * floor {
        return Err(if density == 0.0 { StepError::DegenerateStep { t, h, density } } else { none });
    }
    if excess * density < 0.0 {
        return Err(none);
    }
    let search = Search {
        solve: &|h, near| CurvePoint::at(system, node, T::real(h), near.map_or(v, |point: &CurvePoint<N, T>| point.v)),
        // The polished root is checked on all equations.
        is_rounding: &|_| Ok(true),
        t,
        predicted: h,
        last: h,
        ratio: RATIO,
        excess,
        noise: NOISE,
        slope: 2.0,
        order: 2.0,
    };
    match search.smallest() {
        Ok(Some(point)) => polished(system, node, last, &point),
        Err(failure @ (StepError::NonFinite { .. } | StepError::StepRatio { .. })) => Err(failure),
        // The curve ends if the momentum equation has no solution.
        _ => Err(none),
    }
}

/// Polishes a point of the curve on all equations.
fn polished<const N: usize, T: Scalar, S: EnergyStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    last: &Last<N, T>,
    point: &CurvePoint<N, T>,
) -> Result<EnergyStep<N, T>, StepError> {
    let (t, previous) = (node.t.to_f64(), last.h.to_f64());
    let beyond = |found: f64| found * RATIO < previous || found > previous * RATIO;
    let h = point.h.to_f64();
    let half = T::real(0.5);
    let trial = VelocityStep { v: point.v, h: point.h };
    let range = (point.h * half, point.h / half);
    let step = equations::solve(system, node, trial, range).map_err(|no_step| match no_step {
        NoStep::Degenerate { h, density } => StepError::DegenerateStep { t, h: h.to_f64(), density: density.to_f64() },
        NoStep::NoRoot(_) if beyond(h) => StepError::StepRatio { t, previous, found: h },
        NoStep::NoRoot(residuals) => {
            let iterations = u32::try_from(residuals.iter().count()).unwrap_or(u32::MAX);
            let residual = residuals.iter().last().unwrap_or(point.roundings());
            StepError::NotConverged { t, h, iterations, residual, residuals, turn: 0.0 }
        }
    })?;
    let found = step.h.to_f64();
    if beyond(found) { Err(StepError::StepRatio { t, previous, found }) } else { Ok(step) }
}
