//! Trajectories that one thread takes on: side by side where that pays, else one after the other.
//!
//! In: systems and states, at most [`WIDTH`](crate::ensemble::WIDTH). Out: where each is after so many steps, or how it
//! ended.
//!
//! Beyond three degrees of freedom the formulas are too long to be written into a loop over trajectories, and their
//! matrices are solved by loops themselves: nothing would become a vector instruction. And Newton's iteration across a kink
//! is watched in every step. These are fixed steps, each trajectory for itself.

use crate::block::Block;
use crate::dispatch::Instructions;
use crate::ensemble::Ended;
use vi_core::fixed_step::Checkpoint;
use vi_core::{Batch, FixedStep, State, StepError};

/// Degrees of freedom up to which trajectories go side by side.
const LARGEST: usize = 3;

/// Trajectories of one thread; see the [module](self).
#[derive(Clone, Debug)]
pub(crate) enum Group<S: Batch<N>, const N: usize> {
    Together(Box<Block<S, N>>),
    Apart(Vec<Alone<S, N>>),
}

/// A trajectory by itself, as far as it has come: the integrator does not go from thread to thread.
#[derive(Clone, Debug)]
pub(crate) struct Alone<S, const N: usize> {
    system: S,
    run: Result<(Checkpoint<N>, State<N>), Ended<N>>,
    steps: u64,
}

impl<S: Batch<N>, const N: usize> Group<S, N> {
    /// The group of these trajectories, at least one.
    pub(crate) fn new(trajectories: &[(S, State<N>)], h: f64, instructions: Instructions) -> Self {
        if N <= LARGEST && S::SMOOTH {
            return Self::Together(Box::new(Block::new(trajectories, h, instructions)));
        }
        let alone = |&(system, state): &(S, State<N>)| {
            let run = FixedStep::new(system, state, h).map(|run| (run.checkpoint(), state));
            Alone { system, run: run.map_err(|error| Ended { state, steps: 0, error }), steps: 0 }
        };
        Self::Apart(trajectories.iter().map(alone).collect())
    }

    /// How many trajectories there are, ended or not.
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Together(block) => block.len(),
            Self::Apart(all) => all.len(),
        }
    }

    /// How many have not ended.
    pub(crate) fn running(&self) -> usize {
        match self {
            Self::Together(block) => block.running(),
            Self::Apart(all) => all.iter().filter(|alone| alone.run.is_ok()).count(),
        }
    }

    /// The state of a trajectory.
    pub(crate) fn result(&self, index: usize) -> Result<State<N>, Ended<N>> {
        match self {
            Self::Together(block) => block.result(index),
            Self::Apart(all) => all[index].run.map(|(_, state)| state),
        }
    }

    /// Takes `steps` steps, or as many as there are trajectories for.
    pub(crate) fn run(&mut self, steps: u64) {
        match self {
            Self::Together(block) => block.run(steps),
            Self::Apart(all) => all.iter_mut().for_each(|alone| alone.take(steps)),
        }
    }
}

impl<S: Batch<N>, const N: usize> Alone<S, N> {
    fn take(&mut self, steps: u64) {
        if let Ok((checkpoint, state)) = self.run {
            self.run = self.taken(checkpoint, steps).map_err(|(last, error)| Ended {
                state: last.unwrap_or(state),
                steps: self.steps,
                error,
            });
        }
    }

    /// The run after the steps; or the last state of this part, if there was one, and why there was no other.
    fn taken(
        &mut self,
        checkpoint: Checkpoint<N>,
        steps: u64,
    ) -> Result<(Checkpoint<N>, State<N>), (Option<State<N>>, StepError)> {
        let mut run = FixedStep::restart(self.system, checkpoint).map_err(|error| (None, error))?;
        for _ in 0..steps {
            run.step().map_err(|error| (Some(run.state()), error))?;
            self.steps += 1;
        }
        Ok((run.checkpoint(), run.state()))
    }
}
