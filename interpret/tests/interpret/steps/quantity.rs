//! Quantities along a chain of sites: where they are defined, their kinds, and random values. Takes a kind and
//! scales; gives numbers as the model takes them and as the oracle has them.

use clebsch_oracle::oracle::pair::Pair;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::step::Motion;

/// The sites of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    Whole,
    Nodes,
    Segments,
}

/// The kind of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// A number or a vector with this number of components.
    Vector(usize),
    /// One that is positive.
    Positive,
    /// One that is positive, of the scale of masses.
    Mass,
    /// A positive matrix of three rows.
    Stiffness,
    /// A positive matrix of the scale of masses.
    Moments,
    /// A rotation of space, near the identity of its neighbours.
    Turn,
    /// A unit quaternion, near the quaternions of its neighbours.
    Quaternion,
}

/// A quantity.
pub type Quantity = (&'static str, At, What);

/// The number of segments and the end conditions; a ring unless stated otherwise.
pub type Sites = (usize, Option<[&'static str; 2]>);

impl At {
    pub fn count(self, (n, ends): Sites) -> usize {
        match self {
            At::Whole => 1,
            At::Nodes => n + usize::from(ends.is_some()),
            At::Segments => n,
        }
    }
}

impl What {
    /// The shape of a value as the oracle has it.
    pub fn shape(self) -> [usize; 2] {
        match self {
            What::Vector(n) => [n, 1],
            What::Positive | What::Mass => [1, 1],
            What::Stiffness | What::Moments | What::Turn => [3, 3],
            What::Quaternion => [4, 4],
        }
    }

    /// The numbers of a momentum, and the prefix of its name.
    pub fn momentum(self) -> (usize, &'static str) {
        match self {
            What::Vector(n) => (n, "momentum_"),
            _ => (3, "body_momentum_"),
        }
    }

    pub fn motion(self) -> Motion {
        use clebsch_oracle::oracle::sides::Side::Body;
        use clebsch_oracle::oracle::step::group;
        match self {
            What::Turn => Motion::Turned(group::rotations(3), Body),
            What::Quaternion => Motion::Turned(group::quaternions(), Body),
            _ => Motion::Added,
        }
    }

    pub fn drawn(self, draw: &Draw, source: &mut Source) -> Vec<f64> {
        let scaled = |list: Vec<f64>, by: f64| list.into_iter().map(|x| x * by).collect();
        match self {
            What::Vector(n) => (0..n).map(|_| source.between(-1.0, 1.0)).collect(),
            What::Positive => vec![source.between(0.4, 1.2)],
            What::Mass => vec![source.between(0.4, 1.2) * draw.mass],
            What::Stiffness => source.positive::<3>().0.concat(),
            What::Moments => scaled(source.positive::<3>().0.concat(), draw.mass),
            What::Turn | What::Quaternion => {
                // Less than half a turn from one another.
                let v: [f64; 3] = source.vector();
                let q = [1.0, 0.5 * v[0], 0.5 * v[1], 0.5 * v[2]];
                let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
                let q = q.map(|x| x / length);
                match self {
                    What::Turn => turned(q),
                    _ => q.to_vec(),
                }
            }
        }
    }

    /// The values of the model in the form of the oracle: as given, and exactly in their group.
    pub fn values(self, list: &[f64]) -> [Vec<Pair>; 2] {
        use super::posed::{element, shown};
        let kind = match self {
            What::Turn => clebsch::card::Kind::Rotation,
            What::Quaternion => clebsch::card::Kind::UnitQuaternion,
            _ => clebsch::card::Kind::Matrix,
        };
        let field = kind.field("", self.shape(), "");
        [shown(&field, list), element(&field, list)]
    }

    /// How many numbers the model has for a value.
    pub fn numbers(self) -> usize {
        match self {
            What::Quaternion => 4,
            other => other.shape().iter().product(),
        }
    }
}

/// The rotation of a unit quaternion, row by row.
fn turned([w, x, y, z]: [f64; 4]) -> Vec<f64> {
    vec![
        1.0 - 2.0 * (y * y + z * z),
        2.0 * (x * y - w * z),
        2.0 * (x * z + w * y),
        2.0 * (x * y + w * z),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z - w * x),
        2.0 * (x * z - w * y),
        2.0 * (y * z + w * x),
        1.0 - 2.0 * (x * x + y * y),
    ]
}

/// The settings of one step.
#[derive(Clone, Copy, Debug)]
pub struct Draw {
    pub sites: Sites,
    pub h: f64,
    pub mass: f64,
    pub momentum: f64,
}
