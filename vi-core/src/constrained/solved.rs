//! A solved step with constraints, and the contraction of its iteration.

use crate::node::Node;

/// Residuals up to this are rounding, also of linkages far from the origin, or their guess was close.
const NOISE: f64 = 1e4;

/// From unknowns with a residual up to this to the solution, the terms of the rows hardly change: their scales serve
/// until then.
pub(super) const NEARLY_SOLVED: f64 = 1e8;

/// A solved step; its unknowns are in the list of the caller.
pub(crate) struct Solved<const N: usize, M> {
    pub(crate) end: Node<N>,
    /// The impulse of the projection.
    pub(crate) mu: M,
    pub(crate) residual: f64,
    pub(crate) iterations: u32,
}

/// The largest contraction so far after two residuals in turn.
#[inline(always)]
pub(crate) fn contracted(contraction: f64, [before, after]: [f64; 2]) -> f64 {
    if after > NOISE { contraction.max(after / before) } else { contraction }
}
