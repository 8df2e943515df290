//! Errors as Python exceptions.
//!
//! In: a typed error. Out: the exception class of the same name in `variational`, one class for all modules.

use crate::fields::{Value, fields};
use pyo3::exceptions::{PyMemoryError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vi_core::StepError;

/// The exception of a failed step.
pub(crate) fn exception(py: Python<'_>, error: &StepError) -> PyErr {
    instance(py, error).map_or_else(|raised| raised, PyErr::from_value)
}

/// The exception of a failed step as an object, to be raised later.
pub(crate) fn instance<'py>(py: Python<'py>, error: &StepError) -> PyResult<Bound<'py, PyAny>> {
    let (variant, found) = fields(error);
    let fields = PyDict::new(py);
    for (name, value) in found {
        match value {
            Value::None => fields.set_item(name, py.None()),
            Value::Number(number) => fields.set_item(name, number),
            Value::Integer(integer) => fields.set_item(name, integer),
            Value::Text(text) => fields.set_item(name, text),
            Value::Numbers(numbers) => fields.set_item(name, numbers),
            Value::Texts(texts) => fields.set_item(name, texts),
        }?;
    }
    py.import("variational._errors")?.call_method1("_exception", (variant, error.reason().to_string(), fields))
}

/// A raised exception as an object, to be raised again later.
pub(crate) fn value(py: Python<'_>, raised: PyErr) -> Bound<'_, PyAny> {
    raised.into_value(py).into_bound(py).into_any()
}

/// Turns an error into its exception.
pub(crate) trait Raise<T> {
    /// The value, or the exception.
    fn raise(self, py: Python<'_>) -> PyResult<T>;
}

impl<T> Raise<T> for Result<T, StepError> {
    fn raise(self, py: Python<'_>) -> PyResult<T> {
        self.map_err(|error| exception(py, &error))
    }
}

/// A wrong argument.
pub(crate) fn wrong(message: impl Into<String>) -> PyErr {
    PyValueError::new_err(message.into())
}

/// A run that another thread or a function of an event uses.
pub(crate) fn busy() -> PyErr {
    PyRuntimeError::new_err(
        "the run is advancing in another thread, or it called this function; \
         use one run.copy() for each thread, and do not use a run in its own events",
    )
}

/// Rows that do not fit into memory.
pub(crate) fn too_many(rows: u64) -> PyErr {
    PyMemoryError::new_err(format!("{rows} rows do not fit into memory; keep every k-th one with every=k"))
}
