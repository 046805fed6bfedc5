//! Why a run stops before its end: a failed step, or a number that is NaN or infinite.
//! Takes the node and the number found there; gives errors that name both and suggest a fix.

use crate::solvers::newton::NewtonFailure;
use crate::{StepCause, StepError};
use core::fmt;

/// The kinds of numbers that a run checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Watched {
    /// A component of an invariant.
    Invariant,
    /// The natural scale of a component of an invariant.
    Scale,
    /// A number of an observable.
    Observable,
}

/// A number of a trajectory that is NaN or infinite, although no step failed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotFinite {
    /// The node.
    pub node: u64,
    /// The time there.
    pub time: f64,
    /// The last node before it at which all checked numbers were finite; the node itself if it is the first.
    pub since: u64,
    /// Whether it belongs to an invariant, a scale or an observable.
    pub watched: Watched,
    /// The name of the invariant or observable, as the card has it.
    pub name: &'static str,
    /// The index of the number, row-major from 0; `None` if there is only one number.
    pub index: Option<usize>,
    /// How many numbers a row of it has.
    pub columns: usize,
    /// The number.
    pub value: f64,
}

impl fmt::Display for NotFinite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            node,
            time,
            since,
            name,
            value,
            ..
        } = self;
        write!(f, "at node {node} (time {time}) ")?;
        if node.abs_diff(*since) > 1 {
            write!(f, "or since the last checked node, {since}, ")?;
        }
        // Counted from 1, as in files and plots.
        match (self.index, self.columns) {
            (None, _) => {}
            (Some(index), ..=1) => write!(f, "component {} of ", index + 1)?,
            (Some(index), n) => write!(f, "entry ({}, {}) of ", index / n + 1, index % n + 1)?,
        }
        match self.watched {
            Watched::Invariant => write!(f, "the invariant `{name}` is {value}"),
            Watched::Scale => write!(f, "the natural scale of the invariant `{name}` is {value}"),
            Watched::Observable => write!(f, "`{name}` is {value}"),
        }?;
        f.write_str(match value.is_nan() {
            true => {
                ": the argument of a function left its domain, or an operation is undefined, such as 0/0 or inf - inf; "
            }
            false => ": it exceeds the largest double, 1.8e308; ",
        })?;
        // At the start, a shorter step does not help.
        f.write_str(match node {
            0 => "check the parameters and initial values; if a mass or an inertia is zero, give it a small positive value",
            _ => "reduce the step size, or check the parameters and initial values",
        })
    }
}

impl std::error::Error for NotFinite {}

/// Why a run stopped before its end.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum RunError {
    /// A step failed.
    Step(StepError),
    /// A step succeeded, but a checked number is NaN or infinite after it.
    NotFinite(NotFinite),
}

impl RunError {
    /// The node of the trajectory when the run stopped.
    #[must_use]
    pub fn node(&self) -> u64 {
        match self {
            Self::Step(error) => error.node,
            Self::NotFinite(found) => found.node,
        }
    }
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Step(error) => error.fmt(f),
            Self::NotFinite(found) => found.fmt(f),
        }
    }
}

impl std::error::Error for RunError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Step(error) => Some(error),
            Self::NotFinite(found) => Some(found),
        }
    }
}

impl From<StepError> for RunError {
    #[cold]
    fn from(error: StepError) -> Self {
        Self::Step(error)
    }
}

impl From<NotFinite> for RunError {
    #[cold]
    fn from(found: NotFinite) -> Self {
        Self::NotFinite(found)
    }
}

impl StepCause {
    /// Whether a quantity of the step is NaN or infinite, at a site or not.
    #[must_use]
    pub fn is_not_finite(&self) -> bool {
        match self {
            Self::NotFinite { .. } => true,
            Self::Newton(error) => error.failure == NewtonFailure::NotFinite,
            Self::AtSite { cause, .. } => cause.is_not_finite(),
            _ => false,
        }
    }
}
