//! Variations along a run.
//!
//! In: a run, variations of its node. Out: step after step, with the variations of the node reached. Directions share what is evaluated, so that more of them
//! cost little (`docs/benchmarks.md`); those of a chaotic motion grow, and it is for the caller to make them shorter again ([`Tangent::variations_mut`]).

use super::steps::Differentiable;
use super::variation::Variation;
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use crate::run::Run;
use crate::state::State;

/// A run, and how its node varies in some directions.
#[derive(Clone, Debug)]
pub struct Tangent<M: Method<S, N>, S, const N: usize> {
    run: Run<M, S, N>,
    variations: Vec<Variation<N>>,
    failure: Option<StepError>,
}

impl<M: Differentiable<S, N>, S: Lagrangian<N> + Copy, const N: usize> Tangent<M, S, N> {
    /// A run, and variations of the node at which it is.
    #[must_use]
    pub fn new(run: Run<M, S, N>, variations: Vec<Variation<N>>) -> Self {
        Self { run, variations, failure: None }
    }

    /// Takes a step, and returns the state reached.
    ///
    /// # Errors
    /// That of the step, after which the run and its variations are those before; or of [`Run::vary`], after which the variations have no meaning. The same
    /// error again after an error.
    pub fn step(&mut self) -> Result<State<N>, StepError> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        let before = *self.run.node();
        let outcome = self.run.step();
        let varied = outcome.and_then(|state| self.run.vary(&before, &mut self.variations).map(|()| state));
        varied.inspect_err(|failure| self.failure = Some(*failure))
    }

    /// The run.
    pub fn run(&self) -> &Run<M, S, N> {
        &self.run
    }

    /// The variations of the node at which the run is, in the order given.
    #[must_use]
    pub fn variations(&self) -> &[Variation<N>] {
        &self.variations
    }

    /// The same, to be changed: made shorter, or orthogonal to each other.
    pub fn variations_mut(&mut self) -> &mut [Variation<N>] {
        &mut self.variations
    }
}
