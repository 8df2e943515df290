//! The chain of [`crate::chain`]: `r = m v − s F − p0`, whose derivative A is tridiagonal and, for small h, close to a
//! multiple of one: `A = d − B` with `d = m + 2 s² k`. Its inverse is a series,
//!
//! ```text
//! A⁻¹ r = (1 + d⁻¹ B (1 + d⁻¹ B (…))) r/d        |d⁻¹ B| ≈ 2 s² K/m
//! ```
//!
//! every term of which is a loop without a recurrence, so that the compiler makes vectors of it. What is left of the series
//! is a billionth of a correction, and shows in the residual.

use super::{CORRECTIONS, Sum, is_solved, mul_add, not_converged};
use crate::chain::{Springs, stretches};
use crate::run::Stepper;
use core::array::from_fn;
use core::marker::PhantomData;

/// Terms of the series after the first.
const TERMS: usize = 3;

/// Solver of `A x = b` for N masses; arrays have the length M = N + 1.
pub trait Solver<const N: usize, const M: usize>: Clone {
    /// The solution x for these stiffnesses of the springs; `s` is half of h.
    fn solve(springs: &Springs, s: f64, stiffness: &[f64; M], b: &[f64; M]) -> [f64; M];
}

/// The series.
#[derive(Clone, Debug)]
pub enum Series {}

impl<const N: usize, const M: usize> Solver<N, M> for Series {
    #[inline]
    fn solve(springs: &Springs, s: f64, stiffness: &[f64; M], b: &[f64; M]) -> [f64; M] {
        let over = 1.0 / mul_add(2.0 * s * s, springs.k[0], springs.m);
        let mut x = b.map(|b| b * over);
        for _ in 0..TERMS {
            let stretch = stretches(&x);
            let mut pull = [0.0; M];
            for i in 0..M {
                pull[i] = s * s * stiffness[i] * stretch[i];
            }
            for i in 0..N {
                let image = mul_add(springs.m, x[i], pull[i] - pull[i + 1]);
                x[i] = mul_add(b[i] - image, over, x[i]);
            }
        }
        x
    }
}

/// Fixed steps of N masses; M = N + 1.
#[derive(Clone, Debug)]
pub struct Fixed<S, L, const N: usize, const M: usize> {
    springs: Springs,
    h: f64,
    t: S,
    q: [S; N],
    p: [S; N],
    /// Velocities of the last five steps, in a ring.
    history: [[f64; N]; 5],
    newest: usize,
    solver: PhantomData<L>,
}

impl<S: Sum, L: Solver<N, M>, const N: usize, const M: usize> Fixed<S, L, N, M> {
    /// The stepper at `q` at rest at t = 0.
    pub fn new(springs: Springs, q: [f64; N], h: f64) -> Self {
        const { assert!(M == N + 1) };
        let (q, p) = (q.map(S::new), [S::new(0.0); N]);
        Self { springs, h, t: S::new(0.0), q, p, history: [[0.0; N]; 5], newest: 0, solver: PhantomData }
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

    /// Positions of the masses at the middle of the step, tensions and stiffnesses there, and −r.
    #[inline]
    fn at(&self, v: &[f64; M]) -> Middle<M> {
        let (m, s) = (self.springs.m, self.h / 2.0);
        let mut x = [0.0; M];
        for i in 0..N {
            x[i] = self.q[i].plus(s * v[i]);
        }
        let (tension, stiffness) = self.springs.pull(&x);
        let mut missing = [0.0; M];
        for i in 0..N {
            missing[i] = self.p[i].plus(mul_add(s, tension[i + 1] - tension[i], -(m * v[i])));
        }
        Middle { x, tension, stiffness, missing }
    }

    /// The sums of the absolute values of the terms of r.
    #[cold]
    fn terms(&self, x: &[f64; M], v: &[f64; M]) -> [f64; N] {
        let (m, part) = (self.springs.m, self.h / 2.0 * self.springs.k[0]);
        from_fn(|i| {
            let before = if i == 0 { 0.0 } else { x[i - 1] };
            let stretches = before.abs() + 2.0 * x[i].abs() + x[i + 1].abs();
            self.p[i].value().abs() + mul_add(m, v[i].abs(), part * stretches)
        })
    }
}

/// The middle of a step.
struct Middle<const M: usize> {
    x: [f64; M],
    tension: [f64; M],
    stiffness: [f64; M],
    missing: [f64; M],
}

impl<S: Sum, L: Solver<N, M>, const N: usize, const M: usize> Stepper for Fixed<S, L, N, M> {
    #[inline]
    fn step(&mut self) {
        let h = self.h;
        let mut v = self.guess();
        let mut middle = self.at(&v);
        for _ in 0..CORRECTIONS {
            let newton = L::solve(&self.springs, h / 2.0, &middle.stiffness, &middle.missing);
            for i in 0..N {
                v[i] += newton[i];
            }
            middle = self.at(&v);
            let force: [f64; N] = from_fn(|i| middle.tension[i + 1] - middle.tension[i]);
            let missing: [f64; N] = from_fn(|i| middle.missing[i]);
            if is_solved(missing, &self.p, force.map(|force| h * force), || self.terms(&middle.x, &v)) {
                self.newest = (self.newest + 4) % 5;
                self.history[self.newest].copy_from_slice(&v[..N]);
                for i in 0..N {
                    self.q[i].grow(h, v[i]);
                    self.p[i].grow(h, force[i]);
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
