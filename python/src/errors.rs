//! Failures of the command as exceptions of the package.

use clebsch_cli::failure::Failure;
use clebsch_cli::session;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// An exception of the module `clebsch._errors`, made with these keyword arguments.
pub(crate) fn exception(
    py: Python<'_>,
    name: &str,
    text: &str,
    with: &[(&str, Py<PyAny>)],
) -> PyErr {
    let make = || -> PyResult<PyErr> {
        let class = py.import("clebsch._errors")?.getattr(name)?;
        let keywords = PyDict::new(py);
        for (key, value) in with {
            keywords.set_item(key, value)?;
        }
        Ok(PyErr::from_value(class.call((text,), Some(&keywords))?))
    };
    make().unwrap_or_else(|_| PyRuntimeError::new_err(text.to_owned()))
}

/// Converts a failure to an exception. It concerns a model's text `source`, which messages call `name`, or a case, which messages
/// call `file`.
pub(crate) fn failed(py: Python<'_>, failure: &Failure, source: &str, file: &str) -> PyErr {
    match failure {
        Failure::Usage(text) => match text.strip_prefix('\n') {
            Some(rendered) => of_model(py, rendered, source),
            None => of_data(py, text, file),
        },
        Failure::Failed(text) => {
            let (node, time) = (0_u64.into_pyobject(py), 0.0_f64.into_pyobject(py));
            let numbers = [
                ("node", node.map(|x| x.into_any().unbind())),
                ("time", time.map(|x| x.into_any().unbind())),
            ];
            let with: Vec<(&str, Py<PyAny>)> = numbers
                .into_iter()
                .filter_map(|(key, value)| Some((key, value.ok()?)))
                .collect();
            exception(py, "StepError", text, &with)
        }
        Failure::ReaderGone => PyRuntimeError::new_err(failure.to_string()),
    }
}

/// A mistake in a model's text, with its position.
fn of_model(py: Python<'_>, rendered: &str, source: &str) -> PyErr {
    let mut with = Vec::new();
    if let Some(errors) = session::Model::mistakes(source)
        && let Some(first) = errors.iter().next()
    {
        let (line, column) = first.place.line_and_column();
        let mut put = |key: &'static str, value: PyResult<Py<PyAny>>| {
            with.extend(value.ok().map(|v| (key, v)))
        };
        let number =
            |n: usize| -> PyResult<Py<PyAny>> { Ok(n.into_pyobject(py)?.into_any().unbind()) };
        put("line", number(line));
        put("column", number(column));
        if !first.help.is_empty() {
            put(
                "hint",
                Ok(first
                    .help
                    .join("\n")
                    .into_pyobject(py)
                    .map(|x| x.into_any().unbind())
                    .unwrap_or_else(|_| py.None())),
            );
        }
    }
    exception(py, "ModelError", rendered.trim_end(), &with)
}

/// A wrong value of a case, without the name of its text.
fn of_data(py: Python<'_>, text: &str, file: &str) -> PyErr {
    exception(py, "DataError", without_place(text, file), &[])
}

/// Removes the prefix `FILE:LINE: ` or `FILE: ` of a message, because the text of the case was assembled from arguments.
fn without_place<'t>(text: &'t str, file: &str) -> &'t str {
    let Some(rest) = text.strip_prefix(file) else {
        return text;
    };
    let rest = rest.strip_prefix(':').unwrap_or(rest);
    let numbered = rest
        .split_once(':')
        .filter(|(line, _)| !line.is_empty() && line.bytes().all(|b| b.is_ascii_digit()));
    numbered.map_or(rest, |(_, rest)| rest).trim_start()
}
