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

use super::{CORRECTIONS, History, Sum, is_energy_kept, is_solved, mul_add, not_converged};
use crate::run::Stepper;
use vi_systems::DoubleWell;

/// F and F' at x.
#[inline]
fn field(x: f64) -> (f64, f64) {
    let square = x * x;
    (x * mul_add(-2.0, square, 1.0), mul_add(-6.0, square, 1.0))
}

/// The sum of the absolute values of the terms of r; F changes its sign at ±√½.
#[inline]
fn terms<S: Sum>(m: f64, p: S, v: f64, s: f64, x: f64) -> [f64; 1] {
    let force = x.abs() * mul_add(2.0, x * x, 1.0);
    [p.value().abs() + (m * v).abs() + s * force]
}

/// Fixed steps.
#[derive(Clone, Debug)]
pub struct Fixed<S> {
    m: f64,
    h: f64,
    t: S,
    q: S,
    p: S,
    history: History,
    guess: Guess,
}

/// v, x and p0 of a step, which depend on the one before by its Newton step alone.
#[derive(Clone, Copy, Debug)]
struct Guess {
    v: f64,
    x: f64,
    p: f64,
}

impl<S: Sum> Fixed<S> {
    /// The stepper at `(q, p)` at t = 0.
    #[must_use]
    pub fn new(system: &DoubleWell, (q, p): (f64, f64), h: f64) -> Self {
        let (m, v) = (system.m, p / system.m);
        let (history, guess) = (History::constant(v), Guess { v, x: q + h / 2.0 * v, p });
        Self { m, h, t: S::new(0.0), q: S::new(q), p: S::new(p), history, guess }
    }
}

impl<S: Sum> Stepper for Fixed<S> {
    #[inline]
    fn step(&mut self) {
        let Self { m, h, guess, .. } = *self;
        let (s, over) = (h / 2.0, 1.0 / m);
        // The next guess were there no Newton step.
        let next = mul_add(5.0, guess.v, self.history.known());
        let next_x = self.q.plus(mul_add(h, guess.v, s * next));
        let (force, slope) = field(guess.x);
        // A⁻¹ = (1 + s² F'/m + …)/m: the next term is less than 1e-8 of it.
        let inverse = over * mul_add(s * s * over, slope, 1.0);
        let mut newton = mul_add(s, force, mul_add(-m, guess.v, guess.p)) * inverse;
        for _ in 0..CORRECTIONS {
            let v = guess.v + newton;
            let x = self.q.plus(s * v);
            let (measured, _) = field(x);
            let missing = self.p.plus(mul_add(s, measured, -(m * v)));
            if is_solved([missing], &[self.p], [h * measured], || terms(m, self.p, v, s, x)) {
                let carried = mul_add(s * slope, newton, force);
                self.guess.v = mul_add(5.0, newton, next);
                self.guess.x = mul_add(3.5 * h, newton, next_x);
                self.guess.p = self.p.plus(h * carried);
                self.history.push(v);
                self.q.grow(h, v);
                self.p.grow(h, measured);
                self.t.grow(h, 1.0);
                return;
            }
            newton = mul_add(missing, inverse, newton);
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
    t: S,
    q: S,
    p: S,
    /// The histories of v and of h/2.
    history: [History<7>; 2],
}

/// The two rows at some v and s.
struct Rows {
    /// −r and c.
    missing: f64,
    energy: f64,
    /// |E0| and the absolute values of the terms of the energy.
    terms: f64,
    force: f64,
    slope: f64,
}

impl<S: Sum> EnergyPreserving<S> {
    /// From the middle `(q, v)` of the first interval, of length h, at t = 0.
    #[must_use]
    pub fn new(system: &DoubleWell, (q, v): (f64, f64), h: f64) -> Self {
        let (m, half) = (system.m, h / 2.0);
        let (force, _) = field(q);
        let (t, end, p) = (S::new(half), S::new(q + half * v), S::new(m * v + half * force));
        let energy = m * v * v / 2.0 + (q * q - 1.0) * q * q / 2.0;
        // From v alone Newton's iteration would find the step back, (v, −h).
        let history = [History::line(v, h * force / m), History::constant(half)];
        Self { m, energy, t, q: end, p, history }
    }

    #[inline]
    fn at(&self, v: f64, s: f64) -> Rows {
        let x = self.q.plus(s * v);
        let (force, slope) = field(x);
        let missing = self.p.plus(mul_add(s, force, -(self.m * v)));
        let x2 = x * x;
        let kinetic = 0.5 * self.m * v * v;
        let e = mul_add(0.5 * x2, x2 - 1.0, kinetic - self.energy);
        let terms = mul_add(0.5 * x2, x2 + 1.0, kinetic + self.energy.abs());
        Rows { missing, energy: mul_add(v, missing, e), terms, force, slope }
    }
}

impl Rows {
    /// The Newton corrections of v and s.
    #[inline]
    fn newton(&self, m: f64, v: f64, s: f64) -> (f64, f64) {
        let Self { missing: r, energy, force, slope, .. } = *self;
        let (sv, vv) = (s * slope * v, slope * v * v);
        // One quotient: c/s and 1/determinant.
        let determinant = mul_add(m, vv, -(force * force));
        let over = 1.0 / (s * determinant);
        let (c, r) = (energy * over, r * (s * over));
        (mul_add(r, vv, -c * (force + sv)), -mul_add(c, mul_add(-s * s, slope, m), r * (sv - force)))
    }
}

impl<S: Sum> Stepper for EnergyPreserving<S> {
    #[inline]
    fn step(&mut self) {
        let [mut v, mut s] = [self.history[0].next(), self.history[1].next()];
        let mut rows = self.at(v, s);
        for corrections in 1..=CORRECTIONS {
            let (dv, ds) = rows.newton(self.m, v, s);
            (v, s) = (v + dv, s + ds);
            rows = self.at(v, s);
            let h = 2.0 * s;
            let p = [self.p];
            if is_solved([rows.missing], &p, [h * rows.force], || terms(self.m, self.p, v, s, self.q.plus(s * v)))
                & is_energy_kept(rows.energy, rows.terms, &p, [v], corrections)
            {
                self.history[0].push(v);
                self.history[1].push(s);
                self.q.grow(h, v);
                self.p.grow(h, rows.force);
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
