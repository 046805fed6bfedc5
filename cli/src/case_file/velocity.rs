//! Velocities instead of momenta: `velocity_x`, `angular_velocity_R`, `spatial_angular_velocity_R`.
//! Takes the fields of a card; gives the keys of the velocities of a configuration, the field of each, and the
//! velocity itself.

use clebsch::card::{Field, Kind};
use clebsch_check::{Frame, Velocity};

/// A velocity that a case may give.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Way {
    /// The rate of change of a field, of a linear map, or of the position of a rigid motion.
    Rate,
    /// The angular velocity in the axes of the body.
    Body,
    /// The angular velocity in the axes of space.
    Space,
}

impl Way {
    /// All kinds of velocity.
    pub(super) const ALL: [Self; 3] = [Self::Rate, Self::Body, Self::Space];

    /// The beginning of its key.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Rate => "velocity",
            Self::Body => "angular_velocity",
            Self::Space => "spatial_angular_velocity",
        }
    }

    /// The key of the velocity that replaces the momentum with this key.
    pub(super) fn key(self, momentum: &str) -> Option<String> {
        Some(format!("{}{}", self.word(), suffix(momentum)?))
    }

    /// Whether a configuration has this velocity.
    pub(super) fn is_of(self, element: &Field, momentum: &Field) -> bool {
        match (momentum.kind, element.kind) {
            (Kind::FieldMomentum, _) => self == Self::Rate,
            (_, Kind::Rotation | Kind::UnitQuaternion) => self != Self::Rate,
            (_, Kind::RigidMotion) => true,
            _ => self == Self::Rate,
        }
    }

    /// The field that describes the velocity.
    pub(super) fn field(self, element: &Field, momentum: &Field) -> Field {
        let n = element.rows;
        let of = |kind: Kind, size: [usize; 2]| kind.field("velocity", size, "");
        match (self, element.kind) {
            (Self::Rate, Kind::RigidMotion) => of(Kind::Vector, [n - 1, 1]),
            (Self::Rate, _) => {
                let kind = match (momentum.rows, momentum.cols) {
                    (1, 1) => Kind::Scalar,
                    (_, 1) => Kind::Vector,
                    _ => Kind::Matrix,
                };
                of(kind, [momentum.rows, momentum.cols])
            }
            (_, Kind::UnitQuaternion) => of(Kind::Vector, [3, 1]),
            (_, Kind::RigidMotion) if n == 4 => of(Kind::Vector, [3, 1]),
            (_, Kind::RigidMotion) => of(Kind::Scalar, [1, 1]),
            _ if n == 3 => of(Kind::Vector, [3, 1]),
            _ if n == 2 => of(Kind::Scalar, [1, 1]),
            _ => of(Kind::Skew, [n, n]),
        }
    }

    /// Adds its numbers to the velocity of a configuration.
    pub(super) fn add(self, element: &Field, numbers: &[f64], velocity: &mut Velocity) {
        let frame = match self {
            Self::Rate => {
                velocity.moving = Some(numbers.to_vec());
                return;
            }
            Self::Body => Frame::Body,
            Self::Space => Frame::Space,
        };
        let n = element.rows;
        let components = match (element.kind, numbers) {
            // In the plane the basis has the opposite orientation: the entry above the diagonal is positive.
            (Kind::Rotation, [w]) if n == 2 => vec![-w],
            (Kind::Rotation, all) if all.len() == n * n => {
                let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| i * n + j));
                pairs.filter_map(|k| all.get(k).copied()).collect()
            }
            _ => numbers.to_vec(),
        };
        velocity.turning = Some((components, frame));
    }
}

/// The end of the key of a momentum: an underscore and the name of its configuration, or nothing if there is
/// only one configuration.
pub(super) fn suffix(momentum: &str) -> Option<&str> {
    let plain = momentum
        .strip_prefix("body_")
        .or_else(|| momentum.strip_prefix("spatial_"))
        .unwrap_or(momentum);
    let rest = plain.strip_prefix("momentum")?;
    (rest.is_empty() || rest.starts_with('_')).then_some(rest)
}

/// The numbers of a momentum field from the components along the variations of its configuration.
pub(super) fn momentum_of(element: &Field, momentum: &Field, components: &[f64]) -> Vec<f64> {
    let n = momentum.rows;
    if element.kind != Kind::Rotation || momentum.count() == components.len() {
        return components.to_vec();
    }
    // A skew matrix: its axial vector in three dimensions, otherwise the entries above the diagonal.
    let mut out = vec![0.0; n * n];
    let pairs: Vec<(usize, usize)> = match n {
        3 => vec![(2, 1), (0, 2), (1, 0)],
        _ => (0..n)
            .flat_map(|i| (i + 1..n).map(move |j| (i, j)))
            .collect(),
    };
    for ((i, j), p) in pairs.into_iter().zip(components) {
        if let Some(entry) = out.get_mut(i * n + j) {
            *entry = *p;
        }
        if let Some(entry) = out.get_mut(j * n + i) {
            *entry = -p;
        }
    }
    out
}

/// Whether an unknown key is probably intended as a velocity.
pub(super) fn is_meant(key: &str) -> bool {
    let word = key.to_lowercase();
    word.contains("veloc")
        || word.starts_with("omega")
        || word.starts_with('ω')
        || word.contains("spin")
}
