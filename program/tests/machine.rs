//! Random tapes, run singly and in lanes, against sequential evaluation of their steps: the results agree bit for bit.

mod listing;
mod random_tapes;

use clebsch_program::{Machine, Part, Recording, Step, WIDTH};
use random_tapes::{INPUTS, Random, computed, random_tape, same};

/// Number of random tapes.
const TAPES: u64 = 400;

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
        assert_eq!(clebsch_lanes::run(&machine, &mut wide), all_hold);
        for (lane, wanted) in wanted.iter().enumerate() {
            let agree = machine
                .gives(&wide, lane)
                .zip(wanted)
                .all(|(a, b)| same(a, *b));
            assert!(agree, "lane {lane} of {tape:?}");
        }
    }
    // Decisions with both outcomes occur.
    assert!(held > 1000 && failed > 1000, "{held} held, {failed} failed");
}

#[test]
fn a_tape_in_two_parts_gives_the_same_bits() {
    let mut random = Random(0x5851_f42d_4c95_7f2d);
    let (mut taken, mut held, mut failed) = (0, 0, 0);
    for _ in 0..TAPES {
        let tape = random_tape(&mut random);
        let late = random.below(INPUTS + 1);
        let whole = Part {
            outputs: tape.outputs.clone(),
            guards: tape.guards.clone(),
        };
        let (given, tapes) = tape.behind(late, &[&whole]);
        taken += given.len();
        let first = Part {
            outputs: given.clone(),
            guards: Vec::new(),
        };
        let first = Machine::new(&tape.part(first), late);
        let second = Machine::new(&tapes[0], given.len() + INPUTS - late);
        let (mut before, mut behind) = (first.frame::<1>(), second.frame::<1>());
        let earlier: Vec<f64> = (0..late).map(|_| random.number()).collect();
        for (slot, x) in before.inputs().iter_mut().zip(&earlier) {
            *slot = [*x];
        }
        assert!(
            first.run(&mut before),
            "no decision stays with the first part"
        );
        for (slot, x) in behind.inputs().iter_mut().zip(first.gives(&before, 0)) {
            *slot = [x];
        }
        // Runs the second part repeatedly with the results of the first.
        for _ in 0..8 {
            let later: Vec<f64> = (late..INPUTS).map(|_| random.number()).collect();
            for (slot, x) in behind.inputs()[given.len()..].iter_mut().zip(&later) {
                *slot = [*x];
            }
            let inputs = [earlier.clone(), later].concat();
            let (outputs, holds) = computed(&tape, &inputs);
            assert_eq!(second.run(&mut behind), holds, "{tape:?}");
            let found = second.gives(&behind, 0);
            let agree = found.zip(&outputs).all(|(a, b)| same(a, *b));
            assert!(agree, "{inputs:?} of {tape:?}");
            held += usize::from(holds);
            failed += usize::from(!holds);
        }
    }
    // The first part is not empty, and decisions with both outcomes occur.
    assert!(
        taken > TAPES as usize && held > 500 && failed > 500,
        "{taken} {held} {failed}"
    );
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
