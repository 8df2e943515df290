//! Many runs by any method, over threads.
//!
//! In: runs, each of its own system, state and step. Out: for each, in the order given, the state reached or how it [`Ended`]. A run
//! returns bit for bit what it returns alone, whatever the number of threads.

use crate::alone::Alone;
use crate::ended::Ended;
use rayon::prelude::*;
use vi_core::{Lagrangian, Method, Run, State};

/// Many runs by one method: Gauss steps, compositions, energy-preserving steps. For fixed steps of order 2 of small systems
/// [`Ensemble`](crate::Ensemble) is several times as fast. Threads are those of rayon's current pool.
///
/// ```
/// use vi_core::prelude::*;
/// use vi_ensemble::Runs;
/// use vi_systems::Kepler;
///
/// let planet = Kepler::default();
/// let runs = (0..100).map(|k| {
///     planet.at(0.0, [0.4 + 0.001 * f64::from(k), 0.0], [0.0, 2.0]).integrate(Gauss::<8>, 0.1)
/// });
/// let mut runs = Runs::new(runs.collect::<Result<_, _>>()?);
/// runs.until(5.0);
/// for result in runs.results() {
///     assert_eq!(result.map(|state| state.t), Ok(5.0));
/// }
/// # Ok::<(), StepError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Runs<M: Method<S, N>, S, const N: usize> {
    all: Vec<Alone<M, S, N>>,
}

impl<M, S, const N: usize> Runs<M, S, N>
where
    M: Method<S, N>,
    S: Lagrangian<N> + Copy,
    Run<M, S, N>: Send,
{
    /// The runs, in this order.
    #[must_use]
    pub fn new(runs: Vec<Run<M, S, N>>) -> Self {
        Self { all: runs.into_iter().map(|run| Alone::new(Ok(run))).collect() }
    }

    /// Takes `steps` steps of every run that has not ended.
    pub fn run(&mut self, steps: u64) {
        self.all.par_iter_mut().for_each(|alone| alone.take(steps));
    }

    /// Takes every run that has not ended to the time `t`, exactly; a run that cannot go there has ended with the reason. How an
    /// ended run [`Ended`] counts the steps of [`Runs::run`] only.
    pub fn until(&mut self, t: f64) {
        self.all.par_iter_mut().for_each(|alone| alone.until(t));
    }

    /// The runs, in the order given, for their energies, dense output, checkpoints; of one that has ended, how.
    pub fn runs(&self) -> impl Iterator<Item = Result<&Run<M, S, N>, Ended<N>>> + '_ {
        self.all.iter().map(Alone::run)
    }

    /// The state of each run, in the order given; of one that has ended, how.
    pub fn results(&self) -> impl Iterator<Item = Result<State<N>, Ended<N>>> + '_ {
        self.all.iter().map(Alone::result)
    }

    /// How many runs have not ended.
    #[must_use]
    pub fn running(&self) -> usize {
        self.all.iter().filter(|alone| alone.is_running()).count()
    }
}
