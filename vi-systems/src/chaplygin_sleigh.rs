//! A sleigh on a blade.

use vi_core::lagrangian;

lagrangian! {
    /// Chaplygin sleigh on a horizontal plane: a blade at (x, y) in the direction θ does not move sideways.
    ///
    /// The centre of mass is at the distance a in front of the blade. Turning drives the sleigh forwards, u' = a ω² with the
    /// speed u and the rate ω = θ', and dies out. The energy is constant. Source: Neimark and Fufaev, Dynamics of
    /// Nonholonomic Systems, chapter II, section 6.
    pub struct ChaplyginSleigh {
        /// Mass.
        param m = 1.0;
        /// Distance of the centre of mass from the blade.
        param a = 0.5;
        /// Moment of inertia about the centre of mass.
        param J = 1.0;
        coord x, y;
        angle θ;
        let centre = [x + a * cos(θ), y + a * sin(θ)];
        L = m * dot(centre) * dot(centre) / 2 + J * dot(θ)^2 / 2;
        constraint blade = dot(x) * sin(θ) - dot(y) * cos(θ);
    }
}

impl ChaplyginSleigh {
    /// Coordinates and velocities of a start: in the direction x with the speed 1, turning with 2 rad per unit of time.
    #[must_use]
    pub fn start(&self) -> ([f64; 3], [f64; 3]) {
        ([0.0; 3], [1.0, 0.0, 2.0])
    }
}
