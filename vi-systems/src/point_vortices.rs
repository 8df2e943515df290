//! Vortices of a plane.

use vi_core::lagrangian;

lagrangian! {
    /// Four point vortices of an ideal fluid in the plane: each moves with the velocity that the others cause.
    ///
    /// L is linear in the velocities: the state is the positions, and the momentum of x is Γ y. A vortex of strength
    /// Γ > 0 turns the others counterclockwise, with the velocity Γ/(2π r). Steps preserve Σ Γ x, Σ Γ y and
    /// Σ Γ (x² + y²), so that motions are bounded if all strengths have the same sign. Four vortices move chaotically.
    /// Source: Aref, Annual Review of Fluid Mechanics 15 (1983) 345.
    pub struct PointVortices {
        /// Strengths.
        param strength[4] = [1.0, 0.75, 1.25, 0.5];
        coord x[4], y[4];
        let pairs = sum(a in 0..4, b in 0..a, strength[a] * strength[b] * ln((x[a] - x[b])^2 + (y[a] - y[b])^2));
        L = sum(a in 0..4, strength[a] * y[a] * dot(x[a])) + pairs / (4 * pi);
        check {
            x[0] = 1.0, x[1] = -0.5, x[2] = 0.25, x[3] = -1.25, y[0] = 0.1, y[1] = 0.75, y[2] = -1.0, y[3] = -0.5;
            h = 0.1;
        }
    }
}
