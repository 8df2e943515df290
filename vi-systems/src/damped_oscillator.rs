//! A damped oscillator: the forced example of the paper (section 5.2).

use vi_core::lagrangian;

lagrangian! {
    /// Damped harmonic oscillator, m a + c v + k x = 0.
    ///
    /// With ω = √(k/m) and ζ = c/(2 √(k m)), the energy-preserving step grows as h ≈ h0 e^{ζ ω t} and ends after about
    /// 1/(ζ ω h0) steps. Source: Sharma, Patil, Woolsey, section 5.2.
    pub struct DampedOscillator {
        /// Mass.
        param m = 1.0;
        /// Stiffness.
        param k = 4.0;
        /// Damping: the force −c v.
        param c = 0.04;
        coord x;
        let v = dot(x);
        L = m * v^2 / 2 - k * x^2 / 2;
        force x = -c * v;
        discretize midpoint;
        check { x = 0.8, dot(x) = 0.5; h = 0.05; }
    }
}
