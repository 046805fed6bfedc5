//! Time per step. Takes a function that starts a method; gives nanoseconds, the minimum over a few blocks of
//! steps, since other load only adds time. For published ratios use the benches.

use crate::plan::Plan;
use clebsch::card::Card;
use clebsch_comparisons::gallery::{Offer, Problem};
use std::time::Instant;

const BLOCKS: usize = 5;

/// Steps of a block: at least about 20 microseconds, far above the resolution of the clock.
const STEPS: u64 = 2_000;

/// The generated stepper; `None` if it does not complete the steps.
pub(super) fn generated(card: &Card, plan: &Plan) -> Option<f64> {
    let steps = plan.case.steps.min(STEPS);
    least(steps, || {
        let mut trajectory = plan.open(card).ok()?;
        let begin = Instant::now();
        for _ in 0..steps {
            trajectory.step().ok()?;
        }
        Some(begin.elapsed().as_secs_f64())
    })
}

/// Another method; `None` if it does not complete the steps.
pub(super) fn other(plan: &Plan, offer: &Offer) -> Option<f64> {
    let case = &plan.case;
    let steps = case.steps.min(STEPS);
    let problem = Problem {
        parameters: &case.parameters,
        initial: &case.initial,
        h: case.h,
    };
    least(steps, || {
        let mut method = (offer.start)(&problem).ok()?;
        let begin = Instant::now();
        for _ in 0..steps {
            method.step().ok()?;
        }
        Some(begin.elapsed().as_secs_f64())
    })
}

#[allow(clippy::cast_precision_loss)]
fn least(steps: u64, block: impl Fn() -> Option<f64>) -> Option<f64> {
    let mut best = f64::INFINITY;
    for _ in 0..BLOCKS {
        best = best.min(block()?);
    }
    Some(best * 1e9 / steps.max(1) as f64)
}
