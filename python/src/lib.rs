//! The module `variational._core`: the ready systems, those of a text, the mathematics of any text, and the sources for
//! `variational.compile`.

#![forbid(unsafe_code)]

use proc_macro2::{LexError, TokenStream};
use pyo3::exceptions::{PyNotImplementedError, PyValueError};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedStr;
use std::sync::{Mutex, MutexGuard, PoisonError};
use vi_codegen::inspect::{self, Line, report};
use vi_python::{Kind, pyo3};
use vi_tape::expressions::{self, Moment};

/// The sources of the crates that a compiled system needs, and a number that changes with them.
mod embedded {
    include!(concat!(env!("OUT_DIR"), "/sources.rs"));
}

/// Title, text, and sections of the mathematics of a system. Each line of a section is (left, right) in LaTeX, or
/// ("", words).
type Explained = (String, String, Vec<(&'static str, Vec<(String, String)>)>);

/// The mathematics of a definition, with the equations of a Gauss step if its stages are given. A definition that is to
/// be compiled alone may contain the language only: no Rust functions, and no attributes with code.
///
/// Raises ValueError for a mistake, with its line.
#[pyfunction]
#[pyo3(crate = "vi_python::pyo3", signature = (definition, stages=None, alone=false))]
fn explain(definition: &str, stages: Option<usize>, alone: bool) -> PyResult<Explained> {
    const FILE: &str = "definition";
    // Not by `syn::parse_str`, which recurses before the compiler bounds the nesting.
    let tokens: TokenStream = definition
        .parse()
        .map_err(|error: LexError| PyValueError::new_err(report::unreadable(FILE, definition, &error.into())))?;
    let allowed = if alone { vi_codegen::syntax::alone::check(&tokens) } else { Ok(()) };
    let explained = allowed.and_then(|()| match stages {
        None => inspect::explain(tokens),
        Some(stages) => inspect::explain_gauss(tokens, stages),
    });
    let explained = explained.map_err(|error| PyValueError::new_err(report::report(FILE, definition, &error)))?;
    let text = explained.text();
    let line = |line| match line {
        Line::Equation { left_latex, right_latex, .. } => (left_latex, right_latex),
        Line::Words { text, .. } => (String::new(), text),
    };
    let sections = explained.sections.into_iter().map(|section| {
        let lines = section.lines.into_iter().map(line).collect();
        (section.title, lines)
    });
    Ok((explained.title, text, sections.collect()))
}

/// Whether the motion of a definition splits into kicks and drifts, and whether its rule has a step density.
///
/// Raises ValueError for a mistake, without its line.
#[pyfunction]
#[pyo3(crate = "vi_python::pyo3")]
fn properties(definition: &str) -> PyResult<(bool, bool)> {
    let tokens: TokenStream = definition.parse().map_err(|error: LexError| PyValueError::new_err(error.to_string()))?;
    let found = inspect::properties(tokens).map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok((found.is_separable, found.has_step_density))
}

/// The type of the system that a text declares, with every method.
///
/// `files` are paths and texts of the files of its tables, `dropped` names of constraints that follow from the others.
/// Raises ValueError for a mistake, with its line; NotImplementedError for a system that has to be compiled.
#[pyfunction]
#[pyo3(crate = "vi_python::pyo3")]
fn of_text(
    py: Python<'_>,
    definition: &str,
    files: Vec<(String, String)>,
    dropped: Vec<PyBackedStr>,
) -> PyResult<Kind> {
    let system = py.detach(|| vi_tape::System::of_file("definition", definition, &files));
    let raised = |mistakes: vi_tape::Mistakes| {
        let words = mistakes.to_string();
        if mistakes.needs_compiler() { PyNotImplementedError::new_err(words) } else { PyValueError::new_err(words) }
    };
    let system = system.map_err(raised)?.into_inner();
    if dropped.is_empty() {
        return Ok(Kind::new(system));
    }
    let names: Vec<&str> = dropped.iter().map(|name| &**name).collect();
    let unknown = || PyValueError::new_err(format!("{} has not all constraints of {names:?}", system.name()));
    system.without(&names).map(Kind::new).ok_or_else(unknown)
}

/// An expression in the names of the system of a definition.
#[pyclass(frozen, module = "variational._core", crate = "vi_python::pyo3")]
struct Observable(Mutex<expressions::Observable>);

/// Times, coordinates and velocities.
type Points = (Vec<f64>, Vec<Vec<f64>>, Vec<Vec<f64>>);

#[pymethods]
#[pyo3(crate = "vi_python::pyo3")]
impl Observable {
    /// `files` are paths and texts of the files of its tables. With `wrt`, indices of parameters, it is the derivatives of
    /// the expression: the last axis has t, the coordinates, the velocities and these parameters. Twice, it is the second
    /// derivatives, with two such axes.
    ///
    /// Raises ValueError for a mistake, with its line.
    #[new]
    #[pyo3(signature = (definition, files, expression, wrt=None, twice=false))]
    fn new(
        py: Python<'_>,
        definition: &str,
        files: Vec<(String, String)>,
        expression: &str,
        wrt: Option<Vec<usize>>,
        twice: bool,
    ) -> PyResult<Self> {
        let parsed = py.detach(|| {
            let of = expressions::Observable::parse(definition, &files, expression)?;
            Ok(Mutex::new(match wrt {
                None => of,
                Some(wrt) if twice => of.derivatives(&wrt).derivatives(&wrt),
                Some(wrt) => of.derivatives(&wrt),
            }))
        });
        parsed.map(Self).map_err(|mistakes: vi_tape::Mistakes| PyValueError::new_err(mistakes.to_string()))
    }

    /// The lengths of a vector or a matrix; none of a number.
    #[getter]
    fn shape(&self) -> Vec<usize> {
        self.lock().shape().to_vec()
    }

    /// Whether each entry is zero at every point.
    #[getter]
    fn zeros(&self) -> Vec<bool> {
        self.lock().zeros()
    }

    /// The entries at points, one point after the other, with the numbers of the system at each of them or at all.
    fn values(&self, py: Python<'_>, points: Points, parameters: Vec<Vec<f64>>) -> Vec<f64> {
        let (t, q, v) = points;
        py.detach(|| {
            let of = self.lock();
            let mut values = Vec::new();
            for (row, (t, (q, v))) in t.iter().zip(q.iter().zip(&v)).enumerate() {
                let parameters = parameters.get(row).or(parameters.first()).map_or(&[][..], |of| of);
                values.extend(of.values(&Moment { t: *t, q, v, parameters, ..Moment::default() }));
            }
            values
        })
    }
}

impl Observable {
    fn lock(&self) -> MutexGuard<'_, expressions::Observable> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Path and text of each source file that a compiled system needs.
#[pyfunction]
#[pyo3(crate = "vi_python::pyo3")]
fn sources() -> &'static [(&'static str, &'static str)] {
    embedded::FILES
}

#[pymodule(gil_used = false)]
#[pyo3(crate = "vi_python::pyo3")]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(pyo3::wrap_pyfunction!(explain, module)?)?;
    module.add_function(pyo3::wrap_pyfunction!(properties, module)?)?;
    module.add_function(pyo3::wrap_pyfunction!(of_text, module)?)?;
    module.add_class::<Observable>()?;
    module.add_function(pyo3::wrap_pyfunction!(sources, module)?)?;
    module.add("sources_digest", embedded::DIGEST)?;
    module.add("texts", vi_python_ready::texts())?;
    vi_python::populate(module, vi_python_ready::systems())
}
