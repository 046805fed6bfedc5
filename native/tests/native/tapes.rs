//! Random tapes, compiled to native code, against sequential evaluation of their steps: the results agree bit for bit.

use crate::random_tapes::{INPUTS, Random, computed, random_tape, same};
use clebsch_native::{Native, Refusal};
use clebsch_program::{Compiled, Function, Machine, Recording, Scalar, Step, Test};

/// Number of random tapes, and of input sets for each.
const TAPES: usize = 2000;
const SETS: usize = 40;

/// The registers of a machine, with its constants.
fn registers(machine: &Machine) -> Vec<[f64; 1]> {
    let mut registers = vec![[0.0]; machine.registers()];
    for (register, x) in registers
        .iter_mut()
        .skip(machine.inputs())
        .zip(machine.constants())
    {
        *register = [*x];
    }
    registers
}

#[test]
fn compiled_tapes_give_the_bits_of_their_steps() {
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    let (mut held, mut failed) = (0, 0);
    for _ in 0..TAPES {
        let tape = random_tape(&mut random);
        let machine = Machine::new(&tape, INPUTS);
        let native = Native::of(&machine).expect("a small tape");
        assert!(native.size() > 0);
        let mut registers = registers(&machine);
        for _ in 0..SETS {
            let inputs: Vec<f64> = (0..INPUTS).map(|_| random.number()).collect();
            for (register, x) in registers.iter_mut().zip(&inputs) {
                *register = [*x];
            }
            let (outputs, holds) = computed(&tape, &inputs);
            assert_eq!(native.run(&mut registers), holds, "{tape:?}");
            for (result, wanted) in machine.results().iter().zip(outputs) {
                let [found] = registers[*result as usize];
                assert!(same(found, wanted), "{found} for {wanted} of {tape:?}");
            }
            for (register, x) in registers.iter().zip(&inputs) {
                assert!(same(register[0], *x), "an input has changed");
            }
            held += usize::from(holds);
            failed += usize::from(!holds);
        }
    }
    // Decisions with both outcomes occur.
    assert!(
        held > 10_000 && failed > 10_000,
        "{held} held, {failed} failed"
    );
}

/// A polynomial with this many steps.
fn long(steps: u32) -> Machine {
    let mut recording = Recording::default();
    let x = recording.step(Step::Input(0));
    let mut sum = x;
    for k in 0..steps {
        let c = recording.double(f64::from(k) * 1e-9);
        let scaled = recording.step(Step::Mul(x, c));
        sum = recording.step(Step::Sub(scaled, sum));
    }
    Machine::new(&recording.tape(vec![sum]), 1)
}

#[test]
fn a_tape_that_is_too_large_is_refused_with_its_size() {
    let machine = long(20_000);
    let refused = Native::of(&machine).expect_err("forty thousand operations");
    let instructions = machine.operations();
    assert_eq!(
        refused,
        Refusal::TooLarge {
            instructions,
            most: 20_000
        }
    );
    assert!(refused.to_string().contains(&instructions.to_string()));
}

#[test]
fn too_few_registers_are_a_failure_and_nothing_is_written() {
    let machine = long(10);
    let native = Native::of(&machine).expect("a small tape");
    assert!(!native.run(&mut [[1.0]]));
}

/// A function that panics.
fn panics(_: &[usize], _: &[f64], _: &mut [f64]) {
    panic!("on purpose");
}

#[test]
fn a_call_that_panics_gives_no_number_and_unwinds_nothing() {
    let mut recording = Recording::default();
    let x: Scalar = recording.step(Step::Input(0));
    let outputs = recording.call(panics, &[], vec![x], 1);
    let sine = recording.step(Step::Function(Function::Sin, outputs[0]));
    recording.guard(Test::Finite(sine), true);
    let machine = Machine::new(&recording.tape(vec![sine]), 1);
    let native = Native::of(&machine).expect("a small tape");
    let mut registers = registers(&machine);
    assert!(!native.run(&mut registers));
    assert!(registers[machine.results()[0] as usize][0].is_nan());
}
