//! The principal root of the equations of a step as [`principal`](crate::solvers::newton::trace) finds it, in
//! lists: of any group and any number of unknowns, compiled once.
//! Takes the equations of one lane; gives the root, with a region in which it is the only one.

use super::curve::{Chart, Curve, Lane, Met, Parts, Point};
use super::lasting::lasting;
use super::stage::{MARGIN, Stage, fits};
use crate::scalar::largest;
use crate::solvers::newton::node::Spread;
use crate::solvers::newton::principal::{
    AIM, Care, Fold, INNER, LITTLE, LONGER, MOST_PROOFS, MOST_STAGES, SHORTER, SURE, shortest,
};

/// What was found out on a curve.
#[derive(Clone, Debug)]
pub(super) enum Found<G = Point> {
    /// As [`Traced::Principal`](crate::solvers::newton::Traced::Principal).
    Principal { reach: Vec<f64>, spread: Spread },
    /// As [`Traced::Elsewhere`](crate::solvers::newton::Traced::Elsewhere).
    Elsewhere { root: G, reach: Vec<f64> },
}

/// Finds the principal root, or shows that `solution` is, for a group that a value describes.
#[cold]
pub(super) fn trace_lane<C: Chart>(
    equations: &Lane<C>,
    solution: Option<&C::Element>,
    care: Care,
) -> Result<Found<C::Element>, Fold> {
    let met = Met::new(equations);
    let solution = solution.map(|found| met.keep(found.clone()));
    Ok(match traced(&met, solution, care)? {
        Found::Principal { reach, spread } => Found::Principal { reach, spread },
        Found::Elsewhere { root, reach } => Found::Elsewhere {
            root: met.get(root),
            reach,
        },
    })
}

fn traced(curve: &dyn Curve, solution: Option<Point>, care: Care) -> Result<Found, Fold> {
    let rest = curve.rest();
    let at_rest = curve.residual(rest);
    let Some(stage) = Stage::at(curve, rest, at_rest) else {
        return Err(Fold::at(0.0, 0));
    };
    let units = stage.units(curve.parts());
    let whole = stage.toward(&nowhere(curve));
    if !whole.iter().all(|x| x.is_finite()) {
        return Err(Fold::at(0.0, 0));
    }
    let lengths = curve.parts().lengths(&whole);
    if let (Some(found), true) = (solution, care.lasting) {
        let own = curve.extents(None, found);
        let wanted = own.iter().zip(&lengths).zip(&units);
        let wanted: Vec<f64> = wanted
            .map(|((own, length), unit)| own.max(*length).max(0.01 * unit))
            .collect();
        if let Some(proved) = lasting(curve, &stage, &wanted, care.everywhere) {
            return Ok(proved);
        }
    }
    // What cannot be followed without a proof is not followed with one, a hundred times more slowly.
    let mut first = 1.0;
    let mut found = follow(curve, stage.clone(), solution, &mut first, false);
    if found.is_ok() && care.proved {
        found = follow(curve, stage.clone(), solution, &mut first, true);
    }
    // That there is no proof does not mean that there is a fold.
    found.or_else(|reached| {
        let reached = match care.proved {
            true => None,
            false => reached,
        };
        closely(curve, stage, reached, solution)
    })
}

/// A point of the curve and the part of the way to it.
type Reached = Option<(Stage, f64)>;

/// Residuals that vanish.
fn nowhere(curve: &dyn Curve) -> Vec<f64> {
    vec![0.0; curve.parts().dimension()]
}

fn times(x: &[f64], factor: f64) -> Vec<f64> {
    x.iter().map(|x| x * factor).collect()
}

/// Follows the curve stage by stage from rest, each stage proved or foreseen from its end. `first` is how long a first
/// stage is tried, and was in the end. Where the curve is lost, gives up to where it was followed.
fn follow(
    curve: &dyn Curve,
    rest: Stage,
    solution: Option<Point>,
    first: &mut f64,
    proved: bool,
) -> Result<Found, Reached> {
    let parts = curve.parts();
    let at_rest = rest.residual.clone();
    let units = rest.units(parts);
    let mut stage = rest;
    let mut whole = stage.toward(&nowhere(curve));
    let lengths = parts.lengths(&whole);
    let (mut share, mut length) = (0.0, *first);
    // What the velocity moves by on the way, in every direction a little.
    let mut course = course(&lengths, &units, 1.0);
    let mut radii = vec![0.0; parts.count()];
    let (most_stages, aim) = match proved {
        true => (MOST_PROOFS, SURE),
        false => (MOST_STAGES, AIM),
    };
    for _ in 0..most_stages {
        if share >= 1.0 {
            break;
        }
        let left = 1.0 - share;
        let mut accepted = None;
        let mut next_length = length;
        let [most, least] = SHORTER;
        while accepted.is_none() {
            length = length.min(left);
            if length < shortest(share) {
                return Err(Some((stage, share)));
            }
            let end = if length >= left { 1.0 } else { share + length };
            let goal = times(&at_rest, 1.0 - end);
            let toward = stage.toward(&goal);
            let own = parts.lengths(&toward);
            radii = course.iter().map(|x| MARGIN * length * x).collect();
            let (moved, strain) = match proved {
                true => stage.move_within(curve, &radii, &own),
                false => stage.move_foreseen(curve, &toward, &radii, &own),
            };
            // Lengths are in proportion to strains.
            let longer = match strain.is_nan() {
                true => least,
                false => (aim / strain).min(LONGER),
            };
            next_length = longer * length;
            let inner: Vec<f64> = radii.iter().map(|r| INNER * r).collect();
            let enough = moved.as_ref().is_some_and(|y| fits(y, &inner));
            if enough {
                accepted = stage
                    .solve(curve, &toward, &goal, &radii)
                    .map(|next| (next, end));
            } else if let Some(y) = moved {
                course = reshaped(&course, &y, &own);
            }
            if accepted.is_none() {
                length = next_length.max(least * length).min(most * length);
            }
        }
        let Some((next, end)) = accepted else {
            return Err(Some((stage, share)));
        };
        if share == 0.0 {
            *first = end;
        }
        if end >= 1.0 {
            return Ok(verdict(curve, next, &radii, solution));
        }
        let left = curve.residual(next);
        let Some(next) = Stage::at(curve, next, left) else {
            return Err(Some((stage, share)));
        };
        (stage, share, length) = (next, end, next_length);
        whole = stage.toward(&nowhere(curve));
        course = self::course(&parts.lengths(&whole), &units, 1.0 / (1.0 - share));
    }
    Err(Some((stage, share)))
}

/// How much the tangent may change to the middle and to the end of a short stage.
const SHORT: f64 = 0.5;

/// Follows the curve in short stages where a proof fails: bounds over a region are poor where the
/// coordinates are ill conditioned, as at nearly singular elements of GL(n). The tangent is looked
/// at in the middle and at the end of each stage, its root is solved for; not a proof. Begins at what was reached, where
/// that is given.
fn closely(
    curve: &dyn Curve,
    rest: Stage,
    reached: Reached,
    solution: Option<Point>,
) -> Result<Found, Fold> {
    let parts = curve.parts();
    let (at_rest, units) = (rest.residual.clone(), rest.units(parts));
    let (mut stage, mut share) = reached.unwrap_or((rest, 0.0));
    let mut length = 1.0_f64;
    for _ in 0..MOST_STAGES {
        let left = 1.0 - share;
        length = length.min(left);
        let end = if length >= left { 1.0 } else { share + length };
        let goal = times(&at_rest, 1.0 - end);
        let toward = stage.toward(&goal);
        let fold = || Fold::at(share, fastest(parts, &toward, &units));
        if length < shortest(share) {
            return Err(fold());
        }
        let radii = course(&parts.lengths(&toward), &units, 1.0);
        let strains = [0.5, 1.0].map(|part| stage.strain_at(curve, &times(&toward, part)));
        let strain = largest(strains.map(|x| x.largest(&radii)));
        let within = times(&radii, 2.0);
        let next = match strain <= SHORT {
            true => stage.solve(curve, &toward, &goal, &within),
            false => None,
        };
        let [most, least] = SHORTER;
        let longer = match strain.is_nan() {
            true => least,
            false => (0.5 * SHORT / strain).clamp(least, LONGER),
        };
        let Some(next) = next else {
            length *= longer.min(most);
            continue;
        };
        if end >= 1.0 {
            return Ok(verdict(curve, next, &radii, solution));
        }
        let residual = curve.residual(next);
        stage = Stage::at(curve, next, residual).ok_or_else(fold)?;
        share = end;
        length *= longer;
    }
    Err(Fold::at(
        share,
        fastest(parts, &stage.toward(&nowhere(curve)), &units),
    ))
}

/// How far each part moves per way to the momenta, at least a little in every direction.
fn course(lengths: &[f64], units: &[f64], rate: f64) -> Vec<f64> {
    let shares = lengths.iter().zip(units).map(|(x, u)| x / u);
    let most = shares.filter(|x| x.is_finite()).fold(LITTLE, f64::max);
    // A body may go many times its own size in a step, and need not turn for that.
    let most = most.min(1.0);
    let each = lengths.iter().zip(units);
    each.map(|(length, unit)| rate * length.max(0.05 * most * unit))
        .collect()
}

/// By how much a part of a region is widened at once.
const WIDER: f64 = 5.0;

/// The course, wider in the parts that move more than foreseen, compared with the one that moves
/// furthest.
fn reshaped(course: &[f64], moved: &[f64], own: &[f64]) -> Vec<f64> {
    let share = |b: usize| own[b] / course[b];
    let rate = |b: usize| moved[b] / course[b];
    let parts = 0..course.len();
    let most = parts
        .clone()
        .fold(0, |most, b| if share(b) > share(most) { b } else { most });
    let wide = |b: usize| match rate(b) / rate(most) {
        wider if wider > 1.0 => course[b] * wider.min(WIDER),
        // Also where nothing is known.
        _ => course[b],
    };
    parts.map(wide).collect()
}

/// The coordinate that moves most.
fn fastest(parts: &Parts, x: &[f64], units: &[f64]) -> usize {
    let size = |k: usize| x.get(k).copied().unwrap_or(0.0).abs();
    let share = |k: usize| size(k) / units.get(parts.part_of(k)).copied().unwrap_or(1.0);
    (0..parts.dimension())
        .max_by(|i, j| share(*i).total_cmp(&share(*j)))
        .unwrap_or(0)
}

/// Whether the solution is the root in the region around it.
fn verdict(curve: &dyn Curve, root: Point, radii: &[f64], solution: Option<Point>) -> Found {
    // The region is that around the beginning of the last stage, of which the root is off the edge.
    let reach: Vec<f64> = radii.iter().map(|r| 1e-3 * r).collect();
    match solution {
        Some(found) if curve.is_within(root, found, &reach) => Found::Principal {
            reach: vec![0.0; reach.len()],
            spread: Spread::HERE,
        },
        _ => Found::Elsewhere { root, reach },
    }
}
