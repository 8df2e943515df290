//! The initial guess of a step, extrapolated from the unknowns of the last steps, as in `crate::predictor`, or from the
//! node alone. The number of constraints is no constant of a type, so that the unknowns are a list.

use super::accelerations;
use super::equations::unknowns;
use crate::error::StepError;
use crate::gauss::lobatto::Lobatto;
use crate::gauss::tableau::Tableau;
use crate::linear::Bordered;
use crate::motion::Motion;
use crate::node::Node;
use crate::predictor::weights_of_degrees;
use crate::vector::worse;
use alloc::vec::Vec;
use nalgebra::SVector;

/// Highest degree of the extrapolation.
const HIGHEST: usize = 5;
/// The weights of each degree, the newest first.
const WEIGHTS: [[f64; HIGHEST + 1]; HIGHEST + 1] = weights_of_degrees();

/// The unknowns of the last steps.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Extrapolation {
    /// The newest first; initially all equal to the first guess.
    last: Vec<Vec<f64>>,
    degree: usize,
}

impl Extrapolation {
    /// Starts from a guess of the first step. Allocates.
    pub(crate) fn new(guess: &[f64]) -> Self {
        Self { last: vec![guess.to_vec(); HIGHEST + 1], degree: 0 }
    }

    /// The unknowns of the last step, or the first guess.
    pub(crate) fn newest(&self) -> &[f64] {
        &self.last[0]
    }

    /// The number of unknowns.
    pub(crate) fn count(&self) -> usize {
        self.last.first().map_or(0, Vec::len)
    }

    /// Writes the guess of the next step, from the unknown `first` on.
    pub(crate) fn guess(&self, first: usize, guess: &mut [f64]) {
        let weights = WEIGHTS[self.degree];
        let guess = &mut guess[first..];
        guess.fill(0.0);
        for (u, weight) in self.last.iter().zip(weights).rev() {
            for (entry, u) in guess.iter_mut().zip(&u[first..]) {
                *entry += u * weight;
            }
        }
    }

    fn extrapolated(&self, weights: &[f64], index: usize) -> f64 {
        self.last.iter().zip(weights).rev().fold(0.0, |sum, (u, weight)| sum + u[index] * weight)
    }

    /// Adds the unknowns of a step. The degree grows by one if its guess would not have been worse.
    pub(crate) fn push(&mut self, unknowns: &[f64]) {
        let error = |degree: usize| {
            let errors = unknowns.iter().enumerate().map(|(index, u)| u - self.extrapolated(&WEIGHTS[degree], index));
            errors.fold(0.0, |sum, error| sum + error * error)
        };
        if self.degree < HIGHEST {
            self.degree += usize::from(error(self.degree + 1) <= error(self.degree));
        }
        self.last.rotate_right(1);
        self.last[0].copy_from_slice(unknowns);
    }

    /// Whether it stores finite unknowns of this number. A file may contain anything.
    pub(crate) fn is_valid(&self, count: usize) -> bool {
        let longest = |u: &Vec<f64>| u.iter().fold(0.0, |longest, entry| worse(entry.abs(), longest));
        let is_valid = |u: &Vec<f64>| u.len() == count && longest(u).is_finite();
        self.degree <= HIGHEST && self.last.len() == HIGHEST + 1 && self.last.iter().all(is_valid)
    }
}

/// Unknowns of a step of length h from a node with the velocity v: velocities with constant acceleration, and the
/// impulses of the multipliers at the node. Factors the bordered mass matrix.
///
/// # Errors
/// [`StepError::Singular`] and [`StepError::NonFinite`].
pub(crate) fn from_node<S: Motion<N>, const N: usize, const STAGES: usize>(
    system: &S,
    (node, h, v): (&Node<N>, f64, &SVector<f64, N>),
    bordered: &mut Bordered,
) -> Result<Vec<f64>, StepError> {
    let (acceleration, multipliers) = accelerations(system, (node.t, &node.q, v), bordered)?;
    // One more than the unknowns: callers append the length of the step.
    let mut guess = Vec::with_capacity(unknowns::<N, STAGES>(system.constraint_names().len()) + 1);
    for c in const { Tableau::<STAGES>::VALUES.c } {
        guess.extend((v + acceleration * (h * c)).iter());
    }
    for b in const { Lobatto::<STAGES>::VALUES.b } {
        guess.extend(multipliers.as_ref().iter().map(|multiplier| multiplier * (h * b)));
    }
    Ok(guess)
}

#[cfg(test)]
mod tests {
    use super::{Extrapolation, HIGHEST};

    #[test]
    fn a_polynomial_is_extrapolated() {
        let sequence = |step: u32| f64::from(step).powi(5) - 7.0 * f64::from(step).powi(2);
        let mut extrapolation = Extrapolation::new(&[sequence(0), 1.0]);
        (1..=20).for_each(|step| extrapolation.push(&[sequence(step), 1.0]));
        assert_eq!(extrapolation.degree, HIGHEST);
        let mut guess = [0.0; 2];
        extrapolation.guess(0, &mut guess);
        // Integers below 2⁵³: no rounding.
        assert_eq!(guess.map(f64::to_bits), [sequence(21), 1.0].map(f64::to_bits));
        guess.fill(0.0);
        extrapolation.guess(1, &mut guess);
        assert_eq!(guess.map(f64::to_bits), [0.0_f64, 1.0].map(f64::to_bits));
        assert_eq!(extrapolation.newest(), [sequence(20), 1.0]);
        assert!(extrapolation.is_valid(2) && !extrapolation.is_valid(3));
    }
}
