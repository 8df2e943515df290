//! A charge without mass.

use vi_core::lagrangian;

lagrangian! {
    /// Charge without mass in the plane, in the field B (1 + k (x² + y²)) and the potential E (cos x + sin w y).
    ///
    /// This is the limit of a strong field. L is linear in the velocities: the state is the position, and the momentum
    /// of y is the vector potential. The charge drifts along lines of equal potential with the velocity |∇φ|/B.
    /// Source: Kraus, Projected variational integrators for degenerate Lagrangian systems (2017), arXiv:1708.07356.
    pub struct MasslessParticle {
        /// Field at the origin.
        param B = 1.0;
        /// Growth of the field.
        param k = 0.25;
        /// Strength of the potential.
        param E = 1.0;
        /// Wave number of the potential along y.
        param w = 1.0;
        coord x, y;
        let A = B * (x + k * x^3 / 3 + k * x * y^2);
        L = A * dot(y) - E * (cos(x) + sin(w * y));
        check { x = 0.5, y = 0.25; h = 0.1; }
    }
}
