//! The class `Model` of the compiled module. Texts of its cases are assembled from Python values.

use crate::case_text::literal;
use crate::errors::failed;
use crate::guarded::guarded;
use crate::options::request;
use crate::results::fields;
use crate::running::Running;
use crate::to_python::dictionary;
use clebsch::card::Conserved;
use clebsch_cli::cache_of_process;
use clebsch_cli::gallery::Gallery;
use clebsch_cli::session::{self, Edit, edited, quoted};
use clebsch_core::expr::symbol::ascii;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// The name in messages of a case assembled from arguments.
pub(crate) const ARGUMENTS: &str = "arguments";

/// The shipped models, with the cache of the process.
fn gallery() -> Gallery {
    Gallery::shipped().with_cache(cache_of_process())
}

/// A model.
#[pyclass(frozen, module = "clebsch._clebsch")]
pub(crate) struct Model {
    pub(crate) inner: session::Model,
    /// The name that its text declares.
    declared: String,
}

impl Model {
    fn new(inner: session::Model) -> Self {
        let declared = inner.declared().unwrap_or_default();
        Self { inner, declared }
    }
}

#[pymethods]
impl Model {
    /// The model of a text, which messages call `name`.
    #[staticmethod]
    fn of_text(py: Python<'_>, text: &str, name: &str) -> PyResult<Self> {
        guarded(|| {
            let read = py.detach(|| session::Model::of_text(name, text, &cache_of_process()));
            read.map(Self::new)
                .map_err(|failure| failed(py, &failure, text, name))
        })
    }

    /// A shipped model, or the model of a file.
    #[staticmethod]
    fn named(py: Python<'_>, name: &str) -> PyResult<Self> {
        guarded(|| {
            let read = py.detach(|| session::Model::named(&gallery(), name));
            read.map(Self::new).map_err(|failure| {
                let text = std::fs::read_to_string(name).unwrap_or_default();
                failed(py, &failure, &text, name)
            })
        })
    }

    #[getter]
    fn name(&self) -> &str {
        self.inner.name()
    }

    #[getter]
    fn declared(&self) -> &str {
        &self.declared
    }

    #[getter]
    fn source(&self) -> &str {
        self.inner.source()
    }

    #[getter]
    fn warnings(&self) -> &str {
        self.inner.warnings()
    }

    #[getter]
    fn has_sites(&self) -> bool {
        self.inner.has_sites()
    }

    /// The names of the cases, each with a description.
    fn cases(&self) -> PyResult<Vec<(String, String)>> {
        guarded(|| Ok(self.inner.cases()))
    }

    /// The name of a case in messages, and its text.
    fn case_text(&self, py: Python<'_>, name: Option<&str>) -> PyResult<(String, String)> {
        guarded(|| {
            let found = self.inner.case(name);
            found.map_err(|failure| failed(py, &failure, self.inner.source(), ARGUMENTS))
        })
    }

    /// A case as dictionaries.
    fn case<'py>(&self, py: Python<'py>, name: Option<&str>) -> PyResult<Bound<'py, PyDict>> {
        let (file, text) = self.case_text(py, name)?;
        let table = toml::from_str::<toml::Table>(&text).map_err(|error| {
            let failure = clebsch_cli::failure::Failure::Usage(format!("{file}: {error}"));
            failed(py, &failure, self.inner.source(), ARGUMENTS)
        })?;
        dictionary(py, &table)
    }

    /// Assembles the text of a case from tables of values, on top of `base` if given. A value of None removes the key.
    fn compose(&self, base: Option<&str>, tables: &Bound<'_, PyDict>) -> PyResult<String> {
        guarded(|| {
            let mut edits = Vec::new();
            for (table, values) in tables {
                let table: String = table.extract()?;
                let Ok(values) = values.cast::<PyDict>() else {
                    // A top-level key.
                    let value = Some(literal(&values, &table)?);
                    edits.push(Edit {
                        table: String::new(),
                        key: table,
                        value,
                    });
                    continue;
                };
                for (key, value) in values {
                    let key = ascii(&key.extract::<String>()?);
                    let value = match value.is_none() {
                        true => None,
                        false => Some(literal(&value, &format!("{table}.{key}"))?),
                    };
                    edits.push(Edit {
                        table: table.clone(),
                        key,
                        value,
                    });
                }
            }
            let fresh = || format!("model = {}\n", quoted(&self.declared));
            Ok(edited(&base.map_or_else(fresh, str::to_owned), &edits))
        })
    }

    /// Starts a case, given by its name in messages and by its text.
    fn start(
        &self,
        py: Python<'_>,
        file: &str,
        text: &str,
        options: &Bound<'_, PyDict>,
        sampled: bool,
    ) -> PyResult<Running> {
        let request = request(options)?;
        guarded(|| {
            let planned = py.detach(|| self.inner.planned(file, text, &request));
            let planned =
                planned.map_err(|failure| failed(py, &failure, self.inner.source(), file))?;
            Running::start(py, planned, request.judged, sampled, file)
        })
    }

    /// The derivation in the given format.
    fn derivation(
        &self,
        py: Python<'_>,
        format: &str,
        explain: bool,
        standalone: bool,
    ) -> PyResult<String> {
        guarded(|| {
            let derived = py.detach(|| self.inner.derivation(format, explain, standalone));
            derived.map_err(|failure| failed(py, &failure, self.inner.source(), self.inner.name()))
        })
    }

    /// The card of the model; a model with labels uses the default numbers of sites.
    fn card<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        guarded(|| {
            let card = py.detach(|| self.inner.card());
            let card = card
                .map_err(|failure| failed(py, &failure, self.inner.source(), self.inner.name()))?;
            let out = PyDict::new(py);
            out.set_item("name", card.name)?;
            out.set_item("doc", card.doc.trim())?;
            out.set_item("summary", card.summary)?;
            out.set_item("solver", card.solver)?;
            out.set_item("solvers", card.solvers.to_vec())?;
            out.set_item("order", card.order)?;
            out.set_item("orders", card.orders.to_vec())?;
            out.set_item("reversible", card.reversible)?;
            out.set_item("parameters", fields(py, card.parameters)?)?;
            out.set_item("initial", fields(py, card.initial)?)?;
            out.set_item("observables", fields(py, card.observables)?)?;
            let invariants = PyList::empty(py);
            for invariant in card.invariants {
                let exact = invariant.conserved == Conserved::Exactly;
                invariants.append((invariant.name, invariant.formula, invariant.rows, exact))?;
            }
            out.set_item("invariants", invariants)?;
            Ok(out)
        })
    }
}
