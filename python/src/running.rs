//! The class `Running`, a running case. It steps while other Python threads run, and checks for signals in between.

use crate::errors::failed;
use crate::guarded::guarded;
use crate::results::{arrays, fields, outcomes, row};
use clebsch_check::StepSelection;
use clebsch_cli::session::{self, Planned};
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::exceptions::{PyMemoryError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList};
use std::sync::{Mutex, MutexGuard, TryLockError};
use std::time::{Duration, Instant};

/// Time between two checks for signals.
const AT_A_TIME: Duration = Duration::from_millis(50);

/// A running case.
#[pyclass(frozen, module = "clebsch._clebsch")]
pub(crate) struct Running {
    inner: Mutex<session::Running>,
    /// The name of the case in messages.
    file: String,
}

/// The failure of a run: node, time, message.
type Failed = (u64, f64, String);

impl Running {
    /// Starts a plan.
    pub(crate) fn start(
        py: Python<'_>,
        planned: Planned,
        which: StepSelection,
        sampled: bool,
        file: &str,
    ) -> PyResult<Self> {
        let source = planned.card.source;
        let started = py.detach(|| session::Running::start(planned, which, sampled));
        let inner = started.map_err(|failure| failed(py, &failure, source, file))?;
        Ok(Self {
            inner: Mutex::new(inner),
            file: file.to_owned(),
        })
    }

    pub(crate) fn of(inner: session::Running, file: &str) -> Self {
        Self {
            inner: Mutex::new(inner),
            file: file.to_owned(),
        }
    }

    /// The run, or an error if another thread is stepping it.
    fn locked(&self) -> PyResult<MutexGuard<'_, session::Running>> {
        match self.inner.try_lock() {
            Ok(inner) => Ok(inner),
            Err(TryLockError::WouldBlock) => Err(PyRuntimeError::new_err(
                "another thread is stepping this run; give each thread a run of its own",
            )),
            Err(TryLockError::Poisoned(_)) => Err(PyRuntimeError::new_err(
                "an internal error occurred earlier in this run; start it again",
            )),
        }
    }
}

#[pymethods]
impl Running {
    /// Steps for about this many seconds. Returns whether the run is over, and its failure if there is one.
    fn advance(&self, py: Python<'_>, seconds: f64) -> PyResult<(bool, Option<Failed>)> {
        let begun = Instant::now();
        guarded(|| {
            loop {
                let mut inner = self.locked()?;
                let own = &mut *inner;
                let advanced = py.detach(|| own.advance(AT_A_TIME));
                if let Some(why) = inner.full() {
                    return Err(PyMemoryError::new_err(why));
                }
                match advanced {
                    Ok(true) => return Ok((true, None)),
                    Err(error) => {
                        let summary = inner.summary();
                        return Ok((true, Some((summary.node, summary.time, error.to_string()))));
                    }
                    Ok(false) => {}
                }
                drop(inner);
                py.check_signals()?;
                if begun.elapsed().as_secs_f64() >= seconds {
                    return Ok((false, None));
                }
            }
        })
    }

    /// Ends the run at the current node, which becomes its last sample.
    fn end_here(&self) -> PyResult<()> {
        guarded(|| {
            self.locked()?.end_here();
            Ok(())
        })
    }

    /// Makes up to `steps` steps without samples. Returns how many succeeded, and the failure of the next one.
    fn step(&self, py: Python<'_>, steps: u64) -> PyResult<(u64, Option<Failed>)> {
        guarded(|| {
            let mut made = 0;
            while made < steps {
                let mut inner = self.locked()?;
                let own = &mut *inner;
                match py.detach(|| own.step(steps - made, AT_A_TIME)) {
                    Ok(more) => made += more,
                    Err((more, error)) => {
                        let (node, time) = inner.place();
                        return Ok((made + more, Some((node, time, error.to_string()))));
                    }
                }
                drop(inner);
                py.check_signals()?;
            }
            Ok((made, None))
        })
    }

    /// Steps, node, time and number of samples so far.
    fn summary(&self) -> PyResult<(u64, u64, f64, u64)> {
        let inner = self.locked()?;
        let summary = inner.summary();
        Ok((summary.steps, summary.node, summary.time, summary.samples))
    }

    /// The current node and time.
    fn place(&self) -> PyResult<(u64, f64)> {
        Ok(self.locked()?.place())
    }

    /// Nodes, times and rows of all samples, which the arrays take over.
    fn take<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let mut inner = self.locked()?;
        let width = inner.card().observable_count() + inner.card().invariant_count();
        let rows = inner.take_rows();
        let samples = rows.nodes.len();
        let numbers = rows.numbers.into_pyarray(py);
        let numbers = match width {
            0 => numbers.into_any(),
            _ => numbers.reshape([samples, width])?.into_any(),
        };
        Ok((
            rows.nodes.into_pyarray(py).into_any(),
            rows.times.into_pyarray(py).into_any(),
            numbers,
        ))
    }

    /// A copy of the sample with this index: node, time, row.
    fn sample<'py>(
        &self,
        py: Python<'py>,
        number: usize,
    ) -> PyResult<(u64, f64, Bound<'py, PyAny>)> {
        let inner = self.locked()?;
        let width = inner.card().observable_count() + inner.card().invariant_count();
        let rows = inner.rows();
        let numbers = rows.numbers.get(number * width..(number + 1) * width);
        match (rows.nodes.get(number), rows.times.get(number), numbers) {
            (Some(node), Some(time), Some(numbers)) => {
                Ok((*node, *time, row(py, numbers.to_vec()).into_any()))
            }
            _ => Err(PyValueError::new_err(format!(
                "sample {number} does not exist"
            ))),
        }
    }

    /// The row of the current node.
    fn row<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        guarded(|| Ok(row(py, self.locked()?.row()).into_any()))
    }

    /// The columns of the rows for each array.
    fn arrays<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        guarded(|| arrays(py, self.locked()?.card()))
    }

    /// The names of the columns of the rows, as in trajectory.csv.
    fn columns(&self) -> PyResult<Vec<String>> {
        Ok(clebsch::record::columns(self.locked()?.card()))
    }

    /// The outcomes of the invariants.
    fn outcomes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        guarded(|| outcomes(py, &self.locked()?.outcomes()))
    }

    /// Warnings about the initial kinetic energy and about violated invariants.
    fn warnings(&self) -> PyResult<Vec<String>> {
        let inner = self.locked()?;
        Ok(inner
            .kinetic_warning()
            .into_iter()
            .chain(inner.lost())
            .collect())
    }

    /// The verdict on the checked steps against the action as stated: the sentence of the command, the number of steps, and whether
    /// they pass.
    fn stated(&self) -> PyResult<Option<(String, u64, Option<bool>)>> {
        let inner = self.locked()?;
        Ok(inner.stated().map(|verdict| {
            let holds = verdict.not_judged.is_none().then(|| verdict.holds());
            (verdict.to_string(), verdict.judged, holds)
        }))
    }

    /// The number of steps made in substeps, and the largest number of substeps.
    fn halvings(&self) -> PyResult<Option<(u64, u64)>> {
        Ok(self.locked()?.halvings().map(|h| (h.steps, h.parts)))
    }

    /// The stability limit of the step size, from a search of at most this many seconds.
    fn stability_limit<'py>(&self, py: Python<'py>, seconds: f64) -> PyResult<Bound<'py, PyDict>> {
        guarded(|| {
            let inner = self.locked()?;
            let (card, plan) = (inner.card(), inner.plan());
            let patience = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
            let found = py.detach(|| session::Running::stability_limit(card, plan, patience));
            drop(inner);
            py.check_signals()?;
            let out = PyDict::new(py);
            out.set_item("step", found.step)?;
            out.set_item("frequency", found.frequency)?;
            out.set_item("told", found.told)?;
            out.set_item("warning", found.warning)?;
            Ok(out)
        })
    }

    /// The numbers of the case: step size, number of steps, `every`, and parameters and initial values by name.
    fn case<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let inner = self.locked()?;
        let (card, plan) = (inner.card(), inner.plan());
        let case = &plan.case;
        let out = PyDict::new(py);
        out.set_item("name", &case.name)?;
        out.set_item("file", &self.file)?;
        out.set_item("h", case.h)?;
        out.set_item("steps", case.steps)?;
        out.set_item("every", plan.every)?;
        out.set_item("order", plan.order.unwrap_or(card.order))?;
        for (key, all, values) in [
            ("parameters", card.parameters, &case.parameters),
            ("initial", card.initial, &case.initial),
        ] {
            let own = PyDict::new(py);
            for (field, numbers) in all.iter().zip(values) {
                let array = numbers.clone().into_pyarray(py);
                let shaped = match (field.rows, field.cols) {
                    (1, 1) => array.reshape(Vec::<usize>::new())?.into_any(),
                    (_, 1) => array.into_any(),
                    (rows, cols) => array.reshape([rows, cols])?.into_any(),
                };
                own.set_item(field.ascii, shaped)?;
            }
            out.set_item(key, own)?;
        }
        Ok(out)
    }

    /// Parameters, initial values and observables of the card.
    fn fields<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let inner = self.locked()?;
        let card = inner.card();
        let out = PyDict::new(py);
        out.set_item("parameters", fields(py, card.parameters)?)?;
        out.set_item("initial", fields(py, card.initial)?)?;
        out.set_item("observables", fields(py, card.observables)?)?;
        out.set_item(
            "invariants",
            card.invariants.iter().map(|i| i.name).collect::<Vec<_>>(),
        )?;
        Ok(out)
    }

    /// The current state as bytes; None if it cannot be saved.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyBytes>>> {
        guarded(|| Ok(self.locked()?.saved().map(|bytes| PyBytes::new(py, &bytes))))
    }

    /// Restores bytes from `save` for the same case.
    fn restore(&self, bytes: &[u8]) -> PyResult<()> {
        guarded(|| self.locked()?.restore(bytes).map_err(PyValueError::new_err))
    }
}
