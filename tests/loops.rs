//! A system large enough for loops in its functions: the generated checks, which are independent of loops.

use vi_core::lagrangian;

lagrangian! {
    /// Coupled pendula in a row, all except the first driven and damped.
    struct Row {
        const N = 40;
        param m = 1.2, k = 0.7;
        coord q[N];
        let springs = k * sum(i in 1..N, (q[i] - q[i - 1])^2 / 2 + (q[i] - q[i - 1])^4 / 7);
        L = m * sum(i in 0..N, dot(q[i])^2) / 2 - springs + sum(i in 0..N - 1, cos(q[i]) * q[i + 1]);
        force q[i in 1..N] = k * cos(q[i]) - dot(q[i]) / 9;
        discretize midpoint;
        check { q[i in 0..N] = sin(i + 1) / 3, dot(q[i in 0..N]) = cos(2 * i) / 5; h = 0.01; }
    }
}
