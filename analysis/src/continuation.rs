//! Continuation of relative equilibria in a parameter, through folds.

use crate::branch::{Place, Stepper};
use crate::equilibrium::{EquilibriumError, equilibrium};
use crate::error::{self, Invalid};
use crate::flow::Energy;
use crate::kkt::{Kkt, Point};
use crate::newton::Search;
use crate::variation::Variation;
use nalgebra::DVector;
use std::{error::Error, fmt};

/// The sizes of steps. They are lengths in the space of states, multipliers and the parameter together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Track {
    /// The first step.
    pub first: f64,
    /// The largest step. It bounds the distance of points, and so the folds that can be missed.
    pub largest: f64,
    /// The smallest step. The continuation fails below it.
    pub smallest: f64,
    /// The largest number of points.
    pub points: usize,
    /// When the corrections of a step end.
    pub search: Search,
}

impl Track {
    /// First step |b - a| / 50, largest |b - a| / 10, smallest 1e-9 |b - a|, and at most 1000 points.
    #[must_use]
    pub fn between(a: f64, b: f64) -> Self {
        let span = (b - a).abs();
        Self {
            first: span / 50.0,
            largest: span / 10.0,
            smallest: 1e-9 * span,
            points: 1000,
            search: Search::default(),
        }
    }
}

/// A point of a branch.
#[derive(Clone, Debug)]
pub struct BranchPoint<S> {
    /// The parameter.
    pub p: f64,
    /// The state.
    pub state: S,
    /// The m multipliers.
    pub multipliers: DVector<f64>,
    /// The norm of the equations.
    pub residual: f64,
    /// The derivative of p along the branch, per unit of length. It is zero at a fold.
    pub slope: f64,
    /// The second variation.
    pub variation: Variation,
}

/// What happens between two points of a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The branch turns back in p.
    Fold,
    /// The number of negative directions of the second variation changes, so that other branches may meet this one.
    BranchPoint {
        /// The number before.
        before: usize,
        /// The number after.
        after: usize,
    },
}

/// An event of a branch.
#[derive(Clone, Debug)]
pub struct Special<S> {
    /// What happens.
    pub event: Event,
    /// The number of the point before it.
    pub after_point: usize,
    /// The point of the event; if it could not be located, the point after it.
    pub at: BranchPoint<S>,
    /// Whether it could be located.
    pub located: bool,
}

/// How a branch ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The last point has p = b.
    Reached,
    /// The branch turned back, and the last point has p = a again.
    Returned,
    /// The largest number of points was reached.
    Points,
}

/// A branch of critical points.
#[derive(Clone, Debug)]
pub struct Branch<S> {
    /// The points, in order along the branch. The first has p = a.
    pub points: Vec<BranchPoint<S>>,
    /// Folds and branch points, in order along the branch.
    pub specials: Vec<Special<S>>,
    /// How the branch ended.
    pub end: End,
}

/// Why a continuation failed.
#[derive(Clone, Debug, PartialEq)]
pub enum ContinuationError<E> {
    /// An argument cannot be used.
    Invalid(Invalid),
    /// There is no critical point at p = a near the start.
    Start(EquilibriumError<E>),
    /// Steps became too small.
    Stalled {
        /// The last good value of the parameter.
        p: f64,
        /// The step that failed.
        step: f64,
        /// The number of points up to there.
        points: usize,
    },
}

impl<E: fmt::Display> fmt::Display for ContinuationError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(why) => why.fmt(f),
            Self::Start(why) => why.fmt(f),
            Self::Stalled { p, step, points } => write!(
                f,
                "The branch could not be followed beyond parameter {p} (point {points}): a step of {step:e} failed. Start at another branch, or allow smaller steps."
            ),
        }
    }
}

impl<E: Error + 'static> Error for ContinuationError<E> {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Start(source) => Some(source),
            _ => None,
        }
    }
}

impl<E> From<Invalid> for ContinuationError<E> {
    fn from(why: Invalid) -> Self {
        Self::Invalid(why)
    }
}

/// The branch of critical points that begins near `start` at p = `a` and leads towards p = `b`, with fixed `values` of
/// the m conserved quantities.
///
/// # Errors
///
/// An argument cannot be used, there is no critical point at the start, or steps become too small.
pub fn continuation<E: Energy>(
    energy: &E,
    start: &E::State,
    values: &[f64],
    a: f64,
    b: f64,
    track: &Track,
) -> Result<Branch<E::State>, ContinuationError<E::Error>> {
    error::finite("range of the parameter", &[a, b])?;
    for (what, given) in [
        ("first step", track.first),
        ("largest step", track.largest),
        ("smallest step", track.smallest),
        ("range of the parameter", (b - a).abs()),
    ] {
        if !(given > 0.0 && given.is_finite()) {
            return Err(Invalid::Range {
                what,
                given,
                range: "above zero",
            }
            .into());
        }
    }
    error::number("points", track.points, usize::MAX)?;
    let first =
        equilibrium(energy, start, values, a, &track.search).map_err(ContinuationError::Start)?;
    let stepper = Stepper {
        kkt: Kkt::new(energy, values)?,
        search: track.search,
    };
    let mut along = DVector::zeros(stepper.kkt.size() + 1);
    along[stepper.kkt.size()] = (b - a).signum();
    let point = Point {
        state: first.state,
        multipliers: first.multipliers,
        p: a,
    };
    let mut here = stepper
        .place(point, &along, 0)
        .map_err(ContinuationError::Start)?;
    let mut branch = Branch {
        points: vec![branch_point(&here)],
        specials: Vec::new(),
        end: End::Points,
    };
    let mut step = track.first.min(track.largest);
    while branch.points.len() < track.points {
        let Some(mut next) = stepper.step(&here, step) else {
            step /= 2.0;
            if step < track.smallest {
                let points = branch.points.len();
                return Err(ContinuationError::Stalled {
                    p: here.point.p,
                    step: 2.0 * step,
                    points,
                });
            }
            continue;
        };
        let ended = [(b, End::Reached), (a, End::Returned)]
            .into_iter()
            .find(|&(at, end)| {
                let beyond = (next.point.p - at) * (b - a).signum();
                if end == End::Reached {
                    beyond >= 0.0
                } else {
                    beyond <= 0.0
                }
            });
        let mut length = step;
        if let Some((at, end)) = ended {
            // The last point lies within the step, at p = a or p = b.
            if let Some(place) = stepper.zero(&here, step, &next, |place| Some(place.point.p - at))
            {
                length = (place.point.p - here.point.p) / (next.point.p - here.point.p) * step;
                next = place;
                next.point.p = at;
            }
            branch.end = end;
        }
        branch.specials.extend(special(
            &stepper,
            &here,
            length,
            &next,
            branch.points.len() - 1,
        ));
        branch.points.push(branch_point(&next));
        if ended.is_some() {
            break;
        }
        step = match next.iterations {
            0..=3 => (1.5 * step).min(track.largest),
            4..=5 => step,
            _ => 0.7 * step,
        };
        here = next;
    }
    Ok(branch)
}

fn branch_point<S: Clone>(of: &Place<S>) -> BranchPoint<S> {
    let Point {
        state,
        multipliers,
        p,
    } = of.point.clone();
    BranchPoint {
        p,
        state,
        multipliers,
        residual: of.residual,
        slope: of.slope(),
        variation: of.variation.clone(),
    }
}

/// The fold or branch point between two places at distance `s`.
fn special<E: Energy>(
    stepper: &Stepper<'_, E>,
    from: &Place<E::State>,
    s: f64,
    to: &Place<E::State>,
    after_point: usize,
) -> Option<Special<E::State>> {
    let (before, after) = (from.variation.negative, to.variation.negative);
    let (event, zero) = if from.slope() * to.slope() < 0.0 {
        (
            Event::Fold,
            stepper.zero(from, s, to, |place| Some(place.slope())),
        )
    } else if before != after {
        let critical = before.min(after);
        let value = |place: &Place<E::State>| place.variation.eigenvalues.get(critical).copied();
        (
            Event::BranchPoint { before, after },
            stepper.zero(from, s, to, value),
        )
    } else {
        return None;
    };
    let located = zero.is_some();
    Some(Special {
        event,
        after_point,
        at: branch_point(zero.as_ref().unwrap_or(to)),
        located,
    })
}
