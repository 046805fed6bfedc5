//! Surfaces, their crossings, and why none is found.

use crate::error::{Invalid, failed_step};
use std::{error::Error, fmt};

/// Which crossings count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From negative to positive values along the trajectory.
    Up,
    /// From positive to negative values along the trajectory.
    Down,
    /// All.
    Both,
}

/// A surface, and the direction in which it is crossed.
#[derive(Clone, Copy)]
pub struct Section<'a, S> {
    /// The function g, which is zero on the surface.
    pub value: &'a dyn Fn(&S) -> f64,
    /// The derivative of g in time along the flow, if known. Only its sign is used. With it, the search finds two
    /// crossings within one step.
    pub rate: Option<&'a dyn Fn(&S) -> f64>,
    /// Which crossings count.
    pub direction: Direction,
}

/// A state on the surface.
#[derive(Clone, Debug)]
pub struct Crossing<S> {
    /// The time since the start; negative for a negative step size.
    pub time: f64,
    /// The state.
    pub state: S,
    /// The value of g there, zero up to rounding.
    pub value: f64,
    /// Whether g grows along the trajectory.
    pub upward: bool,
}

/// The crossings of a trajectory.
#[derive(Clone, Debug)]
pub struct Sections<S> {
    /// The crossings in the order of the trajectory.
    pub crossings: Vec<Crossing<S>>,
    /// Whether all crossings that were asked for were found.
    pub complete: bool,
    /// The steps that were taken.
    pub steps: usize,
}

/// Why no crossing was found.
#[derive(Clone, Debug, PartialEq)]
pub enum SectionError<E> {
    /// An argument cannot be used, or g is not a number.
    Invalid(Invalid),
    /// A step failed.
    Step {
        /// The number of the step, from 0.
        step: usize,
        /// The reason.
        source: E,
    },
    /// The trajectory did not cross the surface in this direction.
    Never {
        /// The steps that were taken.
        steps: usize,
        /// The smallest value of g at a node.
        least: f64,
        /// The largest value of g at a node.
        largest: f64,
    },
}

impl<E: fmt::Display> fmt::Display for SectionError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(why) => why.fmt(f),
            Self::Step { step, source } => failed_step(f, *step, source),
            Self::Never {
                steps,
                least,
                largest,
            } if *least < 0.0 && *largest > 0.0 => write!(
                f,
                "No crossing in this direction in {steps} steps, with values from {least:e} to {largest:e}. Take more steps, or count both directions."
            ),
            Self::Never {
                steps,
                least,
                largest,
            } => write!(
                f,
                "No crossing in {steps} steps: the values are between {least:e} and {largest:e}. Take more steps, or choose a level between these values."
            ),
        }
    }
}

impl<E: Error + 'static> Error for SectionError<E> {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Step { source, .. } => Some(source),
            _ => None,
        }
    }
}

impl<E> From<Invalid> for SectionError<E> {
    fn from(why: Invalid) -> Self {
        Self::Invalid(why)
    }
}
