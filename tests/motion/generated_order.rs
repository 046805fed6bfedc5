//! Measures the order of the generated steppers by step halving against the continuous motion: 2.00 +- 0.05. The tests of the
//! hand-written steppers check that the same measurement finds order one for one-sided schemes.

use super::generated_motion::{GeneratedBody, GeneratedTop};
use clebsch_oracle::physics::cases::{Start, asymmetric_body, generic_top, lagrange_top};
use clebsch_oracle::physics::motion::Motion;
use clebsch_oracle::physics::order::{confirms, errors, orders};
use clebsch_oracle::physics::taylor_reference::{Phase, flow};
use clebsch_oracle::reference::asymmetric_body_errors;

/// Rounding error of the least accurate numbers in an error: a few thousand steps of the motion and the series.
const FLOOR: f64 = 1e-13;

fn second_order<M: Motion>(
    start: &Start,
    make: impl Fn(&Start) -> M,
    time: f64,
    steps: u64,
) -> Vec<f64> {
    let phase = Phase {
        attitude: start.attitude.normalised(),
        body_momentum: start.body_momentum,
    };
    let truth = flow(&start.top, &phase, time);
    let measured = errors(|h| make(&start.with_step(h)), time, steps, 4, &truth).expect("solvable");
    println!(
        "{measured:?} {:?} {:?}",
        orders(&measured.momentum),
        orders(&measured.attitude)
    );
    assert!(confirms(&measured.momentum, 2.0, FLOOR), "{measured:?}");
    assert!(confirms(&measured.attitude, 2.0, FLOOR), "{measured:?}");
    measured.attitude
}

#[test]
fn free_body() {
    let attitude = second_order(&asymmetric_body(), GeneratedBody::start, 10.0, 50);
    for (error, recorded) in attitude.iter().zip(asymmetric_body_errors::ATTITUDE) {
        assert!(
            (error / recorded - 1.0).abs() < 1e-4,
            "{error:e} for {recorded:e}"
        );
    }
}

#[test]
fn heavy_tops() {
    second_order(&generic_top(), GeneratedTop::start, 2.0, 20);
    second_order(&lagrange_top(), GeneratedTop::start, 2.0, 20);
}
