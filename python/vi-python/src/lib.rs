//! Python classes of type-erased systems and runs.
//!
//! In: the systems of [`vi_erased::kind!`]. Out: a Python module with the pyclasses [`Kind`] and [`Run`], which the
//! package `variational` wraps in a Python class for each system. Nothing here is generic: a system costs what its
//! integrators cost.
//!
//! | module | product |
//! |---|---|
//! | `kind` | the pyclass of a system's type |
//! | `run` | the pyclass of a run |
//! | `ensemble` | many runs on all cores |
//! | `transcription` | the pyclass of a nonlinear program of optimal control |
//! | `events` | Python functions as events |
//! | `dense` | the pyclass of dense output |
//! | `report` | Ctrl-C and progress of long calls |
//! | `request` | a plan from Python's arguments |
//! | `rows` | numpy arrays, and the memory that they need |
//! | `failure`, `fields` | errors as Python exceptions with their fields |

#![forbid(unsafe_code)]
// pyo3 passes arrays by value.
#![allow(clippy::needless_pass_by_value)]
// A method is not general enough over the lifetime of the interpreter.
#![allow(clippy::redundant_closure_for_method_calls)]

mod dense;
mod ensemble;
mod events;
mod failure;
mod fields;
mod kind;
mod report;
mod request;
mod rows;
mod run;
mod transcription;

pub use dense::Dense;
pub use kind::Kind;
pub use pyo3;
pub use run::Run;
pub use vi_erased;

use pyo3::prelude::*;
use vi_erased::System;
use vi_erased::plan::{Method, Named as _};

/// The version of the interface between these classes and the Python files of the package `variational`.
pub const CONTRACT: u32 = 7;

/// Adds systems to a Python module.
///
/// # Errors
/// An exception of Python.
pub fn populate(module: &Bound<'_, PyModule>, systems: Vec<Box<dyn System>>) -> PyResult<()> {
    let py = module.py();
    let kinds: Vec<Py<Kind>> = systems.into_iter().map(|of| Py::new(py, Kind::new(of))).collect::<PyResult<_>>()?;
    module.add_class::<Kind>()?;
    module.add_class::<Run>()?;
    module.add_class::<Dense>()?;
    module.add_class::<transcription::Transcription>()?;
    module.add("_contract", CONTRACT)?;
    module.add("METHODS", Method::ALL.map(Method::name))?;
    module.add("_kinds", kinds)
}

/// Gives a module the classes of its systems, by the package `variational`.
///
/// # Errors
/// `ImportError` if that package is not installed, or of another version.
pub fn bind(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.py().import("variational")?.call_method1("_bind", (module,)).map(drop)
}

/// A Python module of systems with these integrators: `vi_python::module!(mymodule, Pendulum, CartPole; gauss 8)`.
/// The default is `fixed; gauss 4, 8; energy`.
#[macro_export]
macro_rules! module {
    ($name:ident, $($system:ident),+ $(,)?) => {
        $crate::module!(@bind $name, [$($system),+], { fixed; gauss 4, 8; energy }, $crate::bind);
    };
    ($name:ident, $($system:ident),+; $($methods:tt)*) => {
        $crate::module!(@bind $name, [$($system),+], { $($methods)* }, $crate::bind);
    };
    // A module of the package itself, which makes the classes.
    (@inner $name:ident, $system:ident, $methods:tt) => {
        $crate::module!(@bind $name, [$system], $methods, |_| Ok(()));
    };
    (@bind $name:ident, [$($system:ident),+], $methods:tt, $bind:expr) => {
        /// A Python module of mechanical systems.
        #[$crate::pyo3::pymodule(gil_used = false)]
        #[pyo3(crate = "vi_python::pyo3")]
        fn $name(module: &$crate::pyo3::Bound<'_, $crate::pyo3::types::PyModule>) -> $crate::pyo3::PyResult<()> {
            let bind: fn(&$crate::pyo3::Bound<'_, $crate::pyo3::types::PyModule>) -> $crate::pyo3::PyResult<()> = $bind;
            $crate::populate(module, vec![$($crate::vi_erased::kind!($system, $methods)),+])?;
            bind(module)
        }
    };
}
