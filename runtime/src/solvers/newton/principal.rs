//! The principal root of the equations of a step.
//!
//! With the momenta `m` of the node and everything known there held fixed, the equations read
//! `T(Ω) = m`. Their principal root is the end of the curve `T(Ω_τ) = T_0 + τ (m - T_0)` that
//! starts at rest, `Ω_0 = 1`, `T_0 = T(1)`, as `τ` goes from 0 to 1; it exists as long as the
//! tangent stays regular along the curve and the curve in the domain of the equations. Where the
//! tangent becomes singular, at a fold, the curve turns back: beyond it the equations may have
//! other roots, which no motion of small steps leads to.
//!
//! Along a trajectory of principal roots the velocity changes continuously, unless a step comes to
//! a fold, where it is refused. The converse does not hold: a root that follows the last one
//! continuously may have passed around a fold, and is no principal one then. Such a step is refused.
//!
//! Takes the equations of one lane; gives the root, with a region in which it is the only one. Where
//! bounds are too poor for a proof of that, the curve is followed in short stages without one.

use super::bounds::Region;
use super::lasting::lasting;
use super::node::Spread;
use super::stage::{MARGIN, Stage, fits, lengths};
use crate::groups::Group;
use crate::scalar::{Enclosure, largest};
use nalgebra::{SMatrix, SVector};

/// Stages on the way; each leaves at most two thirds of what is left before a fold.
pub(super) const MOST_STAGES: usize = 1000;

/// Stages that are proved: bounds so poor that more are needed take seconds.
pub(super) const MOST_PROOFS: usize = 64;

/// What a step is worth that is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Care {
    /// Whether a proof is looked for that serves for later steps too.
    pub lasting: bool,
    /// Whether that one holds at every node, for the tangent is the same.
    pub everywhere: bool,
    /// Whether a proof of every stage is looked for; else how the tangent changes on it is taken
    /// from its end. Where that fails the curve is followed closely, without a proof.
    pub proved: bool,
}

/// The shortest stage tried, as a part of the way: a root so close to a fold is not taken. Rounding
/// decides there.
const SHORTEST: f64 = 1e-9;

/// The same at this share of the way. Near rest a short stage says nothing of a fold: where a tangent is nearly singular
/// there and grows, as of a body whose stretches nearly agree, velocities first move as a root of the share. Rounding
/// of momenta is what remains.
pub(super) fn shortest(share: f64) -> f64 {
    (1e-3 * share).clamp(1e-13, SHORTEST)
}

/// The strain aimed at over a stage: up to a fold each stage then leaves the same part of the way.
pub(super) const AIM: f64 = 0.65;

/// The same over a stage that is proved: one that fails costs as much as one that is accepted.
pub(super) const SURE: f64 = 0.5;

/// By how much one stage may be longer than the last.
pub(super) const LONGER: f64 = 4.0;

/// What is left of a stage that was not accepted, at most and at least.
pub(super) const SHORTER: [f64; 2] = [0.8, 0.2];

/// Where nothing moves, regions have this size.
pub(super) const LITTLE: f64 = 1e-6;

/// The root of a stage stays off the edge of its region.
pub(super) const INNER: f64 = 0.99;

/// What was found out about a solution of one lane.
#[derive(Clone, Copy, Debug)]
pub enum Traced<G, const D: usize> {
    /// It is the principal root, as is every solution within `reach` of rest at a node within
    /// `spread` of this one.
    Principal {
        /// Lengths of the coordinates, part by part.
        reach: [f64; D],
        /// For which nodes.
        spread: Spread,
    },
    /// There was none, or it is another: this is the principal root.
    Elsewhere {
        /// The root, to the precision of a stage.
        root: G,
        /// Within these lengths of it there is no other, as far as stages were proved.
        reach: [f64; D],
    },
}

/// The curve could not be followed to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fold {
    /// How far it was followed: the part of the way from rest to the momenta.
    pub share: f64,
    /// The coordinate of the velocity that moved fastest there.
    pub fastest: usize,
    /// The lane.
    pub lane: usize,
}

impl Fold {
    pub(super) fn at(share: f64, fastest: usize) -> Self {
        Self {
            share,
            fastest,
            lane: 0,
        }
    }

    /// The same in a lane.
    #[must_use]
    pub fn in_lane(self, lane: usize) -> Self {
        Self { lane, ..self }
    }
}

/// The equations of one lane. What follows the curve is compiled once for each group, not for every
/// model and scalar.
pub struct Equations<'a, G, E, const D: usize, const K: usize> {
    /// The residual `T(Ω) - m`.
    pub residual: &'a dyn Fn(&G) -> SVector<f64, D>,
    /// The tangent of `T` along the algebra.
    pub tangent: &'a dyn Fn(&G) -> SMatrix<f64, D, D>,
    /// The tangent at all elements of a region, for all nodes as near as that.
    pub enclosed: &'a dyn Fn(Spread, &E) -> SMatrix<Enclosure<K>, D, D>,
}

/// Finds the principal root, or shows that `solution` is.
///
/// # Errors
/// [`Fold`] where there is none, as far as can be followed.
#[cold]
#[inline(never)]
pub fn trace<G, E, const D: usize, const K: usize>(
    equations: &Equations<G, E, D, K>,
    solution: Option<&G>,
    care: Care,
) -> Result<Traced<G, D>, Fold>
where
    G: Group<f64>,
    E: Region<K, Centre = G>,
{
    let rest = G::identity();
    let at_rest = (equations.residual)(&rest);
    let Some(stage) = Stage::at(equations, rest, at_rest) else {
        return Err(Fold::at(0.0, 0));
    };
    let units = stage.units();
    let whole = stage.toward(&SVector::zeros());
    if !whole.iter().all(|x| x.is_finite()) {
        return Err(Fold::at(0.0, 0));
    }
    let lengths = lengths::<G, D>(&whole);
    if let (Some(found), true) = (solution, care.lasting) {
        let mut own = [0.0; D];
        found.extents(&mut own);
        let wanted = core::array::from_fn(|b| own[b].max(lengths[b]).max(0.01 * units[b]));
        if let Some(proved) = lasting(equations, &stage, &wanted, care.everywhere) {
            return Ok(proved);
        }
    }
    // What cannot be followed without a proof is not followed with one, a hundred times more slowly.
    let mut first = 1.0;
    let mut found = follow(equations, stage, solution, &mut first, false);
    if found.is_ok() && care.proved {
        found = follow(equations, stage, solution, &mut first, true);
    }
    // That there is no proof does not mean that there is a fold.
    found.or_else(|reached| {
        let reached = match care.proved {
            true => None,
            false => reached,
        };
        closely(equations, stage, reached, solution)
    })
}

/// A point of the curve and the part of the way to it.
type Reached<G, const D: usize> = Option<(Stage<G, D>, f64)>;

/// Follows the curve stage by stage from rest, each stage proved or foreseen from its end. `first` is how long a first
/// stage is tried, and was in the end. Where the curve is lost, gives up to where it was followed.
fn follow<G, E, const D: usize, const K: usize>(
    equations: &Equations<G, E, D, K>,
    rest: Stage<G, D>,
    solution: Option<&G>,
    first: &mut f64,
    proved: bool,
) -> Result<Traced<G, D>, Reached<G, D>>
where
    G: Group<f64>,
    E: Region<K, Centre = G>,
{
    let at_rest = rest.residual;
    let units = rest.units();
    let mut stage = rest;
    let mut whole = stage.toward(&SVector::zeros());
    let lengths = lengths::<G, D>(&whole);
    let (mut share, mut length) = (0.0, *first);
    // What the velocity moves by on the way, in every direction a little.
    let mut course = course(&lengths, &units, 1.0);
    let mut radii = [0.0; D];
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
            let goal = at_rest * (1.0 - end);
            let toward = stage.toward(&goal);
            let own = self::lengths::<G, D>(&toward);
            radii = course.map(|x| MARGIN * length * x);
            let (moved, strain) = match proved {
                true => stage.move_within::<E, K>(equations, &radii, &own),
                false => stage.move_foreseen(equations, &toward, &radii, &own),
            };
            // Lengths are in proportion to strains.
            let longer = match strain.is_nan() {
                true => least,
                false => (aim / strain).min(LONGER),
            };
            next_length = longer * length;
            let inner = radii.map(|r| INNER * r);
            let enough = moved.is_some_and(|y| fits::<G, D>(&y, &inner));
            if enough {
                accepted = stage
                    .solve(equations, &toward, &goal, &radii)
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
            return Ok(verdict(next, &radii, solution));
        }
        let left = (equations.residual)(&next);
        let Some(next) = Stage::at(equations, next, left) else {
            return Err(Some((stage, share)));
        };
        (stage, share, length) = (next, end, next_length);
        whole = stage.toward(&SVector::zeros());
        course = self::course(&self::lengths::<G, D>(&whole), &units, 1.0 / (1.0 - share));
    }
    Err(Some((stage, share)))
}

/// How much the tangent may change to the middle and to the end of a short stage.
const SHORT: f64 = 0.5;

/// Follows the curve in short stages where a proof fails: bounds over a region are poor where the
/// coordinates are ill conditioned, as at nearly singular elements of GL(n). The tangent is looked
/// at in the middle and at the end of each stage, its root is solved for; not a proof. Begins at what was reached, where
/// that is given.
fn closely<G, E, const D: usize, const K: usize>(
    equations: &Equations<G, E, D, K>,
    rest: Stage<G, D>,
    reached: Reached<G, D>,
    solution: Option<&G>,
) -> Result<Traced<G, D>, Fold>
where
    G: Group<f64>,
{
    let (at_rest, units) = (rest.residual, rest.units());
    let (mut stage, mut share) = reached.unwrap_or((rest, 0.0));
    let mut length = 1.0_f64;
    for _ in 0..MOST_STAGES {
        let left = 1.0 - share;
        length = length.min(left);
        let end = if length >= left { 1.0 } else { share + length };
        let goal = at_rest * (1.0 - end);
        let toward = stage.toward(&goal);
        let fold = || Fold::at(share, fastest::<G, D>(&toward, &units));
        if length < shortest(share) {
            return Err(fold());
        }
        let radii = course(&lengths::<G, D>(&toward), &units, 1.0);
        let strains = [0.5, 1.0].map(|part| stage.strain_at(equations, &(toward * part)));
        let strain = largest(strains.map(|x| x.largest(&radii)));
        let within = radii.map(|r| 2.0 * r);
        let next = match strain <= SHORT {
            true => stage.solve(equations, &toward, &goal, &within),
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
            return Ok(verdict(next, &radii, solution));
        }
        let residual = (equations.residual)(&next);
        stage = Stage::at(equations, next, residual).ok_or_else(fold)?;
        share = end;
        length *= longer;
    }
    Err(Fold::at(
        share,
        fastest::<G, D>(&stage.toward(&SVector::zeros()), &units),
    ))
}

/// How far each part moves per way to the momenta, at least a little in every direction.
fn course<const D: usize>(lengths: &[f64; D], units: &[f64; D], rate: f64) -> [f64; D] {
    let shares = lengths.iter().zip(units).map(|(x, u)| x / u);
    let most = shares.filter(|x| x.is_finite()).fold(LITTLE, f64::max);
    // A body may go many times its own size in a step, and need not turn for that.
    let most = most.min(1.0);
    core::array::from_fn(|b| rate * lengths[b].max(0.05 * most * units[b]))
}

/// By how much a part of a region is widened at once.
const WIDER: f64 = 5.0;

/// The course, wider in the parts that move more than foreseen, compared with the one that moves
/// furthest.
fn reshaped<const D: usize>(course: &[f64; D], moved: &[f64; D], own: &[f64; D]) -> [f64; D] {
    let share = |b: usize| own[b] / course[b];
    let rate = |b: usize| moved[b] / course[b];
    let most = (0..D).fold(0, |most, b| if share(b) > share(most) { b } else { most });
    core::array::from_fn(|b| match rate(b) / rate(most) {
        wider if wider > 1.0 => course[b] * wider.min(WIDER),
        // Also where nothing is known.
        _ => course[b],
    })
}

/// The coordinate that moves most.
fn fastest<G: Group<f64>, const D: usize>(x: &SVector<f64, D>, units: &[f64; D]) -> usize {
    let share = |k: usize| x[k].abs() / units.get(G::part_of(k)).copied().unwrap_or(1.0);
    (0..G::DIMENSION.min(D))
        .max_by(|i, j| share(*i).total_cmp(&share(*j)))
        .unwrap_or(0)
}

/// Whether the solution is the root in the region around it.
fn verdict<G: Group<f64>, const D: usize>(
    root: G,
    radii: &[f64; D],
    solution: Option<&G>,
) -> Traced<G, D> {
    // The region is that around the beginning of the last stage, of which the root is off the edge.
    let reach = radii.map(|r| 1e-3 * r);
    match solution {
        Some(found) if root.inverse().compose(found).is_within(&reach) => Traced::Principal {
            reach: [0.0; D],
            spread: Spread::HERE,
        },
        _ => Traced::Elsewhere { root, reach },
    }
}
