//! Random tapes, run one by one and side by side, against their steps computed one after the other: the same bits.

mod random_tapes;

use clebsch_program::{Machine, Recording, Step, WIDTH};
use random_tapes::{INPUTS, Random, computed, random_tape, same};

/// Random tapes.
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
