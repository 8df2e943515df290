//! A single trajectory with its progress.

use crate::ended::Ended;
use vi_core::{Lagrangian, Method, Run, State, StepError};

/// A run, or its end.
#[derive(Clone, Debug)]
pub(crate) struct Single<M: Method<S, N>, S, const N: usize> {
    run: Result<Run<M, S, N>, Ended<N>>,
    steps: u64,
}

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> Single<M, S, N> {
    /// A run before its first step, or the reason why there is none.
    pub(crate) fn new(run: Result<Run<M, S, N>, Ended<N>>) -> Self {
        Self { run, steps: 0 }
    }

    /// The run, if it has not ended.
    pub(crate) fn run(&self) -> Result<&Run<M, S, N>, Ended<N>> {
        self.run.as_ref().map_err(|ended| *ended)
    }

    /// The state.
    pub(crate) fn result(&self) -> Result<State<N>, Ended<N>> {
        self.run().map(Run::state)
    }

    /// Whether it has not ended.
    pub(crate) fn is_running(&self) -> bool {
        self.run.is_ok()
    }

    /// Takes `steps` steps, or fewer if the run ends.
    pub(crate) fn take(&mut self, steps: u64) {
        self.advance(|run, taken| {
            while *taken < steps {
                run.step()?;
                *taken += 1;
            }
            Ok(())
        });
    }

    /// Advances to the time `t`, with uncounted steps.
    pub(crate) fn until(&mut self, t: f64) {
        self.advance(|run, _| run.until(t).map(drop));
    }

    /// Advances the run and counts its steps; after an error the run has ended.
    fn advance(&mut self, advance: impl FnOnce(&mut Run<M, S, N>, &mut u64) -> Result<(), StepError>) {
        let Ok(run) = &mut self.run else { return };
        let mut taken = 0;
        let outcome = advance(run, &mut taken);
        self.steps += taken;
        if let Err(error) = outcome {
            self.run = Err(Ended { state: run.state(), steps: self.steps, error });
        }
    }
}
