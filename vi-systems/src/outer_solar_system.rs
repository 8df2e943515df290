//! The Sun and the five outer planets.

use vi_core::lagrangian;

lagrangian! {
    /// Sun, Jupiter, Saturn, Uranus, Neptune and Pluto, in this order, with mutual attraction.
    ///
    /// Lengths in astronomical units, times in days, masses relative to the Sun's; the mass of the Sun includes the
    /// inner planets. Conserved: energy, momentum, angular momentum. Jupiter has a period of 4333 days, Pluto of 90
    /// 600. Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, section I.2.3 and table 2.2.
    pub struct OuterSolarSystem {
        const N = 6;
        /// Constant of gravitation.
        param g = 2.95912208286e-4;
        /// The Sun with the inner planets.
        param m0 = 1.00000597682;
        /// Jupiter.
        param m1 = 0.000954786104043;
        /// Saturn.
        param m2 = 0.000285583733151;
        /// Uranus.
        param m3 = 0.0000437273164546;
        /// Neptune.
        param m4 = 0.0000517759138449;
        /// Pluto.
        param m5 = 1 / 1.3e8;
        coord x[N], y[N], z[N];
        let m = [m0, m1, m2, m3, m4, m5];
        let r[i in 0..N] = [x[i], y[i], z[i]];
        let v2[i in 0..N] = dot(r[i]) * dot(r[i]);
        let d[j in 0..N - 1][i in j + 1..N] = norm(r[i] - r[j]);
        let pull[j in 0..N - 1] = m[j] * sum(i in j + 1..N, m[i] / d[j][i]);
        L = sum(i in 0..N, m[i] * v2[i]) / 2 + g * sum(j in 0..N - 1, pull[j]);
        discretize midpoint;
        check {
            x[1] = -3.5, y[1] = -3.8, z[1] = -1.6, dot(x[1]) = 0.0057, dot(y[1]) = -0.0041, dot(z[1]) = -0.0019,
            x[2] = 9.1, y[2] = -3.0, z[2] = -1.6, dot(x[2]) = 0.0017, dot(y[2]) = 0.0048, dot(z[2]) = 0.0019,
            x[3] = 8.3, y[3] = -16.3, z[3] = -7.3, dot(x[3]) = 0.0035, dot(y[3]) = 0.0014, dot(z[3]) = 0.0006,
            x[4] = 11.5, y[4] = -25.7, z[4] = -10.8, dot(x[4]) = 0.0029, dot(y[4]) = 0.0011, dot(z[4]) = 0.0004,
            x[5] = -15.5, y[5] = -25.2, z[5] = -3.2, dot(x[5]) = 0.0028, dot(y[5]) = -0.0017, dot(z[5]) = -0.0014;
            h = 10.0;
        }
    }
}

impl OuterSolarSystem {
    /// Positions of Sun and planets on 5 September 1994: all x, then all y, then all z, in astronomical units.
    #[rustfmt::skip]
    pub const POSITIONS: [f64; 18] = [
        0.0, -3.502_365_3, 9.075_531_4, 8.310_142_0, 11.470_766_6, -15.538_735_7,
        0.0, -3.816_984_7, -3.045_835_3, -16.290_108_6, -25.729_482_9, -25.222_559_4,
        0.0, -1.550_796_3, -1.648_370_8, -7.252_127_8, -10.816_945_6, -3.190_238_2,
    ];
    /// Velocities in the same order, in astronomical units per day.
    #[rustfmt::skip]
    pub const VELOCITIES: [f64; 18] = [
        0.0, 0.005_654_29, 0.001_683_18, 0.003_541_78, 0.002_889_30, 0.002_767_25,
        0.0, -0.004_124_90, 0.004_835_25, 0.001_371_02, 0.001_145_27, -0.001_707_02,
        0.0, -0.001_905_89, 0.001_924_62, 0.000_550_29, 0.000_396_77, -0.001_365_04,
    ];
}
