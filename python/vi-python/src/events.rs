//! Events from Python: coordinates and velocities with values, periods, and Python functions.
//!
//! In: their descriptions. Out: the [`Section`]s of a search. A Python function that raises makes its event NaN, which
//! ends the search; the exception is kept. One more function, of constant value, looks for Ctrl-C and reports progress.

use crate::failure::wrong;
use crate::report::{Report, part};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyFloat;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use vi_erased::section::{Direction, Section, Watch};

/// An event as Python describes it.
#[derive(FromPyObject)]
pub(crate) enum Description {
    /// Whether of a velocity, the index of the coordinate, the value, and the direction.
    Value(bool, usize, f64, i32),
    /// The time of the first one, and the period.
    Period(f64, f64),
    /// A function g(t, q, v), the direction, and its name in messages.
    Function(Py<PyAny>, i32, String),
}

/// The exception that a function raised.
#[derive(Clone, Default)]
pub(crate) struct Raised(Arc<Mutex<Option<PyErr>>>);

impl Raised {
    /// Takes the exception.
    pub(crate) fn take(&self) -> Option<PyErr> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Keeps the first exception.
    fn keep(&self, error: PyErr) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }

    fn is_some(&self) -> bool {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).is_some()
    }
}

/// Evaluations between two looks at signals.
const PATIENCE: u32 = 1 << 14;

/// The sections of these events for a system with n coordinates, the one that looks for signals last, and whether
/// there are Python functions among them. It reports the part of the way between two times.
///
/// # Errors
/// `ValueError` for an index beyond the coordinates.
pub(crate) fn sections(
    events: Vec<Description>,
    n: usize,
    raised: &Raised,
    (report, way): (Report, [f64; 2]),
) -> PyResult<(Vec<Section>, bool)> {
    let mut sections = Vec::with_capacity(events.len() + 1);
    let mut has_functions = false;
    for event in events {
        sections.push(match event {
            Description::Value(_, index, ..) if index >= n => {
                return Err(wrong(format!("there is no coordinate {index}: the system has {n}")));
            }
            Description::Value(true, index, at, to) => Section::Velocity { index, at, direction: direction(to) },
            Description::Value(false, index, at, to) => Section::Coordinate { index, at, direction: direction(to) },
            Description::Period(start, period) => Section::Period { start, period },
            Description::Function(g, to, name) => {
                has_functions = true;
                function(g, to, name, raised.clone())
            }
        });
    }
    sections.push(signals(raised.clone(), report, way));
    Ok((sections, has_functions))
}

fn direction(of: i32) -> Direction {
    match of {
        1.. => Direction::Rising,
        0 => Direction::Both,
        _ => Direction::Falling,
    }
}

/// A Python function as an event of this name.
fn function(g: Py<PyAny>, to: i32, name: String, raised: Raised) -> Section {
    let watch = move |t: f64, q: &[f64], v: &[f64]| {
        if raised.is_some() {
            return f64::NAN;
        }
        Python::attach(|py| {
            let arguments = (t, PyArray1::from_slice(py, q), PyArray1::from_slice(py, v));
            let value = g.bind(py).call1(arguments).and_then(|value| number(&value, &name));
            value.unwrap_or_else(|error| {
                raised.keep(error);
                f64::NAN
            })
        })
    };
    Section::Function(Watch::new(watch), direction(to))
}

/// The value of a function. The package refuses what is no number, as the truth value of a condition.
fn number(value: &Bound<'_, PyAny>, name: &str) -> PyResult<f64> {
    match value.cast::<PyFloat>() {
        Ok(value) => Ok(value.value()),
        Err(_) => value.py().import("variational._events")?.call_method1("value", (value, name))?.extract(),
    }
}

/// A constant function that looks for signals, and reports the part of the way between two times.
fn signals(raised: Raised, report: Report, way: [f64; 2]) -> Section {
    let count = AtomicU32::new(0);
    let watch = move |t: f64, _: &[f64], _: &[f64]| {
        if count.fetch_add(1, Ordering::Relaxed).is_multiple_of(PATIENCE)
            && let Err(error) = Python::attach(|py| report.look(py, part(way, t)))
        {
            raised.keep(error);
        }
        if raised.is_some() { f64::NAN } else { 1.0 }
    };
    Section::Function(Watch::new(watch), Direction::Rising)
}
