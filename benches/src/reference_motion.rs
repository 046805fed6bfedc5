//! The motion of a free body to thirty digits by its Taylor series, as the reference for errors near double-precision rounding.
//! Takes a start with diagonal inertia and a time in double-double; gives attitude and body momentum.

use clebsch::num_traits::{One, Zero};
use clebsch::{DoubleDouble, Real};
use clebsch_comparisons::body::Start;

type Quad = DoubleDouble;

/// Number of coefficients. With expansions over 1/8 time unit and rates of order one, the last is below 1e-34.
const TERMS: usize = 30;

/// A state of the continuous motion.
#[derive(Clone, Copy, Debug)]
pub struct Phase {
    /// Unit quaternion of the attitude, body -> space.
    pub attitude: [f64; 4],
    /// Body momentum.
    pub body_momentum: [f64; 3],
}

impl Phase {
    /// The larger of the relative momentum error and the attitude error in radians.
    pub fn error(&self, attitude: &[f64; 4], body_momentum: &[f64; 3]) -> f64 {
        let length = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let away: [f64; 3] = std::array::from_fn(|i| body_momentum[i] - self.body_momentum[i]);
        // q and -q are the same rotation; for a small angle, their distance is half of it.
        let apart = |sign: f64| {
            let difference: [f64; 4] =
                std::array::from_fn(|i| attitude[i] - sign * self.attitude[i]);
            length(&difference)
        };
        let angle = 4.0 * (0.5 * apart(1.0).min(apart(-1.0))).min(1.0).asin();
        // NaN must not count as the smaller error.
        let momentum = length(&away) / length(&self.body_momentum);
        if momentum.is_nan() || angle.is_nan() {
            return f64::INFINITY;
        }
        angle.max(momentum)
    }
}

/// The state at a time.
pub fn at(start: &Start, time: Quad) -> Phase {
    let [[x, ..], [_, y, _], [.., z]] = start.poinsot;
    let quad = Quad::from_f64;
    // Moments are sums that the other methods round once to a double; uses the same rounded body.
    let rate = [y + z, z + x, x + y].map(|moment| Quad::one() / quad(moment));
    let pieces = (time.value() * 8.0).ceil().max(1.0);
    let h = time / quad(pieces);
    let (mut q, mut mu) = (start.attitude.0.map(quad), start.body_momentum.map(quad));
    let mut done = 0.0;
    while done < pieces {
        (q, mu) = expanded(q, mu, &rate, h);
        done += 1.0;
    }
    Phase {
        attitude: q.map(Quad::value),
        body_momentum: mu.map(Quad::value),
    }
}

/// One expansion: `mu' = mu x w`, `q' = q (0, w) / 2`, `w_i = rate_i mu_i`.
fn expanded(q: [Quad; 4], mu: [Quad; 3], rate: &[Quad; 3], h: Quad) -> ([Quad; 4], [Quad; 3]) {
    let mut turn = [[Quad::zero(); TERMS]; 4];
    let mut momentum = [[Quad::zero(); TERMS]; 3];
    for (series, value) in turn.iter_mut().zip(q) {
        series[0] = value;
    }
    for (series, value) in momentum.iter_mut().zip(mu) {
        series[0] = value;
    }
    for n in 0..TERMS - 1 {
        let product = |a: &[Quad; TERMS], b: &[Quad; TERMS]| {
            (0..=n).fold(Quad::zero(), |sum, k| sum + a[k] * b[n - k])
        };
        let over = Quad::one() / Quad::from_f64((n + 1) as f64);
        let half = over * Quad::from_f64(0.5);
        let pair = |i: usize, j: usize| product(&momentum[i], &momentum[j]);
        let torque = [
            pair(1, 2) * (rate[2] - rate[1]),
            pair(2, 0) * (rate[0] - rate[2]),
            pair(0, 1) * (rate[1] - rate[0]),
        ];
        let spin = |i: usize, j: usize| product(&turn[i], &momentum[j]) * rate[j];
        let turned = [
            -(spin(1, 0) + spin(2, 1) + spin(3, 2)),
            spin(0, 0) + spin(2, 2) - spin(3, 1),
            spin(0, 1) + spin(3, 0) - spin(1, 2),
            spin(0, 2) + spin(1, 1) - spin(2, 0),
        ];
        for (series, value) in momentum.iter_mut().zip(torque) {
            series[n + 1] = value * over;
        }
        for (series, value) in turn.iter_mut().zip(turned) {
            series[n + 1] = value * half;
        }
    }
    let sum = |series: &[Quad; TERMS]| {
        let terms = series.iter().rev();
        terms.fold(Quad::zero(), |sum, term| sum * h + *term)
    };
    (
        [0, 1, 2, 3].map(|i| sum(&turn[i])),
        [0, 1, 2].map(|i| sum(&momentum[i])),
    )
}
