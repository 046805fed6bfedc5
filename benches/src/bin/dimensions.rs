//! Time per step of the generated and the hand-written free body in four to eight dimensions, at several fractions of the
//! solvability bound. Takes no arguments; prints a table.
//! `cargo run --release --manifest-path benches/Cargo.toml --bin dimensions`, a minute.

// The fields of the models are Greek letters, as in the papers.
#![allow(mixed_script_confusables)]

use clebsch::nalgebra::SMatrix;
use clebsch::solvers::left_factor::LeftFactor;
use clebsch::{BodyMomentumMatrix, Orthogonal};
use clebsch_benches::blocks::computed;
use clebsch_comparisons::handwritten::body_n::BodyN as Written;
use clebsch_models::body_n::{BodyN, BodyNInitial, BodyNParameters, entry};
use std::hint::black_box;

/// Steps per block.
const STEPS: u32 = 500;

/// Groups of four blocks, in the order generated, hand, hand, generated.
const QUADRUPLES: usize = 41;

fn main() {
    println!("{}", env!("RUSTC_VERSION"));
    println!(
        "us per step, medians of {} blocks of {STEPS} steps for each stepper, interleaved\n",
        2 * QUADRUPLES
    );
    println!("| n | part of the bound | generated | by hand | ratio |");
    println!("|---|---|---|---|---|");
    for fraction in [0.05, 0.3, 0.6, 0.95] {
        row::<4>(fraction);
        row::<5>(fraction);
        row::<6>(fraction);
        row::<7>(fraction);
        row::<8>(fraction);
    }
}

/// Second moments and momentum of the gallery's case of this size.
fn numbers<const N: usize>() -> Option<(SMatrix<f64, N, N>, SMatrix<f64, N, N>)> {
    let cases = entry().cases;
    let case = cases
        .iter()
        .find(|case| case.parameters[0].len() == N * N)?;
    let matrix = |rows: &[f64]| SMatrix::from_fn(|i, j| rows[i * N + j]);
    Some((matrix(&case.parameters[0]), matrix(&case.initial[1])))
}

fn row<const N: usize>(fraction: f64) {
    let (c, m) = numbers::<N>().expect("a case of this size");
    let h = 0.1;
    let bound = LeftFactor::new(c).expect("a factor").reach(&(m * h));
    let m = m * (fraction / bound);
    let model = BodyN::<N, f64>::new(BodyNParameters { C: c }).expect("a body");
    let initial = BodyNInitial {
        Λ: Orthogonal::identity(),
        body_momentum: BodyMomentumMatrix(m),
    };
    let started = model.start(initial, h).expect("solvable");
    let generated = || {
        let (mut state, mut work) = black_box(started);
        for _ in 0..STEPS {
            model.step(&mut state, &mut work).expect("solvable");
        }
        black_box(&state);
    };
    let rows = |a: &SMatrix<f64, N, N>| std::array::from_fn(|i| std::array::from_fn(|j| a[(i, j)]));
    let diagonal: [f64; N] = std::array::from_fn(|i| c[(i, i)]);
    let body =
        Written::start(&diagonal, &rows(&SMatrix::identity()), &rows(&m), h).expect("solvable");
    let hand = || {
        let mut body = black_box(body);
        for _ in 0..STEPS {
            body.step().expect("solvable");
        }
        black_box(&body);
    };
    let time = |work: &dyn Fn()| {
        let begin = computed();
        work();
        (computed() - begin) / f64::from(STEPS) / 1e3
    };
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    for _ in 0..QUADRUPLES {
        let first = time(&generated);
        theirs.extend([time(&hand), time(&hand)]);
        ours.extend([first, time(&generated)]);
    }
    let median = |times: &mut Vec<f64>| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    };
    let (ours, theirs) = (median(&mut ours), median(&mut theirs));
    println!(
        "| {N} | {fraction} | {ours:.2} | {theirs:.2} | {:.2} |",
        ours / theirs
    );
}
