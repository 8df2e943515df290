//! The pyclass of a run.

use crate::dense::Dense;
use crate::events::{Description, Raised, sections};
use crate::failure::{Raise as _, busy, instance, value, wrong};
use crate::report::{Report, Watch, part};
use crate::rows::{Linearized, check_memory, linearized, record_some, reserved, steps_to, to_python, vector};
use numpy::{PyArray1, PyArray2, PyArray3, PyReadonlyArray1, PyUntypedArrayMethods};
use pyo3::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, TryLockError};
use std::time::{Duration, Instant};
use vi_core::StepError;
use vi_erased::plan::Named as _;
use vi_erased::section::Section;
use vi_erased::simulation::{End, Met, Wanted};
use vi_erased::{Built, Rows, Simulation};

/// A run. A lock, not the borrow checker of pyo3, guards it: its message is for Python's users.
#[pyclass(frozen, module = "variational._core")]
pub struct Run {
    of: Mutex<Box<dyn Simulation>>,
    n: usize,
    integrator: Built,
    /// Bits of the length of a step before steps of other lengths, which the run reports in its place; 0 if there are
    /// none.
    usual: AtomicU64,
}

/// Rows, the exception that ended the run if any, and more.
type Recorded<'py, T> = PyResult<(Bound<'py, PyAny>, Option<Bound<'py, PyAny>>, T)>;

impl Run {
    pub(crate) fn new(of: Box<dyn Simulation>, integrator: Built) -> Self {
        Self { n: of.q().len(), of: Mutex::new(of), integrator, usual: AtomicU64::new(0) }
    }

    /// The run, if no other thread uses it.
    fn lock(&self) -> PyResult<MutexGuard<'_, Box<dyn Simulation>>> {
        match self.of.try_lock() {
            Ok(run) => Ok(run),
            Err(TryLockError::Poisoned(run)) => Ok(run.into_inner()),
            Err(TryLockError::WouldBlock) => Err(busy()),
        }
    }

    /// The length of the next steps, to estimate their number.
    fn length(&self, run: &dyn Simulation) -> f64 {
        match self.usual.load(Ordering::Relaxed) {
            0 => run.h(),
            bits => f64::from_bits(bits),
        }
    }

    /// The section of an event of a derivative.
    fn section(&self, event: Option<Description>) -> PyResult<Option<Section>> {
        let none = (Report::default(), [0.0; 2]);
        let (sections, _) = sections(event.into_iter().collect(), self.n, &Raised::default(), none)?;
        // The last one looks for signals.
        Ok(sections.into_iter().rev().nth(1))
    }

    /// The expected number of steps, or of those up to a time.
    #[allow(clippy::cast_precision_loss)] // of a progress bar
    fn expected(&self, run: &dyn Simulation, steps: u64, t: Option<f64>) -> f64 {
        t.map_or(steps, |end| steps_to(run, self.length(run), end)) as f64
    }

    /// Checks the indices of parameters.
    fn check_parameters(run: &dyn Simulation, mut indices: impl Iterator<Item = usize>) -> PyResult<()> {
        let count = run.parameters().len();
        match indices.find(|index| *index >= count) {
            Some(index) => Err(wrong(format!("there is no parameter {index}: the system has {count}"))),
            None => Ok(()),
        }
    }
}

#[pymethods]
impl Run {
    #[getter]
    fn t(&self) -> PyResult<f64> {
        Ok(self.lock()?.t())
    }

    #[getter]
    fn h(&self) -> PyResult<f64> {
        Ok(self.lock()?.h())
    }

    #[getter]
    fn q<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_slice(py, &self.lock()?.q()))
    }

    #[getter]
    fn p<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_slice(py, self.lock()?.p()))
    }

    #[getter]
    fn v<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_vec(py, self.lock()?.velocity().raise(py)?))
    }

    #[getter]
    fn energy(&self, py: Python<'_>) -> PyResult<f64> {
        self.lock()?.energy().raise(py)
    }

    #[getter]
    fn discrete_energy(&self) -> PyResult<Option<f64>> {
        Ok(self.lock()?.discrete_energy())
    }

    /// The energy that steps with a shift preserve, and the shift.
    #[getter]
    fn shifted_energy(&self) -> PyResult<Option<(f64, f64)>> {
        Ok(self.lock()?.shifted_energy().map(|of| (of.energy, of.shift)))
    }

    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_vec(py, self.lock()?.parameters()))
    }

    /// Method, stages, and whether in transformed time.
    #[getter]
    fn integrator(&self) -> (&'static str, Option<usize>, bool) {
        let (method, stages, is_transformed) = self.integrator;
        (method.name(), stages, is_transformed)
    }

    fn copy(&self) -> PyResult<Self> {
        let usual = AtomicU64::new(self.usual.load(Ordering::Relaxed));
        Ok(Self { of: Mutex::new(self.lock()?.copy()), n: self.n, integrator: self.integrator, usual })
    }

    fn set_parameters(&self, py: Python<'_>, change: Vec<(usize, f64)>) -> PyResult<()> {
        let mut run = self.lock()?;
        Self::check_parameters(&**run, change.iter().map(|(index, _)| *index))?;
        run.set_parameters(&change).raise(py)
    }

    fn set_state(
        &self,
        py: Python<'_>,
        t: f64,
        q: PyReadonlyArray1<'_, f64>,
        p: PyReadonlyArray1<'_, f64>,
        change: Vec<(usize, f64)>,
    ) -> PyResult<()> {
        let (q, p) = (vector(&q, self.n, "q")?, vector(&p, self.n, "p")?);
        let mut run = self.lock()?;
        Self::check_parameters(&**run, change.iter().map(|(index, _)| *index))?;
        run.set_state(&change, (t, &q, &p)).raise(py)
    }

    /// Takes one step.
    #[pyo3(signature = (h=None))]
    fn step(&self, py: Python<'_>, h: Option<f64>) -> PyResult<()> {
        let mut run = self.lock()?;
        let usual = self.length(&**run).to_bits();
        let outcome = match h {
            None => run.advance(),
            Some(h) => run.advance_of(h),
        };
        self.usual.store(if h.is_some() { usual } else { 0 }, Ordering::Relaxed);
        outcome.raise(py)
    }

    /// Takes steps to a time, or a number of steps. Returns the start, every `every`th node and the end, the exception that
    /// ended the run if any, and dense output if requested.
    /// `report` is called with the part that is done.
    #[pyo3(signature = (until=None, steps=None, every=1, dense=false, report=None))]
    #[allow(clippy::too_many_arguments)] // Python's keywords
    fn advance<'py>(
        &self,
        py: Python<'py>,
        until: Option<f64>,
        steps: Option<u64>,
        every: u64,
        dense: bool,
        report: Option<Py<PyAny>>,
    ) -> Recorded<'py, Option<Dense>> {
        let mut guard = self.lock()?;
        let run: &mut dyn Simulation = &mut **guard;
        let most = steps.unwrap_or(u64::MAX);
        if every == 0 {
            return Err(wrong("every must be at least 1"));
        }
        let expected = steps.unwrap_or_else(|| until.map_or(0, |end| steps_to(run, self.length(run), end)));
        check_memory(expected / every, 1 + 2 * self.n)?;
        if dense {
            // Collocation polynomials hold up to 17 values of each coordinate and momentum.
            check_memory(expected, 40 * self.n)?;
        }
        let mut rows = reserved(expected / every, self.n);
        rows.push(run.t(), &run.q(), run.p());
        let mut dense = dense.then(|| Dense::new(self.n));
        self.usual.store(0, Ordering::Relaxed);
        let (mut taken, mut stretch) = (0, Stretch::new());
        let (report, begin) = (Report::new(report), run.t());
        let error = loop {
            // The time of a node is rounded, so that the run itself may find that it lies behind.
            if until == Some(run.t()) {
                break None;
            }
            let few = stretch.steps().min(most - taken);
            let outcome = py.detach(|| match &mut dense {
                None => run.record(until, few, every, &mut taken, &mut rows),
                Some(dense) => record_dense(run, until, few, every, &mut taken, &mut rows, dense),
            });
            match outcome {
                Ok(true) => break None,
                Ok(false) if taken >= most => break None,
                Ok(false) => {
                    #[allow(clippy::cast_precision_loss)] // of a progress bar
                    let done = until.map_or(taken as f64 / most as f64, |end| part([begin, end], run.t()));
                    if let Err(raised) = report.look(py, done) {
                        break Some(value(py, raised));
                    }
                }
                Err(error) => break Some(instance(py, &error)?),
            }
        };
        if rows.t.last().map(|t| t.to_bits()) != Some(run.t().to_bits()) {
            rows.push(run.t(), &run.q(), run.p());
        }
        Ok((to_python(py, rows, self.n)?, error, dense))
    }

    /// States at times, which are in the order of the run.
    #[pyo3(signature = (times, report=None))]
    fn at<'py>(
        &self,
        py: Python<'py>,
        times: PyReadonlyArray1<'py, f64>,
        report: Option<Py<PyAny>>,
    ) -> Recorded<'py, ()> {
        let times = vector(&times, times.len(), "times")?;
        let mut guard = self.lock()?;
        let run = &mut *guard;
        let h = self.length(&**run);
        let mut rows = Rows::default();
        let mut left = &times[..];
        let way = [run.t(), times.last().copied().unwrap_or(f64::NAN)];
        let report = Report::new(report);
        let error = loop {
            if left.is_empty() {
                break None;
            }
            let outcome = py.detach(|| record_some(run, h, &mut left, &mut rows));
            if let Err(error) = outcome {
                break Some(instance(py, &error)?);
            }
            if let Err(raised) = report.look(py, part(way, run.t())) {
                break Some(value(py, raised));
            }
        };
        Ok((to_python(py, rows, self.n)?, error, ()))
    }

    /// Events up to a time, or only the first. Returns a row for each, the exception that ended the run if any, and for
    /// each row the index of the event and whether its function rises.
    #[pyo3(signature = (events, until, is_first, report=None))]
    fn events<'py>(
        &self,
        py: Python<'py>,
        events: Vec<Description>,
        until: f64,
        is_first: bool,
        report: Option<Py<PyAny>>,
    ) -> Recorded<'py, Vec<(usize, bool)>> {
        let raised = Raised::default();
        let mut guard = self.lock()?;
        let run: &mut dyn Simulation = &mut **guard;
        let (sections, has_functions) = sections(events, self.n, &raised, (Report::new(report), [run.t(), until]))?;
        let (mut rows, mut met) = (Rows::default(), Vec::new());
        let mut take = |of: Met| {
            for event in of.events {
                rows.push(of.row.t, &of.row.q, &of.row.p);
                met.push(event);
            }
            true
        };
        let mut search = || {
            if is_first {
                run.next_crossing(&sections, until).map(|found| {
                    found.map(&mut take);
                })
            } else {
                run.cross(&sections, until, &mut take)
            }
        };
        // Python functions attach to the interpreter in every call, which is cheap while it is attached.
        let outcome = if has_functions { search() } else { py.detach(search) };
        let error = match (raised.take(), outcome) {
            (Some(raised), _) => Some(value(py, raised)),
            (None, Err(error)) => Some(instance(py, &error)?),
            (None, Ok(())) => None,
        };
        Ok((to_python(py, rows, self.n)?, error, met))
    }

    /// Takes steps: a number of them, or up to a time, or up to an event, which is at this time. Returns the derivatives of
    /// (q, p, t) at their end: a row for each coordinate, momentum, and parameter of these indices at the start; the
    /// number of parameters is the index of the step length. `velocities` are in place of momenta at the start, at the
    /// end.
    #[pyo3(signature = (parameters, steps=0, t=None, event=None, velocities=[false, false], report=None))]
    #[allow(clippy::too_many_arguments)] // Python's keywords
    fn tangent<'py>(
        &self,
        py: Python<'py>,
        parameters: Vec<usize>,
        steps: u64,
        t: Option<f64>,
        event: Option<Description>,
        velocities: [bool; 2],
        report: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let section = self.section(event)?;
        let mut guard = self.lock()?;
        let run: &mut dyn Simulation = &mut **guard;
        let count = run.parameters().len();
        Self::check_parameters(run, parameters.iter().copied().filter(|index| *index != count))?;
        let wanted =
            Wanted { end: end(steps, t, section.as_ref()), parameters: &parameters, has_velocities: velocities };
        let mut watch = Watch::new(Report::new(report), self.expected(run, steps, t));
        let rows = py.detach(|| run.tangent(wanted, &mut || watch.goes_on())).raise(py)?;
        let rows = watch.unless_raised(rows)?;
        Ok(PyArray2::from_vec2(py, &rows)?)
    }

    /// Derivatives of (q, v) or (q, p) with respect to (q, v) of the start at times, which are in the order of the run:
    /// for each time rows as of `tangent`.
    #[pyo3(signature = (parameters, times, has_velocities, report=None))]
    fn tangents_at<'py>(
        &self,
        py: Python<'py>,
        parameters: Vec<usize>,
        times: PyReadonlyArray1<'py, f64>,
        has_velocities: bool,
        report: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let times = vector(&times, times.len(), "times")?;
        let mut guard = self.lock()?;
        let run: &mut dyn Simulation = &mut **guard;
        let count = run.parameters().len();
        Self::check_parameters(run, parameters.iter().copied().filter(|index| *index != count))?;
        let mut watch = Watch::new(Report::new(report), self.expected(run, 0, times.last().copied()));
        let wanted = (&times[..], &parameters[..]);
        let found = py.detach(|| run.tangents_at(wanted, [true, has_velocities], &mut || watch.goes_on())).raise(py)?;
        Ok(PyArray3::from_vec3(py, &watch.unless_raised(found)?)?)
    }

    /// Takes steps. Returns the largest Lyapunov exponents of them.
    #[pyo3(signature = (steps, count, report=None))]
    fn lyapunov<'py>(
        &self,
        py: Python<'py>,
        steps: u64,
        count: usize,
        report: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mut guard = self.lock()?;
        let run: &mut dyn Simulation = &mut **guard;
        #[allow(clippy::cast_precision_loss)] // of a progress bar
        let mut watch = Watch::new(Report::new(report), steps as f64);
        let found = py.detach(|| run.lyapunov(steps, [count, self.n], &mut || watch.goes_on())).raise(py)?;
        Ok(PyArray1::from_vec(py, watch.unless_raised(found)?))
    }

    /// The linearization of the next step: (q, p) at its end, A and B.
    fn linearization<'py>(&self, py: Python<'py>) -> PyResult<Linearized<'py>> {
        linearized(py, self.lock()?.linearization().raise(py)?)
    }

    /// Takes steps to an end, as `tangent`. Returns the gradient of slope·(q, p, t) there with respect to the start and
    /// the parameters of these indices.
    #[pyo3(signature = (parameters, slope, steps=0, t=None, event=None, velocities=[false, false], report=None))]
    #[allow(clippy::too_many_arguments)] // Python's keywords
    fn gradient<'py>(
        &self,
        py: Python<'py>,
        parameters: Vec<usize>,
        slope: PyReadonlyArray1<'py, f64>,
        steps: u64,
        t: Option<f64>,
        event: Option<Description>,
        velocities: [bool; 2],
        report: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (slope, section) = (vector(&slope, 2 * self.n + 1, "the slope")?, self.section(event)?);
        let mut guard = self.lock()?;
        let run: &mut dyn Simulation = &mut **guard;
        Self::check_parameters(run, parameters.iter().copied())?;
        let wanted =
            Wanted { end: end(steps, t, section.as_ref()), parameters: &parameters, has_velocities: velocities };
        // Each step is taken once on the way ahead, and once on the way back.
        let mut watch = Watch::new(Report::new(report), 2.0 * self.expected(run, steps, t));
        let found = py.detach(|| run.gradient(wanted, &slope, &mut || watch.goes_on())).raise(py)?;
        Ok(PyArray1::from_vec(py, watch.unless_raised(found)?))
    }

    /// The error of the next step: of q, and of h·v.
    fn local_error<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyArray1<f64>>; 2]> {
        let error = self.lock()?.local_error().raise(py)?;
        Ok(error.map(|of| PyArray1::from_vec(py, of)))
    }

    /// Measures errors of the steps from here on.
    fn monitor(&self) -> PyResult<()> {
        self.lock()?.monitor();
        Ok(())
    }

    /// The largest relative error of a step since `monitor`, the time at which that step began, and the index of the
    /// coordinate; `None` without a monitor.
    #[getter]
    fn largest_error(&self) -> PyResult<Option<(f64, f64, usize, f64)>> {
        Ok(self.lock()?.largest_error().map(|of| (of.estimate, of.t, of.coordinate, of.sum)))
    }

    /// Everything that the run carries, as text.
    fn checkpoint(&self) -> PyResult<String> {
        self.lock()?.checkpoint().map_err(wrong)
    }
}

/// The end of differentiated steps: a number of them, a time, or a section at this time.
fn end(steps: u64, t: Option<f64>, section: Option<&Section>) -> End<'_> {
    match (t, section) {
        (None, _) => End::Steps(steps),
        (Some(t), None) => End::Time(t),
        (Some(t), Some(section)) => End::Crossing(section, t),
    }
}

/// [`Simulation::record`] with dense output of each step.
#[allow(clippy::too_many_arguments)] // those of `record`
fn record_dense(
    run: &mut dyn Simulation,
    until: Option<f64>,
    most: u64,
    every: u64,
    taken: &mut u64,
    rows: &mut Rows,
    dense: &mut Dense,
) -> Result<bool, StepError> {
    for _ in 0..most {
        let (t, q, p) = (run.t(), run.q().to_vec(), run.p().to_vec());
        let before = *taken;
        let is_over = run.record(until, 1, every, taken, rows)?;
        if *taken > before {
            dense.push(t, run.step_output(t, &q, &p)?);
        }
        if is_over {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Steps between two looks at signals: about a twentieth of a second.
struct Stretch {
    steps: u64,
    begun: Instant,
}

impl Stretch {
    fn new() -> Self {
        Self { steps: 512, begun: Instant::now() }
    }

    /// The steps of the next stretch.
    fn steps(&mut self) -> u64 {
        let took = self.begun.elapsed();
        if took < Duration::from_millis(25) {
            self.steps = (2 * self.steps).min(1 << 22);
        } else if took > Duration::from_millis(100) {
            self.steps = (self.steps / 2).max(1);
        }
        self.begun = Instant::now();
        self.steps
    }
}
