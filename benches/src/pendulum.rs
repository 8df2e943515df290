//! Three degrees of freedom with a full mass matrix: the largest system whose trajectories an ensemble moves side by side.

mod triple {
    vi_core::lagrangian! {
        /// Three equal pendula, each hanging from the one above, in absolute angles; θ = 0 hangs down.
        ///
        /// `vi-systems` has the same with four.
        pub struct TriplePendulum {
            const N = 3;
            /// Each mass.
            param m = 1.0;
            /// Length of each rod.
            param l = 1.0;
            /// Gravity.
            param g = 9.81;
            coord θ[N];
            let alone = sum(i in 0..N, (N - i) * dot(θ[i])^2) / 2;
            let pairs = sum(i in 1..N, (N - i) * sum(j in 0..i, dot(θ[i]) * dot(θ[j]) * cos(θ[i] - θ[j])));
            L = m * l^2 * (alone + pairs) + m * g * l * sum(i in 0..N, (N - i) * cos(θ[i]));
            discretize midpoint;
        }
    }
}

pub use triple::TriplePendulum;
