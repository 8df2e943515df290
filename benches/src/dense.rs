//! The chain with a general solver: residual and Jacobian as in the step by hand, the same guess, the same end of the
//! iteration, and nalgebra's dense LU between.

use crate::chain::Springs;
use crate::run::Stepper;
use nalgebra::{Const, DimMin, SMatrix, SVector, ToTypenum};

const ITERATIONS: usize = 20;

/// Fixed steps of N masses; M = N + 1.
#[derive(Clone, Debug)]
pub struct Fixed<const N: usize, const M: usize> {
    springs: Springs,
    h: f64,
    tolerance: f64,
    t: f64,
    q: SVector<f64, N>,
    p: SVector<f64, N>,
    /// Velocities of the last five steps, the newest first.
    history: [SVector<f64, N>; 5],
}

impl<const N: usize, const M: usize> Fixed<N, M> {
    /// From `q` at rest at t = 0. A Newton step of `tolerance` is the last one.
    #[must_use]
    pub fn new(springs: Springs, q: [f64; N], h: f64, tolerance: f64) -> Self {
        const { assert!(M == N + 1) };
        Self { springs, h, tolerance, t: 0.0, q: q.into(), p: SVector::zeros(), history: [SVector::zeros(); 5] }
    }
}

impl<const N: usize, const M: usize> Stepper for Fixed<N, M>
where
    Const<N>: ToTypenum + DimMin<Const<N>, Output = Const<N>>,
{
    #[inline]
    fn step(&mut self) {
        let (m, h, s) = (self.springs.m, self.h, self.h / 2.0);
        let [v1, v2, v3, v4, v5] = self.history;
        let mut v = (v1 - v4) * 5.0 + (v3 - v2) * 10.0 + v5;
        for _ in 0..ITERATIONS {
            let mut x = [0.0; M];
            x[..N].copy_from_slice((self.q + v * s).as_slice());
            let (tension, stiffness) = self.springs.pull(&x);
            let force = SVector::<f64, N>::from_fn(|i, _| tension[i + 1] - tension[i]);
            let residual = v * m - force * s - self.p;
            let mut jacobian = SMatrix::<f64, N, N>::zeros();
            for i in 0..N {
                jacobian[(i, i)] = m + s * s * (stiffness[i] + stiffness[i + 1]);
                if i > 0 {
                    jacobian[(i, i - 1)] = -s * s * stiffness[i];
                    jacobian[(i - 1, i)] = -s * s * stiffness[i];
                }
            }
            let newton = jacobian.lu().solve(&residual).expect("a diagonal that dominates");
            v -= newton;
            if newton.amax() <= self.tolerance {
                // r = 0 at the solution: h F = 2 (m v − p0).
                self.q += v * h;
                self.p = v * (2.0 * m) - self.p;
                self.t += h;
                self.history = [v, v1, v2, v3, v4];
                return;
            }
        }
        panic!("Newton's iteration has not converged in {ITERATIONS} iterations");
    }

    fn state(&self) -> Vec<f64> {
        [self.t].iter().chain(self.q.iter()).chain(self.p.iter()).copied().collect()
    }
}
