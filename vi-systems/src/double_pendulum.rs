//! Two pendula, one hanging from the other.

use vi_core::lagrangian;

lagrangian! {
    /// Double pendulum in absolute angles; θ1 = θ2 = 0 hangs down.
    ///
    /// The mass matrix depends on the configuration. Released from (2, 2) rad, the energy-preserving step ends at
    /// t = 4.025. Source: Landau and Lifshitz, Mechanics, section 5.
    pub struct DoublePendulum {
        /// Upper mass.
        param m1 = 1.0;
        /// Lower mass.
        param m2 = 1.0;
        /// Length of the upper rod.
        param l1 = 1.0;
        /// Length of the lower rod.
        param l2 = 1.0;
        /// Gravity.
        param g = 9.81;
        coord θ1, θ2;
        let upper = (m1 + m2) * l1^2 * dot(θ1)^2 / 2;
        let lower = m2 * l2^2 * dot(θ2)^2 / 2 + m2 * l1 * l2 * dot(θ1) * dot(θ2) * cos(θ1 - θ2);
        L = upper + lower + (m1 + m2) * g * l1 * cos(θ1) + m2 * g * l2 * cos(θ2);
        discretize midpoint;
        check { θ1 = 0.5, θ2 = -0.3, dot(θ1) = 0.2, dot(θ2) = 0.1; h = 0.01; }
    }
}
