//! One long run, looked at between the projections as often as behind them.
//! Takes a start, an order and whether to project; gives the largest errors, their trend and the corrections made.

use super::phase::{Lag, Phase};
use clebsch::Order;
use clebsch_benches::body::Generated;
use clebsch_comparisons::body::{BodyMotion, Start};
use clebsch_comparisons::handwritten::attitude::{apply, dot};
use clebsch_oracle::physics::trend::{Trend, trend};

/// Steps of a run: a whole number of [`STRIDE`]s.
pub const STEPS: u64 = 100_000_000;

/// Steps between two projections of the stepper.
const STRIDE: u64 = 64;

/// Every so many strides the motion is looked at, at another place of the stride each time.
const SPARSE: u64 = 16;

/// Steps of the beginning, where it is looked at in every stride.
const EARLY: u64 = 1_000_000;

/// Nodes whose phase is reported.
const REPORTED: [u64; 3] = [10_000, 1_000_000, STEPS];

/// Sizes seen.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    sum: f64,
    count: u64,
    /// The largest.
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

/// What a run has shown. Errors are relative to the start.
pub struct Course {
    /// Largest error of mu . I^-1 mu / 2.
    pub energy: f64,
    /// Largest error of |mu|^2.
    pub square: f64,
    /// Largest |R mu - m| over |m| in the first million steps.
    pub spatial_early: f64,
    /// The same over the whole run.
    pub spatial: f64,
    /// How |R mu - m| over |m| changes, by equally spaced samples.
    pub trend: Trend,
    /// What the projections changed in the momentum.
    pub momentum: Tally,
    /// And in the attitude, in radians.
    pub attitude: Tally,
    /// Behind the closed form, at the nodes reported.
    pub lags: Vec<Lag>,
}

/// Errors at one node.
struct Sample {
    energy: f64,
    square: f64,
    spatial: f64,
}

/// Makes the run.
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
        // What the solver keeps, not what the state makes of its constant spatial momentum.
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
            // Thirty-seven has no divisor in common with the stride.
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
