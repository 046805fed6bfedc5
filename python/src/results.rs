//! The results of a run: rows as arrays that take over their memory, the columns of each array, and the outcomes of the invariants.

use clebsch::card::{Conserved, Field};
use clebsch_cli::session::{Columns, Layout, Outcome, Verdict, layout};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// Fields of a card as dictionaries.
pub(crate) fn fields<'py>(py: Python<'py>, all: &[Field]) -> PyResult<Bound<'py, PyList>> {
    let out = PyList::empty(py);
    for field in all {
        let own = PyDict::new(py);
        own.set_item("name", field.ascii)?;
        own.set_item("written", field.name)?;
        let shape: Vec<usize> = match (field.rows, field.cols) {
            (1, 1) => vec![],
            (rows, 1) => vec![rows],
            (rows, cols) => vec![rows, cols],
        };
        own.set_item("shape", pyo3::types::PyTuple::new(py, shape)?)?;
        own.set_item("kind", format!("{:?}", field.kind))?;
        own.set_item("doc", field.doc)?;
        out.append(own)?;
    }
    Ok(out)
}

/// The arrays of a card: name, shape, and their columns in the rows.
pub(crate) fn arrays<'py>(
    py: Python<'py>,
    card: &clebsch::card::Card,
) -> PyResult<Bound<'py, PyList>> {
    let all = layout(card);
    let out = PyList::empty(py);
    for Layout {
        name,
        shape,
        columns,
    } in all
    {
        let shape = pyo3::types::PyTuple::new(py, shape)?;
        let (kind, numbers): (&str, Bound<'py, PyAny>) = match columns {
            Columns::Nodes => ("nodes", py.None().into_bound(py)),
            Columns::Times => ("times", py.None().into_bound(py)),
            Columns::Blocks {
                start,
                step,
                size,
                count,
            } => (
                "blocks",
                (start, step, size, count).into_pyobject(py)?.into_any(),
            ),
            Columns::Listed(list) => ("listed", list.into_pyarray(py).into_any()),
            Columns::Sites(list) => ("sites", list.into_pyarray(py).into_any()),
        };
        out.append((name, shape, kind, numbers))?;
    }
    Ok(out)
}

/// The outcomes of the invariants, as dictionaries in the order of the card.
pub(crate) fn outcomes<'py>(py: Python<'py>, all: &[Outcome]) -> PyResult<Bound<'py, PyList>> {
    let out = PyList::empty(py);
    for outcome in all {
        let own = PyDict::new(py);
        own.set_item("name", outcome.invariant.name)?;
        own.set_item("formula", outcome.invariant.formula)?;
        own.set_item("exact", outcome.invariant.conserved == Conserved::Exactly)?;
        own.set_item("rows", outcome.invariant.rows)?;
        own.set_item("scale", outcome.scale)?;
        own.set_item("worst", outcome.worst)?;
        own.set_item("last", outcome.last)?;
        own.set_item("bound", outcome.bound)?;
        own.set_item("verdict", outcome.verdict.word())?;
        own.set_item("exceeded", outcome.verdict == Verdict::Left)?;
        own.set_item("zero_by", &outcome.zero_by)?;
        let scales: Vec<f64> = outcome.components.iter().map(|drift| drift.scale).collect();
        own.set_item("scales", scales.into_pyarray(py))?;
        out.append(own)?;
    }
    Ok(out)
}

/// The numbers of one row.
pub(crate) fn row(py: Python<'_>, numbers: Vec<f64>) -> Bound<'_, PyArray1<f64>> {
    numbers.into_pyarray(py)
}
