//! Tangents and adjoints of random tapes against dual numbers typed here.

#[allow(dead_code)] // Other tests use the remaining parts.
mod random_tapes;

use clebsch_program::{Function, Machine, Scalar, Step, Tape};
use random_tapes::{INPUTS, Random, random_tape};

/// The number of tapes that are compared.
const TAPES: usize = 300;

/// Larger numbers on a tape leave no digits to compare.
const LARGEST: f64 = 1e4;

/// Rounding of up to a hundred operations on numbers of up to `LARGEST`.
const NEAR: f64 = 1e-9;

/// A value and its derivative.
type Dual = [f64; 2];

fn function(f: Function, [x, dx]: Dual) -> Dual {
    let slope = match f {
        Function::Sqrt => 0.5 / x.sqrt(),
        Function::Exp => x.exp(),
        Function::Log => 1.0 / x,
        Function::Sin => x.cos(),
        Function::Cos => -x.sin(),
        Function::Sinh => x.cosh(),
        Function::Cosh => x.sinh(),
        Function::Tanh => 1.0 / (x.cosh() * x.cosh()),
        Function::Balance => 0.0,
    };
    [f.of(x), slope * dx]
}

/// All steps with their derivatives; nothing if a number is not finite or too large.
fn duals(tape: &Tape, inputs: &[f64], along: &[f64]) -> Option<Vec<Dual>> {
    let mut all: Vec<Dual> = Vec::new();
    for step in &tape.steps {
        let of = |x: Scalar| all[x.step()];
        let made = match *step {
            Step::Input(i) => [inputs[i as usize], along[i as usize]],
            Step::Double(bits) => [f64::from_bits(bits), 0.0],
            Step::Add(a, b) => [of(a)[0] + of(b)[0], of(a)[1] + of(b)[1]],
            Step::Sub(a, b) => [of(a)[0] - of(b)[0], of(a)[1] - of(b)[1]],
            Step::Mul(a, b) => {
                let ([x, dx], [y, dy]) = (of(a), of(b));
                [x * y, dx * y + x * dy]
            }
            Step::Div(a, b) => {
                let ([x, dx], [y, dy]) = (of(a), of(b));
                [x / y, (dx * y - x * dy) / (y * y)]
            }
            Step::Neg(a) => of(a).map(|x| -x),
            Step::Function(f, a) => function(f, of(a)),
            Step::WherePositive(a, b) if of(a)[0] > 0.0 => of(b),
            Step::WherePositive(..) => [0.0; 2],
            Step::Output(..) => return None,
        };
        if !made.iter().all(|x| x.abs() < LARGEST) {
            return None;
        }
        all.push(made);
    }
    Some(all)
}

fn run(tape: &Tape, inputs: &[f64]) -> Vec<f64> {
    let free = Tape {
        guards: Vec::new(),
        ..tape.clone()
    };
    let machine = Machine::new(&free, inputs.len());
    let mut frame = machine.frame::<1>();
    for (slot, x) in frame.inputs().iter_mut().zip(inputs) {
        *slot = [*x];
    }
    assert!(machine.run(&mut frame));
    machine.gives(&frame, 0).collect()
}

#[test]
fn tangents_and_adjoints_are_the_derivatives_of_dual_numbers() {
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    let mut compared = 0;
    while compared < TAPES {
        let tape = random_tape(&mut random);
        let plain = |random: &mut Random| (random.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
        let mut list = |count: usize| (0..count).map(|_| plain(&mut random)).collect::<Vec<f64>>();
        let (inputs, along, weights) = (list(INPUTS), list(INPUTS), list(tape.outputs.len()));
        if !tape.calls.is_empty() {
            assert!(tape.tangent(INPUTS).is_none() && tape.adjoint(INPUTS).is_none());
            continue;
        }
        let Some(all) = duals(&tape, &inputs, &along) else {
            continue;
        };
        compared += 1;
        let tangent = tape.tangent(INPUTS).expect("no calls");
        assert_eq!(tangent.guards.len(), tape.guards.len());
        let found = run(&tangent, &[inputs.clone(), along.clone()].concat());
        let adjoint = tape.adjoint(INPUTS).expect("no calls");
        let pulled = run(&adjoint, &[inputs.clone(), weights.clone()].concat());
        let mut pushed = 0.0;
        for (k, output) in tape.outputs.iter().enumerate() {
            let [value, slope] = all[output.step()];
            assert!((found[k] - value).abs() <= NEAR * LARGEST, "{tape:?}");
            let off = (found[tape.outputs.len() + k] - slope).abs();
            assert!(off <= NEAR * LARGEST, "{off:e} of {slope:e}: {tape:?}");
            pushed += weights[k] * slope;
        }
        let back: f64 = pulled.iter().zip(&along).map(|(x, d)| x * d).sum();
        if pulled.iter().all(|x| x.abs() < LARGEST) {
            assert!(
                (back - pushed).abs() <= NEAR * LARGEST,
                "{back} {pushed}: {tape:?}"
            );
        }
    }
}

#[test]
fn derivatives_of_a_derivative_are_second_derivatives() {
    use clebsch_program::Recording;
    // x^2 sin(y), whose second derivatives are known.
    let mut recording = Recording::default();
    let (x, y) = (
        recording.step(Step::Input(0)),
        recording.step(Step::Input(1)),
    );
    let square = recording.step(Step::Mul(x, x));
    let sine = recording.step(Step::Function(Function::Sin, y));
    let product = recording.step(Step::Mul(square, sine));
    let tape = recording.tape(vec![product]);
    let slopes = tape.adjoint(2).expect("no calls");
    let bent = slopes.tangent(3).expect("no calls");
    let (x, y) = (0.7_f64, 0.4_f64);
    // The derivative of both slopes along x, for weight 1.
    let found = run(&bent, &[x, y, 1.0, 1.0, 0.0, 0.0]);
    let expected = [
        2.0 * x * y.sin(),
        x * x * y.cos(),
        2.0 * y.sin(),
        2.0 * x * y.cos(),
    ];
    for (a, b) in found.iter().zip(expected) {
        // A few roundings of numbers near 1.
        assert!((a - b).abs() < 1e-15, "{a} {b}");
    }
}
