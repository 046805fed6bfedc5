//! One error type for programs: `?` works in a function that builds, starts, steps and runs a model.
//! Takes any typed error of this crate; gives its message unchanged.

use crate::card::OpenError;
use crate::integrate::{EnsembleError, NotFinite, RunError};
use crate::line::LineError;
use crate::mesh::MeshError;
use crate::solvers::newton::NewtonError;
use crate::{
    MoserVeselovError, NotARigidMotion, NotARotation, NotInvertible, ParameterError, PoinsotError,
    SnapshotError, StartError, StepError,
};
use core::fmt;

/// Any error of this crate.
///
/// ```
/// use clebsch::nalgebra::{Matrix3, Vector3};
/// use clebsch::{Poinsot, Rotation};
///
/// fn data() -> Result<(Rotation<f64>, Poinsot), clebsch::Error> {
///     let attitude = Rotation::from_quaternion([1.0, 0.0, 0.0, 0.0])?;
///     let moments = Poinsot::new(Matrix3::from_diagonal(&Vector3::new(0.5, 0.5, 1.5)))?;
///     Ok((attitude, moments))
/// }
/// assert!(data().is_ok());
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A parameter, an initial value or a step size is unusable.
    Parameter(ParameterError),
    /// A trajectory cannot start.
    Start(StartError),
    /// A step failed.
    Step(StepError),
    /// A run stopped before its end.
    Run(RunError),
    /// A chain of sites cannot be built, started or stepped.
    Line(LineError),
    /// A functional of all particles, or its derivative, is undefined.
    Mesh(MeshError),
    /// A trajectory cannot be opened from numbers.
    Open(OpenError),
    /// A body of an ensemble cannot start.
    EnsembleStart(EnsembleError<StartError>),
    /// A body of an ensemble cannot take its next step.
    EnsembleStep(EnsembleError<StepError>),
    /// A snapshot cannot be taken, read or restored.
    Snapshot(SnapshotError),
    /// Newton's method finds no principal root.
    Newton(NewtonError),
    /// The step is too long for the Moser-Veselov equation to have a principal solution.
    MoserVeselov(MoserVeselovError),
    /// A matrix is not the Poinsot matrix of a body.
    Poinsot(PoinsotError),
    /// A matrix is not a rotation.
    Rotation(NotARotation),
    /// A matrix is not a rigid motion.
    RigidMotion(NotARigidMotion),
    /// A matrix is not invertible.
    Invertible(NotInvertible),
}

/// Implements `From`, `Display` and `source` for every variant of [`Error`].
macro_rules! collected {
    ($($variant:ident: $kind:ty,)*) => {
        $(impl From<$kind> for Error {
            #[cold]
            fn from(error: $kind) -> Self {
                Self::$variant(error)
            }
        })*

        impl fmt::Display for Error {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match self {
                    $(Self::$variant(error) => fmt::Display::fmt(error, f),)*
                }
            }
        }

        impl std::error::Error for Error {
            /// The source of the inner error; `Display` already shows the message of the inner error itself.
            fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
                match self {
                    $(Self::$variant(error) => std::error::Error::source(error),)*
                }
            }
        }
    };
}

collected! {
    Parameter: ParameterError,
    Start: StartError,
    Step: StepError,
    Run: RunError,
    Line: LineError,
    Mesh: MeshError,
    Open: OpenError,
    EnsembleStart: EnsembleError<StartError>,
    EnsembleStep: EnsembleError<StepError>,
    Snapshot: SnapshotError,
    Newton: NewtonError,
    MoserVeselov: MoserVeselovError,
    Poinsot: PoinsotError,
    Rotation: NotARotation,
    RigidMotion: NotARigidMotion,
    Invertible: NotInvertible,
}

impl From<NotFinite> for Error {
    #[cold]
    fn from(found: NotFinite) -> Self {
        Self::Run(RunError::NotFinite(found))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Problem;

    fn refused() -> ParameterError {
        ParameterError {
            field: "m",
            problem: Problem::NotPositive { value: -1.0 },
            remedy: "give a positive mass",
        }
    }

    #[test]
    fn message_and_source_are_those_of_the_error_within() {
        let start = StartError::Initial(refused());
        let any = Error::from(start);
        assert_eq!(any.to_string(), start.to_string());
        let source = std::error::Error::source(&any).map(ToString::to_string);
        assert_eq!(source, Some(refused().to_string()));
    }

    #[test]
    fn a_question_mark_takes_errors_of_several_kinds() {
        fn line() -> Result<(), LineError> {
            Err(refused().into())
        }
        fn both(first: bool) -> Result<(), Error> {
            if first {
                Err(refused())?;
            }
            Ok(line()?)
        }
        assert_eq!(both(true), Err(Error::Parameter(refused())));
        assert_eq!(
            both(false),
            Err(Error::Line(LineError::Parameter(refused())))
        );
    }
}
