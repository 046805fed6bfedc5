//! Times many short integrations in interleaved rounds: every round runs a block of each, so that a drift of the machine affects
//! all equally. Gives the error and the median time of each run.

use super::precision::{MOMENTS, MOMENTUM};
use clebsch::DoubleDouble;
use clebsch_benches::blocks::computed;
use clebsch_benches::body::start_of;
use clebsch_benches::reference_motion;
use std::hint::black_box;

/// Number of rounds.
const ROUNDS: usize = 41;

/// Nanoseconds per block, far above the clock resolution.
const BLOCK: f64 = 1e6;

/// The end of an integration: quaternion and body momentum.
pub type End = ([f64; 4], [f64; 3]);

/// One integration of the problem from start to end.
pub struct Run {
    /// The method.
    pub method: String,
    /// Its step size or its tolerance.
    pub setting: String,
    /// Number of trajectories in lanes.
    pub lanes: usize,
    /// The end time: the multiple of the step size that is closest to the end time of the problem.
    pub time: DoubleDouble,
    /// Runs it.
    pub make: Box<dyn Fn() -> End>,
}

/// A measurement.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The method.
    pub method: String,
    /// Its step size or its tolerance.
    pub setting: String,
    /// The larger of the relative momentum error and the attitude error in radians.
    pub error: f64,
    /// CPU microseconds per trajectory.
    pub micros: f64,
}

/// The error at the end.
pub fn error((attitude, momentum): &End, time: DoubleDouble) -> f64 {
    reference_motion::at(&start_of(MOMENTS, MOMENTUM, 1.0), time).error(attitude, momentum)
}

/// Measures all runs.
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
