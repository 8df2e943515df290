//! Many runs on all cores.
//!
//! In: a system and a plan for each run. Out: the rows of all runs, and the error of each. The interpreter is released;
//! the calling thread looks for Ctrl-C.

use crate::failure::{instance, wrong};
use crate::rows::{check_memory, record_some, to_python};
use pyo3::prelude::*;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;
use vi_core::StepError;
use vi_erased::{Plan, Rows, Simulation, System};

/// The rows of each run.
pub(crate) enum Output {
    /// The state at the end.
    End(f64),
    /// States at times.
    Times(Vec<f64>),
}

/// Many runs of one type of system.
pub(crate) struct Ensemble<'a> {
    /// Coordinates of the system.
    pub(crate) n: usize,
    /// Number of runs.
    pub(crate) many: usize,
    /// The rows of each run.
    pub(crate) output: Output,
    /// System and plan of a run, by its index.
    pub(crate) plan: &'a (dyn Fn(usize) -> PyResult<(Box<dyn System>, Plan)> + Sync),
}

/// The rows of a run, and the error that ended it.
type Ended = (Rows, Option<StepError>);

/// Steps between two looks at the flag that stops all runs.
const STRETCH: u64 = 1 << 14;
/// Time between two looks at signals.
const PATIENCE: Duration = Duration::from_millis(50);

impl Ensemble<'_> {
    /// Runs all on this number of threads, without one on all cores.
    ///
    /// # Errors
    /// `KeyboardInterrupt`, `MemoryError`. Errors of runs are values.
    #[allow(clippy::type_complexity)] // rows and errors
    pub(crate) fn run<'py>(
        &self,
        py: Python<'py>,
        threads: Option<usize>,
    ) -> PyResult<(Bound<'py, PyAny>, Vec<Option<Bound<'py, PyAny>>>)> {
        let rows_of_each = self.rows_of_each();
        let total = (self.many as u64).saturating_mul(rows_of_each as u64);
        check_memory(total, 2 * (1 + 2 * self.n))?;
        // A pool of its own for each call: threads do not outlive it, so that a process can fork afterwards.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
        let pool = pool.map_err(|error| wrong(format!("threads cannot be started: {error}")))?;
        let is_stopped = AtomicBool::new(false);
        let ended = py.detach(|| {
            let (sender, receiver) = channel();
            pool.in_place_scope(|scope| {
                scope.spawn(|_| {
                    let runs: PyResult<Vec<Ended>> =
                        (0..self.many).into_par_iter().map(|index| self.one(index, &is_stopped)).collect();
                    // The receiver lives until the end of the scope.
                    let _ = sender.send(runs);
                });
                let mut signal = Ok(());
                loop {
                    match receiver.recv_timeout(PATIENCE) {
                        Ok(runs) => return signal.and(runs),
                        Err(RecvTimeoutError::Disconnected) => return signal.and(Ok(Vec::new())),
                        Err(RecvTimeoutError::Timeout) if signal.is_ok() => {
                            signal = Python::attach(|py| py.check_signals());
                            is_stopped.store(signal.is_err(), Ordering::Relaxed);
                        }
                        Err(RecvTimeoutError::Timeout) => {}
                    }
                }
            })
        })?;
        let (mut rows, mut errors) = (Rows::default(), Vec::with_capacity(self.many));
        for (of, error) in ended {
            rows.t.extend(of.t);
            rows.q.extend(of.q);
            rows.p.extend(of.p);
            errors.push(error.map(|error| instance(py, &error)).transpose()?);
        }
        Ok((to_python(py, rows, self.n)?, errors))
    }

    fn rows_of_each(&self) -> usize {
        match &self.output {
            Output::End(_) => 1,
            Output::Times(times) => times.len(),
        }
    }

    /// The run of an index.
    fn one(&self, index: usize, is_stopped: &AtomicBool) -> PyResult<Ended> {
        let mut rows = Rows::default();
        if is_stopped.load(Ordering::Relaxed) {
            return Ok((rows, None));
        }
        let (system, plan) = (self.plan)(index)?;
        let goes_on = &mut || !is_stopped.load(Ordering::Relaxed);
        let outcome = system.begin_while(&plan, goes_on).and_then(|mut run| match &self.output {
            Output::End(end) => to_the_end(&mut *run, *end, is_stopped, &mut rows),
            Output::Times(times) => {
                let mut left = &times[..];
                while !left.is_empty() && !is_stopped.load(Ordering::Relaxed) {
                    let h = run.h();
                    record_some(&mut run, h, &mut left, &mut rows)?;
                }
                Ok(())
            }
        });
        // Every run has the same number of rows, so that they form an array.
        let wanted = self.rows_of_each();
        rows.t.resize(wanted, f64::NAN);
        rows.q.resize(wanted * self.n, f64::NAN);
        rows.p.resize(wanted * self.n, f64::NAN);
        Ok((rows, outcome.err()))
    }
}

/// Advances to a time, and adds the state there.
fn to_the_end(run: &mut dyn Simulation, end: f64, is_stopped: &AtomicBool, rows: &mut Rows) -> Result<(), StepError> {
    let mut unused = Rows::default();
    while !run.record(Some(end), STRETCH, u64::MAX, &mut 0, &mut unused)? && !is_stopped.load(Ordering::Relaxed) {}
    rows.push(run.t(), &run.q(), run.p());
    Ok(())
}
