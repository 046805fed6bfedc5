//! A running chain: its node, its steps, and the values that a checkpoint keeps. Module `asked` evaluates its
//! quantities. Takes a model and the places of its routines; moves from node to node.

use super::composed::Composed;
use super::{LineModel, coordinates};
use crate::code::Places;
use crate::opened::at;
use crate::running::run;
use crate::value::Value;
use clebsch::line::LineError;
use clebsch::saved::{Saved, Words};
use std::sync::Arc;

/// A running chain.
#[derive(Clone, Debug)]
pub struct LineTrajectory {
    pub(super) model: Arc<LineModel>,
    pub(super) places: Places<f64>,
    pub(super) h: f64,
    /// The substeps, if the steps are composed.
    pub(super) composed: Option<Composed>,
}

impl LineTrajectory {
    /// The number of the node.
    pub fn node(&self) -> u64 {
        match self.places.get(at::STATE) {
            Some(Value::Struct(s)) => match s.field(self.model.node) {
                Some(Value::Int(n)) => u64::try_from(*n).unwrap_or(0),
                _ => 0,
            },
            _ => 0,
        }
    }

    /// The step size.
    pub fn h(&self) -> f64 {
        self.h
    }

    /// One step.
    ///
    /// # Errors
    /// [`LineError::Step`] names the site; the state is then unchanged.
    pub fn step(&mut self) -> Result<(), LineError> {
        self.step_in_parts(&mut |_, _| {})
    }

    /// Takes a step. After each substep, calls `seen` with the substep as a fraction of the whole step, and with the
    /// chain.
    ///
    /// # Errors
    /// As [`LineTrajectory::step`].
    pub(super) fn step_in_parts(
        &mut self,
        seen: &mut dyn FnMut(f64, &mut Self),
    ) -> Result<(), LineError> {
        let model = self.model.clone();
        let made = match self.composed {
            Some(_) => self.composed_step(seen),
            None => match run(&model.step, &mut self.places) {
                Ok(_) => {
                    seen(1.0, self);
                    Ok(())
                }
                Err(e) => Err(e.line()),
            },
        };
        made.map_err(|e| coordinates::named(&model.coordinates, e))
    }
}

impl Saved for LineTrajectory {
    fn words(&mut self, words: &mut Words) {
        for at in [at::STATE, at::WORK] {
            match self.places.get_mut(at) {
                Some(value) => value.words(words),
                None => words.refuse(),
            }
        }
        let composed = self.composed.iter_mut().flat_map(|c| &mut c.works);
        composed.for_each(|work| work.words(words));
    }
}
