//! Many runs on all cores.
//!
//! In: a system and a plan for each run. Out: the rows of all runs, and the error of each. The interpreter is released;
//! the calling thread looks for Ctrl-C and reports progress.

use crate::failure::{instance, value, wrong};
use crate::report::{PATIENCE, Report};
use crate::rows::{check_memory, record_some, to_python};
use pyo3::prelude::*;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
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

/// The rows of a run, and the error that ended it; none if it was stopped.
type Ended = (Rows, Result<(), Option<StepError>>);

/// Steps between two looks at the flag that stops all runs.
const STRETCH: u64 = 1 << 14;

impl Ensemble<'_> {
    /// Runs all on this number of threads, without one on all cores. Returns their rows and errors, and the exception that
    /// stopped those that had not ended.
    ///
    /// # Errors
    /// `MemoryError`. Errors of runs are values.
    #[allow(clippy::type_complexity)] // rows and errors
    pub(crate) fn run<'py>(
        &self,
        py: Python<'py>,
        threads: Option<usize>,
        report: &Report,
    ) -> PyResult<(Bound<'py, PyAny>, Vec<Option<Bound<'py, PyAny>>>, Option<Bound<'py, PyAny>>)> {
        let rows_of_each = self.rows_of_each();
        let total = (self.many as u64).saturating_mul(rows_of_each as u64);
        check_memory(total, 2 * (1 + 2 * self.n))?;
        // A pool of its own for each call: threads do not outlive it, so that a process can fork afterwards.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
        let pool = pool.map_err(|error| wrong(format!("threads cannot be started: {error}")))?;
        let (is_stopped, done) = (AtomicBool::new(false), AtomicUsize::new(0));
        let one = |index| {
            let ended = self.one(index, &is_stopped);
            done.fetch_add(1, Ordering::Relaxed);
            ended
        };
        let (ended, signal) = py.detach(|| {
            let (sender, receiver) = channel();
            pool.in_place_scope(|scope| {
                scope.spawn(|_| {
                    let runs: PyResult<Vec<Ended>> = (0..self.many).into_par_iter().map(&one).collect();
                    // The receiver lives until the end of the scope.
                    let _ = sender.send(runs);
                });
                let mut signal = Ok(());
                loop {
                    match receiver.recv_timeout(PATIENCE) {
                        Ok(runs) => return (runs, signal),
                        Err(RecvTimeoutError::Disconnected) => return (Ok(Vec::new()), signal),
                        Err(RecvTimeoutError::Timeout) if signal.is_ok() => {
                            #[allow(clippy::cast_precision_loss)] // of a progress bar
                            let part = done.load(Ordering::Relaxed) as f64 / self.many as f64;
                            signal = Python::attach(|py| report.look(py, part));
                            is_stopped.store(signal.is_err(), Ordering::Relaxed);
                        }
                        Err(RecvTimeoutError::Timeout) => {}
                    }
                }
            })
        });
        let stopped = signal.err().map(|raised| value(py, raised));
        let (mut rows, mut errors) = (Rows::default(), Vec::with_capacity(self.many));
        for (of, outcome) in ended? {
            rows.t.extend(of.t);
            rows.q.extend(of.q);
            rows.p.extend(of.p);
            errors.push(match outcome {
                Ok(()) => None,
                Err(None) => stopped.clone(),
                Err(Some(error)) => Some(instance(py, &error)?),
            });
        }
        Ok((to_python(py, rows, self.n)?, errors, stopped))
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
        let wanted = self.rows_of_each();
        let outcome =
            if is_stopped.load(Ordering::Relaxed) { Ok(()) } else { self.taken(index, is_stopped, &mut rows)? };
        let is_whole = rows.t.len() == wanted || !is_stopped.load(Ordering::Relaxed);
        // Every run has the same number of rows, so that they form an array.
        rows.t.resize(wanted, f64::NAN);
        rows.q.resize(wanted * self.n, f64::NAN);
        rows.p.resize(wanted * self.n, f64::NAN);
        Ok((rows, if is_whole { outcome.map_err(Some) } else { Err(None) }))
    }

    /// Takes the steps of a run, and adds its rows. The outcome is an error of its steps.
    fn taken(&self, index: usize, is_stopped: &AtomicBool, rows: &mut Rows) -> PyResult<Result<(), StepError>> {
        let (system, plan) = (self.plan)(index)?;
        let goes_on = &mut || !is_stopped.load(Ordering::Relaxed);
        Ok(system.begin_while(&plan, goes_on).and_then(|mut run| match &self.output {
            Output::End(end) => to_the_end(&mut *run, *end, is_stopped, rows),
            Output::Times(times) => {
                let mut left = &times[..];
                while !left.is_empty() && !is_stopped.load(Ordering::Relaxed) {
                    let h = run.h();
                    record_some(&mut run, h, &mut left, rows)?;
                }
                Ok(())
            }
        }))
    }
}

/// Advances to a time, and adds the state there unless the run is stopped on the way.
fn to_the_end(run: &mut dyn Simulation, end: f64, is_stopped: &AtomicBool, rows: &mut Rows) -> Result<(), StepError> {
    let mut unused = Rows::default();
    while !run.record(Some(end), STRETCH, u64::MAX, &mut 0, &mut unused)? {
        if is_stopped.load(Ordering::Relaxed) {
            return Ok(());
        }
    }
    rows.push(run.t(), &run.q(), run.p());
    Ok(())
}
