//! The options of a run: converts the dictionary of the Python code to a request.

use crate::errors::exception;
use clebsch_check::StepSelection;
use clebsch_cli::session::Request;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// An option, if given; `what` describes the expected type.
fn option<'py, T>(options: &Bound<'py, PyDict>, key: &str, what: &str) -> PyResult<Option<T>>
where
    T: for<'a> FromPyObject<'a, 'py>,
{
    let Some(value) = options.get_item(key)?.filter(|value| !value.is_none()) else {
        return Ok(None);
    };
    value.extract::<T>().map(Some).map_err(|_| {
        let found = value
            .repr()
            .map_or_else(|_| String::new(), |r| r.to_string());
        let text = format!("{key}: expected {what}, found {found}");
        exception(options.py(), "DataError", &text, &[])
    })
}

/// The steps to check against the action as stated.
fn judged(options: &Bound<'_, PyDict>) -> PyResult<StepSelection> {
    let asked: Option<String> = option(options, "judge", "None, \"sample\" or \"all\"")?;
    match asked.as_deref() {
        None => Ok(StepSelection::None),
        Some("sample") => Ok(StepSelection::Sample),
        Some("all") => Ok(StepSelection::All),
        Some(other) => {
            let text = format!("judge: expected None, \"sample\" or \"all\", found {other:?}");
            Err(exception(options.py(), "DataError", &text, &[]))
        }
    }
}

/// The request from a dictionary.
pub(crate) fn request(options: &Bound<'_, PyDict>) -> PyResult<Request> {
    Ok(Request {
        until: option(options, "until", "a number, the final time")?,
        every: option(options, "every", "a whole number of nodes, at least 0")?,
        order: option(options, "order", "a whole number, such as 2 or 4")?,
        solver: option(options, "solver", "the name of a solver")?,
        compensated: option(options, "compensated", "True or False")?.unwrap_or(false),
        halve: option(options, "halve", "True or False")?.unwrap_or(false),
        judged: judged(options)?,
    })
}
