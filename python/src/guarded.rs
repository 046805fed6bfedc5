//! Calls that may reach a defect of clebsch. A panic becomes an exception with a message, since an unwinding panic would end Python.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The result of `call`; `RuntimeError` if it panics.
pub(crate) fn guarded<T>(call: impl FnOnce() -> PyResult<T>) -> PyResult<T> {
    // Half-made changes are reachable only through the object, and the message tells the user to start anew.
    catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
        Err(PyRuntimeError::new_err(format!(
            "clebsch met an internal error: {}. Please report it with the model and the case; start from a new Model",
            text.unwrap_or("no message")
        )))
    })
}
