//! A planet about a fixed sun.

use vi_core::lagrangian;

lagrangian! {
    /// Plane Kepler problem, a = −μ r/|r|³.
    ///
    /// Conserved: energy, angular momentum x v_y − y v_x. Started at the pericentre of an orbit of eccentricity e, the
    /// energy-preserving integrator runs for e ≤ 0.785 and cannot run for e ≥ √(5/8).
    /// Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, section I.2.
    pub struct Kepler {
        /// Gravitational parameter.
        param mu = 1.0;
        coord x, y;
        let r = sqrt(x^2 + y^2);
        L = (dot(x)^2 + dot(y)^2) / 2 + mu / r;
        time_scale = r^(3/2);
        discretize midpoint;
        check { x = 0.6, y = 0.1, dot(x) = -0.2, dot(y) = 1.4; h = 0.02; }
    }
}
