//! The equations of a step as tapes: the functions that Newton's method evaluates at a trial, as functions of the
//! numbers of the step and of the trial.

use super::ready::Ready;
use crate::code::Places;
use crate::listing::{Section, numbered};
use crate::map_scalar::fill;
use clebsch_program::{Part, Scalar, Tape};

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

/// The equations at a node.
#[derive(Clone, Debug)]
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

    /// The equations, and the numbers that the step must compute for them. The first `steady` inputs of the step are the
    /// same in all steps.
    pub fn equations(
        self,
        tape: &Tape,
        solution: usize,
        steady: usize,
    ) -> (Equations, Vec<Scalar>) {
        let recorded: Vec<&Part> = self.parts.iter().flatten().collect();
        let (given, tapes) = tape.behind(self.inputs, &recorded);
        let inputs = given.len() + solution;
        let mut tapes = tapes.iter().map(|tape| Ready::new(tape, inputs, 0));
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
            around: Ready::new(&around, self.inputs, steady),
            computed: self.computed,
            places: self.places,
            own: Vec::new(),
            filled: false,
        };
        (equations, given)
    }
}

impl Equations {
    /// The functions as text.
    pub fn sections(&self) -> Vec<Section> {
        let titles = [
            "residual of the equations at a trial",
            "tangent of the equations at a trial",
            "residual at rest",
            "test of convexity at a trial",
            "residual far from the solution",
        ];
        let parts = self.parts.iter().zip(titles);
        let recorded = parts.filter_map(|(part, title)| Some((part.as_ref()?, title)));
        let told = recorded.map(|(part, title)| {
            let mut inputs = numbered("given", self.given);
            inputs.extend(numbered("velocity", part.inputs() - self.given));
            let outputs = numbered("result", part.outputs());
            Section::of(title, part.machine(), &inputs, &outputs)
        });
        told.collect()
    }

    /// Sets the numbers of the model and of the step size. Returns nothing if there are too few.
    pub fn begin(&mut self, steady: &[f64]) -> Option<()> {
        self.around.begin(steady)
    }

    /// Sets the numbers of a step, and the numbers that the step has computed for the equations.
    pub fn begin_step(&mut self, own: &[f64], given: impl Iterator<Item = f64> + Clone) {
        self.own.clear();
        self.own.extend_from_slice(own);
        self.filled = false;
        for part in self.parts.iter_mut().flatten() {
            for (slot, x) in part.registers().iter_mut().zip(given.clone()) {
                *slot = [x];
            }
        }
    }

    fn at(&mut self, wanted: NewtonFunction, trial: &[f64]) -> Option<impl Iterator<Item = f64>> {
        let part = self.parts.get_mut(wanted as usize)?.as_mut()?;
        let inputs = part.registers().get_mut(self.given..)?;
        for (at, x) in self.of_trial.iter().zip(trial) {
            *inputs.get_mut(*at)? = [*x];
        }
        part.run().then(|| part.gives())
    }

    fn places(&mut self) -> &mut Places<f64> {
        if !self.filled {
            self.filled = true;
            if self.around.computes(&self.own) {
                let mut given = self.around.gives();
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
