//! A mass on a spring.

use vi_core::lagrangian;

lagrangian! {
    /// Harmonic oscillator, m a + k x = 0.
    ///
    /// The exact motion is x(t) = x(0) cos ω t + (v(0)/ω) sin ω t with ω = √(k/m). The frequency ω̃ of the midpoint
    /// rule satisfies tan(ω̃ h/2) = ω h/2. Source: Goldstein, Classical Mechanics, chapter 6.
    pub struct HarmonicOscillator {
        /// Mass.
        param m = 1.0;
        /// Stiffness.
        param k = 4.0;
        coord x;
        L = m * dot(x)^2 / 2 - k * x^2 / 2;
        discretize midpoint;
        check { x = 0.8, dot(x) = 0.5; h = 0.05; }
    }
}
