//! What the next step will be, extrapolated over the last ones.
//!
//! In: the unknowns u of the steps up to now. Out: a guess of those of the next one, by backward differences:
//!
//! ```text
//! guess = Σ ∇^j u,  j = 0 … order          the polynomial of that degree through the last steps, at the next one
//! ∇^j u after a step  =  Σ_{i ≥ j} ∇^i u before it  +  e,          e = u − guess
//! ```
//!
//! One step waits for the other, so what has to be done after u is known is little: every difference takes e, and the next
//! guess `(order + 1) e`. Errors die out after as many steps as there are differences.
//!
//! The order grows by one a step, while that makes the guess better, up to [`ORDER`]. After a step at which the guess was too
//! poor to use, [`Predictor::restart`] takes the order that would have been the best there.

use crate::{Real, Scalar};
use nalgebra::SVector;

/// Highest order of the extrapolation.
pub(crate) const ORDER: usize = 6;
/// Part of u, in roundings, that an error of the guess may be before it is told from what extrapolation makes of roundings.
const NOISE: f64 = 128.0;

/// Guesses of the next M unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: Real + serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub(crate) struct Predictor<const M: usize, T> {
    /// The guess of the next step.
    guess: SVector<T, M>,
    /// ∇^j u of the last step, for j up to the order; then the error of the last guess, where there was one; then zeros.
    differences: [SVector<T, M>; ORDER + 1],
    order: usize,
}

impl<const M: usize, T: Real> Predictor<M, T> {
    /// Before the first step, with a guess of it.
    pub(crate) fn new(guess: SVector<T, M>) -> Self {
        let mut differences = [SVector::zeros(); ORDER + 1];
        differences[0] = guess;
        Self { guess, differences, order: 0 }
    }

    /// The guess of the next step.
    #[inline(always)]
    pub(crate) fn guess(&self) -> SVector<T, M> {
        self.guess
    }

    /// The unknowns of the last step.
    #[inline(always)]
    pub(crate) fn newest(&self) -> SVector<T, M> {
        self.differences[0]
    }

    /// Whether every number is finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.differences.iter().chain([&self.guess]).flat_map(|u| u.iter()).all(|entry| entry.is_finite())
    }

    /// Whether the guess is of the highest order.
    #[inline(always)]
    pub(crate) fn is_highest(&self) -> bool {
        self.order == ORDER
    }

    /// Takes the step `u` where no guess is needed.
    #[inline(always)]
    pub(crate) fn replace(&mut self, u: SVector<T, M>) {
        self.differences[0] = u;
    }

    /// Takes the step `u` at the highest order.
    #[inline(always)]
    pub(crate) fn push_highest(&mut self, u: SVector<T, M>) {
        for i in 0..M {
            let error = u[i] - self.guess[i];
            let mut predicted = self.differences[ORDER][i];
            let mut sum = predicted;
            self.differences[ORDER][i] = predicted + error;
            for j in (1..ORDER).rev() {
                predicted += self.differences[j][i];
                sum += predicted;
                self.differences[j][i] = predicted + error;
            }
            predicted += self.differences[0][i];
            sum += predicted;
            self.differences[0][i] = u[i];
            self.guess[i] = sum + error * T::real(WEIGHT);
        }
    }
}

/// What the next guess takes of the error of the last one, at the highest order.
#[allow(clippy::cast_precision_loss)]
const WEIGHT: f64 = (ORDER + 1) as f64;

impl<const M: usize, T: Scalar> Predictor<M, T> {
    /// Takes the step `u`.
    pub(crate) fn push(&mut self, u: SVector<T, M>) {
        if self.is_highest() { self.push_highest(u) } else { self.push_lower(u) }
    }

    /// Takes the step `u` below the highest order, which grows by one where the guess of the next order would not have been
    /// worse, or as good as rounding allows.
    fn push_lower(&mut self, u: SVector<T, M>) {
        let (order, error) = (self.order, u - self.guess);
        let better = error - self.differences[order + 1];
        let noise = length_squared(&u) * T::real(NOISE * T::EPSILON * NOISE * T::EPSILON);
        let grows = length_squared(&better) <= length_squared(&error) || length_squared(&error) <= noise;
        self.enter(u);
        self.differences[order + 1] = error;
        if grows {
            self.order = order + 1;
            if self.order < ORDER {
                self.differences[order + 2] = better;
            }
        }
        self.sum();
    }

    /// Takes the step `u` after a guess that was too poor to use: the order becomes that which would have guessed best.
    #[cold]
    pub(crate) fn restart(&mut self, u: SVector<T, M>) {
        let mut error = u;
        let (mut best, mut least) = (0, None);
        for (order, difference) in self.differences.iter().enumerate().take(self.order + 1) {
            error -= difference;
            let length = length_squared(&error);
            if least.is_none_or(|least| length < least) {
                (best, least) = (order, Some(length));
            }
        }
        self.order = best;
        self.differences[best + 1..].fill(SVector::zeros());
        self.sum();
        self.enter(u);
        self.sum();
        if !self.is_finite() {
            *self = Self::new(u);
        }
    }

    /// The differences up to the order, after the step `u`.
    fn enter(&mut self, u: SVector<T, M>) {
        let error = u - self.guess;
        for j in (0..self.order).rev() {
            let above = self.differences[j + 1];
            self.differences[j] += above;
        }
        for difference in &mut self.differences[..=self.order] {
            *difference += error;
        }
        self.differences[0] = u;
    }

    /// The guess, from the differences.
    fn sum(&mut self) {
        let known = self.differences[..=self.order].iter();
        self.guess = known.rev().fold(SVector::zeros(), |sum, difference| sum + difference);
    }
}

/// |u|².
#[inline(always)]
pub(crate) fn length_squared<const M: usize, T: Real>(u: &SVector<T, M>) -> T {
    u.iter().fold(T::zero(), |sum, entry| sum + *entry * *entry)
}

#[cfg(test)]
mod tests {
    use super::{ORDER, Predictor};
    use nalgebra::SVector;

    fn one(u: f64) -> SVector<f64, 1> {
        SVector::from([u])
    }

    /// A predictor that has taken the steps 0 … 12 of a sequence.
    fn after_twelve(sequence: impl Fn(f64) -> f64) -> Predictor<1, f64> {
        let mut predictor = Predictor::new(one(sequence(0.0)));
        (1..=12).for_each(|step| predictor.push(one(sequence(f64::from(step)))));
        predictor
    }

    #[test]
    fn a_polynomial_of_degree_six_is_predicted() {
        let sequence = |t: f64| t.powi(6) - 3.0 * t.powi(5) + t;
        let mut predictor = after_twelve(sequence);
        assert_eq!(predictor.order, ORDER);
        for step in 13..40 {
            let u = sequence(f64::from(step));
            // Integers below 2⁵³: no rounding.
            assert_eq!(predictor.guess()[0].to_bits(), u.to_bits(), "step {step}");
            predictor.push(one(u));
            assert_eq!(predictor.newest()[0].to_bits(), u.to_bits());
        }
    }

    #[test]
    fn an_error_is_forgotten_after_as_many_steps_as_there_are_differences() {
        let sequence = |t: f64| t.powi(3) - 2.0 * t;
        let mut predictor = after_twelve(sequence);
        predictor.push(one(1e6));
        for step in 14..14 + ORDER as u32 + 1 {
            assert_ne!(predictor.guess()[0].to_bits(), sequence(f64::from(step)).to_bits());
            predictor.push(one(sequence(f64::from(step))));
        }
        assert_eq!(predictor.guess()[0].to_bits(), sequence(21.0).to_bits());
    }

    #[test]
    fn a_constant_reaches_the_highest_order_whatever_its_noise() {
        let predictor = after_twelve(|t| 1.0 + f64::EPSILON * (7.0 * t).sin());
        assert_eq!(predictor.order, ORDER);
        assert!((predictor.guess()[0] - 1.0).abs() < 128.0 * f64::EPSILON);
    }

    #[test]
    fn what_leaps_is_guessed_by_the_last_step() {
        let mut predictor = after_twelve(f64::sin);
        predictor.restart(one(-5.0));
        assert_eq!((predictor.order, predictor.guess()[0].to_bits()), (0, (-5.0_f64).to_bits()));
        predictor.push(one(-4.0));
        predictor.push(one(-3.0));
        assert!((predictor.guess()[0] + 2.0).abs() < 1e-15);
    }

    #[test]
    fn where_the_guess_was_too_poor_the_best_order_is_kept() {
        // A parabola with a bend in its third derivative: order 2 is right after it, order 6 is not.
        let mut predictor = after_twelve(|t| t * t);
        predictor.differences[5] = one(3.0);
        predictor.sum();
        predictor.restart(one(169.0));
        assert!(predictor.order <= 4 && predictor.order >= 2, "{}", predictor.order);
        assert_eq!(predictor.guess()[0].to_bits(), 196.0_f64.to_bits());
    }
}
