//! Which groups a search for velocities is in. The solver asks a type for what belongs to a group, such as
//! its coordinates; here one type serves all groups, and the answer stands in the shape at work.

use super::bound::VARIABLES;
use clebsch::groups::{Coordinate, Group};
use clebsch::solvers::newton::{Enclosure, Region};
use std::cell::Cell;

/// A group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Rotations of space.
    Rotation,
    /// Unit quaternions.
    Quaternion,
    /// Rigid motions of space.
    Motion,
    /// Those of the plane.
    Plane,
    /// Invertible maps of so many dimensions.
    Linear(usize),
    /// Rotations of so many dimensions.
    Orthogonal(usize),
    /// Fields of so many rows and columns.
    Field(usize, usize),
}

/// The body for the group of a kind, `$G` over numbers and `$R` in bounds; the value of `$other` for
/// groups that are not compiled.
macro_rules! of_kind {
    ($kind:expr, $G:ident, $R:ident, $K:ident, $body:expr, $other:expr) => {{
        use clebsch::emitted::{
            Additive, Linear, Orthogonal, PlaneMotion, RigidMotion, Rotation, UnitQuaternion,
        };
        use clebsch::solvers::newton as bounds;
        macro_rules! with {
            ($g:ty, $r:ty) => {{
                #[allow(dead_code)]
                type $G = $g;
                #[allow(dead_code)]
                type $R<const $K: usize> = $r;
                $body
            }};
        }
        macro_rules! field {
            ($rows:literal, $cols:literal) => {
                with!(Additive<$rows, $cols, f64>, bounds::AdditiveRegion<$rows, $cols, $K>)
            };
        }
        use $crate::newton::shape::Kind;
        match $kind {
            Kind::Rotation => with!(Rotation<f64>, bounds::RotationRegion<$K>),
            Kind::Quaternion => with!(UnitQuaternion<f64>, bounds::QuaternionRegion<$K>),
            Kind::Motion => with!(RigidMotion<f64>, bounds::MotionRegion<$K>),
            Kind::Plane => with!(PlaneMotion<f64>, bounds::PlaneMotionRegion<$K>),
            Kind::Linear(1) => with!(Linear<1, f64>, bounds::LinearRegion<1, $K>),
            Kind::Linear(2) => with!(Linear<2, f64>, bounds::LinearRegion<2, $K>),
            Kind::Linear(3) => with!(Linear<3, f64>, bounds::LinearRegion<3, $K>),
            Kind::Orthogonal(3) => with!(Orthogonal<3, f64>, bounds::OrthogonalRegion<3, $K>),
            Kind::Orthogonal(4) => with!(Orthogonal<4, f64>, bounds::OrthogonalRegion<4, $K>),
            Kind::Orthogonal(5) => with!(Orthogonal<5, f64>, bounds::OrthogonalRegion<5, $K>),
            Kind::Field(1, 1) => field!(1, 1),
            Kind::Field(2, 1) => field!(2, 1),
            Kind::Field(3, 1) => field!(3, 1),
            Kind::Field(4, 1) => field!(4, 1),
            Kind::Field(5, 1) => field!(5, 1),
            Kind::Field(6, 1) => field!(6, 1),
            Kind::Field(7, 1) => field!(7, 1),
            Kind::Field(8, 1) => field!(8, 1),
            Kind::Field(2, 2) => field!(2, 2),
            Kind::Field(2, 3) => field!(2, 3),
            Kind::Field(3, 2) => field!(3, 2),
            Kind::Field(3, 3) => field!(3, 3),
            _ => $other,
        }
    }};
}
pub(super) use of_kind;

impl Kind {
    /// How many coordinates; nothing where the group is not compiled.
    pub fn dimension(self) -> Option<usize> {
        of_kind!(self, G, R, K, Some(<G as Group<f64>>::DIMENSION), None)
    }

    /// How many parts these have.
    pub fn parts(self) -> usize {
        of_kind!(self, G, R, K, <G as Group<f64>>::PARTS, 1)
    }

    /// What a coordinate stands for.
    pub fn coordinate(self, index: usize) -> Option<Coordinate> {
        of_kind!(
            self,
            G,
            R,
            K,
            Some(<G as Group<f64>>::coordinate(index)),
            None
        )
    }

    /// The part that a coordinate belongs to.
    pub fn part_of(self, index: usize) -> usize {
        of_kind!(self, G, R, K, <G as Group<f64>>::part_of(index), 0)
    }

    /// Whether the coordinates of a part are pure numbers.
    pub fn is_pure(self, part: usize) -> bool {
        of_kind!(self, G, R, K, <G as Group<f64>>::is_pure(part), true)
    }

    /// The derivative of its chart, entry by entry.
    pub fn chart_tangent(
        self,
        radii: &[f64],
        first: usize,
        mut put: &mut dyn FnMut(usize, usize, Enclosure<VARIABLES>),
    ) {
        of_kind!(
            self,
            G,
            R,
            K,
            R::<VARIABLES>::chart_tangent(radii, first, &mut put),
            ()
        );
    }

    /// How many variables a region of it takes.
    pub fn variables(self) -> usize {
        of_kind!(self, G, R, K, <R<0> as Region<0>>::VARIABLES, 0)
    }
}

/// The groups of the velocities that are found together.
#[derive(Debug, PartialEq, Eq)]
pub struct Shape {
    /// One after the other.
    pub kinds: Vec<Kind>,
}

thread_local! {
    static AT_WORK: Cell<Option<&'static Shape>> = const { Cell::new(None) };
}

/// While it lives, its shape is the one at work in this thread.
pub struct AtWork {
    before: Option<&'static Shape>,
}

impl Drop for AtWork {
    fn drop(&mut self) {
        AT_WORK.set(self.before);
    }
}

impl Shape {
    /// Puts it to work.
    pub fn at_work(&'static self) -> AtWork {
        AtWork {
            before: AT_WORK.replace(Some(self)),
        }
    }

    /// How many coordinates all have together.
    pub fn dimension(&self) -> Option<usize> {
        self.kinds.iter().map(|k| k.dimension()).sum()
    }
}

/// The groups at work.
pub fn kinds() -> &'static [Kind] {
    AT_WORK.get().map_or(&[], |shape| shape.kinds.as_slice())
}

/// The factor to which a coordinate belongs, and its index there.
pub fn factor_of(index: usize) -> Option<(usize, Kind, usize)> {
    let mut rest = index;
    for (i, kind) in kinds().iter().enumerate() {
        let own = kind.dimension()?;
        if rest < own {
            return Some((i, *kind, rest));
        }
        rest -= own;
    }
    None
}

/// The factor to which a part belongs, and its index there.
pub fn factor_of_part(part: usize) -> Option<(Kind, usize)> {
    let mut rest = part;
    for kind in kinds() {
        if rest < kind.parts() {
            return Some((*kind, rest));
        }
        rest -= kind.parts();
    }
    None
}

/// The body for each number of coordinates that searches are compiled for.
macro_rules! of_dimension {
    ($n:expr, $D:ident, $body:expr) => {
        of_dimension!($n, $D, $body, 1 2 3 4 6 9)
    };
    ($n:expr, $D:ident, $body:expr, $($d:literal)*) => {
        match $n {
            $($d => {
                const $D: usize = $d;
                $body
            })*
            _ => None,
        }
    };
}
pub(super) use of_dimension;
