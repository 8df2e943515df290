//! Systems that only the charts need, in their simplest form, by the midpoint and by the trapezoidal rule.

use vi_core::lagrangian;
use vi_core::rules::{By, Trapezoidal};

lagrangian! {
    /// Oscillator of frequency 1 and damping ratio c/2; by the trapezoidal rule stepped as central differences.
    pub(super) struct Oscillator {
        /// Damping: the force −c v.
        param c = 0.0;
        coord x;
        L = dot(x)^2 / 2 - x^2 / 2;
        force x = -c * dot(x);
        discretize midpoint, trapezoidal;
    }
}

lagrangian! {
    /// Oscillator of frequency 1 with forces of second and third order, `V = x²/2 + x³/3 + x⁴/4`: a single well.
    pub(super) struct Bent {
        coord x;
        L = dot(x)^2 / 2 - x^2 / 2 - x^3 / 3 - x^4 / 4;
        discretize midpoint, trapezoidal;
    }
}

lagrangian! {
    /// Mass 1 on a spring of length 1 and stiffness k, under gravity 1: its stretch, and its angle from the lowest
    /// point.
    pub(super) struct SpringPendulum {
        /// Stiffness.
        param k = 100.0;
        coord s, θ;
        L = (dot(s)^2 + (1 + s)^2 * dot(θ)^2) / 2 - k * s^2 / 2 + (1 + s) * cos(θ);
        discretize midpoint, trapezoidal;
    }
}

/// A system by the trapezoidal rule.
pub(super) fn trapezoidal<S>(system: S) -> By<S, Trapezoidal> {
    By::new(system, Trapezoidal)
}
