//! Lyapunov exponents.
//!
//! From a run and a number k, this module estimates the k largest exponents: the mean growth rates of volumes along the
//! run,
//!
//! ```text
//! λ_1 + … + λ_k = lim ln |δz_1 ∧ … ∧ δz_k| / t
//! ```
//!
//! Every step orthogonalizes the directions again and sums the logarithms of their growth. Source: Benettin, Galgani,
//! Giorgilli, Strelcyn, *Meccanica* 15 (1980) 9. Coordinates and momenta keep their own units. The limit does not
//! depend on them; the estimate does, by a term of order 1/t.

use super::steps::Differentiable;
use super::tangent::Tangent;
use super::variation::Variation;
use super::variation::dimension;
use crate::compensated;
use crate::constrained::variation;
use crate::error::StepError;
use crate::method::Method;
use crate::run::Run;
use crate::stepping::Convertible;
use alloc::vec::Vec;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Estimates of the largest Lyapunov exponents along a run: mean growth rates of its directions.
#[derive(Clone, Debug)]
pub struct Lyapunov<M: Method<S, N>, S, const N: usize> {
    tangent: Tangent<M, S, N>,
    start: f64,
    /// End time of the summed growth.
    end: f64,
    /// Sums of logarithms, with their low parts.
    growth: Vec<(f64, f64)>,
}

impl<M: Differentiable<S, N>, S: Convertible<N>, const N: usize> Lyapunov<M, S, N> {
    /// Estimates the `count` largest exponents of a run. The first directions are fixed, so that results are
    /// reproducible.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] unless `count` is 1 to 2N, less 2 for each holonomic and 1 for each nonholonomic
    /// constraint.
    pub fn new(run: Run<M, S, N>, count: usize) -> Result<Self, StepError> {
        Self::of_first(run, count, N)
    }

    /// The exponents of the first `coordinates`; the others are at rest, and nothing depends on them.
    ///
    /// # Errors
    /// As [`Lyapunov::new`], with this number of coordinates.
    #[doc(hidden)]
    pub fn of_first(run: Run<M, S, N>, count: usize, coordinates: usize) -> Result<Self, StepError> {
        let dimension = dimension(&run.system) - 2 * (N - coordinates);
        if count == 0 || count > dimension {
            #[allow(clippy::cast_precision_loss)] // for the message
            let value = count as f64;
            let allowed =
                "1 to twice the number of coordinates, less 2 for each holonomic constraint and 1 for each other";
            return Err(StepError::InvalidInput { input: "the number of Lyapunov exponents", allowed, value });
        }
        let start = run.t();
        let of_state = Variation::of_state().into_iter().enumerate().filter(|(index, _)| index % N < coordinates);
        let mut variations: Vec<_> = of_state.map(|(_, variation)| variation).collect();
        let turn = |variation: &mut Variation<N>| turn(variation, coordinates);
        if dimension == 2 * coordinates {
            variations.truncate(count);
            variations.iter_mut().for_each(turn);
        } else {
            variations.iter_mut().for_each(turn);
            variation::project(run.system(), run.node(), &mut variations)?;
            keep_independent(&mut variations, count);
        }
        orthogonalize(&mut variations);
        Ok(Self { tangent: Tangent::new(run, variations), start, end: start, growth: vec![(0.0, 0.0); count] })
    }

    /// Takes this number of steps.
    ///
    /// # Errors
    /// The errors of the failed step; [`StepError::NonFinite`] if a step maps a direction to zero, so that its exponent
    /// is unbounded. The estimates then end there.
    pub fn advance(&mut self, steps: u64) -> Result<(), StepError> {
        for _ in 0..steps {
            let before = self.tangent.run().t();
            let t = self.tangent.step()?.t;
            let lengths = orthogonalize(self.tangent.combined());
            if lengths.iter().any(|length| !length.is_normal()) {
                return Err(StepError::NonFinite { t: before, quantity: "Lyapunov exponent", expression: None });
            }
            self.end = t;
            for ((sum, low), length) in self.growth.iter_mut().zip(lengths) {
                compensated::add(sum, low, length.ln());
            }
        }
        Ok(())
    }

    /// The estimates in descending order, in units of one over time; NaN before the first step. For a run backwards in
    /// time they are rates of the reversed flow, relative to the absolute elapsed time.
    #[must_use]
    pub fn exponents(&self) -> Vec<f64> {
        let t = (self.end - self.start).abs();
        let mut exponents: Vec<f64> = self.growth.iter().map(|(growth, low)| (growth + low) / t).collect();
        // Over a short time a later direction may have grown more than one before.
        exponents.sort_by(|one, other| other.total_cmp(one));
        exponents
    }

    /// The run.
    pub fn run(&self) -> &Run<M, S, N> {
        self.tangent.run()
    }
}

/// Turns a direction away from its coordinate or momentum axis, among the first coordinates: in an invariant plane it
/// would never grow in other directions.
fn turn<const N: usize>(variation: &mut Variation<N>, coordinates: usize) {
    let mut part = 0.1;
    for entry in variation.q.iter_mut().take(coordinates).chain(variation.p.iter_mut().take(coordinates)) {
        *entry += part;
        part *= -0.9;
    }
}

/// Keeps this number of directions: one after the other, the direction with the largest part across the kept ones.
fn keep_independent<const N: usize>(variations: &mut Vec<Variation<N>>, count: usize) {
    let mut rest = variations.clone();
    for index in 0..count {
        let length = |of: &Variation<N>| of.q.norm().hypot(of.p.norm());
        let largest = (index + 1..rest.len())
            .fold(index, |best, other| if length(&rest[other]) > length(&rest[best]) { other } else { best });
        rest.swap(index, largest);
        variations.swap(index, largest);
        let (chosen, others) = rest.split_at_mut(index + 1);
        let chosen = &chosen[index];
        let square = length(chosen).powi(2);
        // Twice, so that the rest is orthogonal to rounding.
        for other in others {
            for _ in 0..2 {
                let along = (chosen.q.dot(&other.q) + chosen.p.dot(&other.p)) / square;
                other.add(chosen, -along);
            }
        }
    }
    variations.truncate(count);
}

/// Orthonormalizes directions in order, and returns their previous lengths.
fn orthogonalize<const N: usize>(variations: &mut [Variation<N>]) -> Vec<f64> {
    let mut lengths = Vec::with_capacity(variations.len());
    for index in 0..variations.len() {
        let (before, rest) = variations.split_at_mut(index);
        let Some(own) = rest.first_mut() else { continue };
        // Twice is enough (Parlett and Kahan).
        for other in before.iter().chain(before.iter()) {
            let along = other.q.dot(&own.q) + other.p.dot(&own.p);
            own.q -= other.q * along;
            own.p -= other.p * along;
            own.t -= other.t * along;
            own.energy -= other.energy * along;
        }
        let length = own.q.norm().hypot(own.p.norm());
        own.q /= length;
        own.p /= length;
        // Steps that find their length also vary in time, and with a force in the preserved energy.
        own.t /= length;
        own.energy /= length;
        lengths.push(length);
    }
    lengths
}
