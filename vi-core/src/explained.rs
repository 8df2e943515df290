//! Adds the expression that is not finite to a failure.
//!
//! For a [`StepError::NonFinite`] and the attempted step, this module asks the system for the part of L or f without a
//! value there.

use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::node::Node;
use crate::real::Scalar;
use nalgebra::SVector;

impl StepError {
    /// Adds the expression that is not finite at the attempted step `(v, h)` from `node`, if the system can name it.
    #[cold]
    pub(crate) fn explained<const N: usize, T: Scalar, S: Lagrangian<N, T>>(
        self,
        system: &S,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> Self {
        let Self::NonFinite { t, quantity, expression: None } = self else { return self };
        // The middle of the step, the node, and the middle of the longest trial step.
        let lengths = [h, T::zero(), h * T::real(3.0)];
        let mut places = lengths.into_iter().map(|h| node.midpoint(h, v));
        let expression = places.find_map(|(t, q)| system.non_finite(t, &q, v));
        Self::NonFinite { t, quantity, expression }
    }
}
