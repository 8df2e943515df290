//! The Kepler problem, `L = |v|²/2 + μ/r`: both steppers, two unknowns and three.
//!
//! With `s = h/2`, `x = q0 + s v`, `F = −μ x/r³`, `F' = −μ (1/r³ − 3 x xᵀ/r⁵)`:
//!
//! ```text
//! r = v − s F − p0 = 0          A = ∂r/∂v = 1 − s² F'        q1 = q0 + h v      p1 = p0 + h F
//! ```

use super::{History, ITERATIONS, Lagged, Sum, bordered, mul_add, not_converged};
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
    inverse: [Lagged; 3],
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
            inverse: [1.0, 0.0, 1.0].map(Lagged::constant),
        }
    }
}

/// The force, its derivative (xx, xy, yy) and the potential at a place.
struct Field {
    force: [f64; 2],
    slope: [f64; 3],
    potential: f64,
}

impl Field {
    #[inline]
    fn at(mu: f64, [x, y]: [f64; 2]) -> Self {
        let (xx, yy) = (x * x, y * y);
        let rr = xx + yy;
        // A root and a quotient at the same time: −μ/r³, and 3 μ/r⁵.
        let over = 1.0 / rr;
        let root = rr.sqrt();
        let cube = -(mu * over * over) * root;
        let fifth = -3.0 * cube * over;
        let slope = [mul_add(fifth, xx, cube), fifth * x * y, mul_add(fifth, yy, cube)];
        Self { force: [cube * x, cube * y], slope, potential: -mu * over * root }
    }

    /// `A = 1 − s² F'`, with `square` = s².
    #[inline]
    fn derivative(&self, square: f64) -> [f64; 3] {
        let [xx, xy, yy] = self.slope;
        [mul_add(-square, xx, 1.0), -square * xy, mul_add(-square, yy, 1.0)]
    }

    /// A⁻¹.
    #[inline]
    fn inverse(&self, square: f64) -> [f64; 3] {
        let [xx, xy, yy] = self.derivative(square);
        let over = 1.0 / mul_add(xx, yy, -(xy * xy));
        [yy * over, -xy * over, xx * over]
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
        let Self { mu, h, half, square, .. } = *self;
        let [mut v, mut x] = self.trial;
        let mut inverse: [f64; 3] = self.inverse.map(|entry| entry.next());
        let known: [f64; 2] = from_fn(|i| self.history[i].known());
        for _ in 0..ITERATIONS {
            // The next guess were there no Newton step.
            let next: [f64; 2] = from_fn(|i| mul_add(5.0, v[i], known[i]));
            let next_x: [f64; 2] = from_fn(|i| self.q[i].plus(mul_add(h, v[i], half * next[i])));
            let field = Field::at(mu, x);
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
                for (lagged, entry) in self.inverse.iter_mut().zip(field.inverse(square)) {
                    lagged.push(entry);
                }
                self.t.grow(h, 1.0);
                return;
            }
            x = from_fn(|i| self.q[i].plus(half * v[i]));
            inverse = Field::at(mu, x).inverse(square);
        }
        not_converged()
    }

    fn state(&self) -> Vec<f64> {
        let [x, y] = self.q.map(S::value);
        let [px, py] = self.p.map(S::value);
        vec![self.t.value(), x, y, px, py]
    }
}

/// Energy-preserving steps.
#[derive(Clone, Debug)]
pub struct EnergyPreserving<S> {
    mu: f64,
    energy: f64,
    tolerance: f64,
    t: S,
    q: [S; 2],
    p: [S; 2],
    v: [History; 2],
    /// Half of h.
    s: History,
}

impl<S: Sum> EnergyPreserving<S> {
    /// From the middle `(q, v)` of the first interval, of length h, at t = 0. A Newton step of `tolerance` in v, and
    /// relative in h, is the last one.
    #[must_use]
    pub fn new(system: &Kepler, (q, v): ([f64; 2], [f64; 2]), h: f64, tolerance: f64) -> Self {
        let (mu, half) = (system.mu, h / 2.0);
        let Field { force, potential, .. } = Field::at(mu, q);
        Self {
            mu,
            energy: f64::midpoint(v[0] * v[0], v[1] * v[1]) + potential,
            tolerance,
            t: S::new(half),
            q: from_fn(|i| S::new(q[i] + half * v[i])),
            p: from_fn(|i| S::new(v[i] + half * force[i])),
            // From v alone Newton's iteration would find the step back, (v, −h).
            v: from_fn(|i| History::line(v[i], h * force[i])),
            s: History::constant(half),
        }
    }
}

impl<S: Sum> Stepper for EnergyPreserving<S> {
    #[inline]
    fn step(&mut self) {
        let (mut v, mut s) = (self.v.map(|v| v.next()), self.s.next());
        for _ in 0..ITERATIONS {
            let over = 1.0 / s;
            let Field { force, slope, potential } = Field::at(self.mu, from_fn(|i| self.q[i].plus(s * v[i])));
            let r: [f64; 2] = from_fn(|i| -self.p[i].plus(mul_add(s, force[i], -v[i])));
            let e = mul_add(0.5 * v[0], v[0], mul_add(0.5 * v[1], v[1], potential - self.energy));
            let c = (e - mul_add(v[0], r[0], v[1] * r[1])) * over;
            let bent = times(slope, v);
            let k = mul_add(v[0], bent[0], v[1] * bent[1]);
            let [xx, xy, yy] = (Field { force, slope, potential }).derivative(s * s);
            let across = from_fn(|i| -mul_add(s, bent[i], force[i]));
            let along = from_fn(|i| mul_add(s, bent[i], -force[i]));
            let (dv, ds) = bordered([[xx, yy], across, along], [xy; 2], k, r, c);
            (v, s) = (from_fn(|i| v[i] + dv[i]), s + ds);
            if dv[0].abs().max(dv[1].abs()) <= self.tolerance && ds.abs() <= self.tolerance * s {
                let h = 2.0 * s;
                let moved = times(slope, from_fn(|i| mul_add(s, dv[i], v[i] * ds)));
                for i in 0..2 {
                    self.v[i].push(v[i]);
                    self.q[i].grow(h, v[i]);
                    self.p[i].grow(h, force[i] + moved[i]);
                }
                self.s.push(s);
                self.t.grow(h, 1.0);
                return;
            }
        }
        not_converged()
    }

    fn state(&self) -> Vec<f64> {
        let [x, y] = self.q.map(S::value);
        let [px, py] = self.p.map(S::value);
        vec![self.t.value(), x, y, px, py]
    }
}
