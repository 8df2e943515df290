//! The midpoint rule: L and f in the middle of the interval, order 2, symmetric, symplectic.
//!
//! ```text
//! L_d = h L(t̄, q̄, v)    f_d^± = (h/2) f    g_d^± = −(h/2) f·v    with t̄ = (t0+t1)/2, q̄ = (q0+q1)/2, v = (q1−q0)/h
//! ```

/// The rule in the form in which a user writes one.
pub(super) const RULE: &str = "
    Ld = h * L((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h);
    fd_minus = h/2 * f((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h);
    fd_plus = h/2 * f((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h);
    gd_minus = -h/2 * f((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h) * (q1 - q0)/h;
    gd_plus = -h/2 * f((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h) * (q1 - q0)/h;
";
