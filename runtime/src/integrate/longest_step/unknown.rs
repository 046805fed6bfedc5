//! Why the stability limit of a model is unknown.

use core::fmt;

/// Why the stability limit is unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unknown {
    /// The initial values do not contain a momentum for each configuration.
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
    /// The search was given up before its end.
    Unfinished,
}

impl fmt::Display for Unknown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Kind => "a configuration has no momentum of its own",
            Self::Start => "from the start, at rest, no short step can be taken",
            Self::Refused => "a state near the start, at rest, is refused",
            Self::Kinetic => {
                "the kinetic energy is not positive for every velocity that the model admits"
            }
            Self::Still => "at rest nothing resists a disturbance of the start",
            Self::Far => "from the start, at rest, no step of about 2/ω can be taken",
            Self::OtherSteps => {
                "the step does not move the fastest one as steps with the potential at the nodes do"
            }
            Self::Unfinished => "the search was given up before its end",
        })
    }
}

impl std::error::Error for Unknown {}
