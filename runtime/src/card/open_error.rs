//! Why a trajectory cannot be opened, as numbers and as text.

use crate::kinetic::KineticWarning;
use crate::{ParameterError, StartError, StepCause};
use core::fmt;

/// Why [`Card::open`](super::Card::open) fails.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum OpenError {
    /// A parameter is unusable.
    Parameter(ParameterError),
    /// An initial value is unusable, or the first step fails.
    Start(StartError),
    /// The first step fails, perhaps because the kinetic energy is not positive definite.
    Kinetic {
        /// Why the step fails.
        refused: StepCause,
        /// The warning about the kinetic energy.
        warning: KineticWarning,
    },
    /// The model does not offer the requested solver.
    Solver {
        /// The solvers that the model offers.
        offered: &'static [&'static str],
    },
    /// Too few or too many numbers.
    Count {
        /// The field, or `parameters` / `initial values` for the number of fields itself.
        field: &'static str,
        /// How many are needed.
        expected: usize,
        /// The number of values found.
        found: usize,
    },
    /// The model does not offer steps of this order.
    Order {
        /// The requested order.
        asked: u32,
        /// The orders that the model offers.
        offered: &'static [u32],
    },
    /// Steps of this kind are not compensated.
    Compensation {
        /// The order of the steps.
        order: u32,
        /// Whether the model's orders above the plain one come from modified moments.
        preprocessed: bool,
    },
    /// Steps cannot be halved: the observables do not determine all initial values.
    Unseen {
        /// The initial value that is not among the observables.
        field: &'static str,
    },
}

impl OpenError {
    /// Adds the warning about the kinetic energy if the first step failed.
    #[must_use]
    pub fn beside(self, warning: Option<KineticWarning>) -> Self {
        match (self, warning) {
            (Self::Start(StartError::Refused(refused)), Some(warning)) => {
                Self::Kinetic { refused, warning }
            }
            (other, _) => other,
        }
    }
}

impl fmt::Display for OpenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parameter(error) => write!(f, "{error}"),
            Self::Start(error) => write!(f, "{error}"),
            Self::Kinetic { refused, warning } => {
                write!(f, "cannot take the first step: {refused}; {warning}")
            }
            Self::Solver { offered: [] } => {
                write!(f, "this model has only one solver; remove the option")
            }
            Self::Solver { offered } => {
                write!(
                    f,
                    "no such solver; this model offers {}",
                    offered.join(", ")
                )
            }
            Self::Count {
                field,
                expected,
                found,
            } => write!(f, "`{field}` takes {expected} numbers, found {found}"),
            Self::Compensation {
                order,
                preprocessed,
            } => {
                write!(
                    f,
                    "steps of order {order} of this model cannot be compensated: "
                )?;
                match (preprocessed, order) {
                    (false, _) => write!(
                        f,
                        "they compose plain steps and are symplectic if the plain steps are; leave out the compensation"
                    ),
                    (true, 2) => write!(
                        f,
                        "they are symplectic already; leave out the compensation, or choose order 4, 6 or 8"
                    ),
                    (true, _) => write!(
                        f,
                        "the known series ends there; leave out the compensation, or choose order 4, 6 or 8"
                    ),
                }
            }
            Self::Unseen { field } => write!(
                f,
                "the steps of this model cannot be subdivided: `{field}` is an initial value that is not observed later; use a \
                 smaller step size"
            ),
            Self::Order { asked, offered } => {
                let list: Vec<String> = offered.iter().map(u32::to_string).collect();
                write!(
                    f,
                    "order {asked} is not offered; this model has order {}",
                    list.join(", ")
                )?;
                match offered {
                    [1] => write!(
                        f,
                        ": its step is not symmetric under time reversal, so a composition gains nothing; `clebsch derive` \
                         shows the terms that prevent it: write `node symmetric;` for terms at one end of the step, or add \
                         an assumption on the parameters"
                    ),
                    _ if asked % 2 == 1 => {
                        write!(f, ": a symmetric step has even order; choose one of these")
                    }
                    _ => write!(f, "; choose one of these"),
                }
            }
        }
    }
}

impl std::error::Error for OpenError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Parameter(error) => Some(error),
            Self::Start(error) => Some(error),
            Self::Kinetic { refused, .. } => Some(refused),
            Self::Solver { .. }
            | Self::Count { .. }
            | Self::Order { .. }
            | Self::Compensation { .. }
            | Self::Unseen { .. } => None,
        }
    }
}

impl From<ParameterError> for OpenError {
    fn from(error: ParameterError) -> Self {
        Self::Parameter(error)
    }
}

impl From<StartError> for OpenError {
    fn from(error: StartError) -> Self {
        Self::Start(error)
    }
}
