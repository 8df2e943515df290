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
        let v2[i in 0..N] = dot(x[i])^2 + dot(y[i])^2;
        let r0[i in 1..N] = sqrt((x[i] - x[0])^2 + (y[i] - y[0])^2);
        let r1[i in 2..N] = sqrt((x[i] - x[1])^2 + (y[i] - y[1])^2);
        L = (m0 * v2[0] + m1 * v2[1] + m2 * v2[2]) / 2 + m0 * m1 / r0[1] + m0 * m2 / r0[2] + m1 * m2 / r1[2];
        discretize midpoint;
        check {
            x[0] = 1.0, y[0] = -0.3, x[1] = -0.9, y[1] = 0.2, x[2] = 0.1, y[2] = 0.1,
            dot(x[0]) = 0.4, dot(y[0]) = 0.5, dot(x[1]) = 0.5, dot(y[1]) = 0.4, dot(x[2]) = -0.9, dot(y[2]) = -0.8;
            h = 0.01;
        }
    }
}
