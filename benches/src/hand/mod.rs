//! Steppers written by hand, each for one system: what an expert would write who knows all that the generator knows.
//!
//! All solve for v (and h) from a guess extrapolated with order 4 or 6 over the last steps, as the generated steppers do:
//!
//! ```text
//! correct    v ← v − A⁻¹ r(v)
//! measure    r(v) and p1 − p0, by one evaluation at the new v
//! accept     if each row has |r_i| ≤ 4 ε (|p0_i| + |p1_i − p0_i|), or 4 ε times the sum of the absolute values of its terms,
//!            and the energy row |c| ≤ (ε/2) (|E0| + Σ |terms of E| + Σ_i |v_i p0_i|)
//! else       correct again
//! ```
//!
//! Generic over [`Sum`]: plain sums, or those that keep what rounding takes from them, as the generated steppers do.

pub mod chain;
pub mod double_pendulum;
pub mod double_well;
pub mod heavy_top;
pub mod kepler;
pub mod rods;
mod sine;

use core::array::from_fn;
use core::fmt::Debug;

/// Corrections after which a step is given up.
const CORRECTIONS: usize = 20;
/// Part of its scale that an accepted step may leave of a momentum row: four roundings.
const FLOOR: f64 = 4.0 * f64::EPSILON;
/// Part of its scale that an accepted step may leave of the energy row: half a rounding.
const ENERGY_FLOOR: f64 = 0.5 * f64::EPSILON;
/// Corrections after which the energy row may have four as well.
const PATIENCE: usize = 3;

/// A number that grows by increments: t, q or p.
pub trait Sum: Copy + Debug {
    /// The number at the start.
    fn new(value: f64) -> Self;
    /// The number, rounded.
    fn value(self) -> f64;
    /// The number plus `y`, rounded.
    fn plus(self, y: f64) -> f64;
    /// Grows by `factor · increment`.
    fn grow(&mut self, factor: f64, increment: f64);
}

/// An ordinary sum.
#[derive(Clone, Copy, Debug)]
pub struct Plain(f64);

impl Sum for Plain {
    #[inline]
    fn new(value: f64) -> Self {
        Self(value)
    }

    #[inline]
    fn value(self) -> f64 {
        self.0
    }

    #[inline]
    fn plus(self, y: f64) -> f64 {
        self.0 + y
    }

    #[inline]
    fn grow(&mut self, factor: f64, increment: f64) {
        self.0 = mul_add(factor, increment, self.0);
    }
}

/// A sum with what rounding took from it, which is given to the next increment: Kahan's, the compensated summation of
/// Hairer, Lubich, Wanner, Geometric Numerical Integration, section VIII.5. It loses the last place of the increment.
#[derive(Clone, Copy, Debug)]
pub struct Compensated {
    value: f64,
    low: f64,
}

impl Sum for Compensated {
    #[inline]
    fn new(value: f64) -> Self {
        Self { value, low: 0.0 }
    }

    #[inline]
    fn value(self) -> f64 {
        self.value
    }

    #[inline]
    fn plus(self, y: f64) -> f64 {
        (self.value + y) + self.low
    }

    #[inline]
    fn grow(&mut self, factor: f64, increment: f64) {
        let increment = mul_add(factor, increment, self.low);
        let sum = self.value + increment;
        self.low = increment - (sum - self.value);
        self.value = sum;
    }
}

/// `a b + c`, fused if the target has the instruction: otherwise `f64::mul_add` calls a function.
#[inline]
pub(crate) fn mul_add(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
}

/// A quantity over the last K steps, the newest first, from which the next value is extrapolated with order K − 1: for
/// K = 5 `5 v1 − 10 v2 + 10 v3 − 5 v4 + v5`.
#[derive(Clone, Copy, Debug)]
struct History<const K: usize = 5>([f64; K]);

impl<const K: usize> History<K> {
    /// Binomial coefficients with alternating signs.
    const COEFFICIENTS: [f64; K] = {
        // Pascal's triangle, row by row: no number larger than it has to be.
        let (mut row, mut i) = ([0.0; K], 0);
        while i < K {
            let (mut left, mut j) = (-1.0, 0);
            while j <= i {
                (row[j], left) = (row[j] - left, row[j]);
                j += 1;
            }
            i += 1;
        }
        row
    };

    fn constant(value: f64) -> Self {
        Self([value; K])
    }

    /// A past on a line, to start from: the newest value and its increment over a step.
    fn line(value: f64, increment: f64) -> Self {
        let mut age = -1.0;
        Self([value; K].map(|value| {
            age += 1.0;
            value - age * increment
        }))
    }

    /// The value that comes next.
    #[inline]
    fn next(&self) -> f64 {
        (0..K).rev().fold(0.0, |sum, i| mul_add(Self::COEFFICIENTS[i], self.0[i], sum))
    }

    /// The value after the one that comes next, but for K times that.
    #[inline]
    fn known(&self) -> f64 {
        (1..K).rev().fold(0.0, |sum, i| mul_add(Self::COEFFICIENTS[i], self.0[i - 1], sum))
    }

    #[inline]
    fn push(&mut self, value: f64) {
        self.0 = from_fn(|age| if age == 0 { value } else { self.0[age - 1] });
    }
}

#[cold]
fn not_converged() -> ! {
    panic!("{CORRECTIONS} corrections have not solved the step");
}

/// v, the middle x and p0 of a step of fixed length, as the Newton step of the one before gives them: what the next one waits for.
/// The sums of q and p, in which a step is measured, are off this path.
#[derive(Clone, Copy, Debug)]
struct Guess<const N: usize = 2> {
    v: [f64; N],
    x: [f64; N],
    p: [f64; N],
}

/// Whether a step from momenta `p` with increments `increment` leaves no more than rounding of its momentum rows, whose
/// terms have the sums `terms` of absolute values. These need not be small if the momenta vanish.
#[inline]
fn is_solved<S: Sum, const N: usize>(
    residual: [f64; N],
    p: &[S; N],
    increment: [f64; N],
    terms: impl FnOnce() -> [f64; N],
) -> bool {
    let is_below = |scale: [f64; N]| {
        // A mask: a loop over booleans does not become vector instructions.
        let below = |i: usize| residual[i].abs() <= FLOOR * scale[i];
        (0..N).fold(0, |above, i| above | if below(i) { 0 } else { u64::MAX }) == 0
    };
    is_below(from_fn(|i| p[i].value().abs() + increment[i].abs())) || is_below(terms())
}

/// Whether a step leaves no more than rounding of its energy row, at velocities `v`. The other terms of this row have
/// the sum `terms`, because the energy is a difference. Now and then rounding lets no v and h near the root leave so
/// little; after [`PATIENCE`] corrections as much may be left as of a momentum row.
#[inline]
fn is_energy_kept<S: Sum, const N: usize>(
    residual: f64,
    terms: f64,
    p: &[S; N],
    v: [f64; N],
    corrections: usize,
) -> bool {
    let scale = (0..N).fold(terms, |sum, i| sum + (v[i] * p[i].value()).abs());
    residual.abs() <= if corrections < PATIENCE { ENERGY_FLOOR } else { FLOOR } * scale
}

/// A Newton step on two momentum rows and the energy row, bordered: `A δv + b δs = −r`, `g·δv + k δs = −c`. One quotient.
#[inline]
fn bordered([a, b, g]: [[f64; 2]; 3], off: [f64; 2], k: f64, r: [f64; 2], c: f64) -> ([f64; 2], f64) {
    // A = [a0 off0; off1 a1].
    let adjugate = |r: [f64; 2]| [mul_add(a[1], r[0], -(off[0] * r[1])), mul_add(a[0], r[1], -(off[1] * r[0]))];
    let determinant = mul_add(a[0], a[1], -(off[0] * off[1]));
    let (ar, ab) = (adjugate(r), adjugate(b));
    let schur = mul_add(k, determinant, -mul_add(g[0], ab[0], g[1] * ab[1]));
    let over = 1.0 / (schur * determinant);
    let ds = mul_add(g[0], ar[0], mul_add(g[1], ar[1], -(c * determinant))) * (over * determinant);
    let over = over * schur;
    ([-mul_add(ab[0], ds, ar[0]) * over, -mul_add(ab[1], ds, ar[1]) * over], ds)
}

#[cfg(test)]
mod tests {
    use super::{Compensated, History, PATIENCE, Plain, Sum, is_energy_kept, is_solved};

    #[test]
    fn extrapolation_is_exact_for_polynomials() {
        assert!(History::<5>::COEFFICIENTS.iter().eq(&[5.0, -10.0, 10.0, -5.0, 1.0]));
        let mut history = History::<7>::constant(0.0);
        let value = |t: f64| t.powi(6) - 3.0 * t.powi(5) + t;
        for t in 0..7 {
            history.push(value(f64::from(t)));
        }
        // Integers below 2⁵³: no rounding.
        assert_eq!(history.next().to_bits(), value(7.0).to_bits());
        assert_eq!((7.0 * value(7.0) + history.known()).to_bits(), {
            history.push(value(7.0));
            history.next().to_bits()
        });
    }

    #[test]
    fn a_step_is_solved_at_four_roundings_of_every_row() {
        let (p, increment, rounding) = ([1.0, 1e-3].map(Plain::new), [1.0, -1e-3], f64::EPSILON * 2.0);
        let solved = |roundings: [f64; 2], terms: [f64; 2]| {
            is_solved([roundings[0] * rounding, roundings[1] * 1e-3 * rounding], &p, increment, || terms)
        };
        assert!(solved([3.9, -3.9], [0.0; 2]) && !solved([4.1, 0.0], [0.0; 2]) && !solved([0.0, -4.1], [0.0; 2]));
        // The terms of the second row are larger than the momentum that they add up to.
        assert!(solved([0.0, 40.0], [2.0, 2e-2]) && !solved([0.0, 41.0], [2.0, 2e-2]));
        assert!(!solved([f64::NAN, 0.0], [2.0; 2]));
        let kept =
            |residual: f64, corrections| is_energy_kept(residual * f64::EPSILON, 1.0, &p, [1.0, 0.0], corrections);
        assert!(kept(0.9, 1) && !kept(1.1, 1) && kept(7.9, PATIENCE) && !kept(8.1, PATIENCE));
    }

    #[test]
    fn compensated_sums_keep_what_plain_ones_lose() {
        let (mut plain, mut kept) = (Plain::new(0.0), Compensated::new(0.0));
        for _ in 0..1_000_000 {
            plain.grow(0.1, 1.0);
            kept.grow(0.1, 1.0);
        }
        // The plain sum is 1.3e-6 off, the other one by less than an ulp, 1.5e-11.
        assert!((plain.value() - 1e5).abs() > 1e-6 && (kept.value() - 1e5).abs() < 2e-11);
    }
}
