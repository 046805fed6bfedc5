//! Converts Python values to the text of a case. Numbers, arrays, strings and dictionaries become TOML in which every number has
//! the shortest digits that reproduce its bits.

use crate::errors::exception;
use clebsch_cli::session::quoted;
use numpy::{PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use std::fmt::Write as _;

/// The TOML of a value on one line; `argument` names it in messages.
pub(crate) fn literal(value: &Bound<'_, PyAny>, argument: &str) -> PyResult<String> {
    let mut out = String::new();
    write(value, argument, &mut out, 0)?;
    Ok(out)
}

/// Maximum nesting of the arrays and tables of a case.
const DEEPEST: usize = 16;

fn write(value: &Bound<'_, PyAny>, argument: &str, out: &mut String, depth: usize) -> PyResult<()> {
    let wrong = |why: String| {
        Err(exception(
            value.py(),
            "DataError",
            &format!("{argument}: {why}"),
            &[],
        ))
    };
    if depth > DEEPEST {
        return wrong(format!(
            "nested deeper than {DEEPEST} levels; give a number, an array, a string or a dictionary of them"
        ));
    }
    if let Ok(own) = value.cast::<PyBool>() {
        out.push_str(if own.is_true() { "true" } else { "false" });
    } else if let Ok(own) = value.cast::<PyFloat>() {
        number(own.value(), out);
    } else if value.is_instance_of::<PyInt>() {
        match value.extract::<i64>() {
            Ok(own) => out.push_str(&own.to_string()),
            Err(_) => number(value.extract::<f64>()?, out),
        }
    } else if let Ok(own) = value.cast::<PyString>() {
        out.push_str(&quoted(own.to_str()?));
    } else if let Ok(own) = value.cast::<PyDict>() {
        let mut separator = "{ ";
        for (key, item) in own {
            let key: String = key.str()?.to_str()?.to_owned();
            out.push_str(separator);
            out.push_str(&quoted(&key));
            out.push_str(" = ");
            write(&item, &format!("{argument}.{key}"), out, depth + 1)?;
            separator = ", ";
        }
        out.push_str(if separator == "{ " { "{}" } else { " }" });
    } else if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        out.push('[');
        for (place, item) in value.try_iter()?.enumerate() {
            if place > 0 {
                out.push_str(", ");
            }
            write(&item?, argument, out, depth + 1)?;
        }
        out.push(']');
    } else {
        match array(value) {
            Some(own) => entries(own.as_slice()?, own.shape(), out),
            None => {
                let found = value.get_type();
                let found = found.name()?;
                return wrong(format!(
                    "expected a number, an array of numbers, a string or a dictionary, found {found}; convert it with \
                     numpy.asarray"
                ));
            }
        }
    }
    Ok(())
}

/// Any value that numpy accepts as an array of real numbers.
fn array<'py>(value: &Bound<'py, PyAny>) -> Option<PyReadonlyArrayDyn<'py, f64>> {
    let numpy = value.py().import("numpy").ok()?;
    let found = numpy.call_method1("asarray", (value,)).ok()?;
    let kind: char = found
        .getattr("dtype")
        .ok()?
        .getattr("kind")
        .ok()?
        .extract()
        .ok()?;
    if !['f', 'i', 'u', 'b'].contains(&kind) {
        return None;
    }
    // The arguments `order` and `dtype` request a copy only if one is needed.
    let found = numpy
        .call_method1("require", (found, "float64", "C"))
        .ok()?;
    Some(found.cast::<PyArrayDyn<f64>>().ok()?.readonly())
}

fn entries(numbers: &[f64], shape: &[usize], out: &mut String) {
    let Some((count, rest)) = shape.split_first() else {
        number(numbers.first().copied().unwrap_or(f64::NAN), out);
        return;
    };
    let size: usize = rest.iter().product();
    out.push('[');
    for at in 0..*count {
        if at > 0 {
            out.push_str(", ");
        }
        let own = numbers.get(at * size..(at + 1) * size);
        entries(own.unwrap_or_default(), rest, out);
    }
    out.push(']');
}

fn number(x: f64, out: &mut String) {
    // Writing to a String cannot fail.
    let _ = match x {
        _ if x.is_nan() => write!(out, "nan"),
        _ if x.is_infinite() => write!(out, "{}inf", if x < 0.0 { "-" } else { "" }),
        _ => write!(out, "{x:?}"),
    };
}
