//! The double well, `L = m v²/2 − (q⁴ − q²)/2`: both steppers, one unknown and two.
//!
//! With `s = h/2`, `x = q0 + s v`, `F = x − 2x³`, `V = (x⁴ − x²)/2`, `F' = 1 − 6x²`:
//!
//! ```text
//! r = m v − s F − p0 = 0        A = ∂r/∂v = m − s² F'        q1 = q0 + h v      p1 = p0 + h F
//! e = m v²/2 + V − E0 = 0       c = e − v r
//! [ A             −F − s F' v ] [ δv ]     [ r   ]
//! [ −F + s F' v    F' v²      ] [ δs ] = − [ c/s ]           determinant m F' v² − F²
//! ```

use super::{History, ITERATIONS, Lagged, Sum, mul_add, not_converged};
use crate::run::Stepper;
use vi_systems::systems::DoubleWell;

/// Fixed steps.
#[derive(Clone, Debug)]
pub struct Fixed<S> {
    m: f64,
    h: f64,
    half: f64,
    square: f64,
    tolerance: f64,
    t: S,
    q: S,
    p: S,
    history: History,
    /// Where the next step starts: v, and x there.
    trial: (f64, f64),
    /// 1/A at the last three steps.
    inverse: Lagged,
}

impl<S: Sum> Fixed<S> {
    /// From `(q, p)` at t = 0. A Newton step of `tolerance` is the last one.
    #[must_use]
    pub fn new(system: &DoubleWell, (q, p): (f64, f64), h: f64, tolerance: f64) -> Self {
        let (m, half) = (system.m, h / 2.0);
        let v = p / m;
        let (t, history, trial) = (S::new(0.0), History::constant(v), (v, q + half * v));
        let (square, inverse) = (half * half, Lagged::constant(1.0 / m));
        Self { m, h, half, square, tolerance, t, q: S::new(q), p: S::new(p), history, trial, inverse }
    }
}

impl<S: Sum> Stepper for Fixed<S> {
    #[inline]
    fn step(&mut self) {
        let Self { m, h, half, square, .. } = *self;
        let (mut v, mut x) = self.trial;
        let mut inverse = self.inverse.next();
        let known = self.history.known();
        for _ in 0..ITERATIONS {
            // The next guess were there no Newton step.
            let next = mul_add(5.0, v, known);
            let next_x = self.q.plus(mul_add(h, v, half * next));
            let x2 = x * x;
            let slope = mul_add(-6.0, x2, 1.0);
            let force = x * mul_add(-2.0, x2, 1.0);
            let here = 1.0 / mul_add(-square, slope, m);
            let residual = self.p.plus(mul_add(half, force, -(m * v)));
            let newton = residual * inverse;
            v += newton;
            if newton.abs() <= self.tolerance {
                self.trial = (mul_add(5.0, newton, next), mul_add(3.5 * h, newton, next_x));
                self.inverse.push(here);
                self.history.push(v);
                self.q.grow(h, v);
                self.p.grow(h, mul_add(half * slope, newton, force));
                self.t.grow(h, 1.0);
                return;
            }
            x = self.q.plus(half * v);
            inverse = 1.0 / mul_add(-square, mul_add(-6.0, x * x, 1.0), m);
        }
        not_converged()
    }

    fn state(&self) -> Vec<f64> {
        vec![self.t.value(), self.q.value(), self.p.value()]
    }
}

/// Energy-preserving steps.
#[derive(Clone, Debug)]
pub struct EnergyPreserving<S> {
    m: f64,
    energy: f64,
    tolerance: f64,
    t: S,
    q: S,
    p: S,
    /// Of v and of h/2.
    history: [History; 2],
    /// 1/determinant at the last three steps.
    inverse: Lagged,
}

impl<S: Sum> EnergyPreserving<S> {
    /// From the middle `(q, v)` of the first interval, of length h, at t = 0. A Newton step of `tolerance` in v, and
    /// relative in h, is the last one.
    #[must_use]
    pub fn new(system: &DoubleWell, (q, v): (f64, f64), h: f64, tolerance: f64) -> Self {
        let (m, half) = (system.m, h / 2.0);
        let force = q * (1.0 - 2.0 * q * q);
        let (t, end, p) = (S::new(half), S::new(q + half * v), S::new(m * v + half * force));
        let energy = m * v * v / 2.0 + (q * q - 1.0) * q * q / 2.0;
        let slope = 1.0 - 6.0 * q * q;
        // From v alone Newton's iteration would find the step back, (v, −h).
        let history = [History::line(v, h * force / m), History::constant(half)];
        let inverse = Lagged::constant(1.0 / (m * slope * v * v - force * force));
        Self { m, energy, tolerance, t, q: end, p, history, inverse }
    }
}

impl<S: Sum> Stepper for EnergyPreserving<S> {
    #[inline]
    fn step(&mut self) {
        let m = self.m;
        let [mut v, mut s] = [self.history[0].next(), self.history[1].next()];
        let mut inverse = self.inverse.next();
        for _ in 0..ITERATIONS {
            let over = 1.0 / s;
            let x = self.q.plus(s * v);
            let x2 = x * x;
            let slope = mul_add(-6.0, x2, 1.0);
            let force = x * mul_add(-2.0, x2, 1.0);
            let r = self.p.plus(mul_add(s, force, -(m * v)));
            let e = mul_add(0.5 * x2, x2 - 1.0, mul_add(0.5 * m * v, v, -self.energy));
            let c = mul_add(v, r, e) * over;
            let (sv, vv) = (s * slope * v, slope * v * v);
            let determinant = mul_add(m, vv, -(force * force));
            let dv = mul_add(r, vv, -c * (force + sv)) * inverse;
            let ds = -mul_add(c, mul_add(-s * s, slope, m), r * (sv - force)) * inverse;
            (v, s) = (v + dv, s + ds);
            if dv.abs() <= self.tolerance && ds.abs() <= self.tolerance * s {
                let h = 2.0 * s;
                self.history[0].push(v);
                self.history[1].push(s);
                self.inverse.push(1.0 / determinant);
                // x has moved by s δv + v δs, but for a product of both.
                let force = mul_add(slope, mul_add(s, dv, v * ds), force);
                self.q.grow(h, v);
                self.p.grow(h, force);
                self.t.grow(h, 1.0);
                return;
            }
            inverse = 1.0 / determinant;
        }
        not_converged()
    }

    fn state(&self) -> Vec<f64> {
        vec![self.t.value(), self.q.value(), self.p.value()]
    }
}
