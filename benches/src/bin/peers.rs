//! Time per step of the generated free body beside other methods, and how accurate each is: all from one
//! run. Takes no arguments; prints a table.
//! `cargo run --release --manifest-path benches/Cargo.toml --bin peers`, about a minute.

use clebsch::Order;
use clebsch_benches::blocks::{self, Comparison, STEPS, compare};
use clebsch_benches::body::{Generated, start_of};
use clebsch_comparisons::body::exact::Exact;
use clebsch_comparisons::body::implicit::{FixedPoint, Newton};
use clebsch_comparisons::body::splitting::{FourthOrderSplitting, MergedSplitting, Splitting};
use clebsch_comparisons::body::{BodyMotion, Start};
use clebsch_comparisons::continuous::rigid::{Field, RigidBody};
use clebsch_comparisons::handwritten::free_body::FreeBody as Written;
use clebsch_comparisons::runge_kutta::{Accuracy, Method54, Method85, RungeKutta, Scheme};
use std::hint::black_box;

/// The bodies of thesis figures 2.5, 2.6 and 2.17.
const BODIES: [(&str, [f64; 3], [f64; 3]); 3] = [
    (
        "I = (2, 2, 1), M = (0.1, 0, 1)",
        [2.0, 2.0, 1.0],
        [0.1, 0.0, 1.0],
    ),
    (
        "I = (3.5, 2.5, 2), M = (-0.5, 0, 1)",
        [3.5, 2.5, 2.0],
        [-0.5, 0.0, 1.0],
    ),
    (
        "I = (1, 2, 3), M = (-0.5, 0, 1)",
        [1.0, 2.0, 3.0],
        [-0.5, 0.0, 1.0],
    ),
];

const H: f64 = 0.1;

/// Nodes after which the error is taken: time 100.
const NODES: u32 = 1000;

fn main() {
    println!("{}", env!("RUSTC_VERSION"));
    println!(
        "h = {H}; {} blocks of {STEPS} steps each way, interleaved with the generated stepper; ns per step",
        2 * blocks::QUADRUPLES
    );
    println!("error: largest |M - M*| up to time 100, M* the closed form");
    for (name, moments, body_momentum) in BODIES {
        let start = start_of(moments, body_momentum, H);
        println!("\n{name}");
        println!(
            "{:<36} {:>9} {:>12} {:>9}   quartiles of the ratio",
            "method", "ns", "x generated", "error"
        );
        table(&start);
    }
}

fn table(start: &Start) {
    let s = start;
    own(s, "generated", Order::Two);
    own(s, "generated, order 4", Order::Four);
    own(s, "generated, order 10", Order::Ten);
    row(
        s,
        "by hand",
        Written::start(&s.poinsot, &s.attitude, &s.body_momentum, s.h).expect("solvable"),
    );
    row(s, "splitting", Splitting::start(s).expect("a body"));
    row(
        s,
        "splitting, merged, rational angles",
        MergedSplitting::start(s).expect("a body"),
    );
    row(
        s,
        "splitting, order 4",
        FourthOrderSplitting::start(s).expect("a body"),
    );
    row(s, "fixed point", FixedPoint::start(s).expect("a body"));
    row(s, "Newton", Newton::start(s).expect("a body"));
    row(
        s,
        "Dormand-Prince 5(4), 1e-9",
        runge_kutta::<Method54<7>>(s, 1e-9),
    );
    row(
        s,
        "Dormand-Prince 5(4), 1e-12",
        runge_kutta::<Method54<7>>(s, 1e-12),
    );
    row(
        s,
        "Dormand-Prince 8(5,3), 1e-12",
        runge_kutta::<Method85<7>>(s, 1e-12),
    );
}

/// The generated stepper of an order against the one of order two.
fn own(start: &Start, name: &str, order: Order) {
    let times = compare(
        || Generated::start(start, order).block(),
        || Generated::start(start, Order::Two).block(),
    );
    print(name, &times, error(start, Generated::start(start, order)));
}

/// One method against the generated one.
fn row<M: BodyMotion + Clone>(start: &Start, name: &str, motion: M) {
    let times = compare(
        || block(motion.clone()),
        || Generated::start(start, Order::Two).block(),
    );
    print(name, &times, error(start, motion));
}

fn print(name: &str, times: &Comparison, error: f64) {
    let [low, high] = times.quartiles;
    println!(
        "{name:<36} {:>9.2} {:>12.3} {error:>9.1e}   {low:.3} to {high:.3}",
        times.generated,
        times.generated / times.hand,
    );
}

fn block<M: BodyMotion>(motion: M) -> impl FnOnce() {
    move || {
        let mut motion = black_box(motion);
        for _ in 0..STEPS {
            motion.step().expect("solvable");
        }
        black_box(&motion);
    }
}

fn error<M: BodyMotion>(start: &Start, mut motion: M) -> f64 {
    let mut truth = Exact::start(start).expect("a body");
    let mut worst = 0.0_f64;
    for _ in 0..NODES {
        motion.step().expect("solvable");
        truth.step().expect("closed");
        let pairs = motion
            .body_momentum()
            .into_iter()
            .zip(truth.body_momentum());
        let squares: f64 = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
        worst = worst.max(squares.sqrt());
    }
    worst
}

fn runge_kutta<R: Scheme<7>>(start: &Start, tolerance: f64) -> RungeKutta<R, RigidBody, 7> {
    let [w, x, y, z] = start.attitude.0;
    let [a, b, c] = start.body_momentum;
    let body = RigidBody::new(&start.poinsot, Field::None);
    let accuracy = Accuracy::of(tolerance);
    RungeKutta::start(body, &[w, x, y, z, a, b, c], start.h, accuracy).expect("finite")
}
