//! The Kepler problem, `L = |v|²/2 + μ/r`: both steppers, two unknowns and three.
//!
//! With `s = h/2`, `x = q0 + s v`, `F = −μ x/r³`, `F' = −μ (1/r³ − 3 x xᵀ/r⁵)`:
//!
//! ```text
//! r = v − s F − p0 = 0          A = ∂r/∂v = 1 − s² F'        q1 = q0 + h v      p1 = p0 + h F
//! ```

use super::{CORRECTIONS, Guess, History, Sum, bordered, is_energy_kept, is_solved, mul_add, not_converged};
use crate::run::Stepper;
use core::array::from_fn;
use vi_systems::Kepler;

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
}

/// The symmetric matrix times the vector.
#[inline]
fn times([xx, xy, yy]: [f64; 3], [x, y]: [f64; 2]) -> [f64; 2] {
    [mul_add(xx, x, xy * y), mul_add(xy, x, yy * y)]
}

/// The sums of the absolute values of the terms of r.
#[inline]
fn terms<S: Sum>(p: &[S; 2], v: [f64; 2], increment: [f64; 2]) -> [f64; 2] {
    from_fn(|i| p[i].value().abs() + v[i].abs() + 0.5 * increment[i].abs())
}

/// Fixed steps.
#[derive(Clone, Debug)]
pub struct Fixed<S> {
    mu: f64,
    h: f64,
    t: S,
    q: [S; 2],
    p: [S; 2],
    history: [History; 2],
    guess: Guess,
}

impl<S: Sum> Fixed<S> {
    /// The stepper at `(q, p)` at t = 0.
    pub fn new(system: &Kepler, (q, p): ([f64; 2], [f64; 2]), h: f64) -> Self {
        let guess = Guess { v: p, x: from_fn(|i| q[i] + h / 2.0 * p[i]), p };
        let (mu, history) = (system.mu, p.map(History::constant));
        Self { mu, h, t: S::new(0.0), q: q.map(S::new), p: p.map(S::new), history, guess }
    }
}

impl<S: Sum> Stepper for Fixed<S> {
    #[inline]
    fn step(&mut self) {
        let Self { mu, h, guess, .. } = *self;
        let s = h / 2.0;
        // The next guess were there no Newton step.
        let next: [f64; 2] = from_fn(|i| mul_add(5.0, guess.v[i], self.history[i].known()));
        let next_x: [f64; 2] = from_fn(|i| self.q[i].plus(mul_add(h, guess.v[i], s * next[i])));
        let Field { force, slope, .. } = Field::at(mu, guess.x);
        // A⁻¹ = 1 + s² F' + …: the next term is about 1e-8 of it.
        let solve = |missing: [f64; 2]| -> [f64; 2] {
            let bent = times(slope, missing);
            from_fn(|i| mul_add(s * s, bent[i], missing[i]))
        };
        let mut newton = solve(from_fn(|i| mul_add(s, force[i], guess.p[i] - guess.v[i])));
        for _ in 0..CORRECTIONS {
            let v: [f64; 2] = from_fn(|i| guess.v[i] + newton[i]);
            let measured = Field::at(mu, from_fn(|i| self.q[i].plus(s * v[i]))).force;
            let missing: [f64; 2] = from_fn(|i| self.p[i].plus(mul_add(s, measured[i], -v[i])));
            let increment = measured.map(|force| h * force);
            if is_solved(missing, &self.p, increment, || terms(&self.p, v, increment)) {
                let bent = times(slope, newton);
                for i in 0..2 {
                    self.guess.v[i] = mul_add(5.0, newton[i], next[i]);
                    self.guess.x[i] = mul_add(3.5 * h, newton[i], next_x[i]);
                    self.guess.p[i] = self.p[i].plus(h * mul_add(s, bent[i], force[i]));
                    self.history[i].push(v[i]);
                    self.q[i].grow(h, v[i]);
                    self.p[i].grow(h, measured[i]);
                }
                self.t.grow(h, 1.0);
                return;
            }
            let more = solve(missing);
            newton = from_fn(|i| newton[i] + more[i]);
        }
        not_converged()
    }

    fn state(&self) -> Vec<f64> {
        let ([x, y], [px, py]) = (self.q.map(S::value), self.p.map(S::value));
        vec![self.t.value(), x, y, px, py]
    }
}

#[inline]
fn kinetic(v: [f64; 2]) -> f64 {
    0.5 * mul_add(v[0], v[0], v[1] * v[1])
}

/// Energy-preserving steps.
#[derive(Clone, Debug)]
pub struct EnergyPreserving<S> {
    mu: f64,
    energy: f64,
    t: S,
    q: [S; 2],
    p: [S; 2],
    v: [History<7>; 2],
    /// Half of h.
    s: History<7>,
}

impl<S: Sum> EnergyPreserving<S> {
    /// From the middle `(q, v)` of the first interval, of length h, at t = 0.
    #[must_use]
    pub fn new(system: &Kepler, (q, v): ([f64; 2], [f64; 2]), h: f64) -> Self {
        let (mu, half) = (system.mu, h / 2.0);
        let Field { force, potential, .. } = Field::at(mu, q);
        Self {
            mu,
            energy: kinetic(v) + potential,
            t: S::new(half),
            q: from_fn(|i| S::new(q[i] + half * v[i])),
            p: from_fn(|i| S::new(v[i] + half * force[i])),
            // From v alone Newton's iteration would find the step back, (v, −h).
            v: from_fn(|i| History::line(v[i], h * force[i])),
            s: History::constant(half),
        }
    }

    /// r, c and the field at v and s.
    #[inline]
    fn at(&self, v: [f64; 2], s: f64) -> ([f64; 2], f64, Field) {
        let field = Field::at(self.mu, from_fn(|i| self.q[i].plus(s * v[i])));
        let r: [f64; 2] = from_fn(|i| -self.p[i].plus(mul_add(s, field.force[i], -v[i])));
        let e = kinetic(v) + (field.potential - self.energy);
        (r, e - mul_add(v[0], r[0], v[1] * r[1]), field)
    }
}

impl<S: Sum> Stepper for EnergyPreserving<S> {
    #[inline]
    fn step(&mut self) {
        let (mut v, mut s) = (self.v.map(|v| v.next()), self.s.next());
        let (mut r, mut c, mut field) = self.at(v, s);
        for corrections in 1..=CORRECTIONS {
            let bent = times(field.slope, v);
            let k = mul_add(v[0], bent[0], v[1] * bent[1]);
            let [xx, xy, yy] = field.derivative(s * s);
            let across = from_fn(|i| -mul_add(s, bent[i], field.force[i]));
            let along = from_fn(|i| mul_add(s, bent[i], -field.force[i]));
            let (dv, ds) = bordered([[xx, yy], across, along], [xy; 2], k, r, c / s);
            (v, s) = (from_fn(|i| v[i] + dv[i]), s + ds);
            (r, c, field) = self.at(v, s);
            let h = 2.0 * s;
            let force = field.force;
            let increment = force.map(|force| h * force);
            if is_solved(r, &self.p, increment, || terms(&self.p, v, increment))
                & is_energy_kept(c, self.energy.abs() - field.potential + kinetic(v), &self.p, v, corrections)
            {
                for i in 0..2 {
                    self.v[i].push(v[i]);
                    self.q[i].grow(h, v[i]);
                    self.p[i].grow(h, force[i]);
                }
                self.s.push(s);
                self.t.grow(h, 1.0);
                return;
            }
        }
        not_converged()
    }

    fn state(&self) -> Vec<f64> {
        let ([x, y], [px, py]) = (self.q.map(S::value), self.p.map(S::value));
        vec![self.t.value(), x, y, px, py]
    }
}
