//! Steps of higher order: adapts a model from a file to compositions.

use crate::code::Places;
use crate::opened::{Opened, at};
use crate::packed::Packed;
use crate::recorded::Recorded;
use crate::running::{put, run};
use crate::value::Value;
use clebsch::card::Settings;
use clebsch::integrate::{Reversible, Stepper};
use clebsch::saved::{Saved, Words};
use clebsch::{StartError, StepError};

/// A model and its parameters.
#[derive(Clone, Debug)]
pub struct Model {
    pub opened: &'static Opened,
    pub model: Value<f64>,
    /// Any state, as a template for the numbers of a state.
    pub state: Value<f64>,
}

/// The workspace of one substep of a composition: its own places, and tapes for its own step size.
#[derive(Clone, Debug)]
pub struct Part {
    places: Places<f64>,
    recorded: Recorded,
}

impl Part {
    /// One step of the model from a state. Returns the solutions of the equations of the step, if tapes took it.
    pub fn advance(
        &mut self,
        model: &Model,
        state: &mut Packed,
    ) -> Result<Option<&[f64]>, StepError> {
        let Part { places, recorded } = self;
        if recorded.step_from(state, places) {
            return Ok(recorded.solutions());
        }
        recorded.write(places);
        recorded.follow();
        if let Some(here) = places.get_mut(at::STATE) {
            state.put(here);
        }
        run(&model.opened.functions.step, places).map_err(|e| e.step(state.node))?;
        if let Some(next) = places.get(at::STATE).and_then(Packed::of) {
            *state = next;
        }
        Ok(None)
    }

    /// Saves or restores the data that the solver of this step keeps.
    pub fn words(&mut self, words: &mut Words) {
        self.recorded.write(&mut self.places);
        self.recorded.follow();
        match self.places.get_mut(at::WORK) {
            Some(work) => work.words(words),
            None => words.refuse(),
        }
    }
}

impl Model {
    /// Places with a state, for steps of size `h`.
    fn places(&self, state: &Packed, h: f64) -> Places<f64> {
        let mut places = self.opened.places(self.model.clone());
        let mut here = self.state.clone();
        state.put(&mut here);
        put(&mut places, at::STATE, here);
        put(&mut places, at::STEP, Value::Real(h));
        places
    }

    /// The workspace of a state for steps of size `h`, prepared with this choice.
    pub fn workspace_by(
        &self,
        state: &Packed,
        h: f64,
        choice: Value<f64>,
    ) -> Result<Part, StartError> {
        let mut places = self.places(state, h);
        self.opened
            .prepare(&mut places, Settings::step(h), choice)?;
        let recorded = Recorded::new(self.opened.recordable(), true);
        Ok(Part { places, recorded })
    }
}

impl Stepper for Model {
    type Scalar = f64;
    type State = Packed;
    type Workspace = Part;

    fn workspace(&self, state: &Packed, h: f64) -> Result<Part, StartError> {
        self.workspace_by(state, h, self.opened.usual())
    }

    fn advance(&self, state: &mut Packed, part: &mut Part) -> Result<(), StepError> {
        part.advance(self, state)?;
        Ok(())
    }

    fn attempt(&self, state: &Packed, h: f64) -> Option<Packed> {
        let Some(attempt) = &self.opened.functions.attempt else {
            let mut moving = *state;
            let mut part = self.workspace(state, h).ok()?;
            self.advance(&mut moving, &mut part).ok()?;
            return Some(moving);
        };
        let made = run(attempt, &mut self.places(state, h));
        made.ok().as_ref().and_then(Packed::of)
    }

    fn node(state: &Packed) -> u64 {
        state.node
    }

    fn at_node(state: Packed, node: u64) -> Packed {
        state.counted(node)
    }
}

impl Reversible for Model {}
