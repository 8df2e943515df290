//! A closed loop of four bars.

use vi_core::lagrangian;

lagrangian! {
    /// Four-bar linkage: crank, coupler and rocker between two pivots at the distance d; y upwards.
    ///
    /// The coordinates are those of the joints: (x1, y1) between crank and coupler, (x2, y2) between coupler and
    /// rocker. The pivots are (0, 0) and (d, 0). A uniform bar of mass m between points with velocities u and w has the
    /// kinetic energy m (u·u + u·w + w·w)/6. The crank turns fully if the shortest and the longest bar, d included, are
    /// together no longer than the other two (Grashof). Source: García de Jalón and Bayo, Kinematic and Dynamic
    /// Simulation of Multibody Systems, section 2.
    pub struct FourBar {
        /// Length of the crank.
        param a = 1.0;
        /// Length of the coupler.
        param b = 3.0;
        /// Length of the rocker.
        param c = 2.5;
        /// Distance of the pivots.
        param d = 3.0;
        /// Mass per length of each bar.
        param density = 1.0;
        /// Gravity.
        param g = 9.81;
        coord x1, y1, x2, y2;
        let squares = (a + b) * (dot(x1)^2 + dot(y1)^2) + (b + c) * (dot(x2)^2 + dot(y2)^2);
        let products = b * (dot(x1) * dot(x2) + dot(y1) * dot(y2));
        L = density * (squares + products) / 6 - density * g * ((a + b) * y1 + (b + c) * y2) / 2;
        constraint crank = x1^2 + y1^2 - a^2;
        constraint coupler = (x2 - x1)^2 + (y2 - y1)^2 - b^2;
        constraint rocker = (x2 - d)^2 + y2^2 - c^2;
    }
}

impl FourBar {
    /// Coordinates and velocities of a start: the crank points up and turns with 6 rad per unit of time, the other
    /// joint is above the line of the pivots. Lengths that do not close the loop there give a state off the
    /// constraints, which every run refuses.
    #[must_use]
    pub fn start(&self) -> ([f64; 4], [f64; 4]) {
        let Self { a, b, c, d, .. } = *self;
        // The second joint from the first: b² = along² + across² on the line to the second pivot.
        let distance = a.hypot(d);
        let along = (b * b - c * c + distance * distance) / (2.0 * distance);
        let across = (b * b - along * along).max(0.0).sqrt();
        let [x, y] = [d / distance, -a / distance];
        let [u, w] = [along * x - across * y, along * y + across * x];
        let (x2, y2) = (u, a + w);
        // Its velocity (v, z): coupler u (v − v1) + w z = 0, rocker (x2 − d) v + y2 z = 0.
        let v1 = -6.0 * a;
        let determinant = u * y2 - w * (x2 - d);
        let [v, z] = [u * v1 * y2 / determinant, -u * v1 * (x2 - d) / determinant];
        ([0.0, a, x2, y2], [v1, 0.0, v, z])
    }
}
