//! A disk that rolls on a plane.

use vi_core::lagrangian;

lagrangian! {
    /// Thin disk that rolls on a horizontal plane without slip, as a coin.
    ///
    /// (x, y) is the point of contact, φ the heading, θ the inclination of the disk from the plane (π/2 stands upright),
    /// ψ the rolling angle. The energy and two further quantities are constant. Source: Neimark and Fufaev, Dynamics of
    /// Nonholonomic Systems, chapter II, section 2.
    pub struct RollingDisk {
        /// Mass.
        param m = 1.0;
        /// Radius.
        param r = 1.0;
        /// Gravity.
        param g = 9.81;
        coord x, y, φ, θ, ψ;
        let centre = [x - r * cos(θ) * sin(φ), y + r * cos(θ) * cos(φ), r * sin(θ)];
        let across = dot(θ)^2 + dot(φ)^2 * sin(θ)^2, along = dot(ψ) + dot(φ) * cos(θ);
        L = m * (dot(centre) * dot(centre) / 2 + r^2 * across / 8 + r^2 * along^2 / 4 - g * centre[2]);
        constraint roll = [dot(x) + r * cos(φ) * dot(ψ), dot(y) + r * sin(φ) * dot(ψ)];
    }
}

impl RollingDisk {
    /// Coordinates and velocities of a start: inclined by 1.2 rad, rolling in the direction x with 3 rad per unit of time.
    #[must_use]
    pub fn start(&self) -> ([f64; 5], [f64; 5]) {
        ([0.0, 0.0, 0.0, 1.2, 0.0], [3.0 * self.r, 0.0, 0.5, 0.0, -3.0])
    }
}
