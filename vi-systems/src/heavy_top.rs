//! A top on a fixed point, by a unit quaternion.

use vi_core::lagrangian;

lagrangian! {
    /// Symmetric heavy top on a fixed point; the unit quaternion R turns the body into space, z upwards.
    ///
    /// The body's third axis is the axis of the top. Its components of the angular momentum about the vertical and about the
    /// axis are constant. A fast top with J3 ω3 above 2 √(J1 m g l) stands upright. Source: Goldstein, Classical Mechanics,
    /// section 5.7.
    pub struct HeavyTop {
        /// Mass.
        param m = 1.0;
        /// Distance of the centre of mass from the fixed point.
        param l = 0.3;
        /// Moment of inertia across the axis, about the fixed point.
        param J1 = 0.12;
        /// Moment of inertia about the axis.
        param J3 = 0.05;
        /// Gravity.
        param g = 9.81;
        rotation R;
        let ω = rate(R), axis = turn(R, [0, 0, 1]);
        L = (J1 * (ω[0]^2 + ω[1]^2) + J3 * ω[2]^2) / 2 - m * g * l * axis[2];
    }
}

impl HeavyTop {
    /// Coordinates and velocities of a start: inclined by 0.5 rad, and turning about its axis with 30 rad per unit of
    /// time.
    #[must_use]
    pub fn start(&self) -> ([f64; 4], [f64; 4]) {
        let (sin, cos) = 0.25_f64.sin_cos();
        // Ṙ = R ∘ (0, 0, 0, 30)/2.
        ([cos, sin, 0.0, 0.0], [0.0, 0.0, -15.0 * sin, 15.0 * cos])
    }
}
