//! The equations of a step as tapes: the functions that Newton's method evaluates at a trial, as functions of the
//! numbers of the step and of the trial.

use super::load;
use crate::code::Places;
use crate::map_scalar::fill;
use clebsch_program::{Frame, Machine, Part, Scalar, Tape};

/// The functions that Newton's method evaluates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NewtonFunction {
    /// The residual at a trial, then the whole trial if a part of it is searched for.
    Residual,
    /// The tangent row by row, then its factor.
    Tangent,
    /// The residual of all equations at rest.
    AtRest,
    /// The tape returns no numbers: the action is convex as long as every decision comes out as recorded.
    Convex,
    /// The residual alone, which tests of a solution evaluate far from it.
    Alone,
}

impl NewtonFunction {
    /// All functions.
    pub const ALL: [Self; 5] = [
        Self::Residual,
        Self::Tangent,
        Self::AtRest,
        Self::Convex,
        Self::Alone,
    ];
}

/// A tape with its registers.
#[derive(Debug)]
struct Ready {
    machine: Machine,
    frame: Frame<1>,
}

impl Ready {
    fn new(tape: &Tape, inputs: usize) -> Self {
        let machine = Machine::new(tape, inputs);
        let frame = machine.frame();
        Ready { machine, frame }
    }
}

/// The equations at a node.
#[derive(Debug)]
pub struct Equations {
    parts: [Option<Ready>; 5],
    /// The number of inputs from the step.
    given: usize,
    /// Which numbers of the solution a trial has.
    of_trial: Vec<usize>,
    /// If a function is not recorded, computes the values of the surrounding places from the numbers of the step.
    around: Ready,
    computed: Vec<usize>,
    places: Places<f64>,
    own: Vec<f64>,
    /// Whether the places have the values of this node.
    filled: bool,
}

/// The equations within a recording.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// The functions, in the order of [`NewtonFunction::ALL`].
    pub parts: [Option<Part>; 5],
    /// The number of inputs that the step had before.
    pub inputs: usize,
    /// Which numbers of the solution a trial has.
    pub of_trial: Vec<usize>,
    /// The places, for functions without a tape.
    pub places: Places<f64>,
    /// The places whose numbers are computed.
    pub computed: Vec<usize>,
    /// These numbers.
    pub around: Vec<Scalar>,
}

impl Recorded {
    /// Whether two recordings agree. Counts are not compared.
    pub fn agrees(&self, other: &Recorded) -> bool {
        self.parts == other.parts
            && self.inputs == other.inputs
            && self.of_trial == other.of_trial
            && self.around == other.around
    }

    /// The equations, and the numbers that the step must compute for them.
    pub fn equations(self, tape: &Tape, solution: usize) -> (Equations, Vec<Scalar>) {
        let recorded: Vec<&Part> = self.parts.iter().flatten().collect();
        let (given, tapes) = tape.behind(self.inputs, &recorded);
        let inputs = given.len() + solution;
        let mut tapes = tapes.iter().map(|tape| Ready::new(tape, inputs));
        let parts = self.parts.each_ref().map(|part| match part {
            Some(_) => tapes.next(),
            None => None,
        });
        let around = tape.part(Part {
            outputs: self.around,
            guards: Vec::new(),
        });
        let equations = Equations {
            parts,
            given: given.len(),
            of_trial: self.of_trial,
            around: Ready::new(&around, self.inputs),
            computed: self.computed,
            places: self.places,
            own: Vec::new(),
            filled: false,
        };
        (equations, given)
    }
}

impl Equations {
    /// Sets the numbers of a step, and the numbers that the step has computed for the equations.
    pub fn begin(&mut self, own: &[f64], given: impl Iterator<Item = f64> + Clone) {
        self.own.clear();
        self.own.extend_from_slice(own);
        self.filled = false;
        for part in self.parts.iter_mut().flatten() {
            for (slot, x) in part.frame.inputs().iter_mut().zip(given.clone()) {
                *slot = [x];
            }
        }
    }

    fn at(&mut self, wanted: NewtonFunction, trial: &[f64]) -> Option<impl Iterator<Item = f64>> {
        let part = self.parts.get_mut(wanted as usize)?.as_mut()?;
        let inputs = part.frame.inputs().get_mut(self.given..)?;
        for (at, x) in self.of_trial.iter().zip(trial) {
            *inputs.get_mut(*at)? = [*x];
        }
        let Ready { machine, frame } = part;
        machine.run(frame).then(|| machine.gives(frame, 0))
    }

    fn places(&mut self) -> &mut Places<f64> {
        if !self.filled {
            self.filled = true;
            let Ready { machine, frame } = &mut self.around;
            let own = self.own.get(..machine.inputs()).unwrap_or_default();
            if load(frame.inputs(), own).is_some() && machine.run(frame) {
                let mut given = machine.gives(frame, 0);
                for at in &self.computed {
                    if let Some(value) = self.places.get_mut(*at) {
                        fill(value, &mut given);
                    }
                }
            }
        }
        &mut self.places
    }
}

/// The values around the equations of a step: tapes if the step is recorded, otherwise places.
pub enum EquationValues<'a> {
    /// Values at places.
    Places(&'a mut Places<f64>),
    /// Tapes.
    Tapes(&'a mut Equations),
}

impl EquationValues<'_> {
    /// Appends the numbers of a function at a trial. Returns false if no tape can compute it there.
    pub fn by_tape(
        &mut self,
        wanted: NewtonFunction,
        trial: &[f64],
        out: &mut impl Extend<f64>,
    ) -> bool {
        let EquationValues::Tapes(equations) = self else {
            return false;
        };
        let Some(numbers) = equations.at(wanted, trial) else {
            return false;
        };
        out.extend(numbers);
        true
    }

    /// The places with all values.
    pub fn all(&mut self) -> &mut Places<f64> {
        match self {
            EquationValues::Places(places) => places,
            EquationValues::Tapes(equations) => equations.places(),
        }
    }
}
