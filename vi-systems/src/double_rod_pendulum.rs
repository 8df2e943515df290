//! Two masses on two rods, in Cartesian coordinates.

use vi_core::lagrangian;

lagrangian! {
    /// Double pendulum in Cartesian coordinates, y upwards; each rod is a constraint.
    ///
    /// The same motion in angles is `DoublePendulum`. Here the mass matrix is constant. Source: Landau and Lifshitz,
    /// Mechanics, section 5.
    pub struct DoubleRodPendulum {
        /// Upper mass.
        param m1 = 1.0;
        /// Lower mass.
        param m2 = 1.0;
        /// Length of the upper rod.
        param l1 = 1.0;
        /// Length of the lower rod.
        param l2 = 1.0;
        /// Gravity.
        param g = 9.81;
        coord x1, y1, x2, y2;
        let kinetic = m1 * (dot(x1)^2 + dot(y1)^2) / 2 + m2 * (dot(x2)^2 + dot(y2)^2) / 2;
        L = kinetic - m1 * g * y1 - m2 * g * y2;
        constraint upper = x1^2 + y1^2 - l1^2;
        constraint lower = (x2 - x1)^2 + (y2 - y1)^2 - l2^2;
    }
}

impl DoubleRodPendulum {
    /// Coordinates and velocities of a start: at rest, both rods 1 rad from the vertical.
    #[must_use]
    pub fn start(&self) -> ([f64; 4], [f64; 4]) {
        let (sin, cos) = 1.0_f64.sin_cos();
        let [x, y] = [self.l1 * sin, -self.l1 * cos];
        ([x, y, x + self.l2 * sin, y - self.l2 * cos], [0.0; 4])
    }
}
