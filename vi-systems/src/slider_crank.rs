//! A crank that drives a slider.

use vi_core::lagrangian;

lagrangian! {
    /// Slider-crank: a flywheel with its crank, a connecting rod, and a slider on a line through the axis.
    ///
    /// θ is the angle of the crank and φ that of the rod, both from this line; x is the position of the slider. The rod is
    /// uniform. The loop from the axis over the crank and the rod to the slider closes in two directions. There is no
    /// gravity; k is a spring between the slider and its outer end position. Source: Haug, Computer Aided Kinematics and
    /// Dynamics of Mechanical Systems, section 5.
    pub struct SliderCrank {
        /// Length of the crank.
        param r = 1.0;
        /// Length of the connecting rod.
        param l = 2.5;
        /// Moment of inertia of flywheel and crank about the axis.
        param J = 2.0;
        /// Mass of the rod.
        param m = 0.5;
        /// Mass of the slider.
        param M = 1.0;
        /// Stiffness of the spring.
        param k = 5.0;
        angle θ;
        coord φ, x;
        let centre = [r * cos(θ) + l * cos(φ) / 2, r * sin(θ) + l * sin(φ) / 2];
        let rod = m * dot(centre) * dot(centre) / 2 + m * l^2 * dot(φ)^2 / 24;
        L = J * dot(θ)^2 / 2 + rod + M * dot(x)^2 / 2 - k * (x - r - l)^2 / 2;
        constraint closed = [r * cos(θ) + l * cos(φ) - x, r * sin(θ) + l * sin(φ)];
    }
}

impl SliderCrank {
    /// Coordinates and velocities of a start: at the outer end position, with a crank of 4 rad per unit of time.
    #[must_use]
    pub fn start(&self) -> ([f64; 3], [f64; 3]) {
        ([0.0, 0.0, self.r + self.l], [4.0, -4.0 * self.r / self.l, 0.0])
    }
}
