//! Andrews' squeezing mechanism.

use vi_core::{State, lagrangian};

lagrangian! {
    /// Andrews' squeezer: seven plane bodies in three closed loops, driven by a constant torque against a spring.
    ///
    /// The angles and the parameters are those of the benchmark, in SI units: lengths d, e, f, r, s, t, u, z, masses m,
    /// moments of inertia I about the centres of mass, the fixed points A, B, and C of the spring. The motor turns the
    /// crank of 7 mm by `beta`. Source: Hairer and Wanner, Solving Ordinary Differential Equations II, section VII.7; IVP test
    /// set, problem `andrews`.
    pub struct AndrewsSqueezer {
        /// Masses.
        param m1 = 0.04325, m2 = 0.00365, m3 = 0.02373, m4 = 0.00706, m5 = 0.0705, m6 = 0.00706, m7 = 0.05498;
        /// Moments of inertia.
        param I1 = 2.194e-6, I2 = 4.41e-7, I3 = 5.255e-6, I4 = 5.667e-7, I5 = 1.169e-5, I6 = 5.667e-7, I7 = 1.912e-5;
        /// Fixed points.
        param xa = -0.06934, ya = -0.00227, xb = -0.03635, yb = 0.03273, xc = 0.014, yc = 0.072;
        /// Crank and coupler.
        param rr = 0.007, ra = 0.00092, d = 0.028, da = 0.0115;
        /// Rocker with the spring.
        param ss = 0.035, sa = 0.01874, sb = 0.01043, sc = 0.018, sd = 0.02;
        /// Both pairs of bars.
        param e = 0.02, ea = 0.01421, zt = 0.04, ta = 0.02308, tb = 0.00916;
        /// Both pairs of bars.
        param zf = 0.02, fa = 0.01421, u = 0.04, ua = 0.01228, ub = 0.00449;
        /// Torque of the motor.
        param torque = 0.033;
        /// Stiffness and length of the spring.
        param c0 = 4530.0, l0 = 0.07785;
        coord beta, theta, gamma, phi, delta, omega, epsilon;
        let p = beta + theta, pt = phi + delta, pu = omega + epsilon;
        let crank = [rr * cos(beta), rr * sin(beta)];
        let tip = [crank[0] - d * cos(p), crank[1] - d * sin(p)];
        let hook = [xb + sd * cos(gamma) + sc * sin(gamma), yb + sd * sin(gamma) - sc * cos(gamma)];
        let spring = hypot(hook[0] - xc, hook[1] - yc) - l0;
        let k12 = (m1 * ra^2 + I1 + m2 * rr^2) * dot(beta)^2 + (m2 * da^2 + I2) * dot(p)^2
            - 2 * m2 * da * rr * cos(theta) * dot(beta) * dot(p);
        let k3 = (m3 * (sa^2 + sb^2) + I3) * dot(gamma)^2;
        let k45 = (m4 * zt^2 + m5 * (ta^2 + tb^2) + I5) * dot(delta)^2 + (m4 * (e - ea)^2 + I4) * dot(pt)^2
            + 2 * m4 * zt * (e - ea) * sin(phi) * dot(delta) * dot(pt);
        let k67 = (m6 * u^2 + m7 * (ua^2 + ub^2) + I7) * dot(epsilon)^2 + (m6 * (zf - fa)^2 + I6) * dot(pu)^2
            - 2 * m6 * u * (zf - fa) * sin(omega) * dot(epsilon) * dot(pu);
        L = (k12 + k3 + k45 + k67) / 2 - c0 * spring^2 / 2;
        force beta = torque;
        constraint rocker = tip - [ss * sin(gamma) + xb, yb - ss * cos(gamma)];
        constraint lower = tip - [e * sin(pt) + zt * cos(delta) + xa, zt * sin(delta) - e * cos(pt) + ya];
        constraint upper = tip - [zf * cos(pu) + u * sin(epsilon) + xa, zf * sin(pu) - u * cos(epsilon) + ya];
    }
}

impl AndrewsSqueezer {
    /// Coordinates and velocities of the benchmark's start, at rest. Other parameters move the coordinates to the nearest
    /// that close the loops; if there are none, every run refuses the start.
    #[must_use]
    pub fn start(&self) -> ([f64; 7], [f64; 7]) {
        let benchmark = [
            -0.061_713_890_014_276_45,
            0.0,
            0.455_279_819_163_070_4,
            0.222_668_390_165_885_9,
            0.487_364_979_543_842_55,
            -0.222_668_390_165_885_9,
            1.230_547_444_549_821_2,
        ];
        let nearest = State::projected(self, 0.0, benchmark, [0.0; 7]);
        (nearest.map_or(benchmark, |found| found.state.q.into()), [0.0; 7])
    }
}
