//! Adds the reason to a failure: the function without a value, or the expression that is not finite.
//!
//! For the attempted step, this module searches the system for a table whose argument has left its range, for a Rust
//! function that is not finite, and for the part of L or f without a value. An iteration that reaches the end of a
//! table may fail with another error, so the module also searches after some other errors.

use crate::error::StepError;
use crate::lagrangian::{Lagrangian, Undefined};
use crate::node::Node;
use crate::real::Scalar;
use nalgebra::SVector;

impl StepError {
    /// Adds the function or the expression that is not finite at the attempted step `(v, h)` from `node`, if the system
    /// can name it.
    #[cold]
    pub(crate) fn explained<const N: usize, T: Scalar, S: Lagrangian<N, T>>(
        self,
        system: &S,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> Self {
        if !self.may_be_undefined() {
            return self;
        }
        if let Some(Undefined { function, argument, range }) = undefined(system, node, h, v) {
            return Self::Undefined { t: node.t.to_f64(), function, argument, range };
        }
        let Self::NonFinite { t, quantity, expression: None } = self else { return self };
        // The middle of the step, the node, and the middle of the longest trial step.
        let lengths = [h, T::zero(), h * T::real(3.0)];
        let mut places = lengths.into_iter().map(|h| node.midpoint(h, v));
        let expression = places.find_map(|(t, q)| system.non_finite(t, &q, v));
        Self::NonFinite { t, quantity, expression }
    }

    /// Adds the function or the expression that is not finite at a step of the length h with the velocity of `node`, if
    /// it has one.
    #[cold]
    pub(crate) fn explained_at<const N: usize, T: Scalar, S: Lagrangian<N, T>>(
        self,
        system: &S,
        node: &Node<N, T>,
        h: T,
    ) -> Self {
        if !self.may_be_undefined() || node.check_finite(node.t).is_err() {
            return self;
        }
        let flow = system.flow(node.t, &node.q, &node.p);
        self.explained(system, node, h, &flow.map_or_else(|_| SVector::zeros(), |flow| flow.v))
    }

    /// Whether a function without a value may be the reason.
    fn may_be_undefined(&self) -> bool {
        match self {
            Self::NonFinite { expression: None, .. }
            | Self::NotConverged { .. }
            | Self::TooLong { .. }
            | Self::StagesNotConverged { .. }
            | Self::NoForwardStep { .. }
            | Self::NoForwardGaussStep { .. }
            | Self::DegenerateStep { .. }
            | Self::StepRatio { .. }
            | Self::Singular { .. } => true,
            Self::TimeScale { g, .. } => !g.is_finite(),
            Self::Tolerance { estimate, .. } => !estimate.is_finite(),
            _ => false,
        }
    }
}

/// The function without a value at the node, in the step of the length h, or a little past it, as iterations overshoot.
/// Velocities are constant, or have the acceleration of the node.
fn undefined<const N: usize, T: Scalar, S: Lagrangian<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> Option<Undefined> {
    let acceleration = system.acceleration(node.t, &node.q, v).unwrap_or_else(|_| SVector::zeros());
    let is_finite = acceleration.iter().all(|entry| entry.is_finite());
    let by_acceleration = if is_finite { acceleration } else { SVector::zeros() };
    [1.0, 0.0, 2.0, 3.0].into_iter().find_map(|part| {
        let twice = h * T::real(part);
        let (t, q) = node.midpoint(twice, v);
        let changed = v + by_acceleration * (twice * T::real(0.5));
        system.undefined(t, &q, v).or_else(|| {
            let (t, q) = node.midpoint(twice, &((v + changed) * T::real(0.5)));
            system.undefined(t, &q, &changed)
        })
    })
}
