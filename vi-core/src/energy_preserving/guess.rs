//! The trial of a search, if extrapolation has failed.
//!
//! In: a node and the last interval. Out: a trial `(v, h)`. v is extrapolated and improved by one Newton step on the
//! momentum equation at the last h. Then h follows from the step law, `h = h_last (D_last/D)^(1/3)`, within the factor
//! allowed, and v moves along `dv/dh` of the momentum equation. There is no prediction if D has changed its sign.

use super::equations::Elimination;
use super::interval::Last;
use crate::method::bounds::RATIO;
use crate::node::Node;
use crate::real::Scalar;
use crate::stepping::EnergyStepping;
use crate::vector::VelocityStep;
use nalgebra::SVector;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// The trial after `last`.
pub(crate) fn predict<const N: usize, T: Scalar, S: EnergyStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    last: &Last<N, T>,
) -> VelocityStep<N, T> {
    let extrapolated = VelocityStep { v: last.v + last.slope() * last.h, h: last.h };
    improve(system, node, last, extrapolated)
        .or_else(|| improve(system, node, last, VelocityStep { v: last.v, h: last.h }))
        .unwrap_or(extrapolated)
}

fn improve<const N: usize, T: Scalar, S: EnergyStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    last: &Last<N, T>,
    trial: VelocityStep<N, T>,
) -> Option<VelocityStep<N, T>> {
    let equations = system.extended_system(node, trial.h, &trial.v);
    let elimination = Elimination::finite(&equations)?;
    let ratio = last.density.to_f64() / elimination.density()?.to_f64();
    let factor = if ratio > 0.0 && ratio.is_finite() { ratio.cbrt().clamp(1.0 / RATIO, RATIO) } else { 1.0 };
    let h = last.h * T::real(factor);
    let v: SVector<T, N> = trial.v - elimination.residual - elimination.residual_dh * (h - trial.h);
    Some(VelocityStep { v, h })
}
