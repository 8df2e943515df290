//! Extrapolation of the next step.
//!
//! The guess of the next unknowns u is the polynomial of degree k through the last k + 1 of them, u_0 the newest:
//!
//! ```text
//! guess_k = Σ_i (−1)^i C(k + 1, i + 1) u_i,  i = 0 … k        k = 6:  7 u_0 − 21 u_1 + 35 u_2 − 35 u_3 + 21 u_4 − 7 u_5 + u_6
//! ```
//!
//! Each step waits for the previous one, so only `7 u_0` and one addition depend on u_0.
//!
//! The degree grows by one per step while the guess improves, up to [`HIGHEST`]. After a step with an unusable guess,
//! [`Predictor::restart`] selects the degree that would have been the best.

use crate::real::{Real, Scalar};
use crate::vector::{Vector, length_squared};
use core::hint::black_box;
use nalgebra::SVector;

/// Highest degree of the polynomial.
const HIGHEST: usize = 6;
/// The weights of each degree, the newest first.
const WEIGHTS: [[f64; HIGHEST + 1]; HIGHEST + 1] = weights_of_degrees();
/// Error of a guess, in ulps of u, below which it may be amplified rounding.
const NOISE: f64 = 128.0;

/// The weights `(−1)^i C(degree + 1, i + 1)` of the last steps, the newest first; zero for i > degree.
#[must_use]
pub const fn weights<const K: usize>(degree: usize) -> [f64; K] {
    let mut weights = [0.0; K];
    let (mut i, mut binomial, mut sign) = (0, 1, 1.0);
    while i <= degree && i < K {
        binomial = binomial * (degree + 1 - i) / (i + 1);
        // Below 2⁵³.
        #[allow(clippy::cast_precision_loss)]
        let weight = sign * binomial as f64;
        weights[i] = weight;
        sign = -sign;
        i += 1;
    }
    weights
}

/// The weights of the degrees below K.
pub(crate) const fn weights_of_degrees<const K: usize>() -> [[f64; K]; K] {
    let mut all = [[0.0; K]; K];
    let mut degree = 0;
    while degree < K {
        all[degree] = weights(degree);
        degree += 1;
    }
    all
}

/// Guesses of the next M unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: Real + serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub(crate) struct Predictor<const M: usize, T> {
    /// The last steps, the newest first; initially all equal to the first guess.
    last: [SVector<T, M>; HIGHEST + 1],
    degree: usize,
}

impl<const M: usize, T: Real> Predictor<M, T> {
    /// Starts from a guess of the first step.
    pub(crate) fn new(guess: SVector<T, M>) -> Self {
        Self { last: [guess; HIGHEST + 1], degree: 0 }
    }

    /// A copy number by number, as [`Node::apart`](crate::node::Node::apart).
    #[inline(always)]
    pub(crate) fn apart(&self) -> Self {
        let copy = |u| Vector::map(u, black_box);
        let [u0, u1, u2, u3, u4, u5, u6] = &self.last;
        let last = [copy(u0), copy(u1), copy(u2), copy(u3), copy(u4), copy(u5), copy(u6)];
        Self { last, degree: black_box(self.degree) }
    }

    /// The unknowns of the last step.
    #[inline(always)]
    pub(crate) fn newest(&self) -> SVector<T, M> {
        self.last[0]
    }

    /// Whether the guess has the highest degree.
    #[inline(always)]
    pub(crate) fn is_highest(&self) -> bool {
        self.degree == HIGHEST
    }

    /// Whether every number is finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.degree <= HIGHEST && self.last.iter().flat_map(|u| u.iter()).all(|entry| entry.is_finite())
    }

    /// The guess of the next step.
    pub(crate) fn guess(&self) -> SVector<T, M> {
        self.guess_of(self.degree)
    }

    /// The guess of the next step at the highest degree.
    #[inline(always)]
    pub(crate) fn guess_highest(&self) -> SVector<T, M> {
        let [u0, u1, u2, u3, u4, u5, u6] = &self.last;
        let mut guess = *u0;
        for i in 0..M {
            // Terms of earlier steps are summed while the last step is still computed.
            let known = (u6[i] - u5[i] * T::real(7.0))
                + (u4[i] * T::real(21.0) - u3[i] * T::real(35.0))
                + (u2[i] * T::real(35.0) - u1[i] * T::real(21.0));
            guess[i] = u0[i] * T::real(7.0) + known;
        }
        guess
    }

    fn guess_of(&self, degree: usize) -> SVector<T, M> {
        let terms = self.last.iter().zip(WEIGHTS[degree]).take(degree + 1).rev();
        terms.fold(SVector::zeros(), |sum, (u, weight)| sum + u * T::real(weight))
    }

    /// Adds the step `u` at the highest degree, or if no guess is needed.
    #[inline(always)]
    pub(crate) fn push_highest(&mut self, u: SVector<T, M>) {
        let [u0, u1, u2, u3, u4, u5, _] = self.last;
        self.last = [u, u0, u1, u2, u3, u4, u5];
    }
}

impl<const M: usize, T: Scalar> Predictor<M, T> {
    /// Adds the step `u`. The degree grows by one if its guess would not have been worse, or as good as rounding
    /// allows.
    pub(crate) fn push(&mut self, u: SVector<T, M>) {
        if !self.is_highest() {
            let [error, next] = [0, 1].map(|more| length_squared(&(u - self.guess_of(self.degree + more))));
            let noise = length_squared(&u) * T::real(NOISE * T::EPSILON * NOISE * T::EPSILON);
            self.degree += usize::from(next <= error || error <= noise);
        }
        self.push_highest(u);
    }

    /// Adds the step `u` after an unusable guess, and selects the degree that would have guessed best.
    #[cold]
    pub(crate) fn restart(&mut self, u: SVector<T, M>) {
        let (mut best, mut least) = (0, None);
        for degree in 0..=self.degree {
            let length = length_squared(&(u - self.guess_of(degree)));
            if least.is_none_or(|least| length < least) {
                (best, least) = (degree, Some(length));
            }
        }
        self.degree = best;
        self.push_highest(u);
    }
}

#[cfg(test)]
mod tests {
    use super::{HIGHEST, Predictor, WEIGHTS, weights};
    use nalgebra::SVector;

    fn one(u: f64) -> SVector<f64, 1> {
        SVector::from([u])
    }

    /// A predictor after the steps 0 … 20 of a sequence.
    fn after_twenty(sequence: impl Fn(f64) -> f64) -> Predictor<1, f64> {
        let mut predictor = Predictor::new(one(sequence(0.0)));
        (1..=20).for_each(|step| predictor.push(one(sequence(f64::from(step)))));
        predictor
    }

    #[test]
    fn weights_are_binomials_with_alternating_signs() {
        assert_eq!(WEIGHTS[2].map(f64::to_bits), [3.0, -3.0, 1.0, 0.0, 0.0, 0.0, 0.0].map(f64::to_bits));
        assert_eq!(WEIGHTS[6].map(f64::to_bits), [7.0, -21.0, 35.0, -35.0, 21.0, -7.0, 1.0].map(f64::to_bits));
        for degree in 0..=10_u32 {
            let weights: [f64; 11] = weights(degree as usize);
            let power = |t: f64| t.powi(i32::try_from(degree).unwrap_or(0));
            let guess: f64 = weights.iter().zip(1..).map(|(weight, j)| weight * power(-f64::from(j))).sum();
            // Integers: no rounding.
            assert_eq!(guess.to_bits(), power(0.0).to_bits(), "{degree}");
        }
    }

    #[test]
    fn a_polynomial_of_degree_six_is_predicted() {
        let sequence = |t: f64| t.powi(6) - 3.0 * t.powi(5) + t;
        let mut predictor = after_twenty(sequence);
        assert!(predictor.is_highest());
        for step in 21..50 {
            let u = sequence(f64::from(step));
            // Integers below 2⁵³: no rounding.
            assert_eq!(predictor.guess()[0].to_bits(), u.to_bits(), "step {step}");
            assert_eq!(predictor.guess_highest()[0].to_bits(), u.to_bits(), "step {step}");
            predictor.push(one(u));
            assert_eq!(predictor.newest()[0].to_bits(), u.to_bits());
        }
    }

    #[test]
    fn every_degree_predicts_its_polynomials() {
        for degree in 0..=HIGHEST {
            let power = |t: f64| t.powi(i32::try_from(degree).unwrap_or(0)) + 1.0;
            let mut predictor = after_twenty(power);
            predictor.degree = degree;
            assert_eq!(predictor.guess()[0].to_bits(), power(21.0).to_bits(), "{degree}");
        }
    }

    #[test]
    fn a_constant_reaches_the_highest_degree_whatever_its_noise() {
        let predictor = after_twenty(|t| 1.0 + f64::EPSILON * (7.0 * t).sin());
        assert!(predictor.is_highest());
        assert!((predictor.guess()[0] - 1.0).abs() < 128.0 * f64::EPSILON);
    }

    #[test]
    fn what_leaps_is_guessed_by_the_last_step() {
        let mut predictor = after_twenty(|t| 1.0 + 1e-3 * t);
        predictor.restart(one(-5.0));
        assert_eq!((predictor.degree, predictor.guess()[0].to_bits()), (0, (-5.0_f64).to_bits()));
        predictor.push(one(-4.0));
        predictor.push(one(-3.0));
        assert!((predictor.guess()[0] + 2.0).abs() < 1e-15);
    }

    #[test]
    fn where_the_guess_was_too_poor_the_best_degree_is_kept() {
        // A parabola with a disturbance four steps ago: degree 2 no longer includes it, higher degrees do.
        let mut predictor = after_twenty(|t| t * t);
        predictor.last[3][0] += 1e-3;
        predictor.restart(one(21.0 * 21.0));
        assert_eq!((predictor.degree, predictor.guess()[0].to_bits()), (2, (22.0_f64 * 22.0).to_bits()));
    }
}
