//! Branches of roots of the momentum equation.

/// Selects a root of the momentum equation if there are several.
///
/// With `L = v·Mv/2 − V(q)` and the midpoint rule the Jacobian is `M + (h²/4) ∇²V`, and the root is unique for `h <
/// 2/√(−V''_min/m)`, so that the choice makes no difference. Beyond, roots appear and vanish in pairs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub(crate) enum Branch {
    /// The root that Newton iteration reaches from the velocity of the last step, or extrapolated from the last steps,
    /// if it is connected with h = 0; otherwise the root that is, or
    /// [`StepError::TooLong`](crate::error::StepError::TooLong).
    #[default]
    Nearest,
    /// The root that is connected with h = 0: there it is the velocity of p. It depends on the state alone. The solver
    /// follows it in sixteen parts or more, at 20 to 40 times the cost. If the branch turns back before h, it returns
    /// [`StepError::TooLong`](crate::error::StepError::TooLong).
    Connected,
}
