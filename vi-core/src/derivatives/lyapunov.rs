//! Lyapunov exponents.
//!
//! In: a run, and how many of the largest exponents are wanted. Out: their estimates, the mean rates at which volumes of so many directions grow along it:
//!
//! ```text
//! λ_1 + … + λ_k = lim ln |δz_1 ∧ … ∧ δz_k| / t
//! ```
//!
//! The directions are made orthogonal again after every step, and the logarithms of what they had grown by are summed. Source: Benettin, Galgani, Giorgilli,
//! Strelcyn, *Meccanica* 15 (1980) 9. Coordinates and momenta are measured in their own units; the limit does not depend on them, its estimate does, by a term of
//! order 1/t.

use super::steps::Differentiable;
use super::tangent::Tangent;
use super::variation::Variation;
use crate::compensated;
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use crate::run::Run;

/// Estimates of the largest Lyapunov exponents along a run: mean rates at which its directions grow.
#[derive(Clone, Debug)]
pub struct Lyapunov<M: Method<S, N>, S, const N: usize> {
    tangent: Tangent<M, S, N>,
    start: f64,
    /// The time up to which growth is summed.
    end: f64,
    /// Sums of logarithms, with their low parts.
    growth: Vec<(f64, f64)>,
}

impl<M: Differentiable<S, N>, S: Lagrangian<N> + Copy, const N: usize> Lyapunov<M, S, N> {
    /// The `count` largest exponents of a run. The first directions are fixed, so that two runs give the same.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] unless `count` is 1 to 2N.
    pub fn new(run: Run<M, S, N>, count: usize) -> Result<Self, StepError> {
        if count == 0 || count > 2 * N {
            #[allow(clippy::cast_precision_loss)] // for the message
            let value = count as f64;
            let allowed = "1 to twice the number of coordinates";
            return Err(StepError::InvalidInput { input: "the number of Lyapunov exponents", allowed, value });
        }
        let start = run.t();
        let mut variations = Variation::of_state();
        variations.truncate(count);
        variations.iter_mut().for_each(turn);
        orthogonalize(&mut variations);
        Ok(Self { tangent: Tangent::new(run, variations), start, end: start, growth: vec![(0.0, 0.0); count] })
    }

    /// Takes so many steps.
    ///
    /// # Errors
    /// That of the step that fails, and [`StepError::NonFinite`] where a step leaves nothing of a direction, whose exponent is then without a bound. The estimates
    /// are then those up to there.
    pub fn advance(&mut self, steps: u64) -> Result<(), StepError> {
        for _ in 0..steps {
            let before = self.tangent.run().t();
            let t = self.tangent.step()?.t;
            let lengths = orthogonalize(self.tangent.variations_mut());
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

    /// The estimates, the largest first as a rule, in units of one over time; not a number before the first step. Those of a run backwards in time are of
    /// the motion backwards: rates by the time that has passed, whatever its sign.
    #[must_use]
    pub fn exponents(&self) -> Vec<f64> {
        let t = (self.end - self.start).abs();
        self.growth.iter().map(|(growth, low)| (growth + low) / t).collect()
    }

    /// The run.
    pub fn run(&self) -> &Run<M, S, N> {
        self.tangent.run()
    }
}

/// Turns a direction away from the coordinate or momentum that it is of: a direction in an invariant plane would not leave it.
fn turn<const N: usize>(variation: &mut Variation<N>) {
    let mut part = 0.1;
    for entry in variation.q.iter_mut().chain(variation.p.iter_mut()) {
        *entry += part;
        part *= -0.9;
    }
}

/// Makes directions orthogonal, of length one, in order, and returns the lengths that they had.
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
        // Of steps that find their length the time varies too, and by a force the energy that is kept.
        own.t /= length;
        own.energy /= length;
        lengths.push(length);
    }
    lengths
}
