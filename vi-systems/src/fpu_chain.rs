//! Masses on a line, coupled by slightly nonlinear springs.

use vi_core::lagrangian;

lagrangian! {
    /// Chain of Fermi, Pasta, Ulam and Tsingou: 16 masses between two walls; q[i] is the displacement from rest.
    ///
    /// Each of the 17 springs, including those at the walls, has the force k r + α r² + β r³ at the elongation r. For α
    /// = β = 0 the frequencies are 2 √(k/m) sin(π j/34), j = 1 … 16. Started in the lowest mode, the chain does not
    /// reach thermal equilibrium: the energy returns to that mode. The Jacobian of a step is tridiagonal. Source:
    /// Fermi, Pasta, Ulam, Studies of nonlinear problems I, Los Alamos report LA-1940 (1955), with α = 1/4.
    pub struct FpuChain {
        const N = 16;
        /// Each mass.
        param m = 1.0;
        /// Stiffness of a spring at rest.
        param k = 1.0;
        /// Quadratic part of the force.
        param alpha = 0.25;
        /// Cubic part of the force.
        param beta = 0.0;
        coord q[N];
        let r[i in 1..N] = q[i] - q[i - 1];
        let squares = q[0]^2 + sum(i in 1..N, r[i]^2) + q[N - 1]^2;
        let cubes = q[0]^3 + sum(i in 1..N, r[i]^3) - q[N - 1]^3;
        let fourths = q[0]^4 + sum(i in 1..N, r[i]^4) + q[N - 1]^4;
        let kinetic = m * sum(i in 0..N, dot(q[i])^2) / 2;
        L = kinetic - k * squares / 2 - alpha * cubes / 3 - beta * fourths / 4;
        discretize midpoint;
        check { q[i in 0..N] = sin((i + 1) * pi / (N + 1)), dot(q[3]) = 0.2; h = 0.1; }
    }
}
