//! A symmetric top on a fixed point, by a unit quaternion R. Products are those of quaternions, Ω is the angular velocity of the
//! body at the middle Q of a step, and `u = (h/4) Ω`:
//!
//! ```text
//! Q = R0 (1 + u)/(1 + |u|²)        R1 = R0 (1 + u)²/(1 + |u|²)
//! 2 R1 J ω = p0 − h m g l K Q + 2 λ R0        ω = |Q|² Ω,   K = diag(1, −1, −1, 1)
//! ```
//!
//! Three equations are left, the imaginary part of R0⁻¹ times the last one. The momenta are then projected onto R1.

use super::{CORRECTIONS, FLOOR, History, Sum, not_converged};
use crate::run::Stepper;
use core::array::from_fn;

type Vector = [f64; 3];
/// Scalar first.
type Quaternion = [f64; 4];

#[inline]
fn product([a, b, c, d]: Quaternion, [e, f, g, h]: Quaternion) -> Quaternion {
    [
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    ]
}

#[inline]
fn inverse([a, b, c, d]: Quaternion) -> Quaternion {
    [a, -b, -c, -d]
}

/// K R: half of the slope of the height of the axis.
#[inline]
fn height([a, b, c, d]: Quaternion) -> Quaternion {
    [a, -b, -c, d]
}

#[inline]
fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline]
fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The x with `columns x = b`.
#[inline]
fn solve([a, b, c]: [Vector; 3], right: Vector) -> Vector {
    let determinant = dot(a, cross(b, c));
    [dot(right, cross(b, c)), dot(a, cross(right, c)), dot(a, cross(b, right))].map(|entry| entry / determinant)
}

/// Steps of order 2.
#[derive(Clone, Debug)]
pub struct Fixed<S> {
    inertia: Vector,
    /// m g l.
    weight: f64,
    h: f64,
    t: S,
    q: [S; 4],
    p: [S; 4],
    rate: [History; 3],
}

impl<S: Sum> Fixed<S> {
    /// The stepper at a unit quaternion with its velocity.
    #[must_use]
    pub fn new(inertia: Vector, weight: f64, [q, v]: [Quaternion; 2], h: f64) -> Self {
        let [_, x, y, z] = product(inverse(q), v).map(|entry| 2.0 * entry);
        let [a, b, c] = [inertia[0] * x, inertia[1] * y, inertia[2] * z];
        let p = product(q, [0.0, 2.0 * a, 2.0 * b, 2.0 * c]);
        let rate = [x, y, z].map(History::constant);
        Self { inertia, weight, h, t: S::new(0.0), q: q.map(S::new), p: p.map(S::new), rate }
    }
}

impl<S: Sum> Stepper for Fixed<S> {
    #[inline]
    fn step(&mut self) {
        let Self { inertia, weight, h, .. } = *self;
        let (q, p) = (self.q.map(|q| q.plus(0.0)), self.p.map(|p| p.plus(0.0)));
        let [_, known @ ..] = product(inverse(q), p);
        // R0⁻¹ K R0.
        let turned = |of: Quaternion| product(inverse(q), height(product(q, of)));
        let gravity: [Quaternion; 4] = from_fn(|i| turned(from_fn(|k| f64::from(u8::from(i == k)))));
        let mut rate: Vector = from_fn(|i| self.rate[i].next());
        let mut corrections = 0;
        let (u, n, momentum) = loop {
            let u = rate.map(|rate| h / 4.0 * rate);
            let momentum: Vector = from_fn(|i| inertia[i] * rate[i]);
            let square = dot(u, u);
            let (n, s) = (1.0 + square, 1.0 - square);
            let (over, moved) = (2.0 / ((1.0 + square) * n), cross(u, momentum));
            let turned: Vector = from_fn(|i| over * (s * momentum[i] + 2.0 * moved[i]));
            let pull: Vector =
                from_fn(|i| (gravity[0][i + 1] + (0..3).map(|k| gravity[k + 1][i + 1] * u[k]).sum::<f64>()) / n);
            let missing: Vector = from_fn(|i| turned[i] - known[i] + h * weight * pull[i]);
            let size = |i: usize| turned[i].abs() + known[i].abs() + (h * weight * pull[i]).abs();
            let worst = (0..3).fold(0.0, |worst: f64, i| worst.max(missing[i].abs() / (size(i) + p[0].abs())));
            if worst <= FLOOR && corrections > 0 {
                break (u, n, momentum);
            }
            if corrections == CORRECTIONS {
                not_converged();
            }
            corrections += 1;
            let columns: [Vector; 3] = from_fn(|k| {
                let unit: Vector = from_fn(|i| f64::from(u8::from(i == k)));
                let slope = h / 2.0 * u[k];
                let (along, across) = (cross(u, unit), cross(unit, momentum));
                from_fn(|i| {
                    let of_momentum = inertia[k] * (s * unit[i] + 2.0 * along[i]) + h / 2.0 * across[i];
                    let of_turn = over * (of_momentum - slope * momentum[i]) - 2.0 * slope / n * turned[i];
                    of_turn + h * weight * (h / 4.0 * gravity[k + 1][i + 1] - slope * pull[i]) / n
                })
            });
            let correction = solve(columns, missing);
            for (rate, correction) in rate.iter_mut().zip(correction) {
                *rate -= correction;
            }
        };
        // Q and R1 − R0 = h V, with V = Q Ω/2.
        let middle = product(q, [1.0, u[0], u[1], u[2]]).map(|entry| entry / n);
        let velocity = product(middle, [0.0, rate[0] / 2.0, rate[1] / 2.0, rate[2] / 2.0]);
        let pull = height(middle);
        // p1 = 2 R0 J ω − h m g l K Q, without its part along R1.
        let turned = product(q, [0.0, 2.0 * momentum[0] / n, 2.0 * momentum[1] / n, 2.0 * momentum[2] / n]);
        let end: Quaternion = from_fn(|i| q[i] + h * velocity[i]);
        let free: Quaternion = from_fn(|i| turned[i] - h * weight * pull[i]);
        let along = (0..4).map(|i| free[i] * end[i]).sum::<f64>() / (0..4).map(|i| end[i] * end[i]).sum::<f64>();
        for i in 0..4 {
            self.q[i].grow(h, velocity[i]);
            self.p[i].grow(1.0, (free[i] - along * end[i]) - p[i]);
        }
        for (history, rate) in self.rate.iter_mut().zip(rate) {
            history.push(rate);
        }
        self.t.grow(h, 1.0);
    }

    fn state(&self) -> Vec<f64> {
        let numbers = self.q.iter().chain(&self.p).map(|sum| sum.value());
        [self.t.value()].into_iter().chain(numbers).collect()
    }
}
