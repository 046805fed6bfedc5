//! The errors that steps and starts end with, whatever made them, and their way to the caller.

use clebsch::domain::Contact;
use clebsch::emitted::{LeftFactorError, MoserVeselovError, OpenError, QuaternionError, Unsolved};
use clebsch::line::{LineError, NoReaction, NoRoot};
use clebsch::mesh::MeshError;
use clebsch::solvers::two_sided::SingularFactor;
use clebsch::{
    NotARigidMotion, NotARotation, NotInvertible, ParameterError, PoinsotError, StartError,
    StepCause, StepError,
};

/// Any error of the runtime.
#[derive(Clone, Debug, PartialEq)]
pub enum Failure {
    /// Of a parameter.
    Parameter(ParameterError),
    /// Of a start.
    Start(StartError),
    /// Of a step.
    Step(StepError),
    /// Of a step, without its node.
    Cause(StepCause),
    /// Of the Moser-Veselov equation.
    MoserVeselov(MoserVeselovError),
    /// Of a body.
    Poinsot(PoinsotError),
    /// Of a left factor.
    LeftFactor(LeftFactorError),
    /// Of a solver for a left factor.
    Unsolved(Unsolved),
    /// Of the equation in unit quaternions.
    Quaternion(QuaternionError),
    /// Of a linear equation.
    Singular(SingularFactor),
    /// Of an equation of one site.
    NoRoot(NoRoot),
    /// Of the constraints of a line.
    NoReaction(NoReaction),
    /// Of a domain.
    Contact(Contact),
    /// Of given values.
    Open(OpenError),
    /// Of a given rotation.
    Rotation(NotARotation),
    /// Of a given motion.
    Motion(NotARigidMotion),
    /// Of a given map.
    Map(NotInvertible),
    /// Of a functional of all sites.
    Mesh(MeshError),
    /// The same, with the name of its values.
    Functional(&'static str, MeshError),
    /// Along a line.
    Line(LineError),
    /// Of one site, in a loop over sites.
    At(usize, Box<Failure>),
    /// At one site, in a loop over sites.
    Site(usize),
}

macro_rules! from {
    ($($kind:ident: $ty:ty),* $(,)?) => {
        $(impl From<$ty> for Failure {
            fn from(e: $ty) -> Self {
                Failure::$kind(e)
            }
        })*
    };
}

from! {
    Parameter: ParameterError,
    Start: StartError,
    Step: StepError,
    Cause: StepCause,
    MoserVeselov: MoserVeselovError,
    Poinsot: PoinsotError,
    LeftFactor: LeftFactorError,
    Unsolved: Unsolved,
    Quaternion: QuaternionError,
    Singular: SingularFactor,
    NoRoot: NoRoot,
    NoReaction: NoReaction,
    Contact: Contact,
    Open: OpenError,
    Rotation: NotARotation,
    Motion: NotARigidMotion,
    Map: NotInvertible,
    Line: LineError,
    Mesh: MeshError,
}

/// What is not told by any other error.
const UNTOLD: StepCause = StepCause::NotFinite { what: "step" };

impl Failure {
    /// As the cause of a refused step.
    pub fn cause(self) -> StepCause {
        match self {
            Failure::Step(e) => e.cause,
            Failure::Cause(cause) | Failure::Start(StartError::Refused(cause)) => cause,
            Failure::MoserVeselov(e) => e.into(),
            Failure::Quaternion(e) => e.into(),
            Failure::Unsolved(e) => e.into(),
            Failure::Contact(e) => e.into(),
            Failure::Singular(e) => StepCause::Singular(e),
            Failure::NoRoot(e) => StepCause::NoRoot(e),
            Failure::NoReaction(e) => StepCause::NoReaction(e),
            Failure::LeftFactor(e) => StepCause::Factor(e),
            _ => UNTOLD,
        }
    }

    /// As the error of a step.
    pub fn step(self, node: u64) -> StepError {
        match self {
            Failure::Step(e) => e,
            other => other.cause().at_node(node),
        }
    }

    /// As the error of a line.
    pub fn line(self) -> LineError {
        match self {
            Failure::Line(e) => e,
            Failure::Parameter(e) => LineError::Parameter(e),
            other => LineError::Step {
                node: 0,
                at: clebsch::line::Place {
                    quantity: "line",
                    site: 0,
                },
                cause: other.cause(),
                works: None,
            },
        }
    }

    /// As the error of a start.
    pub fn start(self) -> StartError {
        match self {
            Failure::Start(e) => e,
            Failure::Parameter(e) => e.into(),
            other => StartError::Refused(other.cause()),
        }
    }

    /// As the error of opening a trajectory.
    pub fn open(self) -> OpenError {
        match self {
            Failure::Open(e) => e,
            Failure::Parameter(e) => e.into(),
            other => other.start().into(),
        }
    }

    /// The same error, told of a field.
    pub fn in_field(self, field: &'static str) -> Self {
        match self {
            Failure::Poinsot(e) => e.in_field(field).into(),
            Failure::LeftFactor(e) => e.in_field(field).into(),
            Failure::Rotation(e) => e.in_field(field).into(),
            Failure::Motion(e) => e.in_field(field).into(),
            Failure::Map(e) => e.in_field(field).into(),
            other => other,
        }
    }
}
