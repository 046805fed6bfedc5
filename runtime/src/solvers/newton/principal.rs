//! Follows the principal root of the equations of a step from rest.
//!
//! With fixed node momenta `m` and fixed data at the node, the equations are `P(v) = m`. The curve
//! `P(v) = (1 - τ) P(0) + τ m` starts at rest for `τ = 0` and ends at the principal root for `τ = 1`. At a fold the
//! tangent becomes singular and the curve turns back. The equations may have further roots beyond the fold, but no
//! motion with small steps leads to them.
//!
//! The curve is followed in stages. A stage is accepted if its first two corrections with the same tangent decrease by
//! a factor of four. This bounds the change of the tangent along the stage (Deuflhard, Newton Methods for Nonlinear
//! Problems, 2011, sections 2.1 and 5.1). If a part lacks a natural scale, the equations and the tangent are also
//! checked at points in between: see [`stage`](super::stage). All tests sample points and prove nothing.
//!
//! Takes the equations of one lane; gives the root, or how far the curve could be followed.

use super::continuation_stage::{AIM, Stage, StageEnd, ended, ratio, times};
use super::parts::{Parts, squares};
use crate::groups::Group;
use crate::linalg::{Dense, Reals};
use nalgebra::{SMatrix, SVector};

/// The largest admissible ratio of the second to the first correction with the same tangent.
pub(crate) const FALLS: f64 = 0.25;

/// The largest number of stages.
const MOST_STAGES: usize = 1000;

/// The bounds of a stage's length, relative to the previous stage.
const LONGER: f64 = 4.0;
const SHORTER: f64 = 0.5;

/// If the remaining path is shorter than this fraction of a stage, the stage extends to the end.
const JOINS: f64 = 0.1;

/// Stages that end before this fraction of the path are judged by two corrections alone. If the tangent at rest is
/// nearly singular and grows, further checks would make stages too short for the precision of the momenta.
const LOOKED_AT: f64 = 1e-6;

/// The shortest stage, as a fraction of the path. A root closer to a fold is rejected, because rounding would decide.
const SHORTEST: f64 = 1e-9;

/// The shortest stage at this fraction of the path. Near rest, a short stage does not indicate a fold: if the tangent
/// there is nearly singular and grows, velocities first increase like a root of the fraction. The rounding of momenta
/// is the limit.
fn shortest(share: f64) -> f64 {
    (1e-3 * share).clamp(1e-13, SHORTEST)
}

/// A solution is the principal root if their distance is below this fraction of the last stage.
const SAME: f64 = 1e-3;

/// The result for one lane.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Traced<G> {
    /// The solution is the principal root.
    Principal,
    /// The principal root, if the solution differs from it or is missing.
    Elsewhere {
        /// The root, to the precision of a stage.
        root: G,
        /// The largest distance, part by part, of a polished root from `root`.
        reach: Reals,
    },
}

/// The curve could not be followed to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fold {
    /// The share of the path from rest to the momenta that was followed.
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

    /// This error in lane `lane`.
    #[must_use]
    pub(super) fn in_lane(self, lane: usize) -> Self {
        Self { lane, ..self }
    }
}

/// The equations of one lane, with fixed data at the node.
pub(super) trait Curve {
    /// A velocity.
    type Velocity: Clone;

    /// The coordinates and their parts.
    fn parts(&self) -> &Parts;

    /// The rounding error of the length of a part without a natural unit.
    fn noise(&self, part: usize) -> f64;

    /// The velocity of rest.
    fn rest(&self) -> Self::Velocity;

    /// The velocity `from`, displaced by `coordinates`.
    fn moved(&self, from: &Self::Velocity, coordinates: &[f64]) -> Self::Velocity;

    /// The lengths of the coordinates of `to` seen from `from`.
    fn lengths(&self, from: &Self::Velocity, to: &Self::Velocity) -> Reals;

    /// The residual `P(v) - m`.
    fn residual(&self, at: &Self::Velocity) -> Reals;

    /// The derivative of `P` along the algebra.
    fn tangent(&self, at: &Self::Velocity) -> Dense<f64>;
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
    let tangent = curve.tangent(&curve.rest());
    let mut stage = Stage::at(curve, curve.rest(), &tangent).ok_or_else(nowhere)?;
    let at_rest = stage.residual.clone();
    let nothing = Reals::from_elem(0.0, at_rest.len());
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
        match ended(curve, &stage, &goal, last, end >= LOOKED_AT) {
            Ok(StageEnd {
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
            Ok(StageEnd {
                velocity: next,
                tangent,
                fall,
                ..
            }) => {
                share = end;
                length *= (AIM * FALLS / fall).clamp(SHORTER, LONGER);
                let tangent = tangent.unwrap_or_else(|| curve.tangent(&next));
                match Stage::at(curve, next, &tangent) {
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

/// The equations of one lane on a static group. The code that follows the curve is compiled once for each group, and
/// not for every model and scalar.
pub struct Equations<'a, G, const D: usize> {
    /// The residual `P(v) - m`.
    pub residual: &'a dyn Fn(&G) -> SVector<f64, D>,
    /// The derivative of `P` along the algebra.
    pub tangent: &'a dyn Fn(&G) -> SMatrix<f64, D, D>,
}

/// Equations with the coordinates of the group.
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

    fn lengths(&self, from: &G, to: &G) -> Reals {
        let squares = squares::<f64, G, D>(&from.inverse().compose(to));
        let count = self.parts.count();
        squares.iter().take(count).map(|x| x.sqrt()).collect()
    }

    fn residual(&self, at: &G) -> Reals {
        let size = self.parts.dimension();
        Reals::from_slice(&(self.equations.residual)(at).as_slice()[..size])
    }

    fn tangent(&self, at: &G) -> Dense<f64> {
        let (size, tangent) = (self.parts.dimension(), (self.equations.tangent)(at));
        Dense::from_fn(size, size, |i, j| tangent[(i, j)])
    }
}
