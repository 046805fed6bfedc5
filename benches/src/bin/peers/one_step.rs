//! Time per step and accuracy of the generated free body and of other methods. Prints a table for each body of the thesis figures.

use clebsch::solvers::Method;
use clebsch::solvers::moser_veselov::Edge;
use clebsch::{Order, Poinsot, Rotation};
use clebsch_benches::blocks::{Comparison, STEPS, compare_blocks};
use clebsch_benches::body::{Generated, body_of, start_of};
use clebsch_comparisons::body::exact::Exact;
use clebsch_comparisons::body::implicit::{FixedPoint, Newton};
use clebsch_comparisons::body::splitting::{FourthOrderSplitting, MergedSplitting, Splitting};
use clebsch_comparisons::body::{BodyMotion, Start};
use clebsch_comparisons::continuous::rigid::{Field, RigidBody};
use clebsch_comparisons::handwritten::Unsolvable;
use clebsch_comparisons::handwritten::attitude::Quaternion;
use clebsch_comparisons::handwritten::free_body::FreeBody as Written;
use clebsch_comparisons::runge_kutta::{Accuracy, Method54, Method85, RungeKutta, Scheme};
use std::hint::black_box;

/// Groups of four blocks; a single process measures all methods.
const QUADRUPLES: usize = 101;

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

/// The error is measured after this many nodes, at time 100.
const NODES: u32 = 1000;

/// Steps per block, and groups of four blocks, for solvers that take microseconds.
const SLOW: (u32, usize) = (500, 25);

/// Prints the tables.
pub fn tables() {
    println!(
        "h = {H}; {} blocks of {STEPS} steps for each method ({} of {} for the solvers by name), interleaved with the generated stepper",
        2 * QUADRUPLES,
        2 * SLOW.1,
        SLOW.0
    );
    println!("error: largest |M - M*| up to time 100, M* the closed form");
    for (name, moments, body_momentum) in BODIES {
        let start = start_of(moments, body_momentum, H);
        println!("\n{name}\n");
        println!("| method | ns | x generated (quartiles) | x by hand | error |");
        println!("|---|---|---|---|---|");
        Table::start(start).rows();
    }
}

/// The table of one body.
struct Table {
    start: Start,
    /// Time of the hand-written step, divided by the time of the generated step.
    by_hand: f64,
}

impl Table {
    fn start(start: Start) -> Self {
        let hand = timed((STEPS, QUADRUPLES), &start, by_hand(&start));
        Self {
            by_hand: hand.generated / hand.hand,
            start,
        }
    }

    fn rows(&self) {
        let s = &self.start;
        for (name, order) in [
            ("generated", Order::Two),
            ("generated, order 4", Order::Four),
            ("generated, order 10", Order::Ten),
        ] {
            self.own(name, order);
        }
        self.row("by hand", by_hand(s));
        self.row("generated, solved anew each step", Solved::start(s));
        self.row("splitting", Splitting::start(s).expect("a body"));
        let merged = MergedSplitting::start(s).expect("a body");
        self.row("splitting, merged, rational angles", merged);
        let fourth = FourthOrderSplitting::start(s).expect("a body");
        self.row("splitting, order 4", fourth);
        self.row("fixed point", FixedPoint::start(s).expect("a body"));
        self.row("Newton", Newton::start(s).expect("a body"));
        for method in Method::ALL.into_iter().filter(|m| *m != Method::Kappa) {
            let name = format!("solver {method}");
            match Generated::solved_by(s, Order::Two, method) {
                Ok(motion) => self.timed_row(SLOW, &name, motion),
                // These methods need the inverse of J.
                Err(_) => println!("| {name} | - | - | - | - |"),
            }
        }
        let loose = runge_kutta::<Method54<7>>(s, 1e-9);
        self.row("Dormand-Prince 5(4), 1e-9", loose);
        let tight = runge_kutta::<Method54<7>>(s, 1e-12);
        self.row("Dormand-Prince 5(4), 1e-12", tight);
        let eighth = runge_kutta::<Method85<7>>(s, 1e-12);
        self.row("Dormand-Prince 8(5,3), 1e-12", eighth);
    }

    /// The generated stepper of an order against order two.
    fn own(&self, name: &str, order: Order) {
        let motion = Generated::start(&self.start, order);
        let times = compare_blocks(
            STEPS,
            STEPS,
            QUADRUPLES,
            || motion.clone().block(STEPS),
            || Generated::start(&self.start, Order::Two).block(STEPS),
        );
        self.print(name, &times, error(&self.start, motion));
    }

    /// A method against the generated stepper.
    fn row<M: BodyMotion + Clone>(&self, name: &str, motion: M) {
        self.timed_row((STEPS, QUADRUPLES), name, motion);
    }

    fn timed_row<M: BodyMotion + Clone>(&self, blocks: (u32, usize), name: &str, motion: M) {
        let times = timed(blocks, &self.start, motion.clone());
        self.print(name, &times, error(&self.start, motion));
    }

    fn print(&self, name: &str, times: &Comparison, error: f64) {
        let [low, high] = times.quartiles;
        let ratio = times.generated / times.hand;
        println!(
            "| {name} | {:.2} | {ratio:.3} ({low:.3} to {high:.3}) | {:.3} | {error:.1e} |",
            times.generated,
            ratio / self.by_hand,
        );
    }
}

fn by_hand(s: &Start) -> Written {
    Written::start(&s.poinsot, &s.attitude, &s.body_momentum, s.h).expect("solvable")
}

/// Times a method against the generated stepper of order two.
fn timed<M: BodyMotion + Clone>(
    (steps, quadruples): (u32, usize),
    start: &Start,
    motion: M,
) -> Comparison {
    compare_blocks(
        steps,
        STEPS,
        quadruples,
        || block(steps, motion.clone()),
        || Generated::start(start, Order::Two).block(STEPS),
    )
}

/// The cost of a body under forces without the forces: solves the quartic in every step, like emitted steppers.
#[derive(Clone)]
struct Solved {
    body: Poinsot,
    edge: Edge,
    attitude: Rotation,
    h: f64,
}

impl Solved {
    fn start(s: &Start) -> Self {
        let (parameters, initial) = body_of(s);
        let momentum = initial.body_momentum;
        Self {
            body: Poinsot::new(parameters.J).expect("a body"),
            edge: Edge::new(momentum.0, momentum.to_space(&initial.Λ).0),
            attitude: initial.Λ,
            h: s.h,
        }
    }
}

impl BodyMotion for Solved {
    #[inline(always)]
    fn step(&mut self) -> Result<(), Unsolvable> {
        let turned = self.edge.turn(&self.body, self.h, &self.attitude);
        let turned = turned.map_err(|_| Unsolvable)?;
        let space = self.edge.space();
        self.edge = Edge::new(turned.inverse_rotate(&space), space);
        self.attitude = turned.rotation();
        Ok(())
    }

    fn attitude(&self) -> Quaternion {
        Quaternion(self.attitude.quaternion())
    }

    fn body_momentum(&self) -> [f64; 3] {
        self.edge.body().into()
    }
}

fn block<M: BodyMotion>(steps: u32, motion: M) -> impl FnOnce() {
    move || {
        let mut motion = black_box(motion);
        for _ in 0..steps {
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
