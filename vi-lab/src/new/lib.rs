//! Mechanical systems.

use vi_core::lagrangian;

lagrangian! {
    /// A mass on a spring that swings about a pivot.
    pub struct SpringPendulum {
        /// Mass.
        param m = 1.0;
        /// Stiffness of the spring.
        param k = 40.0;
        /// Its length at rest.
        param l = 1.0;
        /// Gravity.
        param g = 9.81;
        coord r, θ;
        L = m * (dot(r)^2 + r^2 * dot(θ)^2) / 2 + m * g * r * cos(θ) - k * (r - l)^2 / 2;
        discretize midpoint;
        // `cargo test` checks the generated code at this state.
        check { r = 1.2, θ = 0.5; h = 0.01; }
    }
}
