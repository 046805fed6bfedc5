//! Random tapes, run one by one and side by side, against their steps computed one after the other: the same bits.

use clebsch_program::{Function, Machine, Recording, Scalar, Step, Tape, Test, WIDTH};

/// Random tapes.
const TAPES: u64 = 400;

/// Marsaglia's xorshift.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// Plain numbers, zeros of both signs, large, small, infinite ones and NaN.
    fn number(&mut self) -> f64 {
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

const FUNCTIONS: [Function; 9] = [
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

const INPUTS: usize = 5;

/// A function that is taken as a whole: sums of neighbours.
fn turned(sizes: &[usize], inputs: &[f64], outputs: &mut [f64]) {
    for i in 0..sizes[0] {
        outputs[i] = inputs[i] + inputs[(i + 1) % sizes[0]];
    }
}

fn random_tape(random: &mut Random) -> Tape {
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
    let (a, b) = (all[random.below(all.len())], all[random.below(all.len())]);
    let test = match random.below(4) {
        0 => Test::AtMost(a, b),
        1 => Test::Less(a, b),
        2 => Test::Equal(a, b),
        _ => Test::Finite(a),
    };
    recording.guard(test, random.below(2) == 0);
    let outputs = (0..4).map(|_| all[random.below(all.len())]).collect();
    recording.tape(outputs)
}

/// The outputs, and whether the decision comes out as recorded.
fn computed(tape: &Tape, inputs: &[f64]) -> (Vec<f64>, bool) {
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

fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

#[test]
fn a_machine_gives_the_bits_of_its_tape_alone_and_side_by_side() {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let (mut held, mut failed) = (0, 0);
    for _ in 0..TAPES {
        let tape = random_tape(&mut random);
        let machine = Machine::new(&tape, INPUTS);
        let (mut one, mut wide) = (machine.frame::<1>(), machine.frame::<WIDTH>());
        let mut all_hold = true;
        let mut wanted = Vec::new();
        for lane in 0..WIDTH {
            let inputs: Vec<f64> = (0..INPUTS).map(|_| random.number()).collect();
            for (i, x) in inputs.iter().enumerate() {
                one.inputs()[i] = [*x];
                wide.inputs()[i][lane] = *x;
            }
            let (outputs, holds) = computed(&tape, &inputs);
            assert_eq!(machine.run(&mut one), holds);
            let found: Vec<f64> = machine.gives(&one, 0).collect();
            let agree = found.iter().zip(&outputs).all(|(a, b)| same(*a, *b));
            assert!(agree, "{found:?} for {outputs:?} of {tape:?}");
            all_hold &= holds;
            held += usize::from(holds);
            failed += usize::from(!holds);
            wanted.push(outputs);
        }
        assert_eq!(machine.run_wide(&mut wide), all_hold);
        for (lane, wanted) in wanted.iter().enumerate() {
            let agree = machine
                .gives(&wide, lane)
                .zip(wanted)
                .all(|(a, b)| same(a, *b));
            assert!(agree, "lane {lane} of {tape:?}");
        }
    }
    // Decisions of both kinds are met.
    assert!(held > 1000 && failed > 1000, "{held} held, {failed} failed");
}

#[test]
fn equal_steps_are_one_and_no_bit_is_simplified_away() {
    let mut recording = Recording::default();
    let x = recording.step(Step::Input(0));
    let (zero, one) = (recording.double(0.0), recording.double(1.0));
    assert_eq!(recording.step(Step::Mul(one, x)), x);
    assert_eq!(recording.step(Step::Div(x, one)), x);
    let twice = recording.step(Step::Add(x, x));
    assert_eq!(recording.step(Step::Add(x, x)), twice);
    // -0 + 0 is 0, and 0 times NaN is NaN.
    assert_ne!(recording.step(Step::Add(x, zero)), x);
    assert_ne!(recording.step(Step::Mul(x, zero)), zero);
    let half = recording.double(0.5);
    let sum = recording.step(Step::Add(half, half));
    assert_eq!(recording.constant(sum), Some(1.0));
}
