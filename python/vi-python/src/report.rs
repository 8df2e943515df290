//! Ctrl-C and progress on the way of a long call.

use pyo3::prelude::*;
use std::time::{Duration, Instant};

/// A function of Python that takes the part of a call that is done, 0 to 1; or none.
#[derive(Default)]
pub(crate) struct Report(Option<Py<PyAny>>);

impl Report {
    pub(crate) fn new(function: Option<Py<PyAny>>) -> Self {
        Self(function)
    }

    /// Looks for signals, and reports the part.
    ///
    /// # Errors
    /// The exception of a signal, or of the function.
    pub(crate) fn look(&self, py: Python<'_>, part: f64) -> PyResult<()> {
        py.check_signals()?;
        self.0.as_ref().map_or(Ok(()), |function| function.call1(py, (part,)).map(drop))
    }
}

/// The part of the way from one number to another.
pub(crate) fn part([from, to]: [f64; 2], here: f64) -> f64 {
    let part = (here - from) / (to - from);
    if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 }
}

/// Time between two looks.
pub(crate) const PATIENCE: Duration = Duration::from_millis(50);

/// Looks at signals on the way of a derivative or of a measurement, whose steps may take microseconds or milliseconds.
pub(crate) struct Watch {
    report: Report,
    /// Looks that are expected, each after one step.
    total: f64,
    steps: f64,
    looked: Instant,
    raised: Option<PyErr>,
}

impl Watch {
    pub(crate) fn new(report: Report, total: f64) -> Self {
        Self { report, total, steps: 0.0, looked: Instant::now(), raised: None }
    }

    /// Whether to take one more step: no exception has come so far.
    pub(crate) fn goes_on(&mut self) -> bool {
        self.steps += 1.0;
        if self.raised.is_none() && self.looked.elapsed() > PATIENCE {
            self.looked = Instant::now();
            let part = part([0.0, self.total], self.steps);
            self.raised = Python::attach(|py| self.report.look(py, part)).err();
        }
        self.raised.is_none()
    }

    /// The exception that has come, if any.
    pub(crate) fn check(self) -> PyResult<()> {
        self.raised.map_or(Ok(()), Err)
    }

    /// The value found, or the exception.
    pub(crate) fn unless_raised<T>(self, found: Option<T>) -> PyResult<T> {
        self.check()?;
        found.ok_or_else(|| crate::failure::wrong("the derivative was stopped"))
    }
}
