//! The methods written in Rust, each with a range of step sizes or tolerances: the generated stepper of every order, single and in
//! lanes, its compositions, splitting, fixed point, Runge-Kutta. Gives runs to time.

use super::precision::{MOMENTS, MOMENTUM, TIME};
use super::timing::{End, Run};
use clebsch::integrate::{Composition, CompositionOrder, Ensemble};
use clebsch::{DoubleDouble, Order, Real};
use clebsch_benches::body::{Generated, body_of, start_of};
use clebsch_comparisons::body::implicit::FixedPoint;
use clebsch_comparisons::body::splitting::{FourthOrderSplitting, Splitting};
use clebsch_comparisons::body::{BodyMotion, Start};
use clebsch_comparisons::continuous::rigid::{Field, RigidBody};
use clebsch_comparisons::runge_kutta::{
    Accuracy, Method54, Method85, Method98, RungeKutta, Scheme,
};
use clebsch_models::free_body::FreeBody;

/// Number of trajectories in lanes.
pub const LANES: usize = 16;

/// Node distance of Runge-Kutta methods: longer than their steps, and short enough that the sum of the steps has no visible
/// rounding error. For loose tolerances, and for tolerances below 1e-9.
const LOOSE: u32 = 25;
const TIGHT: u32 = 5;

/// Number of steps until the end: h = 1 to 0.001.
const COUNTS: [u32; 16] = [
    100, 125, 160, 200, 250, 320, 400, 500, 640, 800, 1000, 2000, 5000, 10_000, 30_000, 100_000,
];

/// All runs.
pub fn all() -> Vec<Run> {
    let mut runs = Vec::new();
    for order in Order::ALL {
        for count in wanted(order.number()) {
            runs.push(stepping(
                &format!("generated, order {order}"),
                count,
                move |start| Some(Generated::start(start, order)),
            ));
        }
    }
    for count in wanted(Order::Ten.number()) {
        runs.push(lanes(Order::Ten, count));
    }
    for count in COUNTS.into_iter().filter(|n| (160..=5000).contains(n)) {
        runs.push(composed(CompositionOrder::Eight, count));
    }
    for count in COUNTS {
        runs.push(stepping("splitting", count, |s| Splitting::start(s).ok()));
    }
    for count in COUNTS.into_iter().filter(|n| *n <= 10_000) {
        runs.push(stepping("splitting, order 4", count, |s| {
            FourthOrderSplitting::start(s).ok()
        }));
    }
    for count in COUNTS.into_iter().filter(|n| *n >= 200) {
        runs.push(stepping("fixed point", count, |s| {
            FixedPoint::start(s).ok()
        }));
    }
    runs.extend(tolerances(
        "Dormand-Prince 5(4)",
        adaptive::<Method54<7>, LOOSE>,
        adaptive::<Method54<7>, TIGHT>,
    ));
    runs.extend(tolerances(
        "Dormand-Prince 8(5,3)",
        adaptive::<Method85<7>, LOOSE>,
        adaptive::<Method85<7>, TIGHT>,
    ));
    runs.extend(tolerances(
        "Verner 9(8)",
        adaptive::<Method98<7>, LOOSE>,
        adaptive::<Method98<7>, TIGHT>,
    ));
    runs
}

/// Step counts worth measuring at an order: until rounding is reached, and slightly beyond.
fn wanted(order: u32) -> impl Iterator<Item = u32> {
    let most = match order {
        0..=3 => 100_000,
        4 => 30_000,
        5..=6 => 5000,
        _ => 2000,
    };
    COUNTS.into_iter().filter(move |count| *count <= most)
}

/// A method with a fixed step size.
fn stepping<M: BodyMotion>(
    method: &str,
    count: u32,
    make: impl Fn(&Start) -> Option<M> + 'static,
) -> Run {
    let h = TIME / f64::from(count);
    let start = start_of(MOMENTS, MOMENTUM, h);
    let motion = move || {
        let Some(mut motion) = make(&start) else {
            return nowhere();
        };
        for _ in 0..count {
            if motion.step().is_err() {
                return nowhere();
            }
        }
        (motion.attitude().0, motion.body_momentum())
    };
    run(method, h, count, 1, motion)
}

fn run(method: &str, h: f64, count: u32, lanes: usize, make: impl Fn() -> End + 'static) -> Run {
    Run {
        method: method.to_owned(),
        setting: format!("h = {}", (h * 1e4).round() / 1e4),
        lanes,
        time: DoubleDouble::from_f64(h) * DoubleDouble::from_f64(f64::from(count)),
        make: Box::new(make),
    }
}

/// The result of a failed motion, with infinite error.
fn nowhere() -> End {
    ([f64::NAN; 4], [f64::NAN; 3])
}

/// The same trajectory in every lane of an ensemble, on the best instruction set. Equal trajectories save nothing, because every
/// lane has its own numbers.
fn lanes(order: Order, count: u32) -> Run {
    let h = TIME / f64::from(count);
    let start = start_of(MOMENTS, MOMENTUM, h);
    let motion = move || {
        let body = body_of(&start);
        let bodies = std::iter::repeat_n(body, LANES);
        let Ok(mut ensemble) = Ensemble::<FreeBody, LANES>::start_with(bodies, h, order) else {
            return nowhere();
        };
        if ensemble.run(u64::from(count)).is_err() {
            return nowhere();
        }
        let Some((_, state)) = ensemble.body(0) else {
            return nowhere();
        };
        (state.Λ().quaternion(), state.body_momentum().0.into())
    };
    run(
        &format!("generated, order {order}, lanes"),
        h,
        count,
        LANES,
        motion,
    )
}

/// The composed step of order two, which is symplectic in momentum and attitude.
fn composed(order: CompositionOrder, count: u32) -> Run {
    let h = TIME / f64::from(count);
    let start = start_of(MOMENTS, MOMENTUM, h);
    let motion = move || {
        let Generated {
            model, mut state, ..
        } = Generated::start(&start, Order::Two);
        let Ok(mut composition) = Composition::start(&model, &state, h, order) else {
            return nowhere();
        };
        for _ in 0..count {
            if composition.step(&model, &mut state).is_err() {
                return nowhere();
            }
        }
        (state.Λ().quaternion(), state.body_momentum().0.into())
    };
    run(
        &format!("generated, composed, order {order}"),
        h,
        count,
        1,
        motion,
    )
}

type Adaptive = fn(&str, f64) -> Run;

/// A method with tolerances half a decade apart.
fn tolerances(method: &str, loose: Adaptive, tight: Adaptive) -> Vec<Run> {
    let run = |half_decades: u32| {
        let tolerance = 10_f64.powf(-0.5 * f64::from(half_decades));
        let nodes = if half_decades < 18 { loose } else { tight };
        nodes(method, tolerance)
    };
    (8..=31).map(run).collect()
}

/// A method with adaptive steps. The compiler knows the node distance, which favours this method.
fn adaptive<R: Scheme<7> + 'static, const NODES: u32>(method: &str, tolerance: f64) -> Run {
    let nodes = f64::from(NODES);
    let start = start_of(MOMENTS, MOMENTUM, nodes);
    let motion = move || {
        let ([w, x, y, z], [a, b, c]) = (start.attitude.0, start.body_momentum);
        let body = RigidBody::new(&start.poinsot, Field::None);
        let accuracy = Accuracy::of(tolerance);
        let made: Result<RungeKutta<R, _, 7>, _> =
            RungeKutta::start(body, &[w, x, y, z, a, b, c], nodes, accuracy);
        let Ok(mut motion) = made else {
            return nowhere();
        };
        for _ in 0..(TIME / nodes) as u32 {
            if motion.step().is_err() {
                return nowhere();
            }
        }
        (motion.attitude().0, motion.body_momentum())
    };
    Run {
        method: method.to_owned(),
        setting: format!("{tolerance:.0e}"),
        lanes: 1,
        time: DoubleDouble::from_f64(TIME),
        make: Box::new(motion),
    }
}
