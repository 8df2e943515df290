//! A pendulum with two angles.

use vi_core::lagrangian;

lagrangian! {
    /// Spherical pendulum; θ from the vertical down, φ about it.
    ///
    /// φ is cyclic: its momentum m l² sin²θ φ̇ is conserved bit for bit. The coordinates are singular at θ = 0 and π.
    /// Source: Goldstein, Classical Mechanics, chapter 1.
    pub struct SphericalPendulum {
        /// Mass.
        param m = 1.0;
        /// Length of the rod.
        param l = 1.0;
        /// Gravity.
        param g = 9.81;
        coord θ, φ;
        L = m * l^2 * (dot(θ)^2 + sin(θ)^2 * dot(φ)^2) / 2 + m * g * l * cos(θ);
        discretize midpoint;
        check { θ = 1.0, φ = 0.3, dot(θ) = 0.2, dot(φ) = 1.5; h = 0.02; }
    }
}
