//! The ensemble of a caller.
//!
//! In: systems, states, a step h, a number of steps. Out: for each trajectory, in the order given, its state or how it
//! [`Ended`]. The threads of the current rayon pool share groups of 64 trajectories.

use crate::ended::Ended;
use crate::group::Group;
use crate::layout::WIDTH;
use rayon::prelude::*;
use vi_core::stepping::Batch;
use vi_core::support::check_step;
use vi_core::{State, StepError};
use vi_dispatch::Instructions;

/// Minimum number of steps of a task for another thread: 50 µs and more.
const WORTHWHILE: u64 = 1 << 14;

/// Many trajectories of one system with a common step; each has its own parameters and state. The [crate] documentation
/// lists which systems run in vector lanes and which on threads only.
///
/// ```
/// use vi_core::State;
/// use vi_ensemble::Ensemble;
/// use vi_systems::Pendulum;
///
/// let pendulums: Vec<_> = (1..=100).map(|i| Pendulum { l: 0.01 * f64::from(i), ..Pendulum::default() }).collect();
/// let starts = pendulums.iter().map(|pendulum| State::at(pendulum, 0.0, [1.0], [0.0])).collect();
/// let mut ensemble = Ensemble::new(pendulums, starts, 0.001)?;
/// ensemble.run(1000);
/// for (i, result) in ensemble.results().enumerate() {
///     match result {
///         Ok(state) => assert!(state.q[0].abs() < 1.001),
///         Err(ended) => println!("trajectory {i} {ended}"),
///     }
/// }
/// # Ok::<(), vi_core::StepError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Ensemble<S: Batch<N>, const N: usize> {
    groups: Vec<Group<S, N>>,
    h: f64,
    steps: u64,
}

impl<S: Batch<N>, const N: usize> Ensemble<S, N> {
    /// The trajectories of `systems` from `states`, pair by pair, with the step `h` in units of time (negative:
    /// backwards). A state without a first step is a trajectory that has ended.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an h that is zero, subnormal or not finite, or if the numbers of systems and
    /// states differ.
    #[allow(clippy::needless_pass_by_value, clippy::cast_precision_loss)]
    pub fn new(systems: Vec<S>, states: Vec<State<N>>, h: f64) -> Result<Self, StepError> {
        check_step(h)?;
        if systems.len() != states.len() {
            let value = systems.len() as f64;
            let (input, allowed) = ("the number of systems", "that of the states");
            return Err(StepError::InvalidInput { input, allowed, value });
        }
        let instructions = Instructions::detected();
        let trajectories: Vec<(S, State<N>)> = systems.into_iter().zip(states).collect();
        let groups = trajectories.par_chunks(WIDTH).map(|chunk| Group::new(chunk, h, instructions)).collect();
        Ok(Self { groups, h, steps: 0 })
    }

    /// Takes `steps` steps of every trajectory that has not ended.
    pub fn run(&mut self, steps: u64) {
        self.steps = self.steps.saturating_add(steps);
        if let [group] = &mut self.groups[..] {
            return group.run(steps);
        }
        let together = WORTHWHILE / (WIDTH as u64).saturating_mul(steps.max(1));
        let together = usize::try_from(together).unwrap_or(usize::MAX).max(1);
        self.groups.par_iter_mut().with_min_len(together).for_each(|group| group.run(steps));
    }

    /// Takes `steps` steps, `every` at a time (at least one), and calls `observe` after each part.
    pub fn run_observed(&mut self, steps: u64, every: u64, mut observe: impl FnMut(&Self)) {
        let mut left = steps;
        while left > 0 {
            let part = left.min(every.max(1));
            self.run(part);
            left -= part;
            observe(self);
        }
    }

    /// The state of each trajectory, in the order given, or how it ended.
    pub fn results(&self) -> impl Iterator<Item = Result<State<N>, Ended<N>>> + '_ {
        self.groups.iter().flat_map(|group| (0..group.len()).map(|index| group.result(index)))
    }

    /// Number of trajectories that have not ended.
    #[must_use]
    pub fn running(&self) -> usize {
        self.groups.iter().map(Group::running).sum()
    }

    /// Number of steps taken by trajectories that have not ended.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The step, in units of time.
    #[must_use]
    pub fn h(&self) -> f64 {
        self.h
    }
}
