//! Ten point masses on a chain of rods, in Cartesian coordinates with constraints; `pendulum` has them in angles.

mod cartesian {
    vi_core::lagrangian! {
        /// The chain with constraints: r[i] is the position of mass i.
        pub struct RodChain {
            const N = 10;
            /// Each mass.
            param m = 1.0;
            /// Length of each rod.
            param l = 1.0;
            /// Gravity.
            param g = 9.81;
            coord r[N][2];
            constraint rod[0] = r[0] * r[0] - l^2;
            constraint rod[i in 1..N] = (r[i] - r[i - 1]) * (r[i] - r[i - 1]) - l^2;
            L = sum(i in 0..N, m * dot(r[i]) * dot(r[i]) / 2 - m * g * r[i][1]);
        }
    }
}

pub use cartesian::RodChain;

/// Positions and velocities of a straight chain of rods of length 1 that turns about its upper end: (0.6, −0.8) is its
/// direction.
#[must_use]
pub fn straight<const N: usize>() -> [[f64; N]; 2] {
    let mut start = [[0.0; N]; 2];
    for (i, place) in (1_u32..).zip(0..N / 2) {
        let distance = f64::from(i);
        start[0][2 * place..2 * place + 2].copy_from_slice(&[0.6 * distance, -0.8 * distance]);
        start[1][2 * place..2 * place + 2].copy_from_slice(&[0.08 * distance, 0.06 * distance]);
    }
    start
}
