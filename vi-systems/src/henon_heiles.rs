//! A star in the plane of a galaxy, near its circular orbit.

use vi_core::lagrangian;

lagrangian! {
    /// Hénon–Heiles system, V = (x² + y²)/2 + λ (x² y − y³/3).
    ///
    /// Bounded below E = 1/6 for λ = 1; regular at small energies, chaotic near the bound.
    /// Source: Hénon and Heiles, Astronomical Journal 69 (1964) 73.
    pub struct HenonHeiles {
        /// Strength of the coupling.
        param lambda = 1.0;
        coord x, y;
        L = (dot(x)^2 + dot(y)^2) / 2 - (x^2 + y^2) / 2 - lambda * (x^2 * y - y^3 / 3);
        discretize midpoint;
        check { x = 0.3, y = -0.2, dot(x) = 0.1, dot(y) = 0.25; h = 0.05; }
    }
}
