//! The trapezoidal rule: L and f at both ends with the velocity of the interval, order 2, symmetric, symplectic.
//!
//! ```text
//! L_d = (h/2) (L(t0, q0, v) + L(t1, q1, v))    f_d⁻ = (h/2) f(t0, q0, v)    f_d⁺ = (h/2) f(t1, q1, v)
//! g_d⁻ = −f_d⁻·v    g_d⁺ = −f_d⁺·v             with v = (q1−q0)/h
//! ```
//!
//! Explicit where L = v·Mv/2 − V(t, q) with constant M and f is free of v: Störmer–Verlet. The step density has another
//! form here, and the energy-preserving integrator fails with it: it is for fixed steps.

/// The rule in the form in which a user writes one.
pub(super) const RULE: &str = "
    Ld = h/2 * (L(t0, q0, (q1 - q0)/h) + L(t1, q1, (q1 - q0)/h));
    fd_minus = h/2 * f(t0, q0, (q1 - q0)/h);
    fd_plus = h/2 * f(t1, q1, (q1 - q0)/h);
    gd_minus = -h/2 * f(t0, q0, (q1 - q0)/h) * (q1 - q0)/h;
    gd_plus = -h/2 * f(t1, q1, (q1 - q0)/h) * (q1 - q0)/h;
";
