//! A bead on a hoop that turns about its vertical diameter.

use vi_core::lagrangian;

lagrangian! {
    /// Bead on a hoop of radius r that turns with the angular velocity Ω; θ = 0 is the bottom.
    ///
    /// The conserved quantity is the Jacobi integral v·L_v − L, not kinetic plus potential energy. Above Ω² = g/r the
    /// bottom is unstable and the bead rests at cos θ = g/(r Ω²). Source: Goldstein, Classical Mechanics, chapter 2.
    pub struct RotatingHoop {
        /// Mass.
        param m = 1.0;
        /// Radius of the hoop.
        param r = 1.0;
        /// Angular velocity of the hoop.
        param Ω = 4.0;
        /// Gravity.
        param g = 9.81;
        coord θ;
        L = m * r^2 * (dot(θ)^2 + Ω^2 * sin(θ)^2) / 2 + m * g * r * cos(θ);
        discretize midpoint;
        check { θ = 1.2, dot(θ) = 0.3; h = 0.02; }
    }
}
