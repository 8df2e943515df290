//! The trajectories of one task: in vector lanes if that is faster, otherwise one after the other.
//!
//! In: at most [`WIDTH`](crate::layout::WIDTH) systems and states. Out: the state of each after a number of steps, or
//! how it ended.
//!
//! Vector lanes need up to three degrees of freedom and functions short enough to be inlined into the loop over
//! trajectories. Longer functions are calls, and larger matrices are solved in loops: LLVM would not vectorize them.
//! Such systems take fixed steps, one trajectory at a time.

use crate::block::Block;
use crate::ended::Ended;
use crate::single::Single;
use vi_core::stepping::Batch;
use vi_core::{FixedStep, Starts, State};
use vi_dispatch::Instructions;

/// Maximum degrees of freedom in vector lanes.
const LARGEST: usize = 3;

/// The trajectories of one task; see the [module](self).
#[derive(Clone, Debug)]
pub(crate) enum Group<S: Batch<N>, const N: usize> {
    Together(Box<Block<S, N>>),
    Single(Vec<Single<FixedStep, S, N>>),
}

impl<S: Batch<N>, const N: usize> Group<S, N> {
    /// A group of at least one trajectory.
    pub(crate) fn new(trajectories: &[(S, State<N>)], h: f64, instructions: Instructions) -> Self {
        if const { N <= LARGEST } && S::INLINED {
            return Self::Together(Box::new(Block::new(trajectories, h, instructions)));
        }
        let single = |&(system, state): &(S, State<N>)| {
            Single::new(system.at_state(state).integrate(FixedStep, h).map_err(|error| Ended {
                state,
                steps: 0,
                error,
            }))
        };
        Self::Single(trajectories.iter().map(single).collect())
    }

    /// Number of trajectories, including ended ones.
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Together(block) => block.len(),
            Self::Single(all) => all.len(),
        }
    }

    /// Number of trajectories that have not ended.
    pub(crate) fn running(&self) -> usize {
        match self {
            Self::Together(block) => block.running(),
            Self::Single(all) => all.iter().filter(|single| single.is_running()).count(),
        }
    }

    /// The state of a trajectory.
    pub(crate) fn result(&self, index: usize) -> Result<State<N>, Ended<N>> {
        match self {
            Self::Together(block) => block.result(index),
            Self::Single(all) => all[index].result(),
        }
    }

    /// Takes `steps` steps, or fewer if all trajectories end.
    pub(crate) fn run(&mut self, steps: u64) {
        match self {
            Self::Together(block) => block.run(steps),
            Self::Single(all) => all.iter_mut().for_each(|single| single.take(steps)),
        }
    }
}
