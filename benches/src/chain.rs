//! The chain of Fermi, Pasta, Ulam and Tsingou at a trial velocity, by hand: what both rivals on it are made of.
//!
//! Springs 0 … N join N masses with each other and with the walls; arrays are M = N + 1 long, and the last place, mass N, is
//! the wall. With the stretches `r_i = x_i − x_{i−1}`, tensions `T = k r + α r² + β r³` and stiffnesses `K = T'`, mass i is
//! pulled by `T_{i+1} − T_i`.

use vi_systems::FpuChain;

/// The chain of 64 masses, as its neighbour of 16 is declared in `vi-systems`.
mod long {
    vi_core::lagrangian! {
        /// Chain of 64 masses between two walls; q[i] is the displacement from rest.
        pub struct LongChain {
            const N = 64;
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
        }
    }
}

pub use long::LongChain;

/// Mass and springs.
#[derive(Clone, Copy, Debug)]
pub struct Springs {
    /// Each mass.
    pub m: f64,
    /// k, α, β.
    pub k: [f64; 3],
}

impl From<&FpuChain> for Springs {
    fn from(chain: &FpuChain) -> Self {
        Self { m: chain.m, k: [chain.k, chain.alpha, chain.beta] }
    }
}

impl From<&LongChain> for Springs {
    fn from(chain: &LongChain) -> Self {
        Self { m: chain.m, k: [chain.k, chain.alpha, chain.beta] }
    }
}

impl Springs {
    /// Tensions and stiffnesses at the displacements `x`.
    #[inline]
    #[must_use]
    pub fn pull<const M: usize>(&self, x: &[f64; M]) -> ([f64; M], [f64; M]) {
        let [k, alpha, beta] = self.k;
        let (mut tension, mut stiffness) = ([0.0; M], [0.0; M]);
        let stretch = stretches(x);
        for i in 0..M {
            let r = stretch[i];
            tension[i] = r * (k + r * (alpha + r * beta));
            stiffness[i] = k + r * (2.0 * alpha + r * (3.0 * beta));
        }
        (tension, stiffness)
    }
}

/// `x_i − x_{i−1}`, the wall before the first.
#[inline]
#[must_use]
pub fn stretches<const M: usize>(x: &[f64; M]) -> [f64; M] {
    let mut stretch = [0.0; M];
    stretch[0] = x[0];
    for i in 1..M {
        stretch[i] = x[i] - x[i - 1];
    }
    stretch
}

/// The lowest mode, of amplitude 1, at rest.
#[must_use]
pub fn lowest_mode<const N: usize>() -> [f64; N] {
    let mut places = [0.0; N];
    let mut length = 1.0;
    for place in &mut places {
        *place = length;
        length += 1.0;
    }
    places.map(|place| (core::f64::consts::PI * place / length).sin())
}
