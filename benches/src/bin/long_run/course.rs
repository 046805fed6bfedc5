//! One long run, sampled between projections and directly after them. Takes a start, an order and whether to project; gives the
//! largest errors, their trend and the corrections.

use super::phase::{Lag, Phase};
use clebsch::Order;
use clebsch_benches::body::Generated;
use clebsch_comparisons::body::{BodyMotion, Start};
use clebsch_comparisons::handwritten::attitude::{apply, dot};
use clebsch_oracle::physics::drift_detection::{Trend, trend};

/// Steps of a run, a multiple of [`STRIDE`].
pub const STEPS: u64 = 100_000_000;

/// Steps between two projections of the stepper.
const STRIDE: u64 = 64;

/// One in this many strides is sampled, each time at another step of the stride.
const SPARSE: u64 = 16;

/// Initial steps, in which every stride is sampled.
const EARLY: u64 = 1_000_000;

/// Nodes at which the phase is reported.
const REPORTED: [u64; 3] = [10_000, 1_000_000, STEPS];

/// Statistics of a size.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    sum: f64,
    count: u64,
    /// The largest value.
    pub largest: f64,
}

impl Tally {
    fn add(&mut self, size: f64) {
        self.sum += size;
        self.count += 1;
        self.largest = self.largest.max(size);
    }

    /// The mean.
    #[allow(clippy::cast_precision_loss)]
    pub fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}

/// The results of a run. Errors are relative to the initial values.
pub struct Course {
    /// Largest error of mu . I^-1 mu / 2.
    pub energy: f64,
    /// Largest error of |mu|^2.
    pub square: f64,
    /// Largest |R mu - m| over |m| in the first million steps.
    pub spatial_early: f64,
    /// Largest |R mu - m| over |m| in the whole run.
    pub spatial: f64,
    /// The trend of |R mu - m| over |m| in equally spaced samples.
    pub trend: Trend,
    /// The corrections of the momentum by projections.
    pub momentum: Tally,
    /// The corrections of the attitude by projections, in radians.
    pub attitude: Tally,
    /// The phase error relative to the closed form, at the reported nodes.
    pub lags: Vec<Lag>,
}

/// Errors at one node.
struct Sample {
    energy: f64,
    square: f64,
    spatial: f64,
}

/// Runs the motion.
pub fn run(start: &Start, order: Order, projects: bool) -> Course {
    let mut body = Generated::start(start, order);
    if !projects {
        body.workspace = body.workspace.without_projection();
    }
    let inverse = {
        let [[x, ..], [_, y, _], [.., z]] = start.poinsot;
        [1.0 / (y + z), 1.0 / (z + x), 1.0 / (x + y)]
    };
    let energy = |m: &[f64; 3]| 0.5 * (0..3).map(|i| inverse[i] * m[i] * m[i]).sum::<f64>();
    let first = start.body_momentum;
    let (energy_0, square_0) = (energy(&first), dot(&first, &first));
    let look = |body: &Generated| {
        // The momentum that the solver stores, not the one that the state computes from its constant spatial momentum.
        let mu: [f64; 3] = body.workspace.solver().body_momentum().0.into();
        let away = apply(&body.attitude().matrix(), &mu);
        // The attitude starts at the identity.
        let away: [f64; 3] = std::array::from_fn(|i| away[i] - first[i]);
        Sample {
            energy: (energy(&mu) - energy_0).abs() / energy_0,
            square: (dot(&mu, &mu) - square_0).abs() / square_0,
            spatial: (dot(&away, &away) / square_0).sqrt(),
        }
    };
    let mut course = Course {
        energy: 0.0,
        square: 0.0,
        spatial_early: 0.0,
        spatial: 0.0,
        trend: trend(&[0.0]),
        momentum: Tally::default(),
        attitude: Tally::default(),
        lags: Vec::new(),
    };
    let mut phase = Phase::start(start);
    let mut regular = Vec::new();
    let advance = |body: &mut Generated, steps: u64| {
        for _ in 0..steps {
            body.model
                .step(&mut body.state, &mut body.workspace)
                .expect("solvable");
        }
    };
    for stride in 0..STEPS / STRIDE {
        let sparse = stride % SPARSE == 0;
        if sparse || stride * STRIDE < EARLY {
            // Thirty-seven and the stride are coprime.
            let ahead = 37 * (stride / SPARSE + stride % SPARSE) % STRIDE;
            advance(&mut body, ahead);
            let here = look(&body);
            course.energy = course.energy.max(here.energy);
            course.square = course.square.max(here.square);
            course.spatial = course.spatial.max(here.spatial);
            if sparse {
                regular.push(here.spatial);
                phase.follow(&body);
            }
            advance(&mut body, STRIDE - ahead);
        } else {
            advance(&mut body, STRIDE);
        }
        let correction = body.workspace.solver().correction();
        course.momentum.add(correction.momentum);
        course.attitude.add(correction.attitude);
        let (node, next) = ((stride + 1) * STRIDE, (stride + 2) * STRIDE);
        if node <= EARLY && EARLY < next {
            course.spatial_early = course.spatial;
        }
        if REPORTED.iter().any(|at| node <= *at && *at < next) {
            course.lags.push(phase.follow(&body));
        }
    }
    course.trend = trend(&regular);
    course
}
