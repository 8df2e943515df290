//! A mechanical system, and the command to study it.

use vi_core::lagrangian;

lagrangian! {
    /// A mass on a spring that swings.
    pub struct SpringPendulum {
        /// Mass, stiffness, length at rest, gravity.
        param m = 1.0, k = 40.0, l = 1.0, g = 9.81;
        coord r, θ;
        L = m * (dot(r)^2 + r^2 * dot(θ)^2) / 2 + m * g * r * cos(θ) - k * (r - l)^2 / 2;
        discretize midpoint;
        // `cargo test` proves what is generated.
        check { r = 1.2, θ = 0.5; h = 0.01; }
    }
}

vi_lab::main! {
    sources: ["main.rs"],
    systems: [
        SpringPendulum { about: "a mass on a spring that swings", q: [1.2, 0.8], v: [0.0, 0.0], h: 0.01 },
    ],
}
