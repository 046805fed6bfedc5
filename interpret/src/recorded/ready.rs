//! A tape with its registers, ready to run. Numbers that depend only on the model and the step size are computed once.

use super::load;
use crate::listing::{Section, numbered};
use clebsch_program::{Frame, Machine, Part, Tape};
use std::sync::Arc;

/// A tape with its registers. Copies share the operations and their native code.
#[derive(Clone, Debug)]
pub struct Ready {
    /// Computes the first inputs of `machine` from the steady numbers.
    steady: Arc<Machine>,
    machine: Arc<Machine>,
    frame: Frame<1>,
    /// The number of first inputs.
    given: usize,
}

impl Ready {
    /// The tape with this number of inputs. The first `steady` inputs are the same in all runs.
    pub fn new(tape: &Tape, inputs: usize, steady: usize) -> Self {
        let whole = Part {
            outputs: tape.outputs.clone(),
            guards: tape.guards.clone(),
        };
        let (given, tapes) = tape.behind(steady, &[&whole]);
        let late = tapes.first().unwrap_or(tape);
        let machine = Arc::new(Machine::new(late, given.len() + inputs - steady));
        let count = given.len();
        let before = tape.part(Part {
            outputs: given,
            guards: Vec::new(),
        });
        Ready {
            steady: Arc::new(Machine::new(&before, steady)),
            frame: machine.frame(),
            machine,
            given: count,
        }
    }

    /// Sets the steady numbers. Returns nothing if there are too few.
    pub fn begin(&mut self, steady: &[f64]) -> Option<()> {
        let mut frame = self.steady.frame();
        load(frame.inputs(), steady.get(..self.steady.inputs())?)?;
        self.steady.run(&mut frame);
        let own = self.frame.inputs().get_mut(..self.given)?;
        for (slot, x) in own.iter_mut().zip(self.steady.gives(&frame, 0)) {
            *slot = [x];
        }
        Some(())
    }

    /// The number of inputs of a run.
    pub fn inputs(&self) -> usize {
        self.machine.inputs() - self.given
    }

    /// The number of outputs.
    pub fn outputs(&self) -> usize {
        self.machine.outputs()
    }

    /// The registers of the inputs of a run, followed by other registers.
    pub fn registers(&mut self) -> &mut [[f64; 1]] {
        self.frame
            .inputs()
            .get_mut(self.given..)
            .unwrap_or_default()
    }

    /// Computes on the inputs in the registers. Returns false if a decision differs from the recorded one.
    pub fn run(&mut self) -> bool {
        self.machine.run(&mut self.frame)
    }

    /// Computes on these inputs. Returns false if a decision differs from the recorded one, or inputs are missing.
    pub fn computes(&mut self, inputs: &[f64]) -> bool {
        let count = self.inputs();
        let given = inputs.get(..count);
        given.is_some_and(|given| load(self.registers(), given).is_some()) && self.run()
    }

    /// The outputs of the last run.
    pub fn gives(&self) -> impl Iterator<Item = f64> + Clone + '_ {
        self.machine.gives(&self.frame, 0)
    }

    /// The operations of a run.
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// A section for the operations that are computed once, if there are any, and a section for each run. `names` are the
    /// names of the steady numbers.
    pub fn sections(
        &self,
        title: &str,
        names: &[String],
        inputs: &[String],
        outputs: &[String],
    ) -> Vec<Section> {
        let mut steady = numbered("steady", self.given);
        for (name, register) in steady.iter_mut().zip(self.steady.results()) {
            // A number of the model itself keeps its name.
            if let Some(own) = names.get(*register as usize) {
                name.clone_from(own);
            }
        }
        let once = format!("{title}, once for all steps");
        let once = Section::of(&once, &self.steady, names, &steady);
        let mut all = steady;
        all.extend_from_slice(inputs);
        let run = Section::of(title, &self.machine, &all, outputs);
        let has_work = self.steady.operations() > 0;
        has_work.then_some(once).into_iter().chain([run]).collect()
    }
}
