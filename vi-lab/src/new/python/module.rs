//! The Python module of the systems of the library.

use vi_python::pyo3::{self, prelude::*};

#[pymodule(gil_used = false)]
#[pyo3(crate = "vi_python::pyo3")]
fn mine(module: &Bound<'_, PyModule>) -> PyResult<()> {
    vi_python::populate(module, systems::systems())?;
    vi_python::bind(module)
}
