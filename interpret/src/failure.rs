//! The errors of starts and steps from all sources, and their conversion for the caller.

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
    /// An invalid parameter.
    Parameter(ParameterError),
    /// A start that fails.
    Start(StartError),
    /// A step that fails.
    Step(StepError),
    /// The cause of a failed step, without its node.
    Cause(StepCause),
    /// An error of the Moser-Veselov equation.
    MoserVeselov(MoserVeselovError),
    /// An error of a free body.
    Poinsot(PoinsotError),
    /// An error of a left factor.
    LeftFactor(LeftFactorError),
    /// An error of a solver for a left factor.
    Unsolved(Unsolved),
    /// An error of the equation in unit quaternions.
    Quaternion(QuaternionError),
    /// A linear equation with a singular factor.
    Singular(SingularFactor),
    /// The equation of a single site without a root.
    NoRoot(NoRoot),
    /// An error of the constraints of a chain.
    NoReaction(NoReaction),
    /// A step that leaves the domain of the model.
    Contact(Contact),
    /// An error of the values with which a trajectory is opened.
    Open(OpenError),
    /// A given matrix that is not a rotation.
    Rotation(NotARotation),
    /// A given matrix that is not a rigid motion.
    Motion(NotARigidMotion),
    /// A given matrix that is not invertible.
    Map(NotInvertible),
    /// An error of a functional of all sites.
    Mesh(MeshError),
    /// An error of a functional of all sites, with the name of its values.
    Functional(&'static str, MeshError),
    /// An error of a chain.
    Line(LineError),
    /// An error at one site, in a loop over sites.
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

/// The cause if the error is of another kind.
const UNTOLD: StepCause = StepCause::NotFinite { what: "step" };

impl Failure {
    /// The error as the cause of a failed step.
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

    /// The error as an error of a step.
    pub fn step(self, node: u64) -> StepError {
        match self {
            Failure::Step(e) => e,
            other => other.cause().at_node(node),
        }
    }

    /// The error as an error of a chain.
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

    /// The error as an error of a start.
    pub fn start(self) -> StartError {
        match self {
            Failure::Start(e) => e,
            Failure::Parameter(e) => e.into(),
            other => StartError::Refused(other.cause()),
        }
    }

    /// The error as an error of opening a trajectory.
    pub fn open(self) -> OpenError {
        match self {
            Failure::Open(e) => e,
            Failure::Parameter(e) => e.into(),
            other => other.start().into(),
        }
    }

    /// This error, with the name of a field.
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
