//! A failure with the expression that is not finite.
//!
//! In: a [`StepError::NonFinite`] and the step that was tried. Out: the same with the part of L or f that has no value there, where the
//! system says which.

use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::node::Node;
use crate::real::Scalar;
use nalgebra::SVector;

impl StepError {
    /// With the expression that is not finite where the step `(v, h)` from `node` was tried, if that is the error and the
    /// system says so.
    #[cold]
    pub(crate) fn explained<const N: usize, T: Scalar, S: Lagrangian<N, T>>(
        self,
        system: &S,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> Self {
        let Self::NonFinite { t, quantity, expression: None } = self else { return self };
        // The middle of the step, the node, and the middle of the longest step that is looked at.
        let lengths = [h, T::zero(), h * T::real(3.0)];
        let mut places = lengths.into_iter().map(|h| node.midpoint(h, v));
        let expression = places.find_map(|(t, q)| system.non_finite(t, &q, v));
        Self::NonFinite { t, quantity, expression }
    }
}
