//! A recorded evaluation: scalar operations in single assignment without duplicates, and the decisions of the recording.

use rustc_hash::FxHashMap;

/// A function that the tape calls as a unit, such as an elimination with pivoting. Arguments: the sizes it needs, the inputs, and
/// the outputs to fill.
pub type Whole = fn(&[usize], &[f64], &mut [f64]);

/// A call of a whole function.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Call {
    /// The index of the function in the recording.
    pub function: usize,
    /// The sizes that the function needs.
    pub sizes: Vec<usize>,
    /// Its inputs.
    pub inputs: Vec<Scalar>,
    /// The number of outputs.
    pub outputs: usize,
}

/// A number of a tape: the step that computes it.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Scalar(u32);

impl Scalar {
    /// The index of its step.
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
    /// A power of two near `1 / sqrt(|x|)`; 1 if `x` is zero, subnormal or not finite.
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

/// A step of a tape. Constants are compared by their bits, and equal steps are merged.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Step {
    /// An input, by its index among all numbers of all inputs.
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
    /// The second operand if the first is positive, otherwise zero. NaN is not positive.
    WherePositive(Scalar, Scalar),
    /// An output of a call, by the indices of call and output.
    Output(u32, u32),
}

impl Step {
    /// The numbers that it uses, except for an output, which uses the inputs of its call.
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

/// A test of numbers that determined a decision.
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
    /// The numbers that it tests.
    #[must_use]
    pub fn uses(self) -> [Option<Scalar>; 2] {
        match self {
            Test::Finite(a) => [Some(a), None],
            Test::AtMost(a, b) | Test::Less(a, b) | Test::Equal(a, b) => [Some(a), Some(b)],
        }
    }
}

/// A recorded decision. The tape computes the recorded function as long as every test has the recorded outcome.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Guard {
    /// The test.
    pub test: Test,
    /// The outcome.
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
    /// The results, with each array column-major.
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
    /// The decisions that the numbers depend on.
    pub guards: Vec<Guard>,
}

impl Tape {
    /// A part as a separate tape.
    #[must_use]
    pub fn part(&self, part: Part) -> Tape {
        Tape {
            guards: part.guards,
            outputs: part.outputs,
            ..self.clone()
        }
    }

    /// Splits off parts that run often with new values for the inputs from `late` on. Returns the numbers that the parts take from
    /// all other inputs, and a tape for each part. Its first inputs are these numbers, followed by the late inputs.
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
    asked: FxHashMap<Test, bool>,
}

/// A tape under construction.
///
/// Steps are simplified only if every bit stays the same. Constant operations are folded, a factor or divisor of 1 is dropped, and
/// operands of sums and products are put in canonical order. `x + 0` and `0 x` are kept.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    steps: Vec<Step>,
    guards: Vec<Guard>,
    calls: Vec<Call>,
    functions: Vec<Whole>,
    called: FxHashMap<Call, u32>,
    known: FxHashMap<Step, Scalar>,
    asked: FxHashMap<Test, bool>,
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

    /// The number of steps.
    #[must_use]
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// The steps so far.
    #[must_use]
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// The number of decisions.
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

    /// The outputs of a whole function.
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
        // There are no more calls than steps.
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

    /// Starts a separate part: sets aside the decisions so far, which [`Recording::end_aside`] restores.
    #[must_use]
    pub fn begin_aside(&mut self) -> Decisions {
        Decisions {
            guards: std::mem::take(&mut self.guards),
            asked: std::mem::take(&mut self.asked),
        }
    }

    /// Ends a separate part; returns its decisions.
    pub fn end_aside(&mut self, before: Decisions) -> Vec<Guard> {
        self.asked = before.asked;
        std::mem::replace(&mut self.guards, before.guards)
    }

    /// Records a decision. A test that was already decided is not recorded again.
    pub fn guard(&mut self, test: Test, holds: bool) {
        if self.asked.insert(test, holds).is_none() {
            self.guards.push(Guard { test, holds });
        }
    }

    fn kept(&mut self, step: Step) -> Scalar {
        if let Some(known) = self.known.get(&step) {
            return *known;
        }
        // A tape of four billion steps would need 64 GiB; recordings are abandoned long before.
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
