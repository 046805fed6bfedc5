//! Continuation of relative equilibria in a parameter, through folds.

use crate::branch::{Place, Stepper};
use crate::equilibrium::equilibrium;
use crate::error::{self, Invalid};
use crate::flow::Energy;
use crate::kkt::Kkt;
use crate::track::{Branch, ContinuationError, End, Event, Special, Track};
use nalgebra::DVector;

/// An event that cannot be located may be a jump to another branch. The step is then repeated with half its length,
/// down to this part of the first step.
const DOUBTFUL: f64 = 1e-4;

/// The branch of critical points that begins near `start` at p = `a` and leads towards p = `b`. The m conserved
/// quantities keep the given `values`.
///
/// # Errors
///
/// An argument cannot be used, the search at the start fails, or steps become too small.
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
    let (kkt, point) =
        Kkt::new(energy, values, &first.state, a).map_err(ContinuationError::Start)?;
    let stepper = Stepper {
        kkt,
        search: track.search,
    };
    let mut along = DVector::zeros(stepper.kkt.size() + 1);
    along[stepper.kkt.size()] = (b - a).signum();
    let mut here = stepper
        .place(point, &along, 0)
        .map_err(ContinuationError::Start)?;
    let mut branch = Branch {
        points: vec![stepper.branch_point(&here)],
        specials: Vec::new(),
        end: End::Points,
    };
    let mut step = track.first.min(track.largest);
    while branch.points.len() < track.points {
        let Some((next, length, end)) = attempt(&stepper, &here, step, (a, b)) else {
            if step / 2.0 < track.smallest {
                let points = branch.points.len();
                return Err(ContinuationError::Stalled {
                    p: here.point.p,
                    step,
                    points,
                });
            }
            step /= 2.0;
            continue;
        };
        let special = special(&stepper, &here, length, &next, branch.points.len() - 1);
        if special.as_ref().is_some_and(|special| !special.located) && step > DOUBTFUL * track.first
        {
            step /= 2.0;
            continue;
        }
        branch.specials.extend(special);
        branch.points.push(stepper.branch_point(&next));
        if let Some(end) = end {
            branch.end = end;
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

/// A place within one step, its distance, and the end of the branch if the place is at p = `a` or p = `b`.
type Attempt<E> = (Place<<E as Energy>::State>, f64, Option<End>);

/// One step along the branch, shortened at the ends of the range. None if the step is too long.
fn attempt<E: Energy>(
    stepper: &Stepper<'_, E>,
    here: &Place<E::State>,
    step: f64,
    (a, b): (f64, f64),
) -> Option<Attempt<E>> {
    let next = stepper.step(here, step)?;
    let forward = (b - a).signum();
    let (at, end) = match next.point.p {
        p if (p - b) * forward >= 0.0 => (b, End::Reached),
        p if (p - a) * forward <= 0.0 => (a, End::Returned),
        _ => return Some((next, step, None)),
    };
    let (mut place, located) = stepper.zero(here, step, &next, |place| Some(place.point.p - at))?;
    let length = (place.point.p - here.point.p) / (next.point.p - here.point.p) * step;
    place.point.p = at;
    located.then_some((place, length, Some(end)))
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
    let (place, located) = zero.unwrap_or_else(|| (to.clone(), false));
    Some(Special {
        event,
        after_point,
        at: stepper.branch_point(&place),
        located,
    })
}
