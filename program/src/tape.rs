//! A recorded evaluation: scalar operations in single assignment, equal ones computed once, and the decisions that were
//! taken on the way.

use std::collections::HashMap;

/// A function of numbers that is taken as a whole, such as an elimination with pivots: of whole numbers that say how large
/// it is, and the inputs; it fills the outputs.
pub type Whole = fn(&[usize], &[f64], &mut [f64]);

/// A function taken as a whole, called.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Call {
    /// Its number among those that the recording has met.
    pub function: usize,
    /// How large it is.
    pub sizes: Vec<usize>,
    /// Its inputs.
    pub inputs: Vec<Scalar>,
    /// How many numbers it gives.
    pub outputs: usize,
}

/// A number of a tape: the step that computes it.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Scalar(u32);

impl Scalar {
    /// The number of its step.
    #[must_use]
    pub fn step(self) -> usize {
        self.0 as usize
    }
}

/// A function of one number. Angles are in radians.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Function {
    /// The square root.
    Sqrt,
    /// The exponential.
    Exp,
    /// The natural logarithm.
    Log,
    /// The sine.
    Sin,
    /// The cosine.
    Cos,
    /// The hyperbolic sine.
    Sinh,
    /// The hyperbolic cosine.
    Cosh,
    /// The hyperbolic tangent.
    Tanh,
    /// A power of two near `1 / sqrt(|x|)`; 1 for what is zero, subnormal or not finite.
    Balance,
}

impl Function {
    /// The value of the standard library's function.
    #[must_use]
    pub fn of(self, x: f64) -> f64 {
        match self {
            Function::Sqrt => x.sqrt(),
            Function::Exp => x.exp(),
            Function::Log => x.ln(),
            Function::Sin => x.sin(),
            Function::Cos => x.cos(),
            Function::Sinh => x.sinh(),
            Function::Cosh => x.cosh(),
            Function::Tanh => x.tanh(),
            Function::Balance if x.is_normal() => {
                let exponent = (x.abs().to_bits() >> 52) as i32 - 1023;
                f64::from((-exponent).div_euclid(2)).exp2()
            }
            Function::Balance => 1.0,
        }
    }
}

/// A step of a tape. Constants are kept by their bits: equal steps are one.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Step {
    /// An input by its place among all numbers of all inputs.
    Input(u32),
    /// A constant of binary64, by its bits.
    Double(u64),
    /// The sum.
    Add(Scalar, Scalar),
    /// The difference.
    Sub(Scalar, Scalar),
    /// The product.
    Mul(Scalar, Scalar),
    /// The quotient.
    Div(Scalar, Scalar),
    /// The negative.
    Neg(Scalar),
    /// A function of one number.
    Function(Function, Scalar),
    /// The second where the first is positive, else zero. NaN is not positive.
    WherePositive(Scalar, Scalar),
    /// An output of a call, by the numbers of both.
    Output(u32, u32),
}

impl Step {
    /// The numbers that it uses. An output uses the inputs of its call.
    #[must_use]
    pub fn uses(self) -> [Option<Scalar>; 2] {
        match self {
            Step::Input(_) | Step::Double(_) | Step::Output(..) => [None, None],
            Step::Neg(a) | Step::Function(_, a) => [Some(a), None],
            Step::Add(a, b)
            | Step::Sub(a, b)
            | Step::Mul(a, b)
            | Step::Div(a, b)
            | Step::WherePositive(a, b) => [Some(a), Some(b)],
        }
    }
}

/// A test of numbers that an evaluation decided by.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Test {
    /// Whether one number is at most another; false for NaN.
    AtMost(Scalar, Scalar),
    /// Whether one number is less than another; false for NaN.
    Less(Scalar, Scalar),
    /// Whether a number is finite.
    Finite(Scalar),
    /// Whether two numbers are equal.
    Equal(Scalar, Scalar),
}

impl Test {
    /// The numbers that it looks at.
    #[must_use]
    pub fn uses(self) -> [Option<Scalar>; 2] {
        match self {
            Test::Finite(a) => [Some(a), None],
            Test::AtMost(a, b) | Test::Less(a, b) | Test::Equal(a, b) => [Some(a), Some(b)],
        }
    }
}

/// A decision that was taken. A tape computes the recorded function as long as every test comes out as it did.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Guard {
    /// The test.
    pub test: Test,
    /// The answer.
    pub holds: bool,
}

/// Scalar operations in single assignment.
#[derive(Clone, Debug, Default)]
pub struct Tape {
    /// The steps, each after those that it uses.
    pub steps: Vec<Step>,
    /// The decisions.
    pub guards: Vec<Guard>,
    /// The calls, in the order of their first outputs.
    pub calls: Vec<Call>,
    /// The functions that are called.
    pub functions: Vec<Whole>,
    /// The results, each array column after column.
    pub outputs: Vec<Scalar>,
}

impl Tape {
    /// The numbers that a step uses.
    pub fn uses(&self, step: Step) -> impl Iterator<Item = Scalar> + '_ {
        let called = match step {
            Step::Output(call, _) => self.calls.get(call as usize),
            _ => None,
        };
        let inputs = called.map_or(&[][..], |call| &call.inputs);
        step.uses()
            .into_iter()
            .flatten()
            .chain(inputs.iter().copied())
    }
}

/// A part of a tape.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Part {
    /// The numbers that it computes.
    pub outputs: Vec<Scalar>,
    /// The decisions on which they rely.
    pub guards: Vec<Guard>,
}

impl Tape {
    /// A part as a tape of its own.
    #[must_use]
    pub fn part(&self, part: Part) -> Tape {
        Tape {
            guards: part.guards,
            outputs: part.outputs,
            ..self.clone()
        }
    }

    /// Parts that are computed often with other numbers for the inputs from `late` on. Gives the numbers that they take from
    /// all other inputs, and a tape for each part: its first inputs are these numbers, the next ones the late inputs.
    #[must_use]
    pub fn behind(&self, late: usize, parts: &[&Part]) -> (Vec<Scalar>, Vec<Tape>) {
        let mut is_late: Vec<bool> = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            let by_input = matches!(step, Step::Input(place) if *place as usize >= late);
            let by_use = self.uses(*step).any(|used| is_late[used.step()]);
            is_late.push(by_input || by_use);
        }
        let mut met = vec![false; self.steps.len()];
        let tests = parts.iter().flat_map(|part| &part.guards);
        let mut next: Vec<Scalar> = tests.flat_map(|g| g.test.uses()).flatten().collect();
        next.extend(parts.iter().flat_map(|part| &part.outputs));
        let mut given = Vec::new();
        while let Some(at) = next.pop() {
            if std::mem::replace(&mut met[at.step()], true) {
                continue;
            }
            let step = self.steps[at.step()];
            match (is_late[at.step()], step) {
                (true, _) => next.extend(self.uses(step)),
                (false, Step::Double(_)) => {}
                (false, _) => given.push(at),
            }
        }
        given.sort_unstable();
        let mut steps = self.steps.clone();
        let place = |k: usize| u32::try_from(k).unwrap_or(u32::MAX);
        for step in &mut steps {
            if let Step::Input(k) = step {
                *k = place((given.len() + *k as usize).saturating_sub(late));
            }
        }
        for (k, at) in given.iter().enumerate() {
            steps[at.step()] = Step::Input(place(k));
        }
        let tape = |part: &&Part| Tape {
            steps: steps.clone(),
            guards: part.guards.clone(),
            calls: self.calls.clone(),
            functions: self.functions.clone(),
            outputs: part.outputs.clone(),
        };
        let tapes = parts.iter().map(tape).collect();
        (given, tapes)
    }
}

impl PartialEq for Tape {
    fn eq(&self, other: &Self) -> bool {
        let functions = self.functions.iter().zip(&other.functions);
        let same_functions = self.functions.len() == other.functions.len()
            && functions
                .into_iter()
                .all(|(a, b)| core::ptr::fn_addr_eq(*a, *b));
        same_functions
            && self.steps == other.steps
            && self.guards == other.guards
            && self.calls == other.calls
            && self.outputs == other.outputs
    }
}

/// The decisions of a recording.
#[derive(Clone, Debug, Default)]
pub struct Decisions {
    guards: Vec<Guard>,
    asked: HashMap<Test, bool>,
}

/// A tape that is being recorded.
///
/// Steps are simplified only where every bit stays: a constant operation is computed, a factor or divisor 1 is left
/// out, sums and products have their operands in one order. `x + 0` and `0 x` are kept.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    steps: Vec<Step>,
    guards: Vec<Guard>,
    calls: Vec<Call>,
    functions: Vec<Whole>,
    called: HashMap<Call, u32>,
    known: HashMap<Step, Scalar>,
    asked: HashMap<Test, bool>,
}

impl Recording {
    /// The tape with these results.
    #[must_use]
    pub fn tape(self, outputs: Vec<Scalar>) -> Tape {
        Tape {
            steps: self.steps,
            guards: self.guards,
            calls: self.calls,
            functions: self.functions,
            outputs,
        }
    }

    /// How many steps there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// How many decisions are noted.
    #[must_use]
    pub fn guards(&self) -> usize {
        self.guards.len()
    }

    /// Whether nothing is recorded yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// The number that a step computes.
    pub fn step(&mut self, step: Step) -> Scalar {
        match self.simpler(step) {
            Ok(known) => known,
            Err(step) => self.kept(step),
        }
    }

    /// A constant.
    pub fn double(&mut self, x: f64) -> Scalar {
        self.kept(Step::Double(x.to_bits()))
    }

    /// The outputs of a function that is taken as a whole.
    pub fn call(
        &mut self,
        function: Whole,
        sizes: &[usize],
        inputs: Vec<Scalar>,
        outputs: usize,
    ) -> Vec<Scalar> {
        let mut known = self.functions.iter();
        let known = known.position(|other| core::ptr::fn_addr_eq(*other, function));
        let function = known.unwrap_or_else(|| {
            self.functions.push(function);
            self.functions.len() - 1
        });
        let call = Call {
            function,
            sizes: sizes.to_vec(),
            inputs,
            outputs,
        };
        // As few as steps.
        let next = u32::try_from(self.calls.len()).unwrap_or(u32::MAX);
        let at = *self.called.entry(call.clone()).or_insert(next);
        if at == next {
            self.calls.push(call);
        }
        let mut output =
            |k: usize| self.kept(Step::Output(at, u32::try_from(k).unwrap_or(u32::MAX)));
        (0..outputs).map(&mut output).collect()
    }

    /// The value of a constant.
    #[must_use]
    pub fn constant(&self, of: Scalar) -> Option<f64> {
        match self.steps.get(of.step()) {
            Some(Step::Double(bits)) => Some(f64::from_bits(*bits)),
            _ => None,
        }
    }

    /// Begins a part aside: the decisions so far are taken out, and given back with [`Recording::end_aside`].
    #[must_use]
    pub fn begin_aside(&mut self) -> Decisions {
        Decisions {
            guards: std::mem::take(&mut self.guards),
            asked: std::mem::take(&mut self.asked),
        }
    }

    /// Ends a part aside; gives the decisions in it.
    pub fn end_aside(&mut self, before: Decisions) -> Vec<Guard> {
        self.asked = before.asked;
        std::mem::replace(&mut self.guards, before.guards)
    }

    /// Notes a decision. A test that was asked before is not noted again.
    pub fn guard(&mut self, test: Test, holds: bool) {
        if self.asked.insert(test, holds).is_none() {
            self.guards.push(Guard { test, holds });
        }
    }

    fn kept(&mut self, step: Step) -> Scalar {
        if let Some(known) = self.known.get(&step) {
            return *known;
        }
        // A tape of four billion steps would need 64 GiB: recordings are given up long before.
        let scalar = Scalar(u32::try_from(self.steps.len()).unwrap_or(u32::MAX));
        self.steps.push(step);
        self.known.insert(step, scalar);
        scalar
    }

    fn simpler(&mut self, step: Step) -> Result<Scalar, Step> {
        let value = |x: Scalar| self.constant(x);
        let is_one = |x: Scalar| value(x) == Some(1.0);
        let computed = match step {
            Step::Add(a, b) => value(a).zip(value(b)).map(|(a, b)| a + b),
            Step::Sub(a, b) => value(a).zip(value(b)).map(|(a, b)| a - b),
            Step::Mul(a, b) => value(a).zip(value(b)).map(|(a, b)| a * b),
            Step::Div(a, b) => value(a).zip(value(b)).map(|(a, b)| a / b),
            Step::Neg(a) => value(a).map(|a| -a),
            Step::Function(f, a) => value(a).map(|a| f.of(a)),
            Step::WherePositive(a, b) => match value(a) {
                Some(a) if a > 0.0 => return Ok(b),
                Some(_) => Some(0.0),
                None => None,
            },
            Step::Input(_) | Step::Double(_) | Step::Output(..) => None,
        };
        if let Some(x) = computed {
            return Ok(self.double(x));
        }
        match step {
            Step::Mul(a, b) if is_one(a) => Ok(b),
            Step::Mul(a, b) | Step::Div(a, b) if is_one(b) => Ok(a),
            Step::Add(a, b) if b < a => Err(Step::Add(b, a)),
            Step::Mul(a, b) if b < a => Err(Step::Mul(b, a)),
            Step::Neg(a) => match self.steps.get(a.step()) {
                Some(Step::Neg(inner)) => Ok(*inner),
                _ => Err(step),
            },
            _ => Err(step),
        }
    }
}
