//! The double pendulum in absolute angles: both steppers, two unknowns and three.
//!
//! With `a = (m1 + m2) l1²`, `b = m2 l2²`, `c = m2 l1 l2`, `G1 = (m1 + m2) g l1`, `G2 = m2 g l2`, the angles x and y at the
//! middle, d = x − y, `s = h/2`, velocities u and v, and `w = c u v cos d`:
//!
//! ```text
//! L_v = (a u + c v cos d, b v + c u cos d)          L_q = (−c u v sin d − G1 sin x, c u v sin d − G2 sin y)
//! r = L_v − s L_q − p0
//! A = [ a + s² (w + G1 cos x)                        c cos d + s c (u + v) sin d − s² w ]
//!     [ c cos d − s c (u + v) sin d − s² w           b + s² (w + G2 cos y)              ]
//! ```

use super::{
    CORRECTIONS, Guess, History, Sum, bordered, is_energy_kept, is_solved, mul_add, not_converged, sine::Angle,
};
use crate::run::Stepper;
use core::array::from_fn;
use vi_systems::DoublePendulum;

#[derive(Clone, Copy, Debug)]
struct Constants {
    a: f64,
    b: f64,
    c: f64,
    weight: [f64; 2],
}

impl Constants {
    fn of(system: &DoublePendulum) -> Self {
        let &DoublePendulum { m1, m2, l1, l2, g } = system;
        let weight = [(m1 + m2) * g * l1, m2 * g * l2];
        Self { a: (m1 + m2) * l1 * l1, b: m2 * l2 * l2, c: m2 * l1 * l2, weight }
    }
}

/// Derivatives of L at the middle of a step.
struct Middle {
    angles: [Angle; 2],
    momentum: [f64; 2],
    force: [f64; 2],
    /// `c sin d` and `c cos d`.
    sine: f64,
    cosine: f64,
    /// `G cos` of both angles.
    upright: [f64; 2],
    w: f64,
}

impl Middle {
    #[inline]
    fn at(constants: &Constants, q: [f64; 2], v: [f64; 2]) -> Self {
        Self::of(constants, q.map(Angle::at), v)
    }

    /// At angles next to these ones.
    #[inline]
    fn near(&self, constants: &Constants, q: [f64; 2], v: [f64; 2]) -> Self {
        Self::of(constants, from_fn(|i| self.angles[i].near(q[i])), v)
    }

    #[inline]
    fn of(constants: &Constants, angles: [Angle; 2], [u, v]: [f64; 2]) -> Self {
        let Constants { a, b, c, weight } = *constants;
        let [Angle { sine: sin_x, cosine: cos_x, .. }, Angle { sine: sin_y, cosine: cos_y, .. }] = angles;
        let sine = c * mul_add(sin_x, cos_y, -(cos_x * sin_y));
        let cosine = c * mul_add(cos_x, cos_y, sin_x * sin_y);
        let (w, pull) = (u * v * cosine, u * v * sine);
        Self {
            angles,
            momentum: [mul_add(a, u, v * cosine), mul_add(b, v, u * cosine)],
            force: [-mul_add(weight[0], sin_x, pull), mul_add(-weight[1], sin_y, pull)],
            sine,
            cosine,
            upright: [weight[0] * cos_x, weight[1] * cos_y],
            w,
        }
    }

    /// A, its diagonal and the rest.
    #[inline]
    fn derivative(&self, constants: &Constants, s: f64, [u, v]: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let square = s * s;
        let even = mul_add(-square, self.w, self.cosine);
        let odd = s * (u + v) * self.sine;
        let diagonal = [
            mul_add(square, self.w + self.upright[0], constants.a),
            mul_add(square, self.w + self.upright[1], constants.b),
        ];
        (diagonal, [even + odd, even - odd])
    }

    /// The rate of change of L_v with the angles at these velocities, minus L_q.
    #[inline]
    fn steady(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let turn = self.sine * (v - u);
        [mul_add(turn, v, -self.force[0]), mul_add(turn, u, -self.force[1])]
    }

    /// The sums of the absolute values of p0, of the terms of L_v and of the increments of the momenta.
    #[inline]
    fn terms<S: Sum>(&self, constants: &Constants, p: &[S; 2], [u, v]: [f64; 2], increment: [f64; 2]) -> [f64; 2] {
        let momentum =
            [(constants.a * u).abs() + (v * self.cosine).abs(), (constants.b * v).abs() + (u * self.cosine).abs()];
        from_fn(|i| p[i].value().abs() + momentum[i] + increment[i].abs())
    }

    /// The sum of the absolute values of the terms of the energy.
    #[inline]
    fn energies(&self, v: [f64; 2]) -> f64 {
        let kinetic = (v[0] * self.momentum[0]).abs() + (v[1] * self.momentum[1]).abs();
        mul_add(0.5, kinetic, self.upright[0].abs() + self.upright[1].abs())
    }

    /// The change of L_q if the velocities change by `dv` and the angles by `dq`.
    #[inline]
    fn carried(&self, [u, v]: [f64; 2], dv: [f64; 2], dq: [f64; 2]) -> [f64; 2] {
        let pull = mul_add(self.sine, mul_add(v, dv[0], u * dv[1]), self.w * (dq[0] - dq[1]));
        [-mul_add(self.upright[0], dq[0], pull), mul_add(-self.upright[1], dq[1], pull)]
    }

    /// The Newton step in v and s for the residuals r and c.
    #[inline]
    fn newton(&self, constants: &Constants, v: [f64; 2], s: f64, r: [f64; 2], c: f64) -> ([f64; 2], f64) {
        // L_qq v, and the rate of change of L_v with the angles, minus L_q.
        let (bent, steady) = (self.carried(v, [0.0; 2], v), self.steady(v));
        let k = mul_add(v[0], bent[0], v[1] * bent[1]);
        let (diagonal, off) = self.derivative(constants, s, v);
        let across = from_fn(|i| mul_add(-s, bent[i], steady[i]));
        let along = from_fn(|i| mul_add(s, bent[i], steady[i]));
        bordered([diagonal, across, along], off, k, r, c / s)
    }
}

/// Fixed steps.
#[derive(Clone, Debug)]
pub struct Fixed<S> {
    constants: Constants,
    h: f64,
    t: S,
    q: [S; 2],
    p: [S; 2],
    history: [History<7>; 2],
    guess: Guess,
}

impl<S: Sum> Fixed<S> {
    /// The stepper at angles `q` and velocities `v` at t = 0.
    pub fn new(system: &DoublePendulum, (q, v): ([f64; 2], [f64; 2]), h: f64) -> Self {
        let constants = Constants::of(system);
        let p = Middle::at(&constants, q, v).momentum;
        let guess = Guess { v, x: from_fn(|i| q[i] + h / 2.0 * v[i]), p };
        let history = v.map(History::constant);
        Self { constants, h, t: S::new(0.0), q: q.map(S::new), p: p.map(S::new), history, guess }
    }
}

impl<S: Sum> Stepper for Fixed<S> {
    #[inline]
    fn step(&mut self) {
        let Self { constants, h, guess, .. } = *self;
        let s = h / 2.0;
        // The next guess were there no Newton step.
        let next: [f64; 2] = from_fn(|i| mul_add(7.0, guess.v[i], self.history[i].known()));
        let next_x: [f64; 2] = from_fn(|i| self.q[i].plus(mul_add(h, guess.v[i], s * next[i])));
        let middle = Middle::at(&constants, guess.x, guess.v);
        let (diagonal, off) = middle.derivative(&constants, s, guess.v);
        let over = 1.0 / mul_add(diagonal[0], diagonal[1], -(off[0] * off[1]));
        let solve = |missing: [f64; 2]| {
            [
                mul_add(diagonal[1], missing[0], -(off[0] * missing[1])) * over,
                mul_add(diagonal[0], missing[1], -(off[1] * missing[0])) * over,
            ]
        };
        let mut newton = solve(from_fn(|i| mul_add(s, middle.force[i], guess.p[i] - middle.momentum[i])));
        for _ in 0..CORRECTIONS {
            let v: [f64; 2] = from_fn(|i| guess.v[i] + newton[i]);
            let measured = middle.near(&constants, from_fn(|i| self.q[i].plus(s * v[i])), v);
            let missing: [f64; 2] = from_fn(|i| self.p[i].plus(mul_add(s, measured.force[i], -measured.momentum[i])));
            let increment = measured.force.map(|force| h * force);
            if is_solved(missing, &self.p, increment, || measured.terms(&constants, &self.p, v, increment)) {
                let carried = middle.carried(guess.v, newton, newton.map(|d| s * d));
                for i in 0..2 {
                    self.guess.v[i] = mul_add(7.0, newton[i], next[i]);
                    self.guess.x[i] = mul_add(4.5 * h, newton[i], next_x[i]);
                    self.guess.p[i] = self.p[i].plus(h * (middle.force[i] + carried[i]));
                    self.history[i].push(v[i]);
                    self.q[i].grow(h, v[i]);
                    self.p[i].grow(h, measured.force[i]);
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
        let ([q1, q2], [p1, p2]) = (self.q.map(S::value), self.p.map(S::value));
        vec![self.t.value(), q1, q2, p1, p2]
    }
}

/// Energy-preserving steps.
#[derive(Clone, Debug)]
pub struct EnergyPreserving<S> {
    constants: Constants,
    energy: f64,
    t: S,
    q: [S; 2],
    p: [S; 2],
    v: [History<7>; 2],
    /// Half of h.
    s: History<7>,
}

impl<S: Sum> EnergyPreserving<S> {
    /// The stepper after the first interval, with the middle `(q, v)`, of length h, at t = 0.
    #[must_use]
    pub fn new(system: &DoublePendulum, (q, v): ([f64; 2], [f64; 2]), h: f64) -> Self {
        let (constants, half) = (Constants::of(system), h / 2.0);
        let middle = Middle::at(&constants, q, v);
        let (mass, [coupling, _]) = middle.derivative(&constants, 0.0, v);
        let applied = middle.steady(v).map(|steady| -steady);
        let over = 1.0 / (mass[0] * mass[1] - coupling * coupling);
        let acceleration = [
            (mass[1] * applied[0] - coupling * applied[1]) * over,
            (mass[0] * applied[1] - coupling * applied[0]) * over,
        ];
        Self {
            constants,
            energy: energy(&middle, v),
            t: S::new(half),
            q: from_fn(|i| S::new(q[i] + half * v[i])),
            p: from_fn(|i| S::new(middle.momentum[i] + half * middle.force[i])),
            // From v alone Newton's iteration would find the step back, (v, −h).
            v: from_fn(|i| History::line(v[i], h * acceleration[i])),
            s: History::constant(half),
        }
    }

    /// The angles at v and s.
    #[inline]
    fn angles(&self, v: [f64; 2], s: f64) -> [f64; 2] {
        from_fn(|i| self.q[i].plus(s * v[i]))
    }

    /// r and c.
    #[inline]
    fn residuals(&self, middle: &Middle, v: [f64; 2], s: f64) -> ([f64; 2], f64) {
        let r: [f64; 2] = from_fn(|i| -self.p[i].plus(mul_add(s, middle.force[i], -middle.momentum[i])));
        (r, energy(middle, v) - self.energy - mul_add(v[0], r[0], v[1] * r[1]))
    }
}

/// `v·L_v − L = v·L_v/2 + V`.
#[inline]
fn energy(middle: &Middle, v: [f64; 2]) -> f64 {
    let Middle { momentum, upright, .. } = middle;
    mul_add(0.5 * v[0], momentum[0], mul_add(0.5 * v[1], momentum[1], -(upright[0] + upright[1])))
}

impl<S: Sum> Stepper for EnergyPreserving<S> {
    #[inline]
    fn step(&mut self) {
        let (mut v, mut s) = (self.v.map(|v| v.next()), self.s.next());
        let mut middle = Middle::at(&self.constants, self.angles(v, s), v);
        let (mut r, mut c) = self.residuals(&middle, v, s);
        for corrections in 1..=CORRECTIONS {
            let (dv, ds) = middle.newton(&self.constants, v, s, r, c);
            (v, s) = (from_fn(|i| v[i] + dv[i]), s + ds);
            middle = middle.near(&self.constants, self.angles(v, s), v);
            (r, c) = self.residuals(&middle, v, s);
            let h = 2.0 * s;
            let force = middle.force;
            let increment = force.map(|force| h * force);
            if is_solved(r, &self.p, increment, || middle.terms(&self.constants, &self.p, v, increment))
                & is_energy_kept(c, self.energy.abs() + middle.energies(v), &self.p, v, corrections)
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
        let ([q1, q2], [p1, p2]) = (self.q.map(S::value), self.p.map(S::value));
        vec![self.t.value(), q1, q2, p1, p2]
    }
}
