//! Errors of chains: data of a wrong length, a value at one site, a step at one site.
//! Takes the failure and its site; gives messages that name both.

use crate::mesh::MeshError;
use crate::said;
use crate::{ParameterError, StepCause};
use core::fmt;

/// A quantity and the site where something happened, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// The quantity as the model writes it.
    pub quantity: &'static str,
    /// The site; [`Place::ALL`] of what belongs to the whole line.
    pub site: usize,
}

impl Place {
    /// The site of a quantity that belongs to the whole chain.
    pub const ALL: usize = isize::MAX as usize;
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.site {
            Self::ALL => write!(f, "`{}`", self.quantity),
            site => write!(f, "`{}` at site {site}", self.quantity),
        }
    }
}

/// Why a chain cannot be built, started or stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LineError {
    /// Too few sites, or more than can be counted.
    Count {
        /// The name of the number of sites.
        count: &'static str,
        /// The requested number.
        found: usize,
        /// The least number.
        least: usize,
    },
    /// The length of a list differs from the number of sites.
    Length {
        /// The quantity.
        quantity: &'static str,
        /// How many sites there are.
        expected: usize,
        /// How long the list is.
        found: usize,
        /// Which sites, in words.
        sites: &'static str,
    },
    /// A parameter or the step that is the same at all sites.
    Parameter(ParameterError),
    /// A parameter or an initial value at one site.
    Site {
        /// Where.
        at: Place,
        /// The error of the value.
        error: ParameterError,
    },
    /// A functional of all sites, or its derivative, is undefined where it is needed; the state is unchanged.
    Functional {
        /// The node in time.
        node: u64,
        /// Its values, as the model names them.
        quantity: &'static str,
        /// Why.
        cause: MeshError,
        /// A smaller step size for which a trial from the same state succeeded, if there is one.
        works: Option<f64>,
    },
    /// A step failed; the state is unchanged.
    Step {
        /// The node in time from which it would have started.
        node: u64,
        /// Where.
        at: Place,
        /// Why.
        cause: StepCause,
        /// A shorter step from the same state that was tried and works, where one was found.
        works: Option<f64>,
    },
}

impl From<ParameterError> for LineError {
    #[cold]
    fn from(error: ParameterError) -> Self {
        Self::Parameter(error)
    }
}

impl fmt::Display for LineError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count {
                count,
                found,
                least,
            } if found < least => write!(
                f,
                "{count} = {found}, but this chain with its ends needs at least {least}"
            ),
            Self::Count { count, found, .. } => {
                write!(f, "{count} = {found} does not fit into memory")
            }
            Self::Length {
                quantity,
                expected,
                found,
                sites,
            } => write!(
                f,
                "`{quantity}` has values at {found} sites, but there are {expected} {sites}: give one value for each"
            ),
            Self::Parameter(error) => write!(f, "{error}"),
            Self::Site { at, error } => write!(f, "at site {}: {error}", at.site),
            Self::Functional {
                node,
                quantity,
                cause,
                works,
            } => {
                write!(f, "step from node {node}: `{quantity}`: {cause}")?;
                said::works(f, *works)
            }
            Self::Step {
                node,
                at,
                cause,
                works,
            } => {
                write!(f, "step from node {node}: {at}: {cause}")?;
                said::works(f, *works)
            }
        }
    }
}

impl std::error::Error for LineError {}
