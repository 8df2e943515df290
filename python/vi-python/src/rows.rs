//! Rows of a run as numpy arrays.

use crate::failure::{too_many, wrong};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use vi_erased::Rows;

/// Arrays t (K), q (K, N), p (K, N), which take over the memory of the rows.
pub(crate) fn to_python<'py>(py: Python<'py>, rows: Rows, n: usize) -> PyResult<Bound<'py, PyAny>> {
    let count = rows.t.len();
    let t = PyArray1::from_vec(py, rows.t);
    let q = PyArray1::from_vec(py, rows.q).reshape([count, n])?;
    let p = PyArray1::from_vec(py, rows.p).reshape([count, n])?;
    Ok((t, q, p).into_pyobject(py)?.into_any())
}

/// Rows below which memory is not checked: the system allocates them anyway.
const FEW: u64 = 1 << 20;

/// Checks that the memory for so many rows of so many numbers exists, since a failed allocation ends the process.
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
