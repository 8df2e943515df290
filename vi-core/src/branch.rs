//! Which root of the momentum equation is a step.

/// Which root of the momentum equation is a step, where it has several.
///
/// With `L = v·Mv/2 − V(q)` and the midpoint rule the derivative of the equation is `M + (h²/4) ∇²V`: the root is the only
/// one for `h < 2/√(−V''_min/m)`, and then this makes no difference. Beyond, roots appear and vanish in pairs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub(crate) enum Branch {
    /// The root that Newton's iteration reaches from the velocity of the last step, or extrapolated over the last ones. It
    /// depends on the steps before, and on nothing else.
    #[default]
    Nearest,
    /// The root that is connected with h = 0, where it is the velocity that belongs to p: it depends on the state alone.
    /// The step is followed in sixteen parts or more, at 20 to 40 times the effort. Where the branch ends before h,
    /// [`StepError::NotConverged`](crate::error::StepError::NotConverged).
    Connected,
}
