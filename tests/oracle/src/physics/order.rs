//! Order of convergence by step halving against the continuous motion: errors at step sizes h, h/2, h/4, ..., and the orders
//! between neighbours.

use super::measure::worse;
use super::motion::Motion;
use super::taylor_reference::Phase;

/// Errors of a motion at a fixed time for a sequence of halved step sizes.
#[derive(Clone, Debug)]
pub struct Errors {
    /// Largest deviation of a component of the body momentum.
    pub momentum: Vec<f64>,
    /// Largest deviation of an entry of the attitude matrix.
    pub attitude: Vec<f64>,
}

/// Runs `start(h)` to `time` with `steps`, `2 steps`, ... (`halvings` times) and compares with `truth`.
pub fn errors<M: Motion>(
    start: impl Fn(f64) -> M,
    time: f64,
    steps: u64,
    halvings: u32,
    truth: &Phase,
) -> Result<Errors, String> {
    let (mut momentum, mut attitude) = (Vec::new(), Vec::new());
    let exact = truth.attitude.matrix();
    for halving in 0..=halvings {
        let count = steps << halving;
        let mut motion = start(time / count as f64);
        for _ in 0..count {
            motion.step()?;
        }
        let mu = motion.body_momentum();
        momentum.push(
            (0..3)
                .map(|i| (mu[i] - truth.body_momentum[i]).abs())
                .fold(0.0, worse),
        );
        let r = motion.attitude();
        attitude.push(
            (0..9)
                .map(|i| (r[i / 3][i % 3] - exact[i / 3][i % 3]).abs())
                .fold(0.0, worse),
        );
    }
    Ok(Errors { momentum, attitude })
}

/// log2 of the ratio of neighbouring errors.
pub fn orders(errors: &[f64]) -> Vec<f64> {
    errors
        .windows(2)
        .map(|pair| (pair[0] / pair[1]).log2())
        .collect()
}

/// Whether the two finest halvings show `order` to within 0.05, with errors well above rounding (`floor`).
pub fn confirms(errors: &[f64], order: f64, floor: f64) -> bool {
    let measured = orders(errors);
    let clear = errors.iter().rev().take(3).all(|e| *e > 100.0 * floor);
    measured.len() >= 2
        && clear
        && measured
            .iter()
            .rev()
            .take(2)
            .all(|o| (o - order).abs() <= 0.05)
}
