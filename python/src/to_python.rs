//! The tables of a case as dictionaries.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use toml::{Table, Value};

pub(crate) fn dictionary<'py>(py: Python<'py>, table: &Table) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    for (key, value) in table {
        out.set_item(key, object(py, value)?)?;
    }
    Ok(out)
}

fn object<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::String(own) => own.into_pyobject(py)?.into_any(),
        Value::Integer(own) => own.into_pyobject(py)?.into_any(),
        Value::Float(own) => own.into_pyobject(py)?.into_any(),
        Value::Boolean(own) => own.into_pyobject(py)?.to_owned().into_any(),
        Value::Datetime(own) => own.to_string().into_pyobject(py)?.into_any(),
        Value::Array(own) => {
            let out = PyList::empty(py);
            for item in own {
                out.append(object(py, item)?)?;
            }
            out.into_any()
        }
        Value::Table(own) => dictionary(py, own)?.into_any(),
    })
}
