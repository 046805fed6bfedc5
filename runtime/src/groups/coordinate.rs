//! The meaning of one coordinate of a Lie algebra, and of the corresponding component of a momentum. Takes its index;
//! gives the words for messages.

use core::fmt;

/// One coordinate of a group, or of one factor of a product of groups. Everything counts from 0 here,
/// and from 1 in messages, as in files and plots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Coordinate {
    /// The factor of a product of groups; 0 for a single group.
    pub factor: u8,
    /// The index of the coordinate in that factor.
    pub part: Part,
}

/// A coordinate of one group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// A component of a vector: of rotations of space and unit quaternions.
    Axis(u8),
    /// A component of the angular part of a rigid motion.
    Angular(u8),
    /// A component of the linear part of a rigid motion.
    Linear(u8),
    /// The plane of two axes, of rotations in `n` dimensions.
    Plane(u8, u8),
    /// An entry of a matrix, by its row and its column.
    Entry(u8, u8),
}

/// An index in the stored type, whose range covers the coordinates of all groups.
fn small(index: usize) -> u8 {
    u8::try_from(index).unwrap_or(u8::MAX)
}

impl Part {
    /// A component of a vector.
    #[must_use]
    pub fn axis(index: usize) -> Self {
        Self::Axis(small(index))
    }

    /// A component of a vector of six, angular before linear.
    #[must_use]
    pub fn of_motion(index: usize) -> Self {
        match index.checked_sub(3) {
            None => Self::Angular(small(index)),
            Some(linear) => Self::Linear(small(linear)),
        }
    }

    /// An entry of an `n x n` matrix, row by row.
    #[must_use]
    pub fn entry(index: usize, n: usize) -> Self {
        let n = n.max(1);
        Self::Entry(small(index / n), small(index % n))
    }

    /// A component of an angle on top of a vector of the plane.
    #[must_use]
    pub fn of_plane_motion(index: usize) -> Self {
        match index.checked_sub(1) {
            None => Self::Angular(0),
            Some(i) => Self::Linear(small(i)),
        }
    }

    /// The plane of two axes; in three dimensions it is named by its axis of rotation.
    #[must_use]
    pub fn plane(i: usize, j: usize, n: usize) -> Self {
        match (n, 3_usize.checked_sub(i + j)) {
            (3, Some(axis)) => Self::axis(axis),
            _ => Self::Plane(small(i), small(j)),
        }
    }

    /// The plane with this index among the pairs `i < j` of `n` axes, row by row.
    #[must_use]
    pub fn of_pair(index: usize, n: usize) -> Self {
        let mut pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        let (i, j) = pairs.nth(index).unwrap_or((n, n));
        Self::Plane(small(i), small(j))
    }
}

impl Coordinate {
    /// The coordinate of a single group.
    #[must_use]
    pub fn of(part: Part) -> Self {
        Self { factor: 0, part }
    }

    /// This coordinate, in factor `factor` of a product.
    #[must_use]
    pub fn in_factor(self, factor: usize) -> Self {
        Self {
            factor: small(factor),
            ..self
        }
    }
}

/// As messages count.
fn from_one(index: u8) -> u16 {
    u16::from(index) + 1
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Axis(i) => write!(f, "component {}", from_one(*i)),
            Self::Angular(i) => write!(f, "angular component {}", from_one(*i)),
            Self::Linear(i) => write!(f, "linear component {}", from_one(*i)),
            Self::Plane(i, j) => write!(f, "plane ({}, {})", from_one(*i), from_one(*j)),
            Self::Entry(i, j) => write!(f, "entry ({}, {})", from_one(*i), from_one(*j)),
        }
    }
}
