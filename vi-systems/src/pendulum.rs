//! A mass on a rod.

use vi_core::lagrangian;

lagrangian! {
    /// Plane pendulum, m l² a = −m g l sin θ; θ = 0 hangs down.
    ///
    /// Librations run with the energy-preserving integrator; rotations end when the step density vanishes. Source:
    /// Goldstein, Classical Mechanics, chapter 1.
    pub struct Pendulum {
        /// Mass.
        param m = 1.0;
        /// Length of the rod.
        param l = 1.0;
        /// Gravity.
        param g = 1.0;
        coord θ;
        L = m * l^2 * dot(θ)^2 / 2 + m * g * l * cos(θ);
        discretize midpoint;
        check { θ = 1.2, dot(θ) = 0.4; h = 0.05; }
    }
}
