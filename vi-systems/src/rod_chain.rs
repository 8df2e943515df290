//! A chain of rods, in Cartesian coordinates.

use vi_core::lagrangian;

lagrangian! {
    /// Ten equal masses on a chain of ten massless rods, in Cartesian coordinates; r[i] = (x, y) of mass i, y upwards.
    ///
    /// The mass matrix is constant, and each rod shares a mass with its two neighbours only. In angles the mass matrix is full:
    /// `NPendulum`. Source: Landau and Lifshitz, Mechanics, section 5, continued.
    pub struct RodChain {
        const N = 10;
        /// Each mass.
        param m = 1.0;
        /// Length of each rod.
        param l = 1.0;
        /// Gravity.
        param g = 9.81;
        coord r[N][2];
        L = sum(i in 0..N, m * dot(r[i]) * dot(r[i]) / 2 - m * g * r[i][1]);
        constraint rod[0] = r[0] * r[0] - l^2;
        constraint rod[i in 1..N] = (r[i] - r[i - 1]) * (r[i] - r[i - 1]) - l^2;
    }
}

impl RodChain {
    /// Coordinates and velocities of a start: at rest, straight, 1 rad from the vertical.
    #[must_use]
    pub fn start(&self) -> ([f64; 20], [f64; 20]) {
        let (sin, cos) = 1.0_f64.sin_cos();
        let direction = [self.l * sin, -self.l * cos];
        let mut q = [0.0; 20];
        for index in 0..20 {
            let before = if index < 2 { 0.0 } else { q[index - 2] };
            q[index] = before + direction[index % 2];
        }
        (q, [0.0; 20])
    }
}
