//! Both steppers for any Lagrangian, without a generator: derivatives are found at run time, by dual numbers or by
//! differences.
//!
//! The discrete Lagrangian of an interval from q0 to q0 + d of length h is `L_d = h L(q0 + d/2, d/h)`. With M = N
//! unknowns d the step h is given. With M = N + 1 the last unknown is h and the last momentum is −E:
//!
//! ```text
//! −D2 L_d = p0     −D1 L_d = −E0        p1 = D4 L_d     −E1 = D3 L_d
//! ```
//!
//! The unknowns are d and h, because q1 would cause cancellation. The guess repeats the last increment of the unknowns.
//! The residual ends the iteration. The matrix is inverted by nalgebra, up to 4 × 4 in closed form.

use crate::problem::Problem;
use crate::run::Stepper;
use core::array::from_fn;
use core::marker::PhantomData;
use nalgebra::{SMatrix, SVector};
use num_dual::{DualNum, HyperDual64};

const ITERATIONS: usize = 20;

/// The slot derivatives of L_d, time last.
#[derive(Clone, Copy, Debug)]
pub struct Slots<const M: usize> {
    /// Derivatives with respect to the slots of the start.
    left: SVector<f64, M>,
    /// Derivatives with respect to the slots of the end.
    right: SVector<f64, M>,
    /// Second derivatives: rows for the slots of the start, columns for those of the end.
    mixed: SMatrix<f64, M, M>,
}

/// A way to the derivatives.
pub trait Derivatives: Clone {
    /// At the interval from `q` by `d` in time `h`.
    fn slots<P: Problem<N>, const N: usize, const M: usize>(problem: &P, q: [f64; N], d: [f64; N], h: f64) -> Slots<M>;
}

/// Hyper-dual numbers of L: one evaluation for every entry of `mixed`, exact.
#[derive(Clone, Debug)]
pub enum Dual {}

impl Derivatives for Dual {
    #[inline]
    fn slots<P: Problem<N>, const N: usize, const M: usize>(problem: &P, q: [f64; N], d: [f64; N], h: f64) -> Slots<M> {
        let mut slots = Slots { left: SVector::zeros(), right: SVector::zeros(), mixed: SMatrix::zeros() };
        for (i, j) in (0..M).flat_map(|i| (0..M).map(move |j| (i, j))) {
            let unit = |hit: bool| f64::from(u8::from(hit));
            let dual = |k: usize, re: f64, weights: [f64; 2]| {
                HyperDual64::new(re, weights[0] * unit(k == i), weights[1] * unit(k == j), 0.0)
            };
            let time = dual(N, h, [-1.0, 1.0]);
            let x = from_fn(|k| dual(k, q[k] + 0.5 * d[k], [0.5, 0.5]));
            let over = time.recip();
            let ld = problem.lagrangian(x, from_fn(|k| dual(k, d[k], [-1.0, 1.0]) * over)) * time;
            slots.left[i] = ld.eps1;
            slots.right[j] = ld.eps2;
            slots.mixed[(i, j)] = ld.eps1eps2;
        }
        slots
    }
}

/// Differences of first derivatives by hand: one more evaluation of them for every unknown.
#[derive(Clone, Debug)]
pub enum Difference {}

impl Difference {
    #[inline]
    fn ends<P: Problem<N>, const N: usize, const M: usize>(
        problem: &P,
        q: [f64; N],
        d: [f64; N],
        h: f64,
    ) -> [SVector<f64, M>; 2] {
        let (x, v) = (from_fn(|k| q[k] + 0.5 * d[k]), d.map(|d| d / h));
        let [force, momentum] = problem.gradients(x, v);
        let mut ends = [SVector::zeros(); 2];
        for k in 0..N {
            ends[0][k] = 0.5 * h * force[k] - momentum[k];
            ends[1][k] = 0.5 * h * force[k] + momentum[k];
        }
        if M > N {
            let energy = (0..N).fold(-problem.lagrangian(x, v), |energy, k| energy + v[k] * momentum[k]);
            (ends[0][N], ends[1][N]) = (energy, -energy);
        }
        ends
    }
}

impl Derivatives for Difference {
    #[inline]
    fn slots<P: Problem<N>, const N: usize, const M: usize>(problem: &P, q: [f64; N], d: [f64; N], h: f64) -> Slots<M> {
        let [left, right] = Self::ends::<P, N, M>(problem, q, d, h);
        // √eps of h: rounding and curvature take as much.
        let step = 2.0_f64.powi(-26) * h;
        let columns: [SVector<f64, M>; M] = from_fn(|j| {
            let moved = from_fn(|k| if k == j { d[k] + step } else { d[k] });
            let [there, _] = Self::ends::<P, N, M>(problem, q, moved, if j == N { h + step } else { h });
            (there - left) / step
        });
        Slots { left, right, mixed: SMatrix::from_columns(&columns) }
    }
}

/// The stepper: fixed steps for M = N, energy-preserving ones for M = N + 1.
#[derive(Clone, Debug)]
pub struct Newton<P, D, const N: usize, const M: usize> {
    problem: P,
    tolerance: f64,
    t: f64,
    q: [f64; N],
    /// Momenta, and −E.
    p: SVector<f64, M>,
    /// The unknowns and h of the last two steps.
    last: [([f64; N], f64); 2],
    derivatives: PhantomData<D>,
}

impl<P: Problem<N>, D: Derivatives, const N: usize, const M: usize> Newton<P, D, N, M> {
    /// The stepper at the state `(t, q, p)`, after two intervals of length `h` with the velocities `v`, the last one
    /// first. Residuals of `tolerance` are none.
    pub fn new(
        problem: P,
        (t, q, p): (f64, [f64; N], SVector<f64, M>),
        v: [[f64; N]; 2],
        h: f64,
        tolerance: f64,
    ) -> Self {
        const { assert!(M == N || M == N + 1) };
        Self { problem, tolerance, t, q, p, last: v.map(|v| (v.map(|v| h * v), h)), derivatives: PhantomData }
    }
}

impl<P: Problem<N>, D: Derivatives, const N: usize, const M: usize> Stepper for Newton<P, D, N, M> {
    #[inline]
    fn step(&mut self) {
        let [(d1, h1), (d2, h2)] = self.last;
        let mut d: [f64; N] = from_fn(|k| 2.0 * d1[k] - d2[k]);
        let mut h = 2.0 * h1 - h2;
        for _ in 0..ITERATIONS {
            let Slots { left, right, mixed } = D::slots::<P, N, M>(&self.problem, self.q, d, h);
            let residual = left + self.p;
            if residual.amax() <= self.tolerance {
                self.t += h;
                self.q = from_fn(|k| self.q[k] + d[k]);
                self.p = right;
                self.last = [(d, h), self.last[0]];
                return;
            }
            let newton = mixed.try_inverse().expect("a regular derivative") * residual;
            d = from_fn(|k| d[k] - newton[k]);
            if M > N {
                h -= newton[N];
            }
        }
        panic!("Newton's iteration has not converged in {ITERATIONS} iterations");
    }

    fn state(&self) -> Vec<f64> {
        [self.t].iter().chain(&self.q).chain(self.p.iter().take(N)).copied().collect()
    }
}
