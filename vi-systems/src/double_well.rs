//! A particle in a double well: the conservative example of the paper (section 5.1).

use vi_core::lagrangian;

lagrangian! {
    /// Particle in the double well V = (q⁴ − q²)/2.
    ///
    /// Minima at q = ±1/√2 with V = −1/8, a barrier of height 0 at q = 0. Librations about one minimum have E < 0.
    /// Above the barrier the step density vanishes along the motion, and the energy-preserving step ends there. Source:
    /// Sharma, Patil, Woolsey, section 5.1.
    pub struct DoubleWell {
        /// Mass.
        param m = 1.0;
        coord q;
        L = m * dot(q)^2 / 2 - (q^4 - q^2) / 2;
        discretize midpoint;
        check { q = 0.9, dot(q) = 0.1; h = 0.05; }
    }
}
