//! Trajectories that one thread takes on: side by side where that pays, else one after the other.
//!
//! In: systems and states, at most [`WIDTH`](crate::layout::WIDTH). Out: where each is after so many steps, or how it
//! ended.
//!
//! Side by side go systems whose functions are short enough to be inlined into the loop over trajectories, and of up to three degrees
//! of freedom: longer ones are calls, and their matrices are solved by loops themselves, so that nothing would become a vector
//! instruction. Those are fixed steps, each trajectory for itself.

use crate::alone::Alone;
use crate::block::Block;
use crate::ended::Ended;
use vi_core::stepping::Batch;
use vi_core::{FixedStep, Starts, State};
use vi_dispatch::Instructions;

/// Degrees of freedom up to which trajectories go side by side.
const LARGEST: usize = 3;

/// Trajectories of one thread; see the [module](self).
#[derive(Clone, Debug)]
pub(crate) enum Group<S: Batch<N>, const N: usize> {
    Together(Box<Block<S, N>>),
    Apart(Vec<Alone<FixedStep, S, N>>),
}

impl<S: Batch<N>, const N: usize> Group<S, N> {
    /// The group of these trajectories, at least one.
    pub(crate) fn new(trajectories: &[(S, State<N>)], h: f64, instructions: Instructions) -> Self {
        if const { N <= LARGEST } && S::INLINED {
            return Self::Together(Box::new(Block::new(trajectories, h, instructions)));
        }
        let alone = |&(system, state): &(S, State<N>)| {
            Alone::new(system.at_state(state).integrate(FixedStep, h).map_err(|error| Ended { state, steps: 0, error }))
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
            Self::Apart(all) => all.iter().filter(|alone| alone.is_running()).count(),
        }
    }

    /// The state of a trajectory.
    pub(crate) fn result(&self, index: usize) -> Result<State<N>, Ended<N>> {
        match self {
            Self::Together(block) => block.result(index),
            Self::Apart(all) => all[index].result(),
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
