//! The compiled module `clebsch._clebsch`: models, cases and runs of the command as Python objects. The Python sources in
//! `clebsch/` wrap them in the public interface.

// Functions that Python calls take their arguments by value.
#![allow(clippy::needless_pass_by_value)]

mod case_text;
mod command;
mod errors;
mod guarded;
mod many;
mod model;
mod options;
mod results;
mod running;
mod to_python;

use pyo3::prelude::*;

#[pymodule]
fn _clebsch(module: &Bound<'_, PyModule>) -> PyResult<()> {
    #[cfg(feature = "native")]
    clebsch_native::install();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<model::Model>()?;
    module.add_class::<running::Running>()?;
    module.add_function(wrap_pyfunction!(command::command, module)?)?;
    module.add_function(wrap_pyfunction!(command::gallery, module)?)?;
    module.add_function(wrap_pyfunction!(many::run_many, module)?)?;
    Ok(())
}
