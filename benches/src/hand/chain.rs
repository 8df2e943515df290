//! The chain of [`crate::chain`]: `r = m v − s F − p0`, whose derivative A is tridiagonal and, for small h, close to a
//! multiple of one: `A = d − B` with `d = m + 2 s² k`. Its inverse is a series,
//!
//! ```text
//! A⁻¹ r = (1 + d⁻¹ B (1 + d⁻¹ B (…))) r/d        |d⁻¹ B| ≈ 2 s² K/m
//! ```
//!
//! every term of which is a loop without a recurrence, so that the compiler makes vectors of it. What is left of the series
//! is left to the tolerance.

use super::{ITERATIONS, Sum, mul_add, not_converged};
use crate::chain::{Springs, stretches};
use crate::run::Stepper;

/// Terms of the series after the first.
const TERMS: usize = 3;

/// Fixed steps of N masses; M = N + 1.
#[derive(Clone, Debug)]
pub struct Fixed<S, const N: usize, const M: usize> {
    springs: Springs,
    h: f64,
    tolerance: f64,
    t: S,
    q: [S; N],
    p: [S; N],
    /// Velocities of the last five steps, in a ring.
    history: [[f64; N]; 5],
    newest: usize,
}

impl<S: Sum, const N: usize, const M: usize> Fixed<S, N, M> {
    /// From `q` at rest at t = 0. A Newton step of `tolerance` is the last one.
    pub fn new(springs: Springs, q: [f64; N], h: f64, tolerance: f64) -> Self {
        const { assert!(M == N + 1) };
        let (q, p) = (q.map(S::new), [S::new(0.0); N]);
        Self { springs, h, tolerance, t: S::new(0.0), q, p, history: [[0.0; N]; 5], newest: 0 }
    }

    #[inline]
    fn guess(&self) -> [f64; M] {
        let [v1, v2, v3, v4, v5] = [0, 1, 2, 3, 4].map(|age| &self.history[(self.newest + age) % 5]);
        let mut v = [0.0; M];
        for i in 0..N {
            v[i] = mul_add(5.0, v1[i] - v4[i], mul_add(10.0, v3[i] - v2[i], v5[i]));
        }
        v
    }

    /// The Newton step, and by how much it lessens the tensions.
    #[inline]
    fn solve(&self, residual: &[f64; M], stiffness: &[f64; M]) -> ([f64; M], [f64; M]) {
        let (m, s) = (self.springs.m, self.h / 2.0);
        let over = 1.0 / mul_add(2.0 * s * s, self.springs.k[0], m);
        let mut newton = residual.map(|r| r * over);
        let mut eased = [0.0; M];
        for term in 0..=TERMS {
            let stretch = stretches(&newton);
            for i in 0..M {
                eased[i] = s * stiffness[i] * stretch[i];
            }
            if term == TERMS {
                break;
            }
            for i in 0..N {
                let image = mul_add(m, newton[i], s * (eased[i] - eased[i + 1]));
                newton[i] = mul_add(residual[i] - image, over, newton[i]);
            }
        }
        (newton, eased)
    }
}

impl<S: Sum, const N: usize, const M: usize> Stepper for Fixed<S, N, M> {
    #[inline]
    fn step(&mut self) {
        let (m, h, s) = (self.springs.m, self.h, self.h / 2.0);
        let mut v = self.guess();
        for _ in 0..ITERATIONS {
            let mut x = [0.0; M];
            for i in 0..N {
                x[i] = self.q[i].plus(s * v[i]);
            }
            let (tension, stiffness) = self.springs.pull(&x);
            let mut residual = [0.0; M];
            for i in 0..N {
                residual[i] = -self.p[i].plus(mul_add(s, tension[i + 1] - tension[i], -(m * v[i])));
            }
            let (newton, eased) = self.solve(&residual, &stiffness);
            let mut longest = 0.0_f64;
            for i in 0..N {
                v[i] -= newton[i];
                longest = longest.max(newton[i].abs());
            }
            if longest <= self.tolerance {
                self.newest = (self.newest + 4) % 5;
                self.history[self.newest].copy_from_slice(&v[..N]);
                for i in 0..N {
                    self.q[i].grow(h, v[i]);
                    self.p[i].grow(h, (tension[i + 1] - eased[i + 1]) - (tension[i] - eased[i]));
                }
                self.t.grow(h, 1.0);
                return;
            }
        }
        not_converged()
    }

    fn state(&self) -> Vec<f64> {
        [self.t].iter().chain(&self.q).chain(&self.p).map(|sum| sum.value()).collect()
    }
}
