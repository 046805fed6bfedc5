//! The principal root of the equations of a step, followed from rest.
//!
//! With the momenta `m` of the node and everything known there held fixed, the equations read `P(v) = m`. Their
//! principal root is the end of the curve `P(v) = (1 - τ) P(0) + τ m` that begins at rest as `τ` goes from 0 to 1.
//! Where the tangent becomes singular, at a fold, the curve turns back: the equations may have other roots beyond, to
//! which no motion of small steps leads.
//!
//! The curve is followed in stages. A stage is accepted where its first two corrections by one tangent fall by a factor
//! of four, which bounds how the tangent changes along it (Deuflhard, Newton Methods for Nonlinear Problems, 2011,
//! sections 2.1 and 5.1). That is a test at points, not a proof.
//!
//! Takes the equations of one lane; gives the root, or how far the curve could be followed.

use super::parts::{Parts, points};
use crate::groups::Group;
use crate::linalg::Dense;
use nalgebra::{SMatrix, SVector};

/// The largest ratio of the second correction by one tangent to the first.
pub(crate) const FALLS: f64 = 0.25;

/// Most stages on the way.
const MOST_STAGES: usize = 1000;

/// Most corrections of a stage after the first two; they fall quadratically.
const MOST_CORRECTIONS: usize = 12;

/// The last stage ends with a correction that is this part of its length: what is left is the square. Close to a fold
/// rounding permits no less.
const SOLVED: f64 = 1e-6;

/// Corrections of this part of the noise of a length are rounding.
const ROUNDED: f64 = 0.1;

/// Another stage can begin so near the end of one.
const NEAR: f64 = 1e-3;

/// The part of a stage that is tried where corrections do not fall.
const WORSE: f64 = 0.2;

/// Bounds of the length of a stage, in lengths of the one before.
const LONGER: f64 = 4.0;
const SHORTER: f64 = 0.5;

/// The part of the longest admissible length that is tried, and the least part of a refused length.
const AIM: f64 = 0.8;
const SHORTEST_TRY: f64 = 0.1;

/// A rest of the way that is this part of a stage joins it.
const JOINS: f64 = 0.1;

/// The shortest stage tried, as a part of the way: a root so close to a fold is not taken. Rounding decides there.
const SHORTEST: f64 = 1e-9;

/// The same at this share of the way. Near rest a short stage says nothing of a fold: where the tangent is nearly
/// singular there and grows, velocities first move as a root of the share. Rounding of momenta is what remains.
fn shortest(share: f64) -> f64 {
    (1e-3 * share).clamp(1e-13, SHORTEST)
}

/// A solution is the root if it lies within this part of the last stage.
const SAME: f64 = 1e-3;

/// The result for one lane.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Traced<G> {
    /// The solution is the principal root.
    Principal,
    /// There was no solution, or another: this is the principal root.
    Elsewhere {
        /// The root, to the precision of a stage.
        root: G,
        /// A polished root is no further from it than these lengths, part by part.
        reach: Vec<f64>,
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
    fn at(share: f64, fastest: usize) -> Self {
        Self {
            share,
            fastest,
            lane: 0,
        }
    }

    /// The same in a lane.
    #[must_use]
    pub(super) fn in_lane(self, lane: usize) -> Self {
        Self { lane, ..self }
    }
}

/// The equations of one lane, with everything at the node held fixed.
pub(super) trait Curve {
    /// A velocity.
    type Velocity: Clone;

    /// The coordinates.
    fn parts(&self) -> &Parts;

    /// The rounding error of the length of a part without a natural unit.
    fn noise(&self, part: usize) -> f64;

    /// The velocity of rest.
    fn rest(&self) -> Self::Velocity;

    /// A velocity moved by coordinates.
    fn moved(&self, from: &Self::Velocity, coordinates: &[f64]) -> Self::Velocity;

    /// The lengths of the coordinates of `to` seen from `from`.
    fn lengths(&self, from: &Self::Velocity, to: &Self::Velocity) -> Vec<f64>;

    /// The residual `P(v) - m`.
    fn residual(&self, at: &Self::Velocity) -> Vec<f64>;

    /// The derivative of `P` along the algebra.
    fn tangent(&self, at: &Self::Velocity) -> Dense<f64>;
}

/// A point of the curve, and the tangent there.
struct Stage<G> {
    velocity: G,
    residual: Vec<f64>,
    inverse: Dense<f64>,
    units: Vec<f64>,
    /// Whether a part lacks a scale of its own.
    open: bool,
}

impl<G: Clone> Stage<G> {
    /// `None` where the tangent is singular or not finite.
    fn at<C: Curve<Velocity = G>>(curve: &C, velocity: G) -> Option<Self> {
        let tangent = curve.tangent(&velocity);
        let inverse = tangent.balanced_inverse().filter(Dense::is_finite)?;
        Some(Self {
            residual: curve.residual(&velocity),
            units: curve.parts().units(&|i, j| tangent.at(i, j)),
            open: curve.parts().kinds().are_open(&|i, j| tangent.at(i, j)),
            velocity,
            inverse,
        })
    }

    /// The correction by this tangent where the residual is to become `goal`.
    fn correction(&self, goal: &[f64], residual: &[f64]) -> Vec<f64> {
        corrected(&self.inverse, goal, residual)
    }
}

fn corrected(inverse: &Dense<f64>, goal: &[f64], residual: &[f64]) -> Vec<f64> {
    let change = goal.iter().zip(residual).map(|(x, y)| x - y);
    inverse.times(&Dense::column_of(change.collect())).data
}

fn times(x: &[f64], factor: f64) -> Vec<f64> {
    x.iter().map(|x| x * factor).collect()
}

/// The larger of two; NaN where one is.
fn worse(a: f64, b: f64) -> f64 {
    if b <= a { a } else { b + 0.0 * a }
}

/// The largest length over its bound; NaN where any is.
fn ratio(lengths: &[f64], bounds: &[f64]) -> f64 {
    let each = lengths.iter().zip(bounds);
    // A part without length and bound does not move.
    let each = each.map(|(x, bound)| if *x == 0.0 { 0.0 } else { x / bound });
    crate::scalar::largest(each)
}

/// Finds the principal root, or shows that `solution` is.
///
/// # Errors
/// [`Fold`] where there is none, as far as can be followed.
#[cold]
#[inline(never)]
pub(super) fn trace<C: Curve>(
    curve: &C,
    solution: Option<&C::Velocity>,
) -> Result<Traced<C::Velocity>, Fold> {
    let nowhere = || Fold::at(0.0, 0);
    let parts = curve.parts();
    let mut stage = Stage::at(curve, curve.rest()).ok_or_else(nowhere)?;
    let at_rest = stage.residual.clone();
    let nothing = vec![0.0; at_rest.len()];
    let (mut share, mut length) = (0.0, 1.0_f64);
    for _ in 0..MOST_STAGES {
        // A small rest joins the last stage: its own corrections would be rounding.
        let last = share + (1.0 + JOINS) * length >= 1.0;
        let end = if last { 1.0 } else { share + length };
        if !last && length < shortest(share) {
            break;
        }
        length = end - share;
        let goal = times(&at_rest, 1.0 - end);
        match ended(curve, &stage, &goal, last) {
            Ok(Ended {
                velocity: root,
                course,
                ..
            }) if last => {
                let reach = times(&course, SAME);
                let same = |found| ratio(&curve.lengths(&root, found), &reach) <= 1.0;
                return Ok(match solution {
                    Some(found) if same(found) => Traced::Principal,
                    _ => Traced::Elsewhere { root, reach },
                });
            }
            Ok(Ended {
                velocity: next,
                fall,
                ..
            }) => {
                share = end;
                length *= (AIM * FALLS / fall).clamp(SHORTER, LONGER);
                match Stage::at(curve, next) {
                    Some(next) => stage = next,
                    None => break,
                }
            }
            Err(shorter) => length *= shorter,
        }
    }
    let toward = stage.correction(&nothing, &stage.residual);
    if share == 0.0 && !toward.iter().all(|x| x.is_finite()) {
        return Err(nowhere());
    }
    Err(Fold::at(share, parts.fastest(&toward, &stage.units)))
}

/// The end of a stage.
struct Ended<G> {
    velocity: G,
    /// The lengths of its course.
    course: Vec<f64>,
    /// The second correction over the first: it grows with the length of the stage.
    fall: f64,
}

/// The end of a stage, or the part of its length to try next.
fn ended<C: Curve>(
    curve: &C,
    stage: &Stage<C::Velocity>,
    goal: &[f64],
    last: bool,
) -> Result<Ended<C::Velocity>, f64> {
    let parts = curve.parts();
    let first = stage.correction(goal, &stage.residual);
    let course = parts.course(&parts.lengths(&first), &stage.units, |b| curve.noise(b));
    let mut at = curve.moved(&stage.velocity, &first);
    let second = stage.correction(goal, &curve.residual(&at));
    let mut fall = ratio(&parts.lengths(&second), &course);
    if stage.open {
        for share in points() {
            let between = goal.iter().zip(&stage.residual);
            let between: Vec<f64> = between.map(|(x, y)| y + share * (x - y)).collect();
            let there = curve.moved(&stage.velocity, &times(&first, share));
            let off = stage.correction(&between, &curve.residual(&there));
            fall = worse(fall, ratio(&parts.lengths(&off), &course));
        }
    }
    if !course.iter().all(|x| x.is_finite()) || !fall.is_finite() {
        return Err(WORSE);
    }
    if fall > FALLS {
        return Err((AIM * FALLS / fall).clamp(SHORTEST_TRY, AIM));
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
        let known: Vec<f64> = known
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
        // NaN does not fall.
        let falls = size <= 0.5 * before;
        if !falls {
            return Err(WORSE);
        }
        before = size;
    }
    let velocity = at;
    match before <= enough {
        true => Ok(Ended {
            velocity,
            course,
            fall,
        }),
        false => Err(WORSE),
    }
}

/// The equations of one lane on a group that is a type. What follows the curve is compiled once for each group, not for
/// every model and scalar.
pub struct Equations<'a, G, const D: usize> {
    /// The residual `P(v) - m`.
    pub residual: &'a dyn Fn(&G) -> SVector<f64, D>,
    /// The derivative of `P` along the algebra.
    pub tangent: &'a dyn Fn(&G) -> SMatrix<f64, D, D>,
}

/// The same with the coordinates of the group.
pub(super) struct OnGroup<'a, G, const D: usize> {
    equations: &'a Equations<'a, G, D>,
    parts: Parts,
    noise: [f64; D],
}

impl<'a, G: Group<f64>, const D: usize> OnGroup<'a, G, D> {
    pub(super) fn new(equations: &'a Equations<'a, G, D>, noise: [f64; D]) -> Self {
        Self {
            equations,
            parts: Parts::of_group::<f64, G>(D),
            noise,
        }
    }
}

impl<G: Group<f64>, const D: usize> Curve for OnGroup<'_, G, D> {
    type Velocity = G;

    fn parts(&self) -> &Parts {
        &self.parts
    }

    fn noise(&self, part: usize) -> f64 {
        self.noise.get(part).copied().unwrap_or(0.0)
    }

    fn rest(&self) -> G {
        G::identity()
    }

    fn moved(&self, from: &G, coordinates: &[f64]) -> G {
        from.retract(coordinates)
    }

    fn lengths(&self, from: &G, to: &G) -> Vec<f64> {
        let mut lengths = vec![0.0; self.parts.count()];
        from.inverse().compose(to).extents(&mut lengths);
        lengths
    }

    fn residual(&self, at: &G) -> Vec<f64> {
        let size = self.parts.dimension();
        (self.equations.residual)(at).as_slice()[..size].to_vec()
    }

    fn tangent(&self, at: &G) -> Dense<f64> {
        let (size, tangent) = (self.parts.dimension(), (self.equations.tangent)(at));
        Dense::from_fn(size, size, |i, j| tangent[(i, j)])
    }
}
