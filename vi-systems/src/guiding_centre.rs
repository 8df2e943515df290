//! The guiding centre of a charge in a torus.

use vi_core::lagrangian;

lagrangian! {
    /// Guiding centre of a charge in the field of a tokamak with circular surfaces, without its gyration.
    ///
    /// Coordinates are the poloidal angle θ, the toroidal angle φ, the distance r from the axis of the tube, and the
    /// velocity u along the field; mass and charge are one. L = (A + u b)·(θ', φ') − H is linear in the velocities.
    /// H = u²/2 + μ B, B is the curl of A, and b has no component along r. The momentum of φ is conserved. From
    /// θ = φ = 0, r = 0.25, u = 0.005 the centre is trapped on a banana orbit of period 2840; with u = 0.03 it goes
    /// around.
    /// Sources: Littlejohn, Journal of Plasma Physics 29 (1983) 111; Ellison, Finn, Burby, Kraus, Qin, Tang, Physics of
    /// Plasmas 25 (2018) 052502.
    pub struct GuidingCentre {
        /// Toroidal field on the axis of the tube.
        param B0 = 1.0;
        /// Large radius of the torus.
        param R0 = 1.0;
        /// Safety factor near r = 0: turns about the torus in one turn about the tube.
        param safety = 2.0;
        /// Magnetic moment.
        param mu = 1e-4;
        coord θ, φ, r, u;
        let R = R0 + r * cos(θ);
        let toroidal = B0 * (1 - r * cos(θ) / R0), poloidal = B0 * r / (safety * R);
        let B = hypot(toroidal, poloidal);
        let A_θ = B0 * (r^2 / 2 - r^3 * cos(θ) / (3 * R0)), A_φ = -B0 * r^2 / (2 * safety);
        L = (A_θ + u * r * poloidal / B) * dot(θ) + (A_φ + u * R * toroidal / B) * dot(φ) - u^2 / 2 - mu * B;
        check { θ = 0.3, φ = 0.1, r = 0.25, u = 0.004; h = 20.0; }
    }
}
