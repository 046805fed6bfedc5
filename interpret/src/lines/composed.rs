//! Steps of high order of a line: several of its own, of other lengths, counted as one node. The factors are those of bodies,
//! see [`CompositionOrder`].
//! Takes a line at its start; its steps are then composed.

use super::{LineTrajectory, Unstarted};
use crate::code::Places;
use crate::opened::at;
use crate::running::{put, run};
use crate::value::Value;
use clebsch::integrate::CompositionOrder;
use clebsch::line::{LineError, Stamp, shorter};

/// The steps that one step is made of.
#[derive(Clone, Debug)]
pub(super) struct Composed {
    order: CompositionOrder,
    /// The workspace of each of them.
    pub(super) works: Vec<Value<f64>>,
    /// The state that a step begins with, which stays where it is refused.
    from: Value<f64>,
}

impl LineTrajectory {
    /// The same line, each of its steps one of `h` composed of several to this order.
    ///
    /// # Errors
    /// Where the first step cannot be made; with the step that can.
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

    /// Workspaces of the steps that one of `h` is made of.
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

    /// One composed step; where one of its parts is refused the state stays as it was.
    /// `seen` is shown the factor of each part, and the line after it.
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

    /// What is said of a part, said of the whole step: from which node, and which shorter one can be made.
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

    /// Marks a workspace as that of no state: what it holds is that of the same part of the step before, which a line that has
    /// been written down and read cannot tell.
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

/// Puts a workspace where steps look for it, and what stood there in its place.
fn exchange(places: &mut Places<f64>, work: &mut Value<f64>) {
    if let Some(place) = places.get_mut(at::WORK) {
        std::mem::swap(place, work);
    }
}
