//! A chain of pendula, each hanging from the one above.

use vi_core::lagrangian;

lagrangian! {
    /// Four equal pendula, each hanging from the one above, in absolute angles; θ = 0 hangs down.
    ///
    /// Link i carries all masses from i on. So its square has the weight N − i, and the pair (i, j) with j < i has the
    /// weight N − i times the cosine of the angle between the links. The mass matrix is full and depends on the
    /// configuration; the motion is chaotic at large angles. For N = 2 it is the double pendulum with equal masses and
    /// rods. Source: Landau and Lifshitz, Mechanics, section 5, continued.
    pub struct NPendulum {
        const N = 4;
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
        check { θ[i in 0..N] = 0.4 - i / 5; h = 0.005; }
    }
}
