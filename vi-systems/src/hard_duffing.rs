//! Duffing's oscillator with a stiffening spring, driven.

use vi_core::lagrangian;

lagrangian! {
    /// Hard Duffing oscillator, a + c v + α x + β x³ = A cos ω t.
    ///
    /// The drive is in the force, not in L: the two choices have different step densities (`docs/mathematics.md`).
    /// Source: Guckenheimer and Holmes, Nonlinear Oscillations, section 2.2.
    pub struct HardDuffing {
        /// Linear stiffness.
        param alpha = 1.0;
        /// Cubic stiffness.
        param beta = 1.0;
        /// Damping.
        param c = 0.1;
        /// Amplitude of the drive.
        param amplitude = 0.3;
        /// Frequency of the drive.
        param omega = 1.2;
        coord x;
        L = dot(x)^2 / 2 - alpha * x^2 / 2 - beta * x^4 / 4;
        force x = -c * dot(x) + amplitude * cos(omega * t);
        discretize midpoint;
        check { x = 1.1, dot(x) = 0.2; h = 0.05; }
    }
}
