//! Guards calls against defects of clebsch. A panic becomes an exception with a message, because an unwinding panic would end
//! Python.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The result of `call`; `RuntimeError` if it panics.
pub(crate) fn guarded<T>(call: impl FnOnce() -> PyResult<T>) -> PyResult<T> {
    // Only the object can reach a partial change, and the message asks the user to create a new one.
    catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
        Err(PyRuntimeError::new_err(format!(
            "internal error in clebsch: {}. Please report it with the model and the case; start again from a new Model",
            text.unwrap_or("no message")
        )))
    })
}
