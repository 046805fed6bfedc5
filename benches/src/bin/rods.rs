//! A free bending elastic rod, against PyElastica: the path of its first end, and the time of a step. Takes no arguments; prints a
//! table. If Python is available, PyElastica is installed and measured; otherwise the table omits that column.
//! `cargo run --release --manifest-path benches/Cargo.toml --bin rods`

// The fields of the models are Greek letters, as in the papers.
#![allow(mixed_script_confusables, non_snake_case)]

use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::scalar::largest;
use clebsch::{BodyMomentum, Rotation};
use clebsch_benches::blocks::computed;
use clebsch_benches::python;
use clebsch_models::lattices::geometrically_exact_rod::*;
use serde_json::Value;
use std::f64::consts::PI;

// The parameters of python/rod.py.
const LENGTH: f64 = 1.0;
const RADIUS: f64 = 0.05;
const DENSITY: f64 = 1000.0;
const YOUNG: f64 = 1e6;
const SHEAR: f64 = 4e5;
const SPEED: f64 = 0.5;
const STEP: f64 = 1e-4;
const STEPS: usize = 10_000;
const EVERY: usize = 100;
const ROUNDS: usize = 5;

/// The transverse path of the first end, and the seconds per step.
struct Run {
    path: Vec<f64>,
    seconds: f64,
}

fn generated(n: usize, h: f64) -> Run {
    let s = LENGTH / n as f64;
    let area = PI * RADIUS * RADIUS;
    let moment = area * RADIUS * RADIUS / 4.0;
    let mass = |i: usize| DENSITY * area * s * if i == 0 || i == n { 0.5 } else { 1.0 };
    // The shear factor of a circular section.
    let across = 27.0 / 28.0 * SHEAR * area;
    let [bending, twist] = [YOUNG * moment, SHEAR * 2.0 * moment];
    let parameters = GeometricallyExactRodParameters {
        s,
        m: (0..=n).map(mass).collect(),
        J: vec![DENSITY * moment * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0)); n],
        S: Matrix3::from_diagonal(&Vector3::new(across, across, YOUNG * area)),
        B: Matrix3::from_diagonal(&Vector3::new(
            0.5 * twist,
            0.5 * twist,
            bending - 0.5 * twist,
        )),
        g: Vector3::zeros(),
    };
    let ends = GeometricallyExactRodEnds::Open {
        first: GeometricallyExactRodFirst::Free,
        last: GeometricallyExactRodLast::Free,
    };
    let rod = GeometricallyExactRod::new(parameters, GeometricallyExactRodSites { N: n, ends })
        .expect("a rod");
    let initial = GeometricallyExactRodInitial {
        φ: (0..=n).map(|i| Vector3::z() * (s * i as f64)).collect(),
        momentum_φ: (0..=n)
            .map(|i| {
                let place = i as f64 / n as f64 - 0.5;
                Vector3::x() * (mass(i) * SPEED * (place * place * 12.0 - 1.0))
            })
            .collect(),
        Λ: vec![Rotation::identity(); n],
        body_momentum_Λ: vec![BodyMomentum(Vector3::zeros()); n],
    };
    let every = (STEP * EVERY as f64 / h).round() as usize;
    let (mut state, mut work) = rod.start(initial, h).expect("starts");
    let mut path = vec![state.φ()[0][0]];
    let begin = computed();
    for _ in 0..STEPS / EVERY {
        for _ in 0..every {
            rod.step(&mut state, &mut work).expect("steps");
        }
        path.push(state.φ()[0][0]);
    }
    let seconds = 1e-9 * (computed() - begin);
    let steps = (STEPS / EVERY * every) as f64;
    Run {
        path,
        seconds: seconds / steps,
    }
}

/// The run with PyElastica, or an error message.
fn elastica(segments: usize) -> Result<Run, String> {
    let (result, count) = (format!("rod-{segments}.json"), segments.to_string());
    let read = python::run_script("rod.py", &result, &["--segments", &count])?;
    let path = read["path"].as_array().into_iter().flatten();
    Ok(Run {
        path: path.filter_map(Value::as_f64).collect(),
        seconds: read["seconds"].as_f64().unwrap_or(f64::NAN),
    })
}

fn main() {
    println!("{}", env!("RUSTC_VERSION"));
    println!(
        "a free rod of length {LENGTH}, bent at the start, {STEPS} steps of {STEP} s; error: the largest difference of the \
         path of its first end from that of 400 segments, in parts of its way\n"
    );
    let truth = generated(400, STEP / 8.0).path;
    let way = largest(truth.iter().copied());
    let error = |run: &Run| {
        let pairs = run.path.iter().zip(&truth);
        assert_eq!(run.path.len(), truth.len());
        largest(pairs.map(|(a, b)| a - b)) / way
    };
    println!(
        "| segments | generated, µs | its error | PyElastica, µs | its error | times as long |"
    );
    println!("|---|---|---|---|---|---|");
    for n in [25, 50, 100] {
        let mut runs: Vec<Run> = (0..ROUNDS).map(|_| generated(n, STEP)).collect();
        runs.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        let own = &runs[ROUNDS / 2];
        let micros = |run: &Run| 1e6 * run.seconds;
        match elastica(n) {
            Ok(other) => println!(
                "| {n} | {:.2} | {:.1e} | {:.1} | {:.1e} | {:.1} |",
                micros(own),
                error(own),
                micros(&other),
                error(&other),
                other.seconds / own.seconds
            ),
            Err(why) => {
                eprintln!("PyElastica is left out: {why}");
                println!("| {n} | {:.2} | {:.1e} | | | |", micros(own), error(own));
            }
        }
    }
}
