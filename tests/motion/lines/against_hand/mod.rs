//! Compares compiled chains with hand-written steppers: one step and fifty steps from random states with random data at every site,
//! for all ends. A test checks that the comparison detects a relative change of 1e-6 in every datum.

mod chains;
mod rod;
mod tops;

use chains::{Pendulums, Springs};
use clebsch_oracle::handwritten::attitude::{Quaternion, Vector};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::physics::measure::worse;
use rod::Elastic;
use tops::Coupled;

/// Numbers of segments: fewer and more than the block size of either stepper.
const SIZES: [usize; 5] = [2, 3, 5, 12, 50];

/// States for each size and each of two to thirteen ends.
const STATES: usize = 40;

/// About thirty rounding errors in each of the two steppers, for numbers of order one without amplification.
const ONE_STEP: f64 = 1e-14;

/// Number of steps of a short trajectory.
const STEPS: usize = 50;

/// Relative change of a datum, both to measure conditioning and to plant a mistake: far above rounding, far below one.
const NUDGE: f64 = 1e-6;

/// The compared values: one list over all sites per quantity.
type Shown = Vec<Vec<f64>>;

/// A state of a chain with its data.
trait System: Clone {
    /// Kinds of data; some kinds exist only for some ends.
    const KINDS: usize;
    /// Number of end conditions.
    const ENDS: usize;
    fn draw(source: &mut Source, n: usize, ends: usize) -> Self;
    /// The same state, with the data of one kind increased by this fraction; `None` if the state has none of this
    /// kind.
    fn nudged(&self, kind: usize, share: f64) -> Option<Self>;
    fn by_hand(&self, steps: usize) -> Option<Shown>;
    fn generated(&self, steps: usize) -> Option<Shown>;
}

/// The largest difference of each quantity.
fn apart(a: &Shown, b: &Shown) -> Vec<f64> {
    assert_eq!(a.len(), b.len());
    let each = a.iter().zip(b).map(|(a, b)| {
        assert_eq!(a.len(), b.len());
        a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, worse)
    });
    each.collect()
}

/// The change of each quantity per relative change of the data, at least the size of the quantity.
fn conditioning<S: System>(state: &S, result: &Shown, steps: usize) -> Vec<f64> {
    let sizes = result
        .iter()
        .map(|all| all.iter().map(|x| x.abs()).fold(0.0, worse));
    let mut all: Vec<f64> = sizes.collect();
    for kind in 0..S::KINDS {
        if let Some(other) = state.nudged(kind, NUDGE).and_then(|s| s.by_hand(steps)) {
            let moved = apart(&other, result);
            all.iter_mut()
                .zip(moved)
                .for_each(|(c, x)| *c = worse(*c, x / NUDGE));
        }
    }
    all
}

/// The largest difference of two results divided by the conditioning of the state.
fn off<S: System>(state: &S, hand: &Shown, generated: &Shown, steps: usize) -> f64 {
    let scales = conditioning(state, hand, steps);
    let differences = apart(hand, generated).into_iter().zip(scales);
    differences
        .map(|(x, c)| if x == 0.0 { 0.0 } else { x / c })
        .fold(0.0, worse)
}

fn agree<S: System>(name: &str) {
    let mut source = Source::seeded(47);
    for ends in 0..S::ENDS {
        let (mut one, mut many, mut seen) = (0.0_f64, 0.0_f64, vec![None; S::KINDS]);
        for n in SIZES {
            for drawn in 0..STATES {
                let state = S::draw(&mut source, n, ends);
                let hand = state.by_hand(1).expect("a step by hand");
                let generated = state.generated(1).expect("a generated step");
                one = worse(one, off(&state, &hand, &generated, 1));
                if drawn % 8 == 0 {
                    let (hand, generated) = (state.by_hand(STEPS), state.generated(STEPS));
                    let (hand, generated) = (hand.expect("steps"), generated.expect("steps"));
                    many = worse(many, off(&state, &hand, &generated, STEPS));
                    for (kind, seen) in seen.iter_mut().enumerate() {
                        let Some(wrong) = state.nudged(kind, NUDGE) else {
                            continue;
                        };
                        let wrong = wrong.by_hand(1).expect("a step");
                        let generated = state.generated(1).expect("a generated step");
                        let off = off(&state, &wrong, &generated, 1);
                        *seen = Some(worse(seen.unwrap_or(0.0), off));
                    }
                }
            }
        }
        let least = seen.iter().flatten().copied().fold(f64::INFINITY, f64::min);
        println!(
            "{name}, end {ends}: {one:.1e} after a step, {many:.1e} after {STEPS}; a wrong datum at least {least:.1e}"
        );
        assert!(one < ONE_STEP, "{name}, end {ends}: {one:e}");
        // Every step adds the error of one step, and later steps amplify it at most as much as all steps amplify the data.
        assert!(
            many < STEPS as f64 * ONE_STEP,
            "{name}, end {ends}: {many:e}"
        );
        for (kind, off) in seen.into_iter().enumerate() {
            let noticed = off.is_none_or(|off| off > 1e3 * ONE_STEP);
            assert!(noticed, "{name}, end {ends}, datum {kind}: {off:?}");
        }
    }
}

fn stretched<const N: usize>(v: [f64; N], share: f64) -> [f64; N] {
    v.map(|x| x * (1.0 + share))
}

/// The quaternion of a rotation about an axis.
fn turn(axis: Vector, angle: f64) -> Quaternion {
    let [x, y, z] = axis.map(|c| 0.5 * angle * c);
    Quaternion([1.0, x, y, z]).normalised()
}

/// The attitudes, with every second one rotated by an angle.
fn turned(attitudes: &[Quaternion], angle: f64) -> Vec<Quaternion> {
    let each = attitudes.iter().enumerate();
    each.map(|(i, q)| match i % 2 {
        0 => q.times(&turn([0.6, 0.0, 0.8], angle)),
        _ => *q,
    })
    .collect()
}

/// Second moments, mostly not diagonal.
fn moments(source: &mut Source) -> [[f64; 3]; 3] {
    match source.chance(30) {
        true => [
            [source.between(0.3, 2.0), 0.0, 0.0],
            [0.0, source.between(0.3, 2.0), 0.0],
            [0.0, 0.0, source.between(0.3, 2.0)],
        ],
        false => source.positive::<3>().0,
    }
}

fn attitude(source: &mut Source) -> Quaternion {
    Quaternion(source.vector()).normalised()
}

#[test]
fn toda_chain() {
    agree::<Springs>("Toda");
}

#[test]
fn sine_gordon() {
    agree::<Pendulums>("sine-Gordon");
}

#[test]
fn coupled_tops() {
    agree::<Coupled>("tops");
}

#[test]
fn geometrically_exact_rod() {
    agree::<Elastic>("rod");
}
