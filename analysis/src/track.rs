//! Branches of critical points: how to follow them, what is found, and why it fails.

use crate::equilibrium::EquilibriumError;
use crate::error::Invalid;
use crate::newton::Search;
use crate::variation::Variation;
use nalgebra::DVector;
use std::{error::Error, fmt};

/// The sizes of steps. They are lengths in the space of states, multipliers and the parameter together. Multipliers
/// are in the units of [`Equilibrium::residual`](crate::Equilibrium::residual).
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
    /// The norm of the equations, in the units of [`Equilibrium::residual`](crate::Equilibrium::residual).
    pub residual: f64,
    /// The derivative of p along the branch, per unit of length. It is zero at a fold.
    pub slope: f64,
    /// The second variation.
    pub variation: Variation,
}

/// Events between two points of a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The branch turns back in p.
    Fold,
    /// The number of negative directions of the second variation changes, so that other branches may meet here.
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
    /// The event.
    pub event: Event,
    /// The number of the point before it.
    pub after_point: usize,
    /// The point of the event; if it could not be located, the nearest point that was found.
    pub at: BranchPoint<S>,
    /// Whether it could be located to rounding. This fails where branches meet at a fold.
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
    /// The search for a critical point at p = a fails near the start.
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
