//! The paper's equations F and G of the double well in (v, h), solved in plain double precision.
//!
//! In: a first interval and a [`Solver`]. Out: the steps. Newton's iteration has the exact Jacobian. Nothing is scaled or
//! compensated. The formulas are the printed ones, with m = 1.

/// The stopping rule of the iteration, and the energy of the next step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solver {
    /// The largest accepted norm of (F, G). Without one the iteration stops when the norm no longer decreases.
    pub(super) tolerance: Option<f64>,
    /// Whether `E_k` stays `E_1`. Otherwise every step recomputes it from its own v and h, as the paper's formula does.
    pub(super) is_carried: bool,
}

/// A node, and the interval that led to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plain {
    q: f64,
    p: f64,
    /// The energy that the next step has to match.
    energy: f64,
    v: f64,
    h: f64,
}

/// A step: its midpoint, its velocity, its length and the energy there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) q: f64,
    pub(super) v: f64,
    pub(super) h: f64,
    pub(super) energy: f64,
}

/// Newton iterations of a step at most.
const MOST: u32 = 50;
/// A norm of (F, G) above this is not yet at the floor, even if an iteration increases it.
const NEAR: f64 = 1e-10;

/// Half of the force `q − 2q³`.
fn half_force(q: f64) -> f64 {
    q / 2.0 - q.powi(3)
}

/// The derivative of [`half_force`].
fn half_slope(q: f64) -> f64 {
    0.5 - 3.0 * q * q
}

fn energy(q: f64, v: f64) -> f64 {
    v * v / 2.0 + (q.powi(4) - q * q) / 2.0
}

impl Plain {
    /// The first interval, from q0 to q1 in the time h.
    pub(super) fn first(q0: f64, q1: f64, h: f64) -> Self {
        let v = (q1 - q0) / h;
        let middle = f64::midpoint(q0, q1);
        Self { q: q1, p: v + h * half_force(middle), energy: energy(middle, v), v, h }
    }

    /// Takes a step; `None` if the iteration finds no h > 0.
    pub(super) fn step(&mut self, solver: Solver) -> Option<Seen> {
        let (v, h) = self.solve(solver.tolerance)?;
        let middle = self.q + h * v / 2.0;
        let reached = energy(middle, v);
        self.p = v + h * half_force(middle);
        self.q += h * v;
        if !solver.is_carried {
            self.energy = reached;
        }
        (self.v, self.h) = (v, h);
        Some(Seen { q: middle, v, h, energy: reached })
    }

    /// Solves F = G = 0 from the velocity of the momentum equation at the last h.
    fn solve(&self, tolerance: Option<f64>) -> Option<(f64, f64)> {
        let (mut v, mut h) = (self.v, self.h);
        for _ in 0..5 {
            let middle = self.q + h * v / 2.0;
            v -= (v - h * half_force(middle) - self.p) / (1.0 - h * h / 2.0 * half_slope(middle));
        }
        let mut best = (f64::INFINITY, v, h);
        for _ in 0..MOST {
            let middle = self.q + h * v / 2.0;
            let (force, slope) = (half_force(middle), half_slope(middle));
            let f = v - h * force - self.p;
            let g = energy(middle, v) - self.energy;
            let norm = f.hypot(g);
            let is_less = norm < best.0;
            if is_less {
                best = (norm, v, h);
            }
            let is_done = tolerance.map_or(!is_less && best.0 < NEAR, |tolerance| norm < tolerance);
            if is_done || !norm.is_finite() {
                break;
            }
            let [f_v, f_h] = [1.0 - h * h / 2.0 * slope, -force - h * v / 2.0 * slope];
            let [g_v, g_h] = [v - h * force, -force * v];
            let determinant = f_v * g_h - f_h * g_v;
            (v, h) = (v + (g * f_h - f * g_h) / determinant, h + (f * g_v - g * f_v) / determinant);
        }
        let (_, v, h) = best;
        (h > 0.0 && best.0.is_finite()).then_some((v, h))
    }

    /// The determinant of the Jacobian of (F, G) at a step, and `−(h/4) D` there.
    #[cfg(test)]
    fn determinant(middle: f64, v: f64, h: f64) -> (f64, f64) {
        let (force, slope) = (half_force(middle), half_slope(middle));
        let determinant = (1.0 - h * h / 2.0 * slope) * (-force * v) - (-force - h * v / 2.0 * slope) * (v - h * force);
        (determinant, -h / 4.0 * density(middle, v))
    }
}

/// The step density D = V′² + V″ v².
pub(super) fn density(q: f64, v: f64) -> f64 {
    (2.0 * half_force(q)).powi(2) - 2.0 * half_slope(q) * v * v
}

/// The sum of the absolute values of the terms of the energy.
pub(super) fn magnitude(q: f64, v: f64) -> f64 {
    v * v / 2.0 + f64::midpoint(q.powi(4), q * q)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conservative::runs::Case;

    #[test]
    fn plain_steps_are_those_of_the_stepper() {
        let case = Case { q0: 0.995, h0: 0.05 };
        let mut stepper = case.start().expect("a start");
        let mut plain = Plain::first(case.q0, stepper.state().q.x, case.h0);
        let mut worst = 0.0_f64;
        for _ in 0..200 {
            let step = stepper.detailed_step().expect("a step");
            let seen = plain.step(Solver { tolerance: None, is_carried: true }).expect("a step");
            worst = worst.max((seen.q - step.midpoint.1.x).abs()).max((seen.h - step.h).abs());
        }
        // Measured 2.5e-12: the roundings of 200 plain steps.
        assert!(worst < 1e-11, "{worst}");
    }

    #[test]
    fn the_determinant_is_a_quarter_of_h_times_the_density() {
        let mut worst = 0.0_f64;
        for (middle, v, h) in [(0.7, 0.3, 0.1), (0.2, -0.4, 0.01), (0.99, 0.02, 0.3)] {
            let (determinant, expected) = Plain::determinant(middle, v, h);
            worst = worst.max((determinant / expected - 1.0).abs());
        }
        // Measured 2.4e-14.
        assert!(worst < 1e-13, "{worst}");
    }

    #[test]
    fn an_error_of_the_energy_changes_the_length_by_the_law() {
        let case = Case { q0: 0.995, h0: 1e-3 };
        let stepper = case.start().expect("a start");
        let plain = Plain::first(case.q0, stepper.state().q.x, case.h0);
        let solver = Solver { tolerance: None, is_carried: true };
        let seen = { plain }.step(solver).expect("a step");
        // A thousandth of h² D/8.
        let error = 1e-3 * seen.h * seen.h * density(seen.q, seen.v) / 8.0;
        let mut wrong = Plain { energy: plain.energy + error, ..plain };
        let change = wrong.step(solver).expect("a step").h - seen.h;
        let law = -4.0 * error / (seen.h * density(seen.q, seen.v));
        // Measured 2.5e-4, a quarter of the relative error of H − E.
        assert!((change / law - 1.0).abs() < 1e-3, "{change} {law}");
    }
}
