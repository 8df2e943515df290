//! Dense output of a Gauss step: its collocation polynomials.
//!
//! Velocities and forces at the stages give q and p at any time of the step, in Legendre polynomials of x = 2θ − 1,
//! with θ the fraction of the step:
//!
//! ```text
//! v(θ) = Σ_k u_k P_k(x)        u_k = (2k + 1) Σ_i b_i P_k(x_i) V_i        exact, since the Gauss rule is
//! q(θ) = q0 + h Σ_k u_k I_k    I_0 = θ,  I_k = (P_{k+1}(x) − P_{k−1}(x)) / (2 (2k + 1))
//! ```
//!
//! and the same for p with the forces. The order is S + 1 inside the step, and 2S at its ends (Hairer, Lubich, Wanner,
//! *Geometric Numerical Integration*, II.1.2 and II.1.3).

use super::fixed_point::Equations;
use super::general::equations;
use super::points::{EquationForm, ErasedSystem, Points};
use super::stages::{Stages, coefficients, set, stage, time};
use super::tableau::real;
use crate::node::Node;
use crate::run::DenseOutput;
use crate::state::State;
use nalgebra::SVector;

/// Dense output of a step of S stages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CollocationPolynomial<const N: usize, const S: usize> {
    /// The state at the start of the step.
    start: State<N>,
    h: f64,
    /// Coefficients of the velocity and of the force in Legendre polynomials.
    velocity: Stages<N, S>,
    force: Stages<N, S>,
    /// The position at the end of the step minus that of the polynomial, for systems of first order, in which they
    /// differ. It counts as `θ P_S(x)`, which is zero at the start and at the stages.
    rest: Option<SVector<f64, N>>,
}

impl<const N: usize, const S: usize> CollocationPolynomial<N, S> {
    /// Dense output of the step of length h from the node `before` with the state `start` to the position `end`.
    pub(crate) fn over(
        system: &ErasedSystem<'_, N>,
        before: &Node<N>,
        h: f64,
        stages: Stages<N, S>,
        start: State<N>,
        end: &SVector<f64, N>,
    ) -> Self {
        let equations = equations(system, before, h, stages);
        let x = equations.start();
        let velocity = equations.velocity();
        let mut force = [[0.0; S]; N];
        for i in 0..S {
            let t = time::<N, S, false, f64>(before, h, i);
            set(&mut force, i, &system.at(t, &stage(&x, i), &stage(&velocity, i)).force);
        }
        let mut polynomial =
            Self { start, h, velocity: coefficients(&velocity), force: coefficients(&force), rest: None };
        if Points::<N, f64>::form(system) == EquationForm::FirstOrder {
            polynomial.rest = Some(end - polynomial.state(start.t + h).q);
        }
        polynomial
    }

    /// The fraction of the step at the time t.
    fn part(&self, t: f64) -> f64 {
        (t - self.start.t) / self.h
    }
}

impl<const N: usize, const S: usize> DenseOutput<N> for CollocationPolynomial<N, S> {
    fn since_start(self) -> Self {
        Self { start: State { t: 0.0, ..self.start }, ..self }
    }

    fn moved(self, by: &SVector<f64, N>) -> Self {
        Self { start: State { q: self.start.q + by, ..self.start }, ..self }
    }

    fn state(&self, t: f64) -> State<N> {
        let integrals = integrals::<S>(self.part(t));
        let mut q = self.start.q + sum(&self.velocity, &integrals) * self.h;
        if let Some(rest) = self.rest {
            q += rest * (self.part(t) * legendre(S, self.part(t))[0]);
        }
        let p = self.start.p + sum(&self.force, &integrals) * self.h;
        State { t, q, p }
    }

    fn velocity(&self, t: f64) -> SVector<f64, N> {
        let mut v = sum(&self.velocity, &polynomials(self.part(t)));
        if let Some(rest) = self.rest {
            let [value, slope] = legendre(S, self.part(t));
            v += rest * ((value + self.part(t) * slope) / self.h);
        }
        v
    }
}

/// `Σ_k u_k basis_k` of each coordinate, in ascending magnitude.
pub(crate) fn sum<const N: usize, const S: usize>(coefficients: &Stages<N, S>, basis: &[f64; S]) -> SVector<f64, N> {
    let mut total = SVector::<f64, N>::zeros();
    for (total, row) in total.iter_mut().zip(coefficients) {
        for k in (0..S).rev() {
            *total += row[k] * basis[k];
        }
    }
    total
}

/// P_k(2θ − 1), k = 0 … S − 1, by `(k + 1) P_{k+1} = (2k + 1) x P_k − k P_{k−1}`.
pub(crate) fn polynomials<const S: usize>(part: f64) -> [f64; S] {
    let x = 2.0 * part - 1.0;
    let mut values = [0.0; S];
    let mut last = [0.0, 1.0];
    let mut k = 0.0;
    for value in &mut values {
        *value = last[1];
        last = [last[1], ((2.0 * k + 1.0) * x * last[1] - k * last[0]) / (k + 1.0)];
        k += 1.0;
    }
    values
}

/// P_k(2θ − 1) and its derivative with respect to θ, by `P'_{k+1} = P'_{k−1} + (2k + 1) P_k`.
fn legendre(k: usize, part: f64) -> [f64; 2] {
    let x = 2.0 * part - 1.0;
    let (mut values, mut slopes) = ([0.0, 1.0], [0.0, 0.0]);
    for k in 0..k {
        let odd = real(2 * k + 1);
        slopes = [slopes[1], slopes[0] + odd * values[1]];
        values = [values[1], (odd * x * values[1] - real(k) * values[0]) / real(k + 1)];
    }
    [values[1], 2.0 * slopes[1]]
}

/// `∫_0^θ P_k(2u − 1) du`, k = 0 … S − 1.
pub(crate) fn integrals<const S: usize>(part: f64) -> [f64; S] {
    let x = 2.0 * part - 1.0;
    let mut values = [0.0; S];
    let mut last = [1.0, x];
    let mut k = 1.0;
    for (index, value) in values.iter_mut().enumerate() {
        if index == 0 {
            *value = part;
            continue;
        }
        let next = ((2.0 * k + 1.0) * x * last[1] - k * last[0]) / (k + 1.0);
        *value = (next - last[0]) / (2.0 * (2.0 * k + 1.0));
        last = [last[1], next];
        k += 1.0;
    }
    values
}
