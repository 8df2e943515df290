//! Many runs with any method, on threads.
//!
//! In: runs, each with its own system, state and step. Out: for each, in the order given, its state or how it
//! [`Ended`]. A run returns the same bits as alone, for any number of threads.

use crate::ended::Ended;
use crate::single::Single;
use rayon::prelude::*;
use vi_core::{Lagrangian, Method, Run, State};

/// Many runs with one method: Gauss, compositions, energy-preserving, `Gauss` with constraints. For small systems with fixed steps of order 2,
/// [`Ensemble`](crate::Ensemble) is several times as fast. Uses the threads of the current rayon pool.
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
    all: Vec<Single<M, S, N>>,
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
        Self { all: runs.into_iter().map(|run| Single::new(Ok(run))).collect() }
    }

    /// Takes `steps` steps of every run that has not ended.
    pub fn run(&mut self, steps: u64) {
        self.all.par_iter_mut().for_each(|single| single.take(steps));
    }

    /// Advances every run that has not ended to the time `t`, exactly. A run that fails on the way ends with the error.
    /// The step count of [`Ended`] includes steps of [`Runs::run`] only.
    pub fn until(&mut self, t: f64) {
        self.all.par_iter_mut().for_each(|single| single.until(t));
    }

    /// The runs in the order given, for energies, dense output and checkpoints, or how they ended.
    pub fn runs(&self) -> impl Iterator<Item = Result<&Run<M, S, N>, Ended<N>>> + '_ {
        self.all.iter().map(Single::run)
    }

    /// The state of each run in the order given, or how it ended.
    pub fn results(&self) -> impl Iterator<Item = Result<State<N>, Ended<N>>> + '_ {
        self.all.iter().map(Single::result)
    }

    /// Number of runs that have not ended.
    #[must_use]
    pub fn running(&self) -> usize {
        self.all.iter().filter(|single| single.is_running()).count()
    }
}
