//! A charge in a magnetic field.

use vi_core::lagrangian;

lagrangian! {
    /// Charged particle in the field B = (0, 0, b + s x), with the vector potential A = (0, b x + s x²/2, 0) and an
    /// electric potential κ z²/2 that confines it to the plane.
    ///
    /// L depends on the velocity beyond the kinetic energy: `L_qv` is not zero. y is cyclic: p_y = m ẏ + e A_y is
    /// conserved bit for bit. For s = 0 the projection is a circle of radius m v/(e b) with angular velocity e b/m.
    /// Source: Jackson, Classical Electrodynamics, section 12.1.
    pub struct ChargedParticle {
        /// Mass.
        param m = 1.0;
        /// Charge.
        param e = 1.0;
        /// Field at x = 0.
        param b = 1.0;
        /// Slope of the field.
        param s = 0.1;
        /// Strength of the trap.
        param kappa = 1.0;
        coord x, y, z;
        let potential = b * x + s * x^2 / 2;
        L = m * (dot(x)^2 + dot(y)^2 + dot(z)^2) / 2 + e * potential * dot(y) - e * kappa * z^2 / 2;
        discretize midpoint;
        check { x = 0.2, y = 0.1, z = 0.5, dot(x) = 0.7, dot(y) = 0.4, dot(z) = 0.1; h = 0.05; }
    }
}
