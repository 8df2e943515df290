//! Predators and their prey.

use vi_core::lagrangian;

lagrangian! {
    /// Lotka–Volterra equations: prey' = prey (a − b predators), predators' = predators (c prey − d).
    ///
    /// L is linear in the velocities: the state is the numbers of both. The energy is the conserved quantity
    /// b predators − a ln(predators) + c prey − d ln(prey); every motion is periodic.
    /// Source: Kraus, Projected variational integrators for degenerate Lagrangian systems (2017), arXiv:1708.07356.
    pub struct LotkaVolterra {
        /// Birth rate of the prey.
        param a = 1.0;
        /// Rate at which a predator kills prey.
        param b = 1.0;
        /// Rate at which a prey lets predators grow.
        param c = 1.0;
        /// Death rate of the predators.
        param d = 2.0;
        coord predators, prey;
        let energy = b * predators - a * ln(predators) + c * prey - d * ln(prey);
        L = ln(prey) / predators * dot(predators) - energy;
        check { predators = 0.8, prey = 1.5; h = 0.1; }
    }
}
