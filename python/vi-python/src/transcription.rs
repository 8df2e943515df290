//! Optimal control as a nonlinear program.

use crate::failure::{instance, wrong};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use std::sync::{Mutex, MutexGuard, PoisonError};
use vi_erased::function::{Function, Points};
use vi_erased::transcription::{self, Evaluation, Pattern};

/// f, its gradient, g, the entries of the Jacobian of g, and the index and the exception of the first step without an end.
type Evaluated<'py> = (
    f64,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Option<(usize, Bound<'py, PyAny>)>,
);

/// Starts of columns, and rows.
type Places = (Vec<usize>, Vec<usize>);

/// The program of an optimal control problem.
#[pyclass(frozen, module = "variational._core")]
pub struct Transcription(Mutex<transcription::Transcription>);

/// An expression with its first and second derivatives, each an `Observable`.
#[derive(FromPyObject)]
pub(crate) struct Smooth {
    orders: [Py<PyAny>; 3],
    is_of_inputs: bool,
    coordinates: usize,
    inputs: usize,
}

impl Function for Smooth {
    fn at(&self, points: &Points<'_>, order: u8) -> Vec<f64> {
        let rows = |numbers: &[f64], each: usize| -> Vec<Vec<f64>> {
            if each == 0 { Vec::new() } else { numbers.chunks_exact(each).map(<[f64]>::to_vec).collect() }
        };
        let count = points.t.len();
        let (q, v) = (rows(points.q, self.coordinates), rows(points.v, self.coordinates));
        let parameters = rows(points.parameters, points.parameters.len().checked_div(count).unwrap_or(0));
        Python::attach(|py| {
            let of = self.orders[usize::from(order.min(2))].bind(py);
            let found = of.call_method1("values", ((points.t.to_vec(), q, v), parameters));
            let arguments = 1 + 2 * self.coordinates + self.inputs;
            // A function that Python ended has no value.
            found
                .and_then(|values| values.extract())
                .unwrap_or_else(|_| vec![f64::NAN; count * arguments.pow(u32::from(order.min(2)))])
        })
    }

    fn is_of_inputs(&self) -> bool {
        self.is_of_inputs
    }
}

impl Transcription {
    pub(crate) fn new(of: transcription::Transcription) -> Self {
        Self(Mutex::new(of))
    }

    fn lock(&self) -> MutexGuard<'_, transcription::Transcription> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Calls a function of the program that asks Python for the values of expressions.
    fn detached<R: Send>(&self, py: Python<'_>, call: impl FnOnce(&mut transcription::Transcription) -> R + Send) -> R {
        py.detach(|| call(&mut self.lock()))
    }
}

#[pymethods]
impl Transcription {
    /// The function whose integral is least.
    fn set_cost(&self, py: Python<'_>, of: Smooth) {
        self.detached(py, |program| program.set_cost(Box::new(of)));
    }

    /// A function at the end that is added to the cost.
    fn set_final_cost(&self, py: Python<'_>, of: Smooth) {
        self.detached(py, |program| program.set_final_cost(Box::new(of)));
    }

    /// Adds bounds of a function at these nodes: one row for each.
    fn bound(&self, py: Python<'_>, of: Smooth, nodes: Vec<usize>, bounds: [f64; 2]) {
        self.detached(py, |program| program.bound(Box::new(of), &nodes, bounds));
    }

    /// Adds bounds of a velocity, given by the index of its coordinate.
    fn bound_velocity(&self, py: Python<'_>, index: usize, nodes: Vec<usize>, bounds: [f64; 2]) {
        self.detached(py, |program| program.bound_velocity(index, &nodes, bounds));
    }

    /// The bounds of the rows.
    fn row_bounds(&self, py: Python<'_>) -> Vec<[f64; 2]> {
        self.detached(py, |program| program.row_bounds())
    }

    /// The places of the Jacobian in compressed columns: starts of columns, and rows.
    fn jacobian_pattern(&self, py: Python<'_>) -> Places {
        self.detached(py, |program| places(program.jacobian_pattern()))
    }

    /// The places of the upper half of the Hessian matrix in compressed columns.
    fn hessian_pattern(&self, py: Python<'_>) -> Places {
        self.detached(py, |program| places(program.hessian_pattern()))
    }

    /// The functions of the program at x.
    fn evaluate<'py>(&self, py: Python<'py>, x: PyReadonlyArray1<'py, f64>) -> PyResult<Evaluated<'py>> {
        let x = x.as_slice()?;
        let found: PyResult<Evaluation> = self.detached(py, |program| {
            check_length(x, program.bounds().len())?;
            Ok(program.evaluate(x))
        });
        let Evaluation { cost, gradient, rows, jacobian, error } = found?;
        let error = error.map(|(k, error)| Ok::<_, PyErr>((k, instance(py, &error)?))).transpose()?;
        let [gradient, rows, jacobian] = [gradient, rows, jacobian].map(|of| PyArray1::from_vec(py, of));
        Ok((cost, gradient, rows, jacobian, error))
    }

    /// The entries of the Hessian matrix of `weight f + multipliers · g` at x.
    fn hessian<'py>(
        &self,
        py: Python<'py>,
        x: PyReadonlyArray1<'py, f64>,
        weight: f64,
        multipliers: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (x, multipliers) = (x.as_slice()?, multipliers.as_slice()?);
        let found: PyResult<Vec<f64>> = self.detached(py, |program| {
            check_length(x, program.bounds().len())?;
            check_length(multipliers, program.row_bounds().len())?;
            Ok(program.hessian(x, weight, multipliers))
        });
        Ok(PyArray1::from_vec(py, found?))
    }
}

fn places(of: &Pattern) -> Places {
    (of.starts.clone(), of.rows.clone())
}

fn check_length(numbers: &[f64], count: usize) -> PyResult<()> {
    if numbers.len() == count { Ok(()) } else { Err(wrong(format!("expected {count} numbers, not {}", numbers.len()))) }
}
