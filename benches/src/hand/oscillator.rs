//! The harmonic oscillator, `L = m v²/2 − k x²/2`: its momentum equation is linear, and a step is the increment
//!
//! ```text
//! v = (p0 − s k q0)/(m + s² k)      q1 = q0 + h v      p1 = p0 − h k (q0 + s v)      s = h/2
//! ```
//!
//! as two constant rows, computed once. Beside it the same step by Newton's iteration, as if nobody knew that it is linear.

use super::{History, ITERATIONS, Sum, mul_add, not_converged};
use crate::run::Stepper;
use vi_systems::systems::HarmonicOscillator;

/// Fixed steps in closed form.
#[derive(Clone, Debug)]
pub struct Fixed<S> {
    h: f64,
    /// v of q0 and p0; −k (q0 + s v) of q0 and p0.
    rows: [[f64; 2]; 2],
    t: S,
    q: S,
    p: S,
}

impl<S: Sum> Fixed<S> {
    /// From `(q, p)` at t = 0.
    #[must_use]
    pub fn new(system: &HarmonicOscillator, (q, p): (f64, f64), h: f64) -> Self {
        let (m, k, s) = (system.m, system.k, h / 2.0);
        let over = 1.0 / (m + s * s * k);
        let rows = [[-s * k * over, over], [-k * m * over, -k * s * over]];
        Self { h, rows, t: S::new(0.0), q: S::new(q), p: S::new(p) }
    }
}

impl<S: Sum> Stepper for Fixed<S> {
    #[inline]
    fn step(&mut self) {
        let (q, p) = (self.q.value(), self.p.value());
        let [v, force] = self.rows.map(|[of_q, of_p]| mul_add(of_q, q, of_p * p));
        self.q.grow(self.h, v);
        self.p.grow(self.h, force);
        self.t.grow(self.h, 1.0);
    }

    fn state(&self) -> Vec<f64> {
        vec![self.t.value(), self.q.value(), self.p.value()]
    }
}

/// Fixed steps by Newton's iteration.
#[derive(Clone, Debug)]
pub struct Newton<S> {
    m: f64,
    k: f64,
    h: f64,
    tolerance: f64,
    t: S,
    q: S,
    p: S,
    history: History,
}

impl<S: Sum> Newton<S> {
    /// From `(q, p)` at t = 0. A Newton step of `tolerance` is the last one.
    #[must_use]
    pub fn new(system: &HarmonicOscillator, (q, p): (f64, f64), h: f64, tolerance: f64) -> Self {
        let (m, k, history) = (system.m, system.k, History::constant(p / system.m));
        Self { m, k, h, tolerance, t: S::new(0.0), q: S::new(q), p: S::new(p), history }
    }
}

impl<S: Sum> Stepper for Newton<S> {
    #[inline]
    fn step(&mut self) {
        let Self { m, k, h, .. } = *self;
        let s = h / 2.0;
        let mut v = self.history.next();
        for _ in 0..ITERATIONS {
            let force = -k * self.q.plus(s * v);
            let newton = self.p.plus(mul_add(s, force, -(m * v))) / mul_add(s * s, k, m);
            v += newton;
            if newton.abs() <= self.tolerance {
                self.history.push(v);
                self.q.grow(h, v);
                self.p.grow(h, mul_add(-s * k, newton, force));
                self.t.grow(h, 1.0);
                return;
            }
        }
        not_converged()
    }

    fn state(&self) -> Vec<f64> {
        vec![self.t.value(), self.q.value(), self.p.value()]
    }
}
