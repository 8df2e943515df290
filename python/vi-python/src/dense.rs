//! Dense output of many steps.

use crate::rows::vector;
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;
use vi_erased::simulation::StepOutput;

/// The motion over the steps of a run, as polynomials.
#[pyclass(frozen, module = "variational._core")]
pub struct Dense {
    n: usize,
    /// Time at which each step begins, in the order of the run.
    starts: Vec<f64>,
    steps: Vec<Box<dyn StepOutput>>,
}

impl Dense {
    pub(crate) fn new(n: usize) -> Self {
        Self { n, starts: Vec::new(), steps: Vec::new() }
    }

    /// Adds a step.
    pub(crate) fn push(&mut self, start: f64, step: Box<dyn StepOutput>) {
        self.starts.push(start);
        self.steps.push(step);
    }

    /// The step that covers a time; the first or the last one for times outside.
    fn step(&self, t: f64) -> Option<&dyn StepOutput> {
        let is_backward = self.starts.first() > self.starts.last();
        let begun = self.starts.partition_point(|start| if is_backward { *start >= t } else { *start <= t });
        self.steps.get(begun.saturating_sub(1)).map(|step| &**step)
    }
}

#[pymethods]
impl Dense {
    /// Coordinates, momenta and velocities at times, each (K, N).
    fn __call__<'py>(&self, py: Python<'py>, times: PyReadonlyArray1<'py, f64>) -> PyResult<Bound<'py, PyAny>> {
        let count = times.len();
        let times = vector(&times, count, "t")?;
        let mut columns: [Vec<f64>; 3] = Default::default();
        py.detach(|| {
            for t in times {
                let at = self.step(t).map_or_else(|| [(); 3].map(|()| vec![f64::NAN; self.n]), |step| step.at(t));
                for (column, values) in columns.iter_mut().zip(at) {
                    column.extend(values);
                }
            }
        });
        let [q, p, v] = columns.map(|column| PyArray1::from_vec(py, column).reshape([count, self.n]));
        Ok((q?, p?, v?).into_pyobject(py)?.into_any())
    }

    fn __len__(&self) -> usize {
        self.steps.len()
    }
}
