//! A mass on a rod, in Cartesian coordinates.

use vi_core::lagrangian;

lagrangian! {
    /// Plane pendulum in Cartesian coordinates, y upwards; the rod is a constraint.
    ///
    /// The reaction −2 Λ l is the tension of the rod. The same motion in its angle is `Pendulum`. Source: Hairer,
    /// Lubich, Wanner, Geometric Numerical Integration, section VII.1.
    pub struct RodPendulum {
        /// Mass.
        param m = 1.0;
        /// Length of the rod.
        param l = 1.0;
        /// Gravity.
        param g = 9.81;
        coord x, y;
        L = m * (dot(x)^2 + dot(y)^2) / 2 - m * g * y;
        constraint rod = x^2 + y^2 - l^2;
    }
}

impl RodPendulum {
    /// Coordinates and velocities of a start: at rest, 1 rad from the vertical.
    #[must_use]
    pub fn start(&self) -> ([f64; 2], [f64; 2]) {
        let (sin, cos) = 1.0_f64.sin_cos();
        ([self.l * sin, -self.l * cos], [0.0; 2])
    }
}
