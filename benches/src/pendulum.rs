//! Equal pendula, each hanging from the one above, in absolute angles: systems with a full mass matrix.

macro_rules! pendula {
    ($(#[$about:meta])* $module:ident, $name:ident, $count:literal) => {
        mod $module {
            vi_core::lagrangian! {
                $(#[$about])*
                ///
                /// θ = 0 hangs down; `vi-systems` has the same with four.
                pub struct $name {
                    const N = $count;
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

        pub use $module::$name;
    };
}

pendula!(
    /// Three pendula: the most degrees of freedom whose trajectories an ensemble moves side by side.
    triple, TriplePendulum, 3
);
pendula!(
    /// Ten pendula: the chain of rods in angles.
    chain, AngleChain, 10
);
