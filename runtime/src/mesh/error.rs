//! Errors in the computation of functionals of all sites. Takes the numbers of the failure and its sites, counted
//! from 0; gives messages that name them.

use core::fmt;

/// Why a functional or its derivative cannot be computed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MeshError {
    /// The position of a particle is NaN or infinite.
    NotFinite {
        /// Its number.
        site: usize,
    },
    /// A particle is so many periods away that rounding destroys its position within a period.
    TooFar {
        /// Its number.
        site: usize,
        /// How many.
        periods: f64,
    },
    /// Two particles coincide, or are so close that their cells cannot be separated.
    Coincident {
        /// One of them.
        first: usize,
        /// The other.
        second: usize,
    },
    /// Three neighbours are so nearly collinear, relative to their distances, that rounding decides the shape of
    /// their cells.
    Flat {
        /// They.
        sites: [usize; 3],
    },
    /// An iteration did not converge.
    NotConverged {
        /// Steps taken.
        iterations: usize,
        /// The residual, relative to the right side.
        residual: f64,
        /// The tolerance for the residual.
        tolerance: f64,
    },
    /// The number of values differs from the number of sites.
    Count {
        /// The number of values.
        given: usize,
        /// How many sites.
        sites: usize,
    },
    /// A particle is too far beyond a wall for a reflection.
    Outside {
        /// Its number.
        site: usize,
        /// How far.
        by: f64,
    },
}

impl MeshError {
    /// Whether a list has this number of values, one for each site.
    pub(super) fn unless_of_length<V>(list: &[V], sites: usize) -> Result<(), Self> {
        match list.len() {
            given if given == sites => Ok(()),
            given => Err(Self::Count { given, sites }),
        }
    }
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { site } => write!(f, "the position of particle {site} is not finite"),
            Self::TooFar { site, periods } => write!(
                f,
                "particle {site} is {periods:e} periods of the domain away, where rounding makes its position meaningless"
            ),
            Self::Coincident { first, second } => {
                write!(f, "particles {first} and {second} are at the same position")
            }
            Self::Flat { sites: [a, b, c] } => write!(
                f,
                "particles {a}, {b} and {c} are so close and so nearly collinear that rounding decides their cells"
            ),
            Self::NotConverged {
                iterations,
                residual,
                tolerance,
            } => write!(
                f,
                "no convergence after {iterations} iterations: the residual is {residual:e}, needed {tolerance:e}"
            ),
            Self::Count { given, sites } => {
                write!(f, "found {given} values for {sites} sites")
            }
            Self::Outside { site, by } => {
                write!(
                    f,
                    "particle {site} is {by:e} beyond a wall, too far for a reflection"
                )
            }
        }
    }
}

impl std::error::Error for MeshError {}
