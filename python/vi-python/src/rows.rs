//! Rows of a run as numpy arrays.

use crate::failure::{too_many, wrong};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use vi_core::StepError;
use vi_erased::control::Linear;
use vi_erased::{Rows, Simulation};

/// Arrays t (K), q (K, N), p (K, N), which take over the memory of the rows.
pub(crate) fn to_python(py: Python<'_>, rows: Rows, n: usize) -> PyResult<Bound<'_, PyAny>> {
    let count = rows.t.len();
    let t = PyArray1::from_vec(py, rows.t);
    let q = PyArray1::from_vec(py, rows.q).reshape([count, n])?;
    let p = PyArray1::from_vec(py, rows.p).reshape([count, n])?;
    Ok((t, q, p).into_pyobject(py)?.into_any())
}

/// A matrix of rows of n numbers.
pub(crate) fn rows(py: Python<'_>, numbers: Vec<f64>, n: usize) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let count = numbers.len().checked_div(n).unwrap_or(0);
    PyArray1::from_vec(py, numbers).reshape([count, n])
}

/// The value of a linearization, A and B.
pub(crate) type Linearized<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>);

/// A linearization as arrays.
pub(crate) fn linearized(py: Python<'_>, of: Linear) -> PyResult<Linearized<'_>> {
    let (count, inputs) = (of.value.len(), of.b.len() / of.value.len());
    let b = PyArray1::from_vec(py, of.b).reshape([count, inputs])?;
    Ok((PyArray1::from_vec(py, of.value), rows(py, of.a, count)?, b))
}

/// Rows below which memory is not checked: the system allocates them anyway.
const FEW: u64 = 1 << 20;

/// Checks that rows of this many numbers fit into memory: a failed allocation would end the process.
///
/// # Errors
/// `MemoryError`.
pub(crate) fn check_memory(rows: u64, numbers: usize) -> PyResult<()> {
    if rows <= FEW {
        return Ok(());
    }
    let total = usize::try_from(rows).ok().and_then(|rows| rows.checked_mul(numbers)).ok_or_else(|| too_many(rows))?;
    // A vector doubles when it grows, so that old and new entries exist at the same time.
    let total = total.checked_add(total / 2).ok_or_else(|| too_many(rows))?;
    Vec::<f64>::new().try_reserve_exact(total).map_err(|_| too_many(rows))
}

/// Rows with memory for as many as are expected, but for a few only: the run may end early.
pub(crate) fn reserved(expected: u64, n: usize) -> Rows {
    let count = usize::try_from(expected.min(FEW / n as u64)).unwrap_or(0) + 2;
    let [t, q, p] = [count, count * n, count * n].map(Vec::with_capacity);
    Rows { t, q, p }
}

/// The entries of a contiguous vector.
///
/// # Errors
/// `ValueError` for another number of entries than `count`.
pub(crate) fn vector(array: &PyReadonlyArray1<'_, f64>, count: usize, name: &str) -> PyResult<Vec<f64>> {
    let values = array.as_slice()?;
    if values.len() == count {
        Ok(values.to_vec())
    } else {
        Err(wrong(format!("{name} must have {count} entries, not {}", values.len())))
    }
}

/// The entries of a contiguous matrix, row after row.
///
/// # Errors
/// `ValueError` for another shape.
pub(crate) fn matrix(array: &PyReadonlyArray2<'_, f64>, shape: [usize; 2], name: &str) -> PyResult<Vec<f64>> {
    if array.shape() == shape {
        Ok(array.as_slice()?.to_vec())
    } else {
        Err(wrong(format!("{name} must have the shape {shape:?}, not {:?}", array.shape())))
    }
}

/// Steps of the length h to a time; 0 if it is not ahead.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
pub(crate) fn steps_to(run: &dyn Simulation, h: f64, end: f64) -> u64 {
    ((end - run.t()) / h).ceil() as u64
}

/// Steps to output times between two looks at signals.
const NEAR: u64 = 8192;

/// Adds the states at some of the times, and removes them from the front of `times`. If the first of them is far, it
/// only takes steps toward it. h is the length of a step.
///
/// # Errors
/// The error of the failed step.
pub(crate) fn record_some(
    run: &mut Box<dyn Simulation>,
    h: f64,
    times: &mut &[f64],
    rows: &mut Rows,
) -> Result<(), StepError> {
    let near = times.iter().take(256).take_while(|t| steps_to(&**run, h, **t) <= NEAR).count();
    let (now, later) = times.split_at(near);
    *times = later;
    match (now, later) {
        ([], [far, ..]) => {
            let most = (steps_to(&**run, h, *far) / 4).min(NEAR);
            let mut ahead = run.copy();
            ahead.record(None, most, u64::MAX, &mut 0, &mut Rows::default())?;
            if (far - ahead.t()) * h > 0.0 {
                *run = ahead;
                return Ok(());
            }
            // The steps have grown: it is near.
            *times = &times[1..];
            run.record_at(&[*far], rows)
        }
        _ => run.record_at(now, rows),
    }
}
