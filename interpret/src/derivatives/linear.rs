//! A recorded function with its derivatives. Takes inputs, and weights or directions; gives derivatives by tapes.

use crate::recorded::{Ready, WithDerivatives};
use clebsch_program::Tape;

/// A function as a tape, with tapes of its derivatives, which are made at first use.
#[derive(Debug)]
pub struct Linear {
    tape: Tape,
    /// The number of inputs, and how many of them are the same in all evaluations.
    inputs: usize,
    steady: Vec<f64>,
    /// The inputs of the recorded evaluation.
    recorded: Vec<f64>,
    pub serves_others: bool,
    value: Option<Ready>,
    adjoint: Option<Ready>,
    tangent: Option<Ready>,
    second: Option<Ready>,
}

impl Linear {
    /// A recording whose first `steady` inputs are the same in all evaluations.
    pub fn new(recording: WithDerivatives, steady: usize) -> Self {
        let WithDerivatives {
            tape,
            inputs,
            serves_others,
        } = recording;
        Linear {
            tape,
            inputs: inputs.len(),
            steady: inputs.get(..steady).unwrap_or_default().to_vec(),
            recorded: inputs,
            serves_others,
            value: None,
            adjoint: None,
            tangent: None,
            second: None,
        }
    }

    /// The number of outputs.
    pub fn outputs(&self) -> usize {
        self.tape.outputs.len()
    }

    /// The number of inputs that change.
    pub fn late(&self) -> usize {
        self.inputs - self.steady.len()
    }

    /// The changing inputs of the recorded evaluation.
    pub fn recorded(&self) -> &[f64] {
        self.recorded.get(self.steady.len()..).unwrap_or_default()
    }

    /// The outputs. Returns nothing if a decision differs from the recorded one.
    pub fn value(&mut self, late: &[f64]) -> Option<Vec<f64>> {
        let made = |tape: &Tape, inputs, _| Some((tape.clone(), inputs));
        let ready = ready(
            &mut self.value,
            (&self.tape, self.inputs),
            &self.steady,
            made,
        )?;
        ready.computes(late).then(|| ready.gives().collect())
    }

    /// The sum of the derivatives of the outputs with these weights, with respect to all inputs, the steady ones first.
    /// Returns nothing if a decision differs from the recorded one.
    pub fn pull(&mut self, late: &[f64], weights: &[f64]) -> Option<Vec<f64>> {
        let made = |tape: &Tape, inputs, outputs| Some((tape.adjoint(inputs)?, inputs + outputs));
        let of = (&self.tape, self.inputs);
        let ready = ready(&mut self.adjoint, of, &self.steady, made)?;
        let all: Vec<f64> = late.iter().chain(weights).copied().collect();
        ready.computes(&all).then(|| ready.gives().collect())
    }

    /// The derivative of the outputs along a direction of all inputs, the steady ones first. Returns nothing if a decision
    /// differs from the recorded one.
    pub fn push(&mut self, late: &[f64], direction: &[f64]) -> Option<Vec<f64>> {
        let made = |tape: &Tape, inputs, _| Some((tape.tangent(inputs)?, 2 * inputs));
        let of = (&self.tape, self.inputs);
        let outputs = self.outputs();
        let ready = ready(&mut self.tangent, of, &self.steady, made)?;
        let all: Vec<f64> = late.iter().chain(direction).copied().collect();
        ready
            .computes(&all)
            .then(|| ready.gives().skip(outputs).collect())
    }

    /// The derivative of [`Linear::pull`] along a direction of the changing inputs from an index on. Returns nothing if a
    /// decision differs from the recorded one.
    pub fn bend(
        &mut self,
        late: &[f64],
        weights: &[f64],
        (first, direction): (usize, &[f64]),
    ) -> Option<Vec<f64>> {
        let made = |tape: &Tape, inputs: usize, outputs: usize| {
            let pulled = tape.adjoint(inputs)?;
            Some((pulled.tangent(inputs + outputs)?, 2 * (inputs + outputs)))
        };
        let (inputs, steady) = (self.inputs, self.steady.len());
        let of = (&self.tape, inputs);
        let ready = ready(&mut self.second, of, &self.steady, made)?;
        let mut along = vec![0.0; inputs + weights.len()];
        let from = steady + first;
        along
            .get_mut(from..from + direction.len())?
            .copy_from_slice(direction);
        let all: Vec<f64> = late.iter().chain(weights).chain(&along).copied().collect();
        ready
            .computes(&all)
            .then(|| ready.gives().skip(inputs).collect())
    }

    /// The derivative of the outputs along a direction of the changing inputs from `first` on; the others stay.
    pub fn push_from(&mut self, late: &[f64], first: usize, direction: &[f64]) -> Option<Vec<f64>> {
        let mut all = vec![0.0; self.inputs];
        let from = self.steady.len() + first;
        all.get_mut(from..from + direction.len())?
            .copy_from_slice(direction);
        self.push(late, &all)
    }

    /// The derivatives of the outputs along each of several directions of the first changing inputs.
    pub fn push_each(&mut self, late: &[f64], directions: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
        let each = directions.iter().map(|x| self.push_from(late, 0, x));
        each.collect()
    }
}

/// The tape that `made` gives, ready to run.
fn ready<'a>(
    slot: &'a mut Option<Ready>,
    (tape, inputs): (&Tape, usize),
    steady: &[f64],
    made: impl FnOnce(&Tape, usize, usize) -> Option<(Tape, usize)>,
) -> Option<&'a mut Ready> {
    if slot.is_none() {
        let (tape, inputs) = made(tape, inputs, tape.outputs.len())?;
        let mut ready = Ready::new(&tape, inputs, steady.len());
        ready.begin(steady)?;
        *slot = Some(ready);
    }
    slot.as_mut()
}
