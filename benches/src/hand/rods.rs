//! A chain of N rods of the length l with equal masses m, in Cartesian coordinates. With the rods `d_i = r_i − r_(i−1)`, at the
//! start d and at the end e, the velocity follows from the impulses λ, and one equation is left for each rod:
//!
//! ```text
//! m v_i = p_i + (h/2) F + 2 (λ_i d_i − λ_(i+1) d_(i+1))        (|e_i|² − l²)/h = 0
//! ```
//!
//! Its derivative by λ is tridiagonal, as is the matrix of the projection of the momenta.

use super::{CORRECTIONS, FLOOR, History, Sum, mul_add, not_converged};
use crate::run::Stepper;
use core::array::from_fn;

/// A vector in the plane.
type Plane = [f64; 2];

#[inline]
fn dot(a: Plane, b: Plane) -> f64 {
    mul_add(a[0], b[0], a[1] * b[1])
}

/// A sum after an increment.
#[inline]
fn grown<S: Sum>(mut sum: S, factor: f64, increment: f64) -> S {
    sum.grow(factor, increment);
    sum
}

#[inline]
fn minus(a: Plane, b: Plane) -> Plane {
    [a[0] - b[0], a[1] - b[1]]
}

/// Steps of N masses.
#[derive(Clone, Debug)]
pub struct Fixed<S, const N: usize> {
    mass: f64,
    length: f64,
    gravity: f64,
    h: f64,
    t: S,
    q: [[S; 2]; N],
    p: [[S; 2]; N],
    rods: [Plane; N],
    lambda: [History; N],
}

impl<S: Sum, const N: usize> Fixed<S, N> {
    /// From places with velocities; flat arrays of 2 N numbers.
    #[must_use]
    pub fn new([mass, length, gravity]: [f64; 3], [q, v]: [&[f64]; 2], h: f64) -> Self {
        let q: [Plane; N] = from_fn(|i| [q[2 * i], q[2 * i + 1]]);
        let p: [Plane; N] = from_fn(|i| [mass * v[2 * i], mass * v[2 * i + 1]]);
        let rods = rods(&q);
        // At rest against gravity: a guess of the first step.
        let lambda = from_fn(|i| {
            let below = f64::from(u32::try_from(N - i).unwrap_or(1));
            History::constant(-h * below * mass * gravity / (4.0 * length))
        });
        let sums = |of: [Plane; N]| of.map(|of| of.map(S::new));
        Self { mass, length, gravity, h, t: S::new(0.0), q: sums(q), p: sums(p), rods, lambda }
    }
}

/// The rods between places.
#[inline]
fn rods<const N: usize>(q: &[Plane; N]) -> [Plane; N] {
    from_fn(|i| if i == 0 { q[0] } else { minus(q[i], q[i - 1]) })
}

/// The momenta that impulses along rods add.
#[inline]
fn pushed<const N: usize>(rods: &[Plane; N], impulses: &[f64; N]) -> [Plane; N] {
    let along: [Plane; N] = from_fn(|i| rods[i].map(|entry| 2.0 * impulses[i] * entry));
    from_fn(|i| if i + 1 == N { along[i] } else { minus(along[i], along[i + 1]) })
}

/// Solves `4 e_i·(2 d_i x_i − d_(i−1) x_(i−1) − d_(i+1) x_(i+1)) = m b_i`, where the first rod has one mass only.
#[inline]
fn solve<const N: usize>(ends: &[Plane; N], starts: &[Plane; N], b: &[f64; N], mass: f64) -> [f64; N] {
    let (mut upper, mut x) = ([0.0; N], [0.0; N]);
    for i in 0..N {
        let masses = if i == 0 { 4.0 } else { 8.0 };
        let (mut diagonal, mut right) = (masses * dot(ends[i], starts[i]), mass * b[i]);
        if i > 0 {
            let lower = -4.0 * dot(ends[i], starts[i - 1]);
            diagonal -= lower * upper[i - 1];
            right -= lower * x[i - 1];
        }
        let over = 1.0 / diagonal;
        upper[i] = if i + 1 < N { -4.0 * dot(ends[i], starts[i + 1]) * over } else { 0.0 };
        x[i] = right * over;
    }
    for i in (0..N - 1).rev() {
        x[i] -= upper[i] * x[i + 1];
    }
    x
}

impl<S: Sum, const N: usize> Fixed<S, N> {
    /// `A v` of each rod over the rounding of its terms, and the largest of these.
    #[inline]
    fn rates(ends: &[Plane; N], v: &[Plane; N]) -> ([f64; N], f64) {
        let before = |i: usize| if i == 0 { [0.0; 2] } else { v[i - 1] };
        let rates: [f64; N] = from_fn(|i| 2.0 * dot(ends[i], minus(v[i], before(i))));
        let terms =
            |i: usize| 2.0 * (0..2).map(|k| ends[i][k].abs() * (v[i][k].abs() + before(i)[k].abs())).sum::<f64>();
        let worst =
            (0..N).fold(0.0, |worst: f64, i| worst.max(rates[i].abs() / (3.0 * terms(i)).max(f64::MIN_POSITIVE)));
        (rates, worst)
    }
}

impl<S: Sum, const N: usize> Stepper for Fixed<S, N> {
    #[inline]
    fn step(&mut self) {
        let Self { mass, length, gravity, h, .. } = *self;
        let weight = [0.0, -mass * gravity];
        let mut lambda: [f64; N] = from_fn(|i| self.lambda[i].next());
        let mut corrections = 0;
        let (v, ends) = loop {
            let push = pushed(&self.rods, &lambda);
            let v: [Plane; N] =
                from_fn(|i| from_fn(|k| self.p[i][k].plus(mul_add(h / 2.0, weight[k], push[i][k])) / mass));
            let q: [Plane; N] = from_fn(|i| from_fn(|k| self.q[i][k].plus(h * v[i][k])));
            let ends = rods(&q);
            let off: [f64; N] = from_fn(|i| mul_add(-length, length, dot(ends[i], ends[i])) / h);
            let terms = |i: usize| {
                let before = if i == 0 { [0.0; 2] } else { q[i - 1] };
                2.0 * (0..2).map(|k| ends[i][k].abs() * (q[i][k].abs() + before[k].abs())).sum::<f64>()
            };
            let worst = (0..N).fold(0.0, |worst: f64, i| worst.max(off[i].abs() * h / terms(i)));
            if worst <= FLOOR && corrections > 0 || worst <= f64::EPSILON {
                break (v, ends);
            }
            if corrections == CORRECTIONS {
                not_converged();
            }
            corrections += 1;
            let correction = solve(&ends, &self.rods, &off, mass);
            for (lambda, correction) in lambda.iter_mut().zip(correction) {
                *lambda -= correction;
            }
        };
        let push = pushed(&self.rods, &lambda);
        // The momenta, which have to be along the surface.
        let increment: [Plane; N] = from_fn(|i| from_fn(|k| mul_add(h, weight[k], push[i][k])));
        let p: [Plane; N] = from_fn(|i| from_fn(|k| self.p[i][k].plus(increment[i][k]) / mass));
        let (rates, _) = Self::rates(&ends, &p);
        let mu = solve(&ends, &ends, &rates, -mass);
        let back = pushed(&ends, &mu);
        for i in 0..N {
            self.q[i] = from_fn(|k| grown(self.q[i][k], h, v[i][k]));
            self.p[i] = from_fn(|k| grown(self.p[i][k], 1.0, increment[i][k] + back[i][k]));
            self.lambda[i].push(lambda[i]);
        }
        // What rounding has left across the surface goes the same way, and is measured.
        let p: [Plane; N] = from_fn(|i| from_fn(|k| self.p[i][k].plus(0.0) / mass));
        let (rates, _) = Self::rates(&ends, &p);
        let back = pushed(&ends, &solve(&ends, &ends, &rates, -mass));
        for (p, back) in self.p.iter_mut().zip(back) {
            *p = from_fn(|k| grown(p[k], 1.0, back[k]));
        }
        let p: [Plane; N] = from_fn(|i| from_fn(|k| self.p[i][k].plus(0.0) / mass));
        let (_, worst) = Self::rates(&ends, &p);
        if worst > FLOOR {
            not_converged();
        }
        self.rods = ends;
        self.t.grow(h, 1.0);
    }

    fn state(&self) -> Vec<f64> {
        let places = self.q.iter().flatten().map(|sum| sum.value());
        let momenta = self.p.iter().flatten().map(|sum| sum.value());
        [self.t.value()].into_iter().chain(places).chain(momenta).collect()
    }
}
