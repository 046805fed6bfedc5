//! High-order steps of a chain. Each composed step consists of several substeps of other sizes and counts as one node.
//! The factors are the same as for bodies, see [`CompositionOrder`]. Takes a chain at its start; its steps are then
//! composed.

use super::{LineTrajectory, Unstarted};
use crate::code::Places;
use crate::opened::at;
use crate::running::{put, run};
use crate::value::Value;
use clebsch::integrate::CompositionOrder;
use clebsch::line::{LineError, Stamp, shorter};

/// The substeps of a composed step.
#[derive(Clone, Debug)]
pub(super) struct Composed {
    order: CompositionOrder,
    /// The workspace of each substep.
    pub(super) works: Vec<Value<f64>>,
    /// The state before a step, restored if the step fails.
    from: Value<f64>,
}

impl LineTrajectory {
    /// This chain, with steps of size `h` composed to the given order.
    ///
    /// # Errors
    /// If the first step fails. The error contains a smaller step that succeeds, if one is found.
    pub(super) fn of_order(mut self, order: CompositionOrder, h: f64) -> Result<Self, Unstarted> {
        self.h = h;
        let works = self.workspaces(order, self.h)?;
        self.composed = Some(Composed {
            order,
            works,
            from: Value::Unit,
        });
        self.clone().step()?;
        Ok(self)
    }

    /// The workspaces of the substeps of a step of size `h`.
    fn workspaces(
        &mut self,
        order: CompositionOrder,
        h: f64,
    ) -> Result<Vec<Value<f64>>, LineError> {
        let model = self.model.clone();
        let factors = order.factors().into_iter();
        let each = factors.map(|factor| {
            put(&mut self.places, at::STEP, Value::Real(h * factor));
            run(&model.workspace, &mut self.places).map_err(|e| e.line())
        });
        each.collect()
    }

    /// One composed step. If a substep fails, the state is unchanged. After each substep, `seen` receives its factor
    /// and the chain.
    pub(super) fn composed_step(
        &mut self,
        seen: &mut dyn FnMut(f64, &mut Self),
    ) -> Result<(), LineError> {
        let Some(mut composed) = self.composed.take() else {
            return Ok(());
        };
        let (model, node) = (self.model.clone(), self.node());
        if let Some(state) = self.places.get(at::STATE) {
            composed.from.clone_from(state);
        }
        let mut made = Ok(());
        let factors = composed.order.factors();
        for (work, factor) in composed.works.iter_mut().zip(factors) {
            self.begun_anew(work);
            exchange(&mut self.places, work);
            made = run(&model.step, &mut self.places).map(|_| ());
            exchange(&mut self.places, work);
            if made.is_err() {
                break;
            }
            seen(factor, self);
        }
        let order = composed.order;
        let made = match made {
            Ok(()) => {
                self.count(node + 1);
                Ok(())
            }
            Err(e) => {
                if let Some(state) = self.places.get_mut(at::STATE) {
                    state.clone_from(&composed.from);
                }
                Err(e.line())
            }
        };
        self.composed = Some(composed);
        made.map_err(|e| self.in_all(e, order, node))
    }

    /// Turns the error of a substep into an error of the whole step, with its node and a smaller step that succeeds.
    #[cold]
    fn in_all(&self, e: LineError, order: CompositionOrder, node: u64) -> LineError {
        match e {
            LineError::Step { at, cause, .. } => LineError::Step {
                node,
                at,
                cause,
                works: shorter(self.h, |h| self.could(order, h)),
            },
            other => other,
        }
    }

    /// Whether a step of `h` in all can be made from here.
    fn could(&self, order: CompositionOrder, h: f64) -> bool {
        let mut trial = self.clone();
        let Ok(works) = trial.workspaces(order, h) else {
            return false;
        };
        works.into_iter().all(|mut work| {
            exchange(&mut trial.places, &mut work);
            run(&trial.model.clone().step, &mut trial.places).is_ok()
        })
    }

    /// Marks a workspace as stale. It contains data of the same substep of the previous step. A chain that is saved
    /// and reloaded cannot recognise such data.
    fn begun_anew(&self, work: &mut Value<f64>) {
        if let Value::Struct(work) = work
            && let Some(stamp) = work.field_mut(self.model.stamp)
        {
            *stamp = Value::Stamp(Stamp::none());
        }
    }

    fn count(&mut self, node: u64) {
        if let Some(Value::Struct(state)) = self.places.get_mut(at::STATE)
            && let Some(Value::Int(own)) = state.field_mut(self.model.node)
        {
            *own = i64::try_from(node).unwrap_or(i64::MAX);
        }
    }
}

/// Swaps a workspace with the workspace that steps use.
fn exchange(places: &mut Places<f64>, work: &mut Value<f64>) {
    if let Some(place) = places.get_mut(at::WORK) {
        std::mem::swap(place, work);
    }
}
