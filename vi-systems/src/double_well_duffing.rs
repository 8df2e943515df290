//! Duffing's oscillator in a double well, driven: the standard example of chaos.

use vi_core::lagrangian;

lagrangian! {
    /// Double-well Duffing oscillator, a + c v − x + x³ = A cos ω t.
    ///
    /// With these parameters the motion is chaotic, and the energy-preserving step ends at t ≈ 7.98 for every h0.
    /// Source: Guckenheimer and Holmes, Nonlinear Oscillations, section 2.2.
    pub struct DoubleWellDuffing {
        /// Damping.
        param c = 0.3;
        /// Amplitude of the drive.
        param amplitude = 0.37;
        /// Frequency of the drive.
        param omega = 1.2;
        coord x;
        L = dot(x)^2 / 2 + x^2 / 2 - x^4 / 4;
        force x = -c * dot(x) + amplitude * cos(omega * t);
        discretize midpoint;
        check { x = 1.3, dot(x) = 0.1; h = 0.05; }
    }
}
