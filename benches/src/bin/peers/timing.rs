//! Times of many short integrations, interleaved: every round makes a block of each, so that a drift of the machine falls
//! on all alike. Takes runs; gives the error of each and the median of its times.

use super::precision::{MOMENTS, MOMENTUM};
use clebsch::DoubleDouble;
use clebsch_benches::blocks::computed;
use clebsch_benches::body::start_of;
use clebsch_benches::truth;
use std::hint::black_box;

/// Rounds of the measurement.
const ROUNDS: usize = 41;

/// Nanoseconds of a block, far above the resolution of the clock.
const BLOCK: f64 = 1e6;

/// Where an integration ended: quaternion and body momentum.
pub type End = ([f64; 4], [f64; 3]);

/// One integration of the problem, from its start to its end.
pub struct Run {
    /// The method.
    pub method: String,
    /// Its step or its tolerance.
    pub setting: String,
    /// How many trajectories it makes side by side.
    pub lanes: usize,
    /// The time where it ends, which is the step's multiple nearest to that of the problem.
    pub time: DoubleDouble,
    /// Makes it.
    pub make: Box<dyn Fn() -> End>,
}

/// What was measured.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The method.
    pub method: String,
    /// Its step or its tolerance.
    pub setting: String,
    /// The larger of the error of the momentum, relative, and of the attitude, in radians.
    pub error: f64,
    /// Microseconds of the processor for one trajectory.
    pub micros: f64,
}

/// The error at the end.
pub fn error((attitude, momentum): &End, time: DoubleDouble) -> f64 {
    truth::at(&start_of(MOMENTS, MOMENTUM, 1.0), time).error(attitude, momentum)
}

/// Measures all of them.
pub fn measure(runs: Vec<Run>) -> Vec<Measured> {
    let time = |run: &Run, count: u32| {
        let begin = computed();
        for _ in 0..count {
            black_box((run.make)());
        }
        (computed() - begin) / f64::from(count)
    };
    let counts: Vec<u32> = runs
        .iter()
        .map(|run| (BLOCK / time(run, 3)).ceil().max(1.0) as u32)
        .collect();
    let mut times = vec![Vec::with_capacity(ROUNDS); runs.len()];
    for _ in 0..ROUNDS {
        for ((run, count), times) in runs.iter().zip(&counts).zip(&mut times) {
            times.push(time(run, *count));
        }
    }
    runs.into_iter()
        .zip(times)
        .map(|(run, mut times)| {
            times.sort_by(f64::total_cmp);
            Measured {
                error: error(&(run.make)(), run.time),
                micros: times[ROUNDS / 2] / run.lanes as f64 / 1e3,
                method: run.method,
                setting: run.setting,
            }
        })
        .collect()
}
