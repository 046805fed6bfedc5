//! A stage of the curve from rest to the principal root: one step from a point of the curve to the next.
//!
//! If a part lacks a natural scale, for example a field, its equations may vary over any length. The stage then checks
//! the equations at points in between, more densely if they are rough. It also checks the tangent, which shows changes
//! in parts that move little.
//!
//! Takes the equations and a fraction of the path; gives the next point, or a shorter fraction to try.

use super::changes::{CHANGE, Changes};
use super::checked_points::{JudgedDifference, Remainders, looks, shared_noise};
use super::parts::SlowPartTest;
use super::principal::{Curve, FALLS};
use crate::linalg::{Dense, Reals};
use crate::scalar::larger;

/// The largest number of corrections after the first two. They converge quadratically.
const MOST_CORRECTIONS: usize = 12;

/// The last stage ends with a correction below this fraction of its length; the error left is about its square. Close
/// to a fold, rounding permits no smaller value.
const SOLVED: f64 = 1e-6;

/// Corrections below this fraction of the rounding error of a length count as rounding.
const ROUNDED: f64 = 0.1;

/// A stage that is not the last ends once its corrections are below this fraction of its length.
const NEAR: f64 = 1e-3;

/// If corrections do not decrease, the next stage is shorter by this factor.
const WORSE: f64 = 0.2;

/// In a stage, the equations may change by this factor more than in a step judged by one correction.
const STEEP: f64 = 1.5;

/// The largest number of times that a rough piece of the path is halved, and the smallest change of slope that causes
/// a halving.
const HALVINGS: u8 = 5;
const BEND: f64 = 1e-2;

/// The fraction of the longest admissible length that is tried next, and the smallest fraction of a rejected length.
pub(super) const AIM: f64 = 0.8;
const SHORTEST_TRY: f64 = 0.1;

/// A point of the curve, with the tangent at that point.
pub(super) struct Stage<G> {
    velocity: G,
    pub residual: Reals,
    inverse: Dense<f64>,
    pub units: Reals,
    /// Whether some part lacks a natural scale.
    open: bool,
}

impl<G: Clone> Stage<G> {
    /// The stage that starts at `velocity`; `None` if the tangent is singular or not finite.
    pub(super) fn at<C: Curve<Velocity = G>>(
        curve: &C,
        velocity: G,
        tangent: &Dense<f64>,
    ) -> Option<Self> {
        let inverse = tangent.balanced_inverse().filter(Dense::is_finite)?;
        Some(Self {
            residual: curve.residual(&velocity),
            units: curve
                .parts()
                .units(&|i, j| tangent.at(i, j), SlowPartTest::OfStage),
            open: curve.parts().kinds().are_open(&|i, j| tangent.at(i, j)),
            velocity,
            inverse,
        })
    }

    /// The correction, with this stage's tangent, that changes the residual to `goal`.
    pub(super) fn correction(&self, goal: &[f64], residual: &[f64]) -> Reals {
        corrected(&self.inverse, goal, residual)
    }
}

fn corrected(inverse: &Dense<f64>, goal: &[f64], residual: &[f64]) -> Reals {
    let change = goal.iter().zip(residual).map(|(x, y)| x - y);
    Reals::from_vec(inverse.times(&Dense::column_of(change.collect())).data)
}

pub(super) fn times(x: &[f64], factor: f64) -> Reals {
    x.iter().map(|x| x * factor).collect()
}

pub(super) fn less(x: &[f64], y: &[f64]) -> Reals {
    x.iter().zip(y).map(|(x, y)| x - y).collect()
}

/// The larger of two numbers; NaN if either is NaN.
fn worse(a: f64, b: f64) -> f64 {
    if b <= a { a } else { b + 0.0 * a }
}

/// The largest ratio of a length to its bound; NaN if any ratio is NaN.
pub(super) fn ratio(lengths: &[f64], bounds: &[f64]) -> f64 {
    let each = lengths.iter().zip(bounds);
    // A part of length zero does not move, even if its bound is zero.
    let each = each.map(|(x, bound)| if *x == 0.0 { 0.0 } else { x / bound });
    crate::scalar::largest(each)
}

/// The end of a stage.
pub(super) struct StageEnd<G> {
    pub velocity: G,
    /// The tangent at the end, if it was evaluated.
    pub tangent: Option<Dense<f64>>,
    /// The reference lengths of the parts.
    pub course: Reals,
    /// The ratio of the second to the first correction, which grows with the length of the stage.
    pub fall: f64,
}

/// Completes a stage, or returns the fraction of its length to try next. If `is_looked_at`, the equations between its
/// ends are checked.
pub(super) fn ended<C: Curve>(
    curve: &C,
    stage: &Stage<C::Velocity>,
    goal: &[f64],
    last: bool,
    is_looked_at: bool,
) -> Result<StageEnd<C::Velocity>, f64> {
    let parts = curve.parts();
    let first = stage.correction(goal, &stage.residual);
    let course = parts.course(&parts.lengths(&first), &stage.units, |b| curve.noise(b));
    let mut at = curve.moved(&stage.velocity, &first);
    let second = stage.correction(goal, &curve.residual(&at));
    let mut fall = ratio(&parts.lengths(&second), &course);
    let mut steepest = 0.0;
    let looks = stage.open && is_looked_at;
    if looks {
        let [left, slope] = on_the_way(curve, stage, goal, &first, &course);
        fall = worse(fall, left);
        steepest = slope;
    }
    let most = worse(fall, steepest);
    if !course.iter().all(|x| x.is_finite()) || !most.is_finite() {
        return Err(WORSE);
    }
    if most > FALLS {
        return Err((AIM * FALLS / most).clamp(SHORTEST_TRY, AIM));
    }
    at = curve.moved(&at, &second);
    let enough = if last { SOLVED } else { NEAR };
    let mut before = fall;
    for _ in 0..MOST_CORRECTIONS {
        if !last && before <= enough {
            break;
        }
        let inverse = curve.tangent(&at).balanced_inverse().ok_or(WORSE)?;
        let correction = corrected(&inverse, goal, &curve.residual(&at));
        let lengths = parts.lengths(&correction);
        let known = lengths.iter().enumerate();
        let known: Reals = known
            .map(|(b, x)| {
                if *x <= ROUNDED * curve.noise(b) {
                    0.0
                } else {
                    *x
                }
            })
            .collect();
        let size = ratio(&known, &course);
        at = curve.moved(&at, &correction);
        if size <= enough {
            before = size;
            break;
        }
        // NaN does not count as a decrease.
        let falls = size <= 0.5 * before;
        if !falls {
            return Err(WORSE);
        }
        before = size;
    }
    // The comparison is false for NaN.
    let solved = before <= enough;
    if !solved {
        return Err(WORSE);
    }
    let tangent = looks.then(|| curve.tangent(&at));
    if let Some(end) = &tangent {
        let way = |share: f64| {
            let straight = curve.moved(&stage.velocity, &times(&first, share));
            curve.tangent(&curve.moved(&straight, &times(&second, share * share)))
        };
        let changes = Changes::from(&stage.inverse, &stage.units, parts);
        let change = changes.on_the_way(&way, end);
        if !change.is_finite() {
            return Err(WORSE);
        }
        if change > CHANGE {
            return Err((AIM * CHANGE / change).clamp(SHORTEST_TRY, AIM));
        }
    }
    Ok(StageEnd {
        velocity: at,
        tangent,
        course,
        fall,
    })
}

/// Measures a remainder at a point, and a change between two points, relative to the reference lengths.
struct Judges<'a> {
    value: &'a dyn Fn(&[f64]) -> f64,
    slope: &'a dyn Fn(&JudgedDifference<Reals>) -> f64,
}

/// The largest remainder of the equations between the ends of a stage, and its largest change between two checked
/// points, as corrections relative to the reference lengths.
fn on_the_way<C: Curve>(
    curve: &C,
    stage: &Stage<C::Velocity>,
    goal: &[f64],
    first: &[f64],
    course: &[f64],
) -> [f64; 2] {
    let off = |share: f64| {
        let between = goal.iter().zip(&stage.residual);
        let between: Reals = between.map(|(x, y)| y + share * (x - y)).collect();
        let there = curve.moved(&stage.velocity, &times(first, share));
        stage.correction(&between, &curve.residual(&there))
    };
    let of = |x: &[f64]| ratio(&curve.parts().lengths(x), course);
    let own: Reals = (0..curve.parts().count()).map(|b| curve.noise(b)).collect();
    let shared = shared_noise(&own, &stage.units);
    // If the rounding error is unknown, slopes may be only rounding.
    let known = shared > 0.0;
    let noise = |b: usize| {
        let unit = stage.units.get(b).copied().unwrap_or(0.0);
        larger(curve.noise(b), shared * unit)
    };
    // Changes at rounding level do not count.
    let judge = |x: &JudgedDifference<Reals>| {
        let lengths = curve.parts().lengths(&times(&x.difference, x.factor));
        let known = lengths.iter().enumerate().map(|(b, length)| {
            match *length <= FALLS * x.noise(noise(b)) {
                true => 0.0,
                false => *length,
            }
        });
        ratio(&known.collect::<Reals>(), course) / STEEP
    };
    let nothing = Reals::from_elem(0.0, first.len());
    let mut seen = vec![(0.0, nothing.clone())];
    let mut so_far = Remainders::nothing(nothing);
    let (mut left, mut steepest, mut rough) = (0.0, 0.0, vec![]);
    // The tangent is exact at the start of the stage, so the additional first point is skipped.
    for look in looks(1.0).filter(|look| look.is_regular()) {
        let here = off(look.share);
        let [slope, fourth] = so_far.next(look, &here, |x, y| less(x, y));
        left = worse(left, of(&here));
        if known {
            steepest = worse(steepest, slope.as_ref().map_or(0.0, judge));
        }
        seen.push((look.share, here));
        rough.push(fourth.is_some_and(|x| judge(&x) > FALLS));
    }
    let judges = Judges {
        value: &of,
        slope: &judge,
    };
    for (k, ends) in seen.windows(2).enumerate() {
        // A fourth difference covers four pieces.
        let is_rough = rough.iter().skip(k).take(4).any(|x| *x);
        if let ([from, to], true) = (ends, known && is_rough && worse(left, steepest) <= FALLS) {
            steepest = worse(steepest, left_between(&off, &judges, [from, to], HALVINGS));
        }
    }
    [left, steepest]
}

/// Like `on_the_way`, between two checked points, if the equations are rough.
fn left_between(
    off: &dyn Fn(f64) -> Reals,
    judges: &Judges<'_>,
    [from, to]: [&(f64, Reals); 2],
    halvings: u8,
) -> f64 {
    let half = 0.5 * (to.0 - from.0);
    let middle = (from.0 + half, off(from.0 + half));
    let [before, after] = [less(&middle.1, &from.1), less(&to.1, &middle.1)];
    let bend = (judges.slope)(&JudgedDifference::slope(less(&after, &before), half));
    let slopes = [before, after].map(|x| (judges.slope)(&JudgedDifference::slope(x, half)));
    let most = slopes.into_iter().fold((judges.value)(&middle.1), worse);
    let halved = halvings > 0 && most <= FALLS && bend > BEND;
    if !halved {
        return most;
    }
    let ends = [[from, &middle], [&middle, to]];
    let each = ends.map(|ends| left_between(off, judges, ends, halvings - 1));
    each.into_iter().fold(most, worse)
}
