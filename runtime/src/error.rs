//! Errors of parameters, of the start of a trajectory, and of its steps.
//! Takes the numbers of the failure; gives messages that say what to change.

use crate::domain::{Contact, Domain, Function};
use crate::groups::{NotARigidMotion, NotARotation, NotInvertible};
use crate::line::{NoReaction, NoRoot, Place};
use crate::mesh::MeshError;
use crate::number_format::{self, place};
use crate::solvers::left_factor::{LeftFactorError, Unsolved};
use crate::solvers::moser_veselov::{MoserVeselovError, PoinsotError};
use crate::solvers::newton::NewtonError;
use crate::solvers::two_sided::SingularFactor;
use crate::solvers::unit_quaternions::QuaternionError;
use core::fmt;

/// A parameter or an initial value that the model cannot work with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterError {
    /// The name of the quantity as the model writes it.
    pub field: &'static str,
    /// The problem, with numbers.
    pub problem: Problem,
    /// The suggested fix.
    pub remedy: &'static str,
}

/// The problem with a parameter or an initial value. Positions, rows and columns count from 0 here, and
/// from 1 in the message, as in files and plots.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Problem {
    /// A component is NaN or infinite.
    NotFinite {
        /// Its position.
        index: usize,
        /// The offending value.
        value: f64,
    },
    /// An entry of a matrix is NaN or infinite.
    EntryNotFinite {
        /// Its row.
        row: usize,
        /// Its column.
        column: usize,
        /// The offending value.
        value: f64,
    },
    /// The matrix must be symmetric and is not.
    NotSymmetric {
        /// Row of the entry above the diagonal.
        row: usize,
        /// Its column.
        column: usize,
        /// The entry at (row, column).
        upper: f64,
        /// The entry at (column, row).
        lower: f64,
    },
    /// The matrix must be skew and is not.
    NotSkew {
        /// Row of the entry above (or on) the diagonal.
        row: usize,
        /// Its column.
        column: usize,
        /// The entry at (row, column).
        upper: f64,
        /// The entry at (column, row).
        lower: f64,
    },
    /// The matrix must be diagonal and is not.
    NotDiagonal {
        /// Row of the entry.
        row: usize,
        /// Its column.
        column: usize,
        /// The entry.
        value: f64,
    },
    /// The matrix must be a rotation and is not: its columns are not orthonormal, or it is a
    /// reflection.
    NotOrthogonal {
        /// Largest entry of `A^T A - 1`.
        deviation: f64,
        /// Its determinant.
        determinant: f64,
    },
    /// The matrix must be an element of a group and is not.
    NotInGroup {
        /// A description of the elements of the group.
        elements: &'static str,
        /// The largest difference to an entry of the nearest element.
        deviation: f64,
    },
    /// The matrix must be invertible and is not, to working precision.
    NotInvertible,
    /// The number must be positive and is not.
    NotPositive {
        /// The number.
        value: f64,
    },
    /// The number is so small that its inverse is infinite.
    TooSmall {
        /// The number.
        value: f64,
    },
    /// An assumption stated in the model does not hold.
    AssumptionFails {
        /// The assumption as the model writes it.
        text: &'static str,
    },
    /// The initial configuration violates a constraint.
    OffConstraint {
        /// The constraint as the model writes it.
        equation: &'static str,
        /// The difference of the left and the right side.
        size: f64,
        /// The size of its terms.
        scale: f64,
    },
    /// The initial momentum is not tangent to a constraint.
    AcrossConstraint {
        /// The constraint as the model writes it.
        equation: &'static str,
        /// The multiplier of the gradient of the left side minus the right side; the projection subtracts that
        /// multiple.
        impulse: f64,
        /// The size of the part that the projection on all constraints removes from the momentum.
        taken: f64,
        /// The size of the momentum.
        whole: f64,
    },
    /// An impulse does not determine a velocity: a mass is zero, or the mass matrix is singular.
    NoInertia,
    /// The constraints are not independent at the initial configuration.
    DependentConstraints {
        /// One of them.
        equation: &'static str,
    },
    /// Around a ring, unit quaternions return with the opposite sign, which changes a coupling term of neighbours.
    SignAroundRing,
    /// A function of parameters is undefined at their values.
    OutsideDomain {
        /// The function.
        function: Function,
        /// The condition on its argument.
        domain: Domain,
        /// The argument.
        value: f64,
    },
    /// The matrix is not the Poinsot matrix of a body.
    Poinsot(PoinsotError),
    /// The matrix is not a left factor of a Moser-Veselov equation.
    LeftFactor(LeftFactorError),
    /// The matrix is not a rotation.
    Rotation(NotARotation),
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { index, value } => {
                write!(f, "component {} is {value}", index + 1)
            }
            Self::EntryNotFinite { row, column, value } => {
                write!(f, "entry {} is {value}", place(*row, *column))
            }
            Self::NotSymmetric {
                row,
                column,
                upper,
                lower,
            } => write!(
                f,
                "not symmetric: entry {} is {upper} but {} is {lower}",
                place(*row, *column),
                place(*column, *row)
            ),
            Self::NotSkew {
                row, column, upper, ..
            } if row == column => write!(
                f,
                "not skew: entry {} is {upper}, not 0",
                place(*row, *column)
            ),
            Self::NotSkew {
                row,
                column,
                upper,
                lower,
            } => write!(
                f,
                "not skew: entry {} is {upper} but {} is {lower}",
                place(*row, *column),
                place(*column, *row)
            ),
            Self::NotDiagonal { row, column, value } => {
                write!(f, "not diagonal: entry {} is {value}", place(*row, *column))
            }
            Self::NotOrthogonal {
                deviation,
                determinant,
            } => write!(
                f,
                "not a rotation: A^T A differs from 1 by {deviation}, and the determinant is {determinant}"
            ),
            Self::NotInGroup {
                elements,
                deviation,
            } => write!(f, "not {elements}, off by {deviation:e}"),
            Self::NotInvertible => write!(f, "not invertible"),
            Self::NotPositive { value } => write!(f, "{value} is not positive"),
            Self::TooSmall { value } => {
                write!(f, "{value:e} is too small: its inverse is infinite")
            }
            Self::AssumptionFails { text } => write!(f, "the assumption `{text}` does not hold"),
            Self::OffConstraint {
                equation,
                size,
                scale,
            } => write!(
                f,
                "the initial configuration violates the constraint `{equation}`: its sides differ by {size:e}, with terms of \
                 size {scale:e}"
            ),
            Self::AcrossConstraint {
                equation,
                impulse,
                taken,
                whole,
            } => write!(
                f,
                "the initial momentum is not tangent to the constraint `{equation}`: projecting it onto the constraints \
                 removes {taken:.3e} of its size {whole:.3e}, with the multiplier {impulse} for this constraint"
            ),
            Self::NoInertia => write!(
                f,
                "its mass is zero or its mass matrix is singular, so the constraint forces on it are undetermined"
            ),
            Self::DependentConstraints { equation } => write!(
                f,
                "the constraint force of `{equation}` is not determined: at the initial configuration its derivative vanishes \
                 or is a combination of the derivatives of other constraints"
            ),
            Self::SignAroundRing => write!(
                f,
                "around the ring these attitudes make an odd number of turns, so unit quaternions that vary continuously from \
                 site to site return with the opposite sign; a coupling of neighbours would see a whole turn between the \
                 last site and the first"
            ),
            Self::OutsideDomain {
                function,
                domain,
                value,
            } => write!(
                f,
                "it is {value}, and the argument of {function} must be {}",
                domain.needs()
            ),
            Self::Poinsot(error) => write!(f, "{error}"),
            Self::LeftFactor(error) => write!(f, "{error}"),
            Self::Rotation(error) => write!(f, "{error}"),
        }
    }
}

impl fmt::Display for ParameterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`: {}; {}", self.field, self.problem, self.remedy)
    }
}

impl std::error::Error for ParameterError {}

impl PoinsotError {
    /// Turns this error into a [`ParameterError`] of the parameter `field`.
    #[cold]
    pub fn in_field(self, field: &'static str) -> ParameterError {
        let remedy = match self {
            Self::NoInertia { .. } => {
                "add to J the second moments of the mass about its own centre, so that J has rank two or three; a hundredth of \
                 J is enough"
            }
            Self::Triangle { .. } => {
                "the Moser-Veselov equation needs second moments J = tr(I)/2 - I that are not negative, as for a real mass \
                 distribution; positive moments of inertia are not enough"
            }
            Self::NotFinite { .. } | Self::NotSymmetric { .. } => {
                "give the matrix of second moments J = tr(I)/2 - I of a real mass distribution"
            }
        };
        ParameterError {
            field,
            problem: Problem::Poinsot(self),
            remedy,
        }
    }
}

impl NotARotation {
    /// Turns this error into a [`ParameterError`] of the initial value `field`.
    #[cold]
    pub fn in_field(self, field: &'static str) -> ParameterError {
        ParameterError {
            field,
            problem: Problem::Rotation(self),
            remedy: "give a matrix with orthonormal columns and determinant +1, accurate to all digits",
        }
    }
}

impl NotARigidMotion {
    /// Turns this error into a [`ParameterError`] of the initial value `field`.
    #[cold]
    pub fn in_field(self, field: &'static str) -> ParameterError {
        match self {
            NotARigidMotion::Rotation(why) => why.in_field(field),
            NotARigidMotion::LastRow { defect } => ParameterError {
                field,
                problem: Problem::NotInGroup {
                    elements: "the homogeneous matrix of a rigid motion",
                    deviation: defect,
                },
                remedy: "give a finite matrix whose last row is 0, ..., 0, 1",
            },
        }
    }
}

impl NotInvertible {
    /// Turns this error into a [`ParameterError`] of the initial value `field`.
    #[cold]
    pub fn in_field(self, field: &'static str) -> ParameterError {
        ParameterError {
            field,
            problem: Problem::NotInvertible,
            remedy: "give a finite matrix with a non-zero determinant",
        }
    }
}

/// Why a trajectory cannot start.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum StartError {
    /// An initial value, or the step size, is unusable.
    Initial(ParameterError),
    /// The data are valid, but the first step fails.
    Refused(StepCause),
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Initial(error) => write!(f, "cannot start: {error}"),
            Self::Refused(cause) => write!(f, "cannot take the first step: {cause}"),
        }
    }
}

impl std::error::Error for StartError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Initial(error) => Some(error),
            Self::Refused(cause) => Some(cause),
        }
    }
}

impl From<ParameterError> for StartError {
    #[cold]
    fn from(error: ParameterError) -> Self {
        Self::Initial(error)
    }
}

impl From<StepCause> for StartError {
    #[cold]
    fn from(cause: StepCause) -> Self {
        Self::Refused(cause)
    }
}

impl From<MoserVeselovError> for StartError {
    #[cold]
    fn from(error: MoserVeselovError) -> Self {
        Self::Refused(StepCause::MoserVeselov(error))
    }
}

impl From<NewtonError> for StartError {
    #[cold]
    fn from(error: NewtonError) -> Self {
        Self::Refused(StepCause::Newton(error))
    }
}

/// A step that was not taken; the state is as it was before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepError {
    /// The node the step would have started from.
    pub node: u64,
    /// Why.
    pub cause: StepCause,
}

/// Why a step was not taken.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum StepCause {
    /// The step is too long for the Moser-Veselov equation to have a principal solution.
    MoserVeselov(MoserVeselovError),
    /// The step is too long for the equation in unit quaternions to have a principal solution.
    Quaternions(QuaternionError),
    /// The solver of a left factor fails, usually because the step is too long.
    LeftFactor(Unsolved),
    /// The matrix computed from the state is not a left factor.
    Factor(LeftFactorError),
    /// The linear equation of the step does not determine the velocity.
    Singular(SingularFactor),
    /// The Newton iteration failed.
    Newton(NewtonError),
    /// The step of a chain does not have a solution connected to h = 0.
    NoRoot(NoRoot),
    /// The step of a chain does not have constraint forces that enforce its constraints.
    NoReaction(NoReaction),
    /// The step leaves the domain of the model.
    Contact(Contact),
    /// A quantity became NaN or infinite.
    NotFinite {
        /// Its name.
        what: &'static str,
    },
    /// The step of a chain fails at one of its sites.
    AtSite {
        /// Where.
        at: Place,
        /// Why.
        cause: &'static StepCause,
        /// A smaller step size for which a trial succeeded, if there is one.
        works: Option<f64>,
    },
    /// A functional of all sites, or its derivative, is undefined where the step needs it.
    Functional {
        /// Its values, as the model names them.
        quantity: &'static str,
        /// Why.
        cause: MeshError,
        /// A shorter step that was tried successfully, if one was found.
        works: Option<f64>,
    },
    /// A model that is read from its text needs an operation that only a compiled model has.
    Unread {
        /// The operation.
        what: &'static str,
    },
}

impl StepCause {
    /// A quantity of this name is NaN or infinite.
    #[cold]
    #[must_use]
    pub fn not_finite(what: &'static str) -> Self {
        Self::NotFinite { what }
    }

    /// The error of the step from node `node`.
    #[cold]
    pub fn at_node(self, node: u64) -> StepError {
        StepError { node, cause: self }
    }
}

impl From<MoserVeselovError> for StepCause {
    #[cold]
    fn from(error: MoserVeselovError) -> Self {
        Self::MoserVeselov(error)
    }
}

impl From<QuaternionError> for StepCause {
    #[cold]
    fn from(error: QuaternionError) -> Self {
        Self::Quaternions(error)
    }
}

impl From<Unsolved> for StepCause {
    #[cold]
    fn from(error: Unsolved) -> Self {
        Self::LeftFactor(error)
    }
}

impl From<Contact> for StepCause {
    #[cold]
    fn from(contact: Contact) -> Self {
        Self::Contact(contact)
    }
}

impl From<NewtonError> for StepCause {
    #[cold]
    fn from(error: NewtonError) -> Self {
        Self::Newton(error)
    }
}

impl fmt::Display for StepCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MoserVeselov(error) => write!(f, "{error}"),
            Self::Quaternions(error) => write!(f, "{error}"),
            Self::LeftFactor(error) => write!(f, "{error}"),
            Self::Factor(error) => write!(f, "the left factor at this state: {error}"),
            Self::Singular(error) => write!(f, "{error}"),
            Self::Newton(error) => write!(f, "{error}"),
            Self::NoRoot(error) => write!(f, "{error}"),
            Self::NoReaction(error) => write!(f, "{error}"),
            Self::Contact(contact) => write!(f, "{contact}"),
            Self::NotFinite { what } => write!(
                f,
                "`{what}` is NaN or infinite; reduce the step size or check the initial values"
            ),
            Self::AtSite { at, cause, works } => {
                write!(f, "{at}: {cause}")?;
                number_format::works(f, *works)
            }
            Self::Functional {
                quantity,
                cause,
                works,
            } => {
                write!(f, "`{quantity}`: {cause}")?;
                number_format::works(f, *works)
            }
            Self::Unread { what } => write!(
                f,
                "a model read from its text cannot take this step ({what}); compile the model with `model! {{ ... }}` in a \
                 crate"
            ),
        }
    }
}

impl std::error::Error for StepCause {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::MoserVeselov(error) => Some(error),
            Self::Quaternions(error) => Some(error),
            Self::LeftFactor(error) => Some(error),
            Self::Factor(error) => Some(error),
            Self::Singular(error) => Some(error),
            Self::Newton(error) => Some(error),
            Self::NoRoot(error) => Some(error),
            Self::NoReaction(error) => Some(error),
            Self::Contact(contact) => Some(contact),
            Self::AtSite { cause, .. } => Some(*cause),
            Self::Functional { cause, .. } => Some(cause),
            Self::NotFinite { .. } | Self::Unread { .. } => None,
        }
    }
}

impl StepError {
    /// The time of contact since node 0, for equal steps, if the motion left the domain of its model.
    #[must_use]
    pub fn contact_time(&self) -> Option<f64> {
        match &self.cause {
            StepCause::Contact(contact) => {
                let share = contact.share?;
                Some((self.node as f64 + share) * contact.h)
            }
            _ => None,
        }
    }
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "step from node {} failed (state unchanged): {}",
            self.node, self.cause
        )
    }
}

impl std::error::Error for StepError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.cause)
    }
}
