//! The harmonic oscillator, `L = m v²/2 − k x²/2`: its momentum equation is linear, and a step is the increment
//!
//! ```text
//! v = (p0 − s k q0)/(m + s² k)      q1 = q0 + h v      p1 = p0 − h k (q0 + s v)      s = h/2
//! ```
//!
//! as two constant rows, computed once.

use super::{Sum, mul_add};
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
