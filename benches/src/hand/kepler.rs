//! The Kepler problem, `L = |v|²/2 + μ/r`: both steppers, two unknowns and three.
//!
//! With `s = h/2`, `x = q0 + s v`, `F = −μ x/r³`, `F' = −μ (1/r³ − 3 x xᵀ/r⁵)`:
//!
//! ```text
//! r = v − s F − p0 = 0          A = ∂r/∂v = 1 − s² F'        q1 = q0 + h v      p1 = p0 + h F
//! ```

use super::{History, ITERATIONS, Sum, mul_add, not_converged};
use crate::run::Stepper;
use core::array::from_fn;
use vi_systems::systems::Kepler;

/// Fixed steps.
#[derive(Clone, Debug)]
pub struct Fixed<S> {
    mu: f64,
    h: f64,
    half: f64,
    square: f64,
    tolerance: f64,
    t: S,
    q: [S; 2],
    p: [S; 2],
    history: [History; 2],
    /// Where the next step starts: v, and x there.
    trial: [[f64; 2]; 2],
    /// A⁻¹ at the last three steps: xx, xy, yy.
    inverse: [[f64; 3]; 3],
}

impl<S: Sum> Fixed<S> {
    /// From `(q, p)` at t = 0. A Newton step of `tolerance` is the last one.
    pub fn new(system: &Kepler, (q, p): ([f64; 2], [f64; 2]), h: f64, tolerance: f64) -> Self {
        let half = h / 2.0;
        Self {
            mu: system.mu,
            h,
            half,
            square: half * half,
            tolerance,
            t: S::new(0.0),
            q: q.map(S::new),
            p: p.map(S::new),
            history: p.map(History::constant),
            trial: [p, [q[0] + half * p[0], q[1] + half * p[1]]],
            inverse: [[1.0, 0.0, 1.0]; 3],
        }
    }
}

/// The force and its derivative at a place, and the inverse of A.
struct Field {
    force: [f64; 2],
    slope: [f64; 3],
    inverse: [f64; 3],
}

impl Field {
    #[inline]
    fn at(mu: f64, square: f64, [x, y]: [f64; 2]) -> Self {
        let (xx, yy) = (x * x, y * y);
        let rr = xx + yy;
        let over = 1.0 / rr;
        // A root and a quotient at the same time: −μ/r³, and 3 μ/r⁵.
        let cube = -(mu * over * over) * rr.sqrt();
        let fifth = -3.0 * cube * over;
        let slope = [mul_add(fifth, xx, cube), fifth * x * y, mul_add(fifth, yy, cube)];
        let a = [mul_add(-square, slope[0], 1.0), -square * slope[1], mul_add(-square, slope[2], 1.0)];
        let over = 1.0 / mul_add(a[0], a[2], -(a[1] * a[1]));
        Self { force: [cube * x, cube * y], slope, inverse: [a[2] * over, -a[1] * over, a[0] * over] }
    }
}

/// The symmetric matrix times the vector.
#[inline]
fn times([xx, xy, yy]: [f64; 3], [x, y]: [f64; 2]) -> [f64; 2] {
    [mul_add(xx, x, xy * y), mul_add(xy, x, yy * y)]
}

impl<S: Sum> Stepper for Fixed<S> {
    #[inline]
    fn step(&mut self) {
        let Self { mu, h, half, square, inverse: [inverse1, inverse2, inverse3], .. } = *self;
        let [mut v, mut x] = self.trial;
        let mut inverse: [f64; 3] = from_fn(|i| mul_add(3.0, inverse1[i] - inverse2[i], inverse3[i]));
        let known: [f64; 2] = from_fn(|i| self.history[i].known());
        for _ in 0..ITERATIONS {
            // The next guess were there no Newton step.
            let next: [f64; 2] = from_fn(|i| mul_add(5.0, v[i], known[i]));
            let next_x: [f64; 2] = from_fn(|i| self.q[i].plus(mul_add(h, v[i], half * next[i])));
            let field = Field::at(mu, square, x);
            let residual: [f64; 2] = from_fn(|i| self.p[i].plus(mul_add(half, field.force[i], -v[i])));
            let newton = times(inverse, residual);
            v = from_fn(|i| v[i] + newton[i]);
            if newton[0].abs().max(newton[1].abs()) <= self.tolerance {
                let carried = times(field.slope, newton);
                for i in 0..2 {
                    self.trial[0][i] = mul_add(5.0, newton[i], next[i]);
                    self.trial[1][i] = mul_add(3.5 * h, newton[i], next_x[i]);
                    self.history[i].push(v[i]);
                    self.q[i].grow(h, v[i]);
                    self.p[i].grow(h, mul_add(half, carried[i], field.force[i]));
                }
                self.inverse = [field.inverse, inverse1, inverse2];
                self.t.grow(h, 1.0);
                return;
            }
            x = from_fn(|i| self.q[i].plus(half * v[i]));
            inverse = Field::at(mu, square, x).inverse;
        }
        not_converged()
    }

    fn state(&self) -> Vec<f64> {
        let [x, y] = self.q.map(S::value);
        let [px, py] = self.p.map(S::value);
        vec![self.t.value(), x, y, px, py]
    }
}
