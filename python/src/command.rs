//! The command `clebsch` itself, as `python -m clebsch` runs it, and its list of models.

use crate::errors::failed;
use crate::guarded::guarded;
use clebsch_cli::failure::Failure;
use clebsch_cli::gallery::Gallery;
use clebsch_cli::{Streams, execute, run_arguments};
use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the command with these arguments on the streams of the process; returns its exit code.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, arguments: Vec<OsString>) -> PyResult<u8> {
    let name = OsString::from("clebsch");
    guarded(|| Ok(py.detach(|| run_arguments(std::iter::once(name).chain(arguments)))))
}

/// The list of shipped models, as `clebsch list --json` prints it.
#[pyfunction]
pub(crate) fn gallery(py: Python<'_>) -> PyResult<String> {
    guarded(|| {
        let (mut out, mut err) = (Vec::new(), Vec::new());
        let mut streams = Streams {
            input: &mut std::io::empty(),
            out: &mut out,
            err: &mut err,
            progress: false,
            width: None,
        };
        let arguments = ["clebsch", "list", "--json"].map(OsString::from);
        let code = execute(arguments, &Gallery::shipped(), &mut streams);
        let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
        match code {
            0 => Ok(text(out)),
            _ => Err(failed(py, &Failure::Failed(text(err)), "", "")),
        }
    })
}
