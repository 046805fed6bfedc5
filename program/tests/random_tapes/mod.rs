//! Random tapes, and the results of their steps by sequential evaluation.

use clebsch_program::{Function, Recording, Scalar, Step, Tape, Test};

/// Marsaglia's xorshift.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// Ordinary numbers, zeros of both signs, large, small and infinite numbers, and NaN.
    pub fn number(&mut self) -> f64 {
        let plain = (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
        match self.bits() % 40 {
            0 => 0.0,
            1 => -0.0,
            2 => f64::from_bits(self.bits() >> 12),
            3 => plain * 1e300,
            4 => f64::INFINITY,
            5 => f64::NAN,
            6 => 1.0,
            _ => plain,
        }
    }
}

/// All functions of one number.
pub const FUNCTIONS: [Function; 9] = [
    Function::Sqrt,
    Function::Exp,
    Function::Log,
    Function::Sin,
    Function::Cos,
    Function::Sinh,
    Function::Cosh,
    Function::Tanh,
    Function::Balance,
];

/// Number of inputs of a tape.
pub const INPUTS: usize = 5;

/// A whole function: sums of neighbours.
fn turned(sizes: &[usize], inputs: &[f64], outputs: &mut [f64]) {
    for i in 0..sizes[0] {
        outputs[i] = inputs[i] + inputs[(i + 1) % sizes[0]];
    }
}

/// A tape with every operation, calls, and up to three decisions.
pub fn random_tape(random: &mut Random) -> Tape {
    let mut recording = Recording::default();
    let mut all: Vec<Scalar> = Vec::new();
    for i in 0..INPUTS as u32 {
        all.push(recording.step(Step::Input(i)));
    }
    for _ in 0..3 {
        let x = random.number();
        all.push(recording.double(x));
    }
    for _ in 0..5 + random.below(60) {
        if random.below(16) == 0 {
            let inputs = (0..3).map(|_| all[random.below(all.len())]).collect();
            let outputs = recording.call(turned, &[3], inputs, 3);
            all.push(outputs[random.below(3)]);
            all.push(outputs[random.below(3)]);
        }
        let (a, b) = (all[random.below(all.len())], all[random.below(all.len())]);
        let step = match random.below(8) {
            0 | 1 => Step::Add(a, b),
            2 => Step::Sub(a, b),
            3 | 4 => Step::Mul(a, b),
            5 => Step::Div(a, b),
            6 => Step::WherePositive(a, b),
            _ if random.below(2) == 0 => Step::Neg(a),
            _ => Step::Function(FUNCTIONS[random.below(FUNCTIONS.len())], a),
        };
        all.push(recording.step(step));
    }
    for _ in 0..random.below(4) {
        let (a, b) = (all[random.below(all.len())], all[random.below(all.len())]);
        let test = match random.below(4) {
            0 => Test::AtMost(a, b),
            1 => Test::Less(a, b),
            2 => Test::Equal(a, b),
            _ => Test::Finite(a),
        };
        recording.guard(test, random.below(2) == 0);
    }
    let outputs = (0..4).map(|_| all[random.below(all.len())]).collect();
    recording.tape(outputs)
}

/// The outputs, and whether every decision has the recorded outcome.
pub fn computed(tape: &Tape, inputs: &[f64]) -> (Vec<f64>, bool) {
    let mut all: Vec<f64> = Vec::new();
    let called = |call: u32, output: u32, all: &[f64]| {
        let call = &tape.calls[call as usize];
        let inputs: Vec<f64> = call.inputs.iter().map(|x| all[x.step()]).collect();
        let mut outputs = vec![f64::NAN; call.outputs];
        tape.functions[call.function](&call.sizes, &inputs, &mut outputs);
        outputs[output as usize]
    };
    for step in &tape.steps {
        let of = |x: Scalar| all[x.step()];
        let x = match *step {
            Step::Input(i) => inputs[i as usize],
            Step::Double(bits) => f64::from_bits(bits),
            Step::Add(a, b) => of(a) + of(b),
            Step::Sub(a, b) => of(a) - of(b),
            Step::Mul(a, b) => of(a) * of(b),
            Step::Div(a, b) => of(a) / of(b),
            Step::Neg(a) => -of(a),
            Step::Function(f, a) => f.of(of(a)),
            Step::Output(call, output) => called(call, output, &all),
            Step::WherePositive(a, b) => {
                if of(a) > 0.0 {
                    of(b)
                } else {
                    0.0
                }
            }
        };
        all.push(x);
    }
    let of = |x: Scalar| all[x.step()];
    let holds = tape.guards.iter().all(|guard| {
        let found = match guard.test {
            Test::AtMost(a, b) => of(a) <= of(b),
            Test::Less(a, b) => of(a) < of(b),
            Test::Equal(a, b) => of(a) == of(b),
            Test::Finite(a) => of(a).is_finite(),
        };
        found == guard.holds
    });
    (tape.outputs.iter().map(|x| of(*x)).collect(), holds)
}

/// Whether two numbers have the same bits; all NaN count as equal.
pub fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}
