//! Dense output of a step in transformed time: its collocation polynomials.
//!
//! The rates of time, positions and momenta at the stages give q and p at any time of the step. With θ the fraction of
//! the step in transformed time and x = 2θ − 1, all three are polynomials of θ,
//!
//! ```text
//! t(θ) = t0 + Δτ Σ_k g_k I_k(θ)        q(θ) = q0 + Δτ Σ_k (g v)_k I_k(θ)        p(θ) = p0 + Δτ Σ_k (dp/dτ)_k I_k(θ)
//! ```
//!
//! and θ follows from t, which increases with θ because g is positive. Coefficients and I_k are those of a Gauss step
//! in time.

use super::super::polynomial::{integrals, polynomials, sum};
use super::super::stages::{Stages, coefficients, scaled};
use super::LastRates;
use super::equations::Scaled;
use crate::motion::Motion;
use crate::node::Node;
use crate::run::DenseOutput;
use crate::state::State;
use nalgebra::SVector;

/// Dense output of a step of S stages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransformedPolynomial<const N: usize, const S: usize> {
    /// The state at the start of the step.
    start: State<N>,
    dtau: f64,
    /// Coefficients of `dt/dτ`, `dq/dτ` and `dp/dτ` in Legendre polynomials.
    time: Stages<1, S>,
    position: Stages<N, S>,
    momentum: Stages<N, S>,
}

/// Most iterations for the fraction of a step.
const ITERATIONS: u32 = 60;

impl<const N: usize, const S: usize> TransformedPolynomial<N, S> {
    /// Dense output of the last step, from `start` to a node with this energy.
    pub(crate) fn of<Y: Motion<N>>(system: &Y, energy: f64, last: &LastRates<N, S>, start: State<N>) -> Self {
        let rates = last.rates();
        // The energy at the start of the step, from that of the node.
        let mut node = Node::new(start, energy);
        node.energy -=
            Scaled::<f64, Y, N, S, false>::new(system, &node, last.taken, rates, None).quadrature(&rates.energy);
        let mut equations = Scaled::<f64, Y, N, S, false>::new(system, &node, last.taken, rates, None);
        let momentum = coefficients(&equations.momentum_rates());
        let position = coefficients(&rates.velocity.map(|row| scaled(&rates.g, &row)));
        Self { start, dtau: last.taken, time: coefficients(&[rates.g]), position, momentum }
    }

    /// The time at a fraction of the step, and its derivative.
    fn time(&self, part: f64) -> [f64; 2] {
        let passed = sum(&self.time, &integrals::<S>(part))[0];
        let g = sum(&self.time, &polynomials::<S>(part))[0];
        [self.start.t + self.dtau * passed, self.dtau * g]
    }

    /// The fraction of the step at the time t: Newton iteration with bisection outside of the bracket. Beyond the ends
    /// the time continues linearly.
    fn part(&self, t: f64) -> f64 {
        for end in [0.0, 1.0] {
            let [time, slope] = self.time(end);
            let beyond = (t - time) / slope;
            if beyond == 0.0 || (beyond > 0.0) == (end > 0.5) {
                return end + beyond;
            }
        }
        let [mut low, mut high] = [0.0, 1.0];
        let mut part = 0.5;
        for _ in 0..ITERATIONS {
            let [time, slope] = self.time(part);
            let left = (t - time) / slope;
            if left > 0.0 {
                low = part;
            } else {
                high = part;
            }
            let next = part + left;
            let next = if next > low && next < high { next } else { 0.5 * (low + high) };
            if (next - part).abs() <= f64::EPSILON {
                return next;
            }
            part = next;
        }
        part
    }
}

impl<const N: usize, const S: usize> DenseOutput<N> for TransformedPolynomial<N, S> {
    fn since_start(self) -> Self {
        Self { start: State { t: 0.0, ..self.start }, ..self }
    }

    fn moved(self, by: &SVector<f64, N>) -> Self {
        Self { start: State { q: self.start.q + by, ..self.start }, ..self }
    }

    fn state(&self, t: f64) -> State<N> {
        let integrals = integrals::<S>(self.part(t));
        let q = self.start.q + sum(&self.position, &integrals) * self.dtau;
        let p = self.start.p + sum(&self.momentum, &integrals) * self.dtau;
        State { t, q, p }
    }

    fn velocity(&self, t: f64) -> SVector<f64, N> {
        let basis = polynomials::<S>(self.part(t));
        sum(&self.position, &basis) / sum(&self.time, &basis)[0]
    }
}
