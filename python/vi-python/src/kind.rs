//! The pyclass of a system's type.

use crate::ensemble::{Ensemble, Output};
use crate::failure::{Raise as _, wrong};
use crate::report::{Report, Watch};
use crate::request::{Request, checked};
use crate::rows::{Linearized, linearized, matrix, rows, vector};
use crate::run::Run;
use crate::transcription::Transcription;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use vi_core::lagrangian::Space;
use vi_erased::System;
use vi_erased::control::Rest;
use vi_erased::plan::{Method, Named as _, PhasePoint, Plan};
use vi_erased::system::{OnConstraints, Quantity};
use vi_erased::transcription::Mesh;

/// A system's type.
#[pyclass(frozen, module = "variational._core")]
pub struct Kind {
    of: Box<dyn System>,
    n: usize,
    parameters: Vec<(&'static str, f64)>,
}

impl Kind {
    /// The type of a system; its parameters are the defaults.
    #[must_use]
    pub fn new(of: Box<dyn System>) -> Self {
        Self { n: of.coordinates().len(), parameters: of.parameters(), of }
    }

    /// The system with these parameters.
    fn with(&self, values: &[f64]) -> PyResult<Box<dyn System>> {
        let count = self.parameters.len();
        if values.len() != count {
            return Err(wrong(format!("{} has {count} parameters, not {}", self.of.name(), values.len())));
        }
        Ok(self.of.with_parameters(values))
    }
}

#[pymethods]
impl Kind {
    /// Whether L is linear in the velocities: coordinates alone are a state.
    #[getter]
    fn is_first_order(&self) -> bool {
        self.of.is_first_order()
    }

    #[getter]
    fn name(&self) -> &'static str {
        self.of.name()
    }

    #[getter]
    fn about(&self) -> &'static str {
        self.of.about()
    }

    #[getter]
    fn definition(&self) -> &'static str {
        self.of.definition()
    }

    #[getter]
    fn coordinates(&self) -> Vec<&'static str> {
        self.of.coordinates()
    }

    /// What each coordinate is: "coord", "angle", or "rotation".
    #[getter]
    fn spaces(&self) -> Vec<&'static str> {
        let word = |space| match space {
            Space::Line => "coord",
            Space::Circle => "angle",
            Space::Rotation(_) => "rotation",
        };
        self.of.spaces().into_iter().map(word).collect()
    }

    #[getter]
    fn constraints(&self) -> &'static [&'static str] {
        self.of.constraints()
    }

    /// Name, default and documentation of each parameter.
    #[getter]
    fn parameters(&self) -> Vec<(&'static str, f64, &'static str)> {
        let about = self.of.parameters_about();
        self.parameters.iter().zip(about).map(|((name, default), about)| (*name, *default, *about)).collect()
    }

    /// Method, stages, and whether in transformed time, of each integrator.
    #[getter]
    fn integrators(&self) -> Vec<(&'static str, Option<usize>, bool)> {
        self.of
            .integrators()
            .into_iter()
            .map(|(method, stages, transformed)| (method.name(), stages, transformed))
            .collect()
    }

    /// The integrator of a request, as `integrators` lists it.
    ///
    /// Raises ValueError for one that is not built.
    fn integrator(&self, request: Request) -> PyResult<(&'static str, Option<usize>, bool)> {
        let system = &*self.of;
        let plan = request.plan(system, 0.0, Vec::new(), Vec::new())?;
        let (method, stages, is_transformed) = plan.wanted(!system.constraints().is_empty());
        Ok((method.name(), stages, is_transformed))
    }

    /// A function at points: t (K,), q and v (K, N). Returns (K,) numbers, (K·N,) for a
    /// vector, (K·N·N,) for the mass matrix, (K·C,) for the reactions of C constraints, (K·2·C,) for their residuals.
    #[allow(clippy::too_many_arguments)] // Python's keywords
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        parameters: PyReadonlyArray1<'py, f64>,
        of: &str,
        t: PyReadonlyArray1<'py, f64>,
        q: PyReadonlyArray2<'py, f64>,
        v: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let system = self.with(parameters.as_slice()?)?;
        let count = t.len();
        let (t, q, v) = (vector(&t, count, "t")?, matrix(&q, [count, self.n], "q")?, matrix(&v, [count, self.n], "v")?);
        let mut out = Vec::new();
        let quantity = match of {
            "mass_matrix" => {
                py.detach(|| system.control().mass_matrix([&t, &q, &v], &mut out));
                return Ok(PyArray1::from_vec(py, out));
            }
            "bias" => {
                py.detach(|| system.control().bias([&t, &q, &v], &mut out));
                return Ok(PyArray1::from_vec(py, out));
            }
            "lagrangian" => Quantity::Lagrangian,
            "energy" => Quantity::Energy,
            "hamiltonian" => Quantity::Hamiltonian,
            "momentum" => Quantity::Momentum,
            "force" => Quantity::Force,
            "acceleration" => Quantity::Acceleration,
            "extended_acceleration" => Quantity::ExtendedAcceleration,
            "velocity" => Quantity::Velocity,
            "reaction" => Quantity::Reaction,
            "reaction_force" => Quantity::ReactionForce,
            "residuals" => Quantity::Residuals,
            _ => return Err(wrong(format!("there is no function {of:?}"))),
        };
        py.detach(|| system.evaluate(quantity, [&t, &q, &v], &mut out)).raise(py)?;
        Ok(PyArray1::from_vec(py, out))
    }

    /// Indices of the inputs among the parameters.
    #[getter]
    fn inputs(&self) -> Vec<usize> {
        self.of.control().inputs().to_vec()
    }

    /// The linearization of (q, v): its value, A and B.
    fn linearization<'py>(
        &self,
        py: Python<'py>,
        parameters: PyReadonlyArray1<'py, f64>,
        t: f64,
        q: PyReadonlyArray1<'py, f64>,
        v: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Linearized<'py>> {
        let system = self.with(parameters.as_slice()?)?;
        let (q, v) = (vector(&q, self.n, "q")?, vector(&v, self.n, "v")?);
        linearized(py, system.control().linearization(t, &q, &v).raise(py)?)
    }

    /// The equilibrium near a guess: q and the multipliers; the directions with the matrices M, C and K along them;
    /// whether coordinates are free, the residual, and the real and imaginary parts of the rates.
    #[allow(clippy::type_complexity)] // fields of a Python class
    fn equilibrium<'py>(
        &self,
        py: Python<'py>,
        parameters: PyReadonlyArray1<'py, f64>,
        t: f64,
        guess: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<([Bound<'py, PyArray1<f64>>; 2], Vec<Bound<'py, PyArray2<f64>>>, Vec<bool>, f64, Vec<[f64; 2]>)> {
        let system = self.with(parameters.as_slice()?)?;
        let Rest {
            q,
            multipliers,
            freedom,
            directions,
            matrices: [mass, damping, stiffness],
            free,
            residual,
            rates,
            ..
        } = system.control().equilibrium(t, &vector(&guess, self.n, "guess")?).raise(py)?;
        let matrices = [directions, mass, damping, stiffness].into_iter().map(|of| rows(py, of, freedom));
        let vectors = [q, multipliers].map(|of| PyArray1::from_vec(py, of));
        Ok((vectors, matrices.collect::<PyResult<_>>()?, free, residual, rates))
    }

    /// The nearest coordinates and velocities on the constraints, or those that a continuation from a far guess finds,
    /// and their changes.
    #[pyo3(signature = (parameters, t, q, v, is_far=false))]
    #[allow(clippy::type_complexity)] // fields of a Python class
    fn project<'py>(
        &self,
        py: Python<'py>,
        parameters: PyReadonlyArray1<'py, f64>,
        t: f64,
        q: PyReadonlyArray1<'py, f64>,
        v: PyReadonlyArray1<'py, f64>,
        is_far: bool,
    ) -> PyResult<[Bound<'py, PyArray1<f64>>; 4]> {
        let system = self.with(parameters.as_slice()?)?;
        let at = PhasePoint { t, q: vector(&q, self.n, "q")?, v: vector(&v, self.n, "v")? };
        let found = if is_far { system.assemble(&at) } else { system.project(&at) };
        let OnConstraints { point, moved_q, moved_v } = found.raise(py)?;
        Ok([point.q, point.v, moved_q, moved_v].map(|of| PyArray1::from_vec(py, of)))
    }

    /// Names of the constraints that follow from the others at coordinates.
    fn redundant<'py>(
        &self,
        py: Python<'py>,
        parameters: PyReadonlyArray1<'py, f64>,
        t: f64,
        q: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Vec<&'static str>> {
        let q = vector(&q, self.n, "q")?;
        self.with(parameters.as_slice()?)?.redundant(t, &q).raise(py)
    }

    /// Starts a run from velocities, or from momenta.
    #[pyo3(signature = (parameters, request, t, q, v=None, p=None))]
    #[allow(clippy::too_many_arguments)] // Python's keywords
    fn begin<'py>(
        &self,
        py: Python<'py>,
        parameters: PyReadonlyArray1<'py, f64>,
        request: Request,
        t: f64,
        q: PyReadonlyArray1<'py, f64>,
        v: Option<PyReadonlyArray1<'py, f64>>,
        p: Option<PyReadonlyArray1<'py, f64>>,
    ) -> PyResult<Run> {
        let system = self.with(parameters.as_slice()?)?;
        let q = vector(&q, self.n, "q")?;
        let v = v.map_or_else(|| Ok(vec![0.0; self.n]), |v| vector(&v, self.n, "v"))?;
        let p = p.map(|p| vector(&p, self.n, "p")).transpose()?;
        let plan = Plan { p, ..checked(py, &*system, request.plan(&*system, t, q, v)?)? };
        // A tolerance takes thousands of steps, a measured shift up to billions.
        let mut watch = Watch::new(Report::default(), f64::INFINITY);
        let run = py.detach(|| system.begin_while(&plan, &mut || watch.goes_on()));
        watch.check()?;
        Ok(Run::new(run.raise(py)?, plan.wanted(!system.constraints().is_empty())))
    }

    /// The program of an optimal control problem, from the time of the first node, the nodes as shares of the duration, its
    /// least and greatest value, and the indices of the inputs to find.
    #[allow(clippy::too_many_arguments)] // Python's keywords
    fn transcription(
        &self,
        py: Python<'_>,
        parameters: PyReadonlyArray1<'_, f64>,
        request: Request,
        start: f64,
        shares: Vec<f64>,
        duration: [f64; 2],
        inputs: Vec<usize>,
    ) -> PyResult<Transcription> {
        let system = self.with(parameters.as_slice()?)?;
        let plan = request.plan(&*system, 0.0, Vec::new(), Vec::new())?;
        let mesh = Mesh { start, shares, duration };
        vi_erased::transcription::Transcription::of(&*system, &plan, mesh, &inputs).raise(py).map(Transcription::new)
    }

    /// Restarts a stored run.
    fn restart(
        &self,
        parameters: PyReadonlyArray1<'_, f64>,
        integrator: (String, Option<usize>, bool),
        stored: &str,
    ) -> PyResult<Run> {
        let (method, stages, is_transformed) = integrator;
        let method = Method::named(&method).ok_or_else(|| wrong(format!("there is no method {method:?}")))?;
        let built = (method, stages, is_transformed);
        let run = self.with(parameters.as_slice()?)?.restart(built, stored).map_err(wrong)?;
        Ok(Run::new(run, built))
    }

    /// Runs from many states over threads: the state at the time `until`, or the states at times, of each. Returns the
    /// rows of all runs, for each run `None` or the exception that ended it, and the one that interrupted all.
    #[pyo3(signature = (parameters, request, t, q, v, until=None, times=None, threads=None, report=None))]
    #[allow(clippy::too_many_arguments, clippy::type_complexity)] // Python's keywords
    fn ensemble<'py>(
        &self,
        py: Python<'py>,
        parameters: PyReadonlyArray2<'py, f64>,
        request: Request,
        t: f64,
        q: PyReadonlyArray2<'py, f64>,
        v: PyReadonlyArray2<'py, f64>,
        until: Option<f64>,
        times: Option<Vec<f64>>,
        threads: Option<usize>,
        report: Option<Py<PyAny>>,
    ) -> PyResult<(Bound<'py, PyAny>, Vec<Option<Bound<'py, PyAny>>>, Option<Bound<'py, PyAny>>)> {
        let many = q.shape()[0];
        let output = match (until, times) {
            (None, Some(times)) => Output::Times(times),
            (Some(end), None) => Output::End(end),
            _ => return Err(wrong("give one of until and times")),
        };
        // Finds wrong options once, before the threads start.
        let zeros = || vec![0.0; self.n];
        checked(py, &*self.of, request.plan(&*self.of, t, zeros(), zeros())?)?;
        let parameters = matrix(&parameters, [many, self.parameters.len()], "parameters")?;
        let (q, v) = (matrix(&q, [many, self.n], "q")?, matrix(&v, [many, self.n], "v")?);
        let count = self.parameters.len();
        let plan = |index: usize| {
            let of = |values: &[f64]| values[index * self.n..(index + 1) * self.n].to_vec();
            let system = self.with(&parameters[index * count..(index + 1) * count])?;
            let plan = request.plan(&*system, t, of(&q), of(&v))?;
            Ok((system, plan))
        };
        Ensemble { n: self.n, many, output, plan: &plan }.run(py, threads, &Report::new(report))
    }
}
