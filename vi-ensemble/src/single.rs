//! A trajectory by itself, as far as it has come.

use crate::ended::Ended;
use vi_core::{Lagrangian, Method, Run, State, StepError};

/// A run, or how it ended.
#[derive(Clone, Debug)]
pub(crate) struct Alone<M: Method<S, N>, S, const N: usize> {
    run: Result<Run<M, S, N>, Ended<N>>,
    steps: u64,
}

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> Alone<M, S, N> {
    /// A run before its first step, or why there is none.
    pub(crate) fn new(run: Result<Run<M, S, N>, Ended<N>>) -> Self {
        Self { run, steps: 0 }
    }

    /// The run, where it has not ended.
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

    /// Takes `steps` steps, or as many as there are.
    pub(crate) fn take(&mut self, steps: u64) {
        self.advance(|run, taken| {
            while *taken < steps {
                run.step()?;
                *taken += 1;
            }
            Ok(())
        });
    }

    /// Goes on to the time `t`, by steps that are not counted.
    pub(crate) fn until(&mut self, t: f64) {
        self.advance(|run, _| run.until(t).map(drop));
    }

    /// Lets the run go on, which counts its steps; where it cannot, it has ended.
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
