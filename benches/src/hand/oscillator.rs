//! The harmonic oscillator, `L = m v²/2 − k x²/2`: its momentum equation is linear, and a step is the increment
//!
//! ```text
//! v = (p0 − s k q0)/(m + s² k)      q1 = q0 + h v      p1 = p0 − h k (q0 + s v)      s = h/2
//! ```
//!
//! as two constant rows, computed once; both are measured at the v that they give. Beside it the same step by Newton's iteration,
//! as if nobody knew that it is linear.

use super::{CORRECTIONS, History, Sum, is_solved, mul_add, not_converged};
use crate::run::Stepper;
use vi_systems::HarmonicOscillator;

/// The momentum equation of an oscillator over steps of one length.
#[derive(Clone, Copy, Debug)]
struct Equation {
    m: f64,
    k: f64,
    h: f64,
    /// 1/A.
    inverse: f64,
}

impl Equation {
    fn of(system: &HarmonicOscillator, h: f64) -> Self {
        let &HarmonicOscillator { m, k } = system;
        Self { m, k, h, inverse: 1.0 / (m + h * h / 4.0 * k) }
    }

    /// The sum of the absolute values of the terms of r.
    #[inline]
    fn terms<S: Sum>(&self, q: S, p: S, v: f64) -> [f64; 1] {
        let x = q.value().abs() + self.h / 2.0 * v.abs();
        [p.value().abs() + self.m * v.abs() + self.h / 2.0 * self.k * x]
    }

    /// −r and F at v.
    #[inline]
    fn at<S: Sum>(&self, q: S, p: S, v: f64) -> (f64, f64) {
        let s = self.h / 2.0;
        let force = -self.k * q.plus(s * v);
        (p.plus(mul_add(s, force, -(self.m * v))), force)
    }
}

/// Fixed steps in closed form.
#[derive(Clone, Debug)]
pub struct Fixed<S> {
    equation: Equation,
    /// v of q0 and p0; F of q0 and p0.
    rows: [[f64; 2]; 2],
    t: S,
    q: S,
    p: S,
}

impl<S: Sum> Fixed<S> {
    /// From `(q, p)` at t = 0.
    #[must_use]
    pub fn new(system: &HarmonicOscillator, (q, p): (f64, f64), h: f64) -> Self {
        let equation = Equation::of(system, h);
        let Equation { m, k, inverse, .. } = equation;
        let half = h / 2.0;
        let rows = [[-half * k * inverse, inverse], [-k * m * inverse, -k * half * inverse]];
        Self { equation, rows, t: S::new(0.0), q: S::new(q), p: S::new(p) }
    }
}

impl<S: Sum> Stepper for Fixed<S> {
    #[inline]
    fn step(&mut self) {
        let Self { equation, q, p, .. } = *self;
        let Equation { h, inverse, .. } = equation;
        let [mut v, mut force] = self.rows.map(|[of_q, of_p]| mul_add(of_q, q.value(), of_p * p.value()));
        for _ in 0..CORRECTIONS {
            let (missing, measured) = equation.at(q, p, v);
            let gain = [h * force];
            if is_solved([missing], &[p], gain, || equation.terms(q, p, v))
                && is_solved([h * (force - measured)], &[p], gain, || equation.terms(q, p, v))
            {
                self.q.grow(h, v);
                self.p.grow(h, force);
                self.t.grow(h, 1.0);
                return;
            }
            (v, force) = (mul_add(missing, inverse, v), measured);
        }
        not_converged()
    }

    fn state(&self) -> Vec<f64> {
        vec![self.t.value(), self.q.value(), self.p.value()]
    }
}

/// Fixed steps by Newton's iteration.
#[derive(Clone, Debug)]
pub struct Newton<S> {
    equation: Equation,
    t: S,
    q: S,
    p: S,
    history: History,
}

impl<S: Sum> Newton<S> {
    /// From `(q, p)` at t = 0.
    #[must_use]
    pub fn new(system: &HarmonicOscillator, (q, p): (f64, f64), h: f64) -> Self {
        let (equation, history) = (Equation::of(system, h), History::constant(p / system.m));
        Self { equation, t: S::new(0.0), q: S::new(q), p: S::new(p), history }
    }
}

impl<S: Sum> Stepper for Newton<S> {
    #[inline]
    fn step(&mut self) {
        let Self { equation, q, p, .. } = *self;
        let Equation { m, k, h, .. } = equation;
        let mut v = self.history.next();
        let (mut missing, _) = equation.at(q, p, v);
        for _ in 0..CORRECTIONS {
            v += missing / mul_add(h * h / 4.0, k, m);
            let force;
            (missing, force) = equation.at(q, p, v);
            if is_solved([missing], &[p], [h * force], || equation.terms(q, p, v)) {
                self.history.push(v);
                self.q.grow(h, v);
                self.p.grow(h, force);
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
