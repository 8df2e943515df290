//! Three bodies in a plane.

use vi_core::lagrangian;

lagrangian! {
    /// Three bodies in a plane with mutual attraction; the constant of gravitation is 1.
    ///
    /// Conserved: energy, momentum, angular momentum. Equal masses can follow one another on a stable figure-eight
    /// orbit. Source: Chenciner and Montgomery, Annals of Mathematics 152 (2000) 881; initial state computed by C.
    /// Simó.
    pub struct ThreeBody {
        const N = 3;
        /// Mass of the first body.
        param m0 = 1.0;
        /// Mass of the second one.
        param m1 = 1.0;
        /// Mass of the third one.
        param m2 = 1.0;
        coord x[N], y[N];
        let m = [m0, m1, m2];
        let r[i in 0..N] = [x[i], y[i]];
        let v2[i in 0..N] = dot(r[i]) * dot(r[i]);
        let d[j in 0..N - 1][i in j + 1..N] = norm(r[i] - r[j]);
        L = sum(i in 0..N, m[i] * v2[i]) / 2 + sum(j in 0..N - 1, i in j + 1..N, m[j] * m[i] / d[j][i]);
        discretize midpoint;
        check {
            x[0] = 1.0, y[0] = -0.3, x[1] = -0.9, y[1] = 0.2, x[2] = 0.1, y[2] = 0.1,
            dot(x[0]) = 0.4, dot(y[0]) = 0.5, dot(x[1]) = 0.5, dot(y[1]) = 0.4, dot(x[2]) = -0.9, dot(y[2]) = -0.8;
            h = 0.01;
        }
    }
}
