//! Why the stability limit of a model is unknown.

use core::fmt;

/// Why the stability limit is unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unknown {
    /// The initial values lack a momentum for some configuration.
    Kind,
    /// The first step from the start at rest fails, or its constraints are not independent.
    Start,
    /// A step from a state near the start fails.
    Refused,
    /// The kinetic energy is not positive for a velocity that the constraints allow.
    Kinetic,
    /// The stiffness is zero.
    Still,
    /// Steps of about 2/ω from the start at rest fail.
    Far,
    /// A step does not move the fastest motion as steps with the potential at the nodes do: with a potential in the
    /// middle of steps, with strong terms linear in velocities, at a kink, all steps may be stable.
    OtherSteps,
    /// The search reached its time limit.
    Unfinished,
}

impl fmt::Display for Unknown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Kind => "a configuration has no momentum in the initial values",
            Self::Start => "no short step from the initial configuration at rest succeeds",
            Self::Refused => "a step from a state near the initial configuration fails",
            Self::Kinetic => "the kinetic energy is not positive for all admissible velocities",
            Self::Still => "the stiffness at the initial configuration is zero",
            Self::Far => "no step of about 2/ω from the initial configuration at rest succeeds",
            Self::OtherSteps => "the scheme does not treat the fastest mode like Störmer-Verlet",
            Self::Unfinished => "the search was stopped early",
        })
    }
}

impl std::error::Error for Unknown {}
