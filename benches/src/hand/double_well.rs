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

use super::{History, ITERATIONS, Sum, mul_add, not_converged};
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
    inverse: [f64; 3],
}

impl<S: Sum> Fixed<S> {
    /// From `(q, p)` at t = 0. A Newton step of `tolerance` is the last one.
    pub fn new(system: &DoubleWell, (q, p): (f64, f64), h: f64, tolerance: f64) -> Self {
        let (m, half) = (system.m, h / 2.0);
        let v = p / m;
        let (t, history, trial) = (S::new(0.0), History::constant(v), (v, q + half * v));
        let (square, inverse) = (half * half, [1.0 / m; 3]);
        Self { m, h, half, square, tolerance, t, q: S::new(q), p: S::new(p), history, trial, inverse }
    }
}

impl<S: Sum> Stepper for Fixed<S> {
    #[inline]
    fn step(&mut self) {
        let Self { m, h, half, square, inverse: [inverse1, inverse2, inverse3], .. } = *self;
        let (mut v, mut x) = self.trial;
        let mut inverse = mul_add(3.0, inverse1 - inverse2, inverse3);
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
                self.inverse = [here, inverse1, inverse2];
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
