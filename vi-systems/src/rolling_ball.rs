//! A ball that rolls on a turntable.

use vi_core::lagrangian;

lagrangian! {
    /// Homogeneous ball that rolls without slip on a horizontal table, which turns with the rate Ω; Ω = 0 is a plane.
    ///
    /// (x, y) is the centre of the ball, and the unit quaternion R its orientation. The centre runs in a circle with the
    /// rate 2 Ω/7; on a plane that rests it runs straight. Source: Neimark and Fufaev, Dynamics of Nonholonomic Systems,
    /// chapter III, section 2; J. A. Burns, Ball rolling on a turntable, Am. J. Phys. 49 (1981).
    pub struct RollingBall {
        /// Mass.
        param m = 1.0;
        /// Radius.
        param r = 0.5;
        /// Rate of the table.
        param Ω = 2.0;
        coord x, y;
        rotation R;
        let ω = spin(R);
        L = m * (dot(x)^2 + dot(y)^2) / 2 + m * r^2 * (ω * ω) / 5;
        constraint roll = [dot(x) - r * ω[1] + Ω * y, dot(y) + r * ω[0] - Ω * x];
    }
}

impl RollingBall {
    /// Coordinates and velocities of a start: at (1, 0) with the velocity (0, 1/2).
    #[must_use]
    pub fn start(&self) -> ([f64; 6], [f64; 6]) {
        // The spin about x, ω = (Ω x − y')/r; with R = 1 the velocity of R is (0, ω)/2.
        ([1.0, 0.0, 1.0, 0.0, 0.0, 0.0], [0.0, 0.5, 0.0, (self.Ω - 0.5) / (2.0 * self.r), 0.0, 0.0])
    }
}
