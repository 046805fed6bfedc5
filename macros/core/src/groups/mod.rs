//! The table of groups: one record per file, with all properties of a group that the engine uses. Takes sizes only;
//! gives shapes of letters, the Lie algebra and its dual, the transformations of both, and their names in text. To
//! add a group, add its file and its line in [`Group`].

mod additive;
mod euclidean;
mod general_linear;
mod plane_motions;
mod rigid_motions;
mod special_orthogonal;
#[cfg(test)]
mod tests;
mod unit_quaternions;

pub use additive::Additive;
pub use euclidean::Euclidean;
pub use general_linear::GeneralLinear;
pub use plane_motions::PlaneMotions;
pub use rigid_motions::RigidMotions;
pub use special_orthogonal::SpecialOrthogonal;
pub use unit_quaternions::UnitQuaternions;

use crate::algebra::Rational;
use crate::check::spec::Side;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr};
use std::ops::Deref;

/// The size of three-dimensional space.
pub const THREE: Dim = Dim::Fixed(3);

/// The size of an angular and a linear part in space.
pub const SIX: Dim = Dim::Fixed(6);

/// A group of the table, of one size.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Group {
    /// Rotations, SO(n).
    SpecialOrthogonal(SpecialOrthogonal),
    /// Invertible matrices, GL(n).
    GeneralLinear(GeneralLinear),
    /// Unit quaternions, SU(2), as 4 x 4 matrices of left multiplication.
    UnitQuaternions(UnitQuaternions),
    /// Rigid motions of the plane, SE(2), as 3 x 3 homogeneous matrices.
    PlaneMotions(PlaneMotions),
    /// Rigid motions of space, SE(3), as 4 x 4 homogeneous matrices.
    RigidMotions(RigidMotions),
    /// Numbers, vectors or matrices under addition: fields.
    Additive(Additive),
}

impl Deref for Group {
    type Target = dyn Record;

    fn deref(&self) -> &(dyn Record + 'static) {
        match self {
            Group::SpecialOrthogonal(record) => record,
            Group::GeneralLinear(record) => record,
            Group::UnitQuaternions(record) => record,
            Group::PlaneMotions(record) => record,
            Group::RigidMotions(record) => record,
            Group::Additive(record) => record,
        }
    }
}

/// A line of the table of groups.
pub struct Line {
    /// The name of its family.
    pub family: &'static str,
    /// Its size, if it has a single size.
    pub size: Option<u32>,
    /// The group of a size.
    pub group: fn(Dim) -> Group,
}

impl Line {
    const fn any(family: &'static str, group: fn(Dim) -> Group) -> Line {
        Line {
            family,
            size: None,
            group,
        }
    }

    const fn only(family: &'static str, size: u32, group: fn(Dim) -> Group) -> Line {
        Line {
            family,
            size: Some(size),
            group,
        }
    }

    fn holds(&self, n: Dim) -> bool {
        self.size.is_none_or(|size| n == Dim::Fixed(size))
    }

    /// The group in the syntax of a model, with `n` for any size.
    fn stated(&self) -> String {
        let size = self.size.map_or("n".to_owned(), |n| n.to_string());
        format!("{}<{size}>", self.family)
    }
}

/// The groups that models state by name.
pub const TABLE: [Line; 5] = [
    Line::any("SO", Group::rotations),
    Line::any("GL", |n| Group::GeneralLinear(GeneralLinear(n))),
    Line::only("SU", 2, |_| Group::UnitQuaternions(UnitQuaternions)),
    Line::only("SE", 2, |_| Group::PlaneMotions(PlaneMotions)),
    Line::only("SE", 3, |_| Group::RigidMotions(RigidMotions)),
];

/// The group of a family and a size.
pub fn named(family: &str, n: Dim) -> Option<Group> {
    let mut lines = TABLE.iter();
    let found = lines.find(|line| line.family == family && line.holds(n))?;
    Some((found.group)(n))
}

/// The families, without repetition.
pub fn families() -> impl Iterator<Item = &'static str> {
    let first = |i: &usize| TABLE.iter().position(|l| l.family == TABLE[*i].family) == Some(*i);
    (0..TABLE.len()).filter(first).map(|i| TABLE[i].family)
}

/// Whether a family supports only some sizes.
pub fn has_few_sizes(family: &str) -> bool {
    let mut lines = TABLE.iter();
    lines.any(|line| line.family == family && line.size.is_some())
}

/// Groups of the table in the syntax of a model, with `last` before the last one: `SO<n>, GL<n> and SU<2>`.
pub fn listed(last: &str, which: impl Fn(&str, Group) -> bool) -> String {
    let lines = TABLE.iter().filter(|line| {
        let n = Dim::Fixed(line.size.unwrap_or(3));
        which(line.family, (line.group)(n))
    });
    let mut all: Vec<String> = lines.map(Line::stated).collect();
    match (all.pop(), all.is_empty()) {
        (Some(only), true) => only,
        (Some(end), false) => format!("{} {last} {end}", all.join(", ")),
        (None, _) => String::new(),
    }
}

/// The group whose elements have this structure and shape.
pub fn of_elements(structure: Structure, shape: Shape) -> Option<Group> {
    let groups = families_in(shape).chain(TABLE.iter().filter_map(|line| {
        let n = Dim::Fixed(line.size?);
        Some((line.group)(n))
    }));
    groups
        .into_iter()
        .find(|g| g.structure() == structure && g.shape() == shape)
}

/// The groups of any size, at the size of a shape.
fn families_in(shape: Shape) -> impl Iterator<Item = Group> {
    let lines = TABLE.iter().filter(|line| line.size.is_none());
    lines.map(move |line| (line.group)(shape.rows))
}

impl Group {
    /// Rotations in n dimensions.
    pub fn rotations(n: Dim) -> Group {
        Group::SpecialOrthogonal(SpecialOrthogonal(n))
    }

    /// Whether its Lie algebra consists of the skew matrices.
    pub fn is_orthogonal(self) -> bool {
        matches!(self, Group::SpecialOrthogonal(_))
    }

    /// Whether it is SO(3).
    pub fn is_of_space(self) -> bool {
        self == Group::rotations(THREE)
    }

    /// Whether it is additive: its elements rotate nothing, and all frames are equal.
    pub fn is_additive(self) -> bool {
        matches!(self, Group::Additive(_))
    }

    /// Whether its elements are unit quaternions.
    pub fn is_quaternionic(self) -> bool {
        matches!(self, Group::UnitQuaternions(_))
    }

    /// Whether it consists of all invertible matrices.
    pub fn is_linear(self) -> bool {
        matches!(self, Group::GeneralLinear(_))
    }
}

/// How the runtime stores the elements of a group.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ElementStorage {
    /// Rotations of space, by unit quaternions; covectors are vectors.
    Rotation,
    /// Orthogonal matrices; covectors are skew matrices.
    Orthogonal(Dim),
    /// Invertible matrices; covectors are matrices.
    Linear(Dim),
    /// Unit quaternions; covectors are vectors.
    Quaternion,
    /// A type of the group's own; covectors are vectors of coordinates.
    Coordinates(Names),
    /// Numbers, vectors or matrices under addition; covectors have the same shape.
    Field(Shape),
}

/// The coordinates in which loops over sites store elements of groups that they do not support directly.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Chart {
    /// The entries of a matrix with this number of rows.
    Entries(u32),
    /// An angle.
    Angle,
    /// An angle and a position in the plane.
    AngleAndPlace,
    /// A rotation of space and a position.
    TurnAndPlace,
}

/// The names in the runtime of a group whose Lie algebra has coordinates: its types and functions.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Names {
    /// The type of elements.
    pub element: &'static str,
    /// The type of momenta, after the name of the frame.
    pub momentum: &'static str,
    /// The number of coordinates of the Lie algebra.
    pub coordinates: u32,
    /// The kind of an element in case files.
    pub kind: &'static str,
    /// A description of an element.
    pub words: &'static str,
}

/// An element of a basis of a Lie algebra: its nonzero entries (row, column, value).
pub type Element = Vec<(usize, usize, i64)>;

/// The values of the sizes.
pub type Sizes<'a> = dyn Fn(Dim) -> usize + 'a;

/// The properties of a group that the engine uses. Letters of variation `ξ` are elements of the Lie algebra as
/// matrices, or their coordinates. Covectors (momenta) have the form of [`Record::dual`].
pub trait Record {
    /// The shape of its elements, and of velocities.
    fn shape(&self) -> Shape;

    /// The structure of its elements.
    fn structure(&self) -> Structure;

    /// The number of coordinates of its Lie algebra, if its letters of variation are coordinates.
    fn coordinates(&self) -> Option<Dim> {
        None
    }

    /// Shape and structure of the letters of variation.
    fn variation(&self) -> (Shape, Structure);

    /// Shape and structure of covectors, and of velocities in continuous time.
    fn dual(&self) -> (Shape, Structure) {
        self.variation()
    }

    /// A basis of the Lie algebra in the order of the momentum's coordinates, as letters of
    /// variation.
    fn basis(&self, size: &Sizes) -> Vec<Element>;

    /// The matrix of the Lie algebra for a letter of variation.
    fn element(&self, x: Expr) -> Expr {
        x
    }

    /// The letter of variation for a velocity in continuous time.
    fn rate(&self, zeta: Expr) -> Expr {
        zeta
    }

    /// The covector of a matrix `Y` on the Lie algebra, `ξ -> <Y, ξ>`: the dual of the inclusion.
    fn covector(&self, s: &Symbols, y: Expr) -> Expr;

    /// The covector of `Y` as an element of the Lie algebra, as the thesis writes its momenta.
    fn as_algebra(&self, s: &Symbols, y: Expr) -> Expr {
        self.covector(s, y)
    }

    /// The covector of the gradient of a scalar that is linear in the letter of variation.
    fn of_gradient(&self, _: &Symbols, y: Expr) -> Expr {
        y
    }

    /// The covector of the gradient with respect to a velocity in continuous time.
    fn of_rate_gradient(&self, _: &Symbols, y: Expr) -> Expr {
        y
    }

    /// The pairing of a covector with a letter of variation.
    fn pairing(&self, s: &Symbols, covector: Expr, xi: Expr) -> Expr;

    /// `Ad*` of the inverse of `g`: a body covector in the frame of space.
    fn to_space(&self, s: &Symbols, g: &Expr, covector: Expr) -> Expr;

    /// `<μ, [ξ, η]>`.
    fn bracket(&self, s: &Symbols, mu: Expr, xi: Expr, eta: Expr) -> Expr;

    /// `ad*_ζ μ`, with `<ad*_ζ μ, ξ> = <μ, [ζ, ξ]>`.
    fn coadjoint(&self, s: &Symbols, mu: Expr, zeta: Expr) -> Expr;

    /// `-ad*_ζ μ`.
    fn coadjoint_in_space(&self, s: &Symbols, mu: Expr, zeta: Expr) -> Expr {
        expr::scale(Rational::MINUS_ONE, self.coadjoint(s, mu, zeta))
    }

    /// The neutral element.
    fn identity(&self) -> Expr {
        expr::identity(self.shape().rows)
    }

    /// The product of two elements.
    fn compose(&self, a: Expr, b: Expr) -> Expr {
        expr::mul(a, b)
    }

    /// The inverse of an element.
    fn inverse(&self, s: &Symbols, a: Expr) -> Expr {
        expr::inverse(s, a)
    }

    /// The change of an element along a matrix of the Lie algebra: `g ξ` (body) or `ξ g` (spatial).
    fn moved(&self, side: Side, g: Expr, xi: Expr) -> Expr {
        side.product(g, xi)
    }

    /// Twice the second-order term of `exp(ξ)`.
    fn second(&self, xi: Expr) -> Expr {
        expr::mul(xi.clone(), xi)
    }

    /// A gradient with respect to an element, transformed to the identity: `g^T Y` (body) or `Y g^T`.
    fn pulled_back(&self, s: &Symbols, side: Side, g: Expr, y: Expr) -> Expr {
        let t = expr::transpose(s, g);
        side.product(t, y)
    }

    /// The weight of the pairing of an element with its multiplier: with weight ½, the momentum map of SO(n) is
    /// `skew(Λ^T P)` (thesis 2.75); with weight 1, the momentum map of GL(n) is `Q^T P` (3.25).
    fn weight(&self) -> Rational {
        Rational::ONE
    }

    /// Whether the Lie algebra is a proper subspace of the matrices that represent the elements. A relation for a
    /// velocity then holds up to the multiplier of the group.
    fn has_normal(&self) -> bool {
        true
    }

    /// The rotation of space by an element, if it has one.
    fn turn(&self, _: &Symbols, _: &Expr) -> Option<Expr> {
        None
    }

    /// How the runtime stores its elements.
    fn kept(&self) -> ElementStorage;

    /// The coordinates in which loops over sites store an element, if they do not support the group directly.
    fn chart(&self) -> Option<Chart> {
        None
    }

    /// The group as a group of rigid motions, if it is one.
    fn rigid(&self) -> Option<&dyn Euclidean> {
        None
    }

    /// The position of an element, if elements of the group have one: its stored components are rounded to its distance
    /// from the origin.
    fn place(&self, s: &Symbols, g: &Expr) -> Option<Expr> {
        self.rigid().map(|_| expr::column(s, g))
    }

    /// Whether elements preserve lengths and do not change positions. A spatial equation then costs no more than one
    /// in the body.
    fn is_isometric(&self) -> bool {
        self.structure().is_orthogonal()
    }

    /// Whether its elements are rotations only, so that a momentum is an angular momentum.
    fn only_turns(&self) -> bool {
        self.structure().is_orthogonal()
    }

    /// A description of a letter of variation: as plain text, and typeset.
    fn variation_words(&self) -> [String; 2];

    /// A description of the elements as symmetries of space.
    fn motions_words(&self) -> &'static str {
        "rotations of space"
    }

    /// The group in the syntax of a model, `SO<3>`; `size` names the sizes.
    fn statement(&self, size: &dyn Fn(Dim) -> String) -> String;

    /// The group in the notation of a paper, `SO(3)`; for a field, the set of its values.
    fn name(&self, size: &dyn Fn(Dim) -> String) -> String;

    /// An example of a kinetic term of a model that is stated by `next`.
    fn kinetic_example(&self, element: &str) -> String;
}

impl dyn Record {
    /// The number of rows of its elements.
    pub fn size(&self) -> Dim {
        self.shape().rows
    }

    /// The velocity from one node to the next: `g^-1 g'` (body) or `g' g^-1` (spatial).
    pub fn velocity(&self, s: &Symbols, side: Side, g: Expr, next: Expr) -> Expr {
        let back = self.inverse(s, g);
        let (first, second) = side.ordered(back, next);
        self.compose(first, second)
    }

    /// The element at the end of an edge: `g w` (body) or `w g` (spatial).
    pub fn advanced(&self, side: Side, g: Expr, w: Expr) -> Expr {
        let (first, second) = side.ordered(g, w);
        self.compose(first, second)
    }
}

/// Matrix units of a shape, row by row.
pub(crate) fn entries(shape: Shape, size: &Sizes) -> Vec<Element> {
    let (rows, cols) = (size(shape.rows), size(shape.cols));
    let all = 0..rows * cols;
    all.map(|k| vec![(k / cols, k % cols, 1)]).collect()
}
