//! Errors of chains: a list of the wrong length, an invalid value at a site, a failed step at a site. Takes the failure
//! and its site; gives messages that name both.

use crate::mesh::MeshError;
use crate::number_format;
use crate::{ParameterError, StepCause};
use core::fmt;

/// A quantity and a site, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// The quantity as the model writes it.
    pub quantity: &'static str,
    /// The site, or [`Place::ALL`] for a quantity of the whole chain.
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
    /// Too few sites, or more sites than an index can count.
    Count {
        /// The model's name for the number of sites.
        count: &'static str,
        /// The requested number.
        found: usize,
        /// The smallest admissible number.
        least: usize,
    },
    /// The length of a list differs from the number of sites.
    Length {
        /// The quantity.
        quantity: &'static str,
        /// The number of sites.
        expected: usize,
        /// The length of the list.
        found: usize,
        /// A description of the sites.
        sites: &'static str,
    },
    /// An invalid parameter or step size that is common to all sites.
    Parameter(ParameterError),
    /// An invalid parameter or initial value at one site.
    Site {
        /// The quantity and the site.
        at: Place,
        /// The reason.
        error: ParameterError,
    },
    /// A functional of all sites, or its derivative, is undefined at the current positions; the state is unchanged.
    Functional {
        /// The time node.
        node: u64,
        /// The functional, as the model names it.
        quantity: &'static str,
        /// The reason.
        cause: MeshError,
        /// A smaller step size for which a trial from the same state succeeded, if there is one.
        works: Option<f64>,
    },
    /// A step failed; the state is unchanged.
    Step {
        /// The time node at which the step started.
        node: u64,
        /// The quantity and the site.
        at: Place,
        /// The reason.
        cause: StepCause,
        /// A smaller step size for which a trial from the same state succeeded, if there is one.
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
                number_format::works(f, *works)
            }
            Self::Step {
                node,
                at,
                cause,
                works,
            } => {
                write!(f, "step from node {node}: {at}: {cause}")?;
                number_format::works(f, *works)
            }
        }
    }
}

impl std::error::Error for LineError {}
