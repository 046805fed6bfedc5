//! Expressions as the user wrote them: a closed, shaped, immutable tree. Decisions use normal forms
//! ([`crate::algebra`]); printed and emitted code uses these trees.

mod build;
mod collect;
mod constant;
mod determinant;
mod diagonal;
mod directional;
mod display_form;
mod factored;
mod factored_inverse;
mod function;
pub(crate) mod functional;
mod gradient;
mod hashed;
mod letter_mask;
mod magnitude;
#[cfg(test)]
mod magnitude_tests;
pub(crate) mod position_differences;
mod projection;
mod quaternion;
mod quaternion_components;
pub(crate) mod range;
mod rigid;
pub mod shape;
mod simpler;
pub(crate) mod spelling;
mod substitute;
pub mod symbol;
mod terms;
#[cfg(test)]
mod tests;
mod turned;

use crate::algebra::Rational;
use shape::{Dim, Shape};
use std::sync::Arc;
use symbol::SymbolId;

pub use build::*;
pub(crate) use collect::parts;
pub use collect::{coefficient, collect, positive_first, term_by_term};
pub use constant::Constant;
pub use determinant::{adjugate, adjugate_polynomial, det, with_plain_determinants};
pub use diagonal::{diagonal, diagonal_of};
pub use directional::directional;
pub use display_form::{power_of_length, shown};
pub use factored::{axial_of_outer, factored};
pub use factored_inverse::InvertedFactor;
pub use function::{Function, Parity};
pub use functional::{
    Applied, BY_CASE, Functional, FunctionalId, Kind, Reach, derived, given, pull_back,
};
pub(crate) use functional::{kind, pairing};
pub use gradient::gradient;
pub(crate) use hashed::{Exprs, Hashed};
pub(crate) use letter_mask::{may_contain, may_hold};
pub(crate) use magnitude::{lengths_of_differences, magnitude, magnitude_by_differences};
pub use projection::projected;
pub use quaternion::{imaginary, pure, real, rotation};
pub use quaternion_components::quaternion_components;
pub use rigid::{
    block, column, inclusion, is_motion, last_axis, paired_with_twists, part_of_six, quarter_turn,
    rows_in_parts, rows_of, stacked, taken_rows, twist, within,
};
pub use simpler::simpler;
pub use substitute::{
    contains, contains_role, letters, rebuild, shift_time, substitute, with_children,
};
pub use terms::{Change, changes};
pub use turned::turned;

/// Offset of a letter from the node or edge of an equation, in time and along the labels.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug, Default)]
pub struct Shift {
    /// Time levels: `+1` is `next(x)`, `-1` the level before.
    pub time: i8,
    /// Label offsets, for rods and particles.
    pub label: [i8; 2],
}

impl Shift {
    /// No offset.
    pub const HERE: Shift = Shift {
        time: 0,
        label: [0, 0],
    };
    /// One time level later.
    pub const NEXT: Shift = Shift {
        time: 1,
        label: [0, 0],
    };
    /// One time level earlier.
    pub const PREVIOUS: Shift = Shift {
        time: -1,
        label: [0, 0],
    };
}

/// A symbol at an offset.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Letter {
    /// The symbol.
    pub symbol: SymbolId,
    /// Where it is taken.
    pub shift: Shift,
}

/// Parts of a square matrix, linear in it.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Part {
    /// `(A + A^T)/2`.
    Symmetric,
    /// `(A - A^T)/2`.
    Skew,
    /// The diagonal, as a matrix.
    Diagonal,
}

/// Maps of quaternions as 4 x 4 matrices of left multiplication, maps of rigid motions as homogeneous matrices, and
/// maps between vectors and diagonals.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Map {
    /// The real part, `tr(A)/4`.
    Real,
    /// The imaginary part: the vector `v` for which `pure(v)` is nearest to `A`.
    Imaginary,
    /// The left multiplication by a vector, taken as a quaternion without real part.
    Pure,
    /// The rotation of a letter: the rotation that a quaternion covers, or the block of a rigid motion.
    Rotation,
    /// The translation of a rigid motion, which is a letter.
    Translation,
    /// The element `[hat(ω) v; 0 0]` of the Lie algebra of rigid motions, for a vector `(ω, v)`.
    Twist,
    /// The matrix with a vector on its diagonal and zeros elsewhere.
    Diagonal,
    /// The diagonal of a square matrix, as a vector.
    DiagonalOf,
}

/// One node of an expression. Shapes of children are checked by the constructors in `build`.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Node {
    /// An exact number.
    Number(Rational),
    /// A constant that exact arithmetic does not represent.
    Constant(Constant),
    /// A symbol at an offset.
    Letter(Letter),
    /// The identity matrix.
    Identity(Dim),
    /// Zero of a shape.
    Zero(Shape),
    /// The unit vector along an axis (counted from 0).
    Unit(Dim, u8),
    /// The zero-padding inclusion of the given shape: the identity from this row on, zero elsewhere.
    Inclusion(Shape, u8),
    /// A sum of terms of equal shape.
    Sum(Vec<Expr>),
    /// The negative.
    Neg(Expr),
    /// A product: scalars first, then matrices in order.
    Product(Vec<Expr>),
    /// A quotient by a scalar.
    Quotient(Expr, Expr),
    /// A rational power of a scalar.
    Power(Expr, Rational),
    /// The transpose.
    Transpose(Expr),
    /// The inverse of a square matrix.
    Inverse(Expr),
    /// The trace of a square matrix.
    Trace(Expr),
    /// The determinant of a square matrix.
    Det(Expr),
    /// The adjugate of a 2x2 or 3x3 matrix: `det(A) A^-1`, defined for every `A`.
    Adjugate(Expr),
    /// The scalar product of two vectors.
    Dot(Expr, Expr),
    /// The vector product in three dimensions.
    Cross(Expr, Expr),
    /// The skew matrix of a vector: `hat(v) w = v x w`.
    Hat(Expr),
    /// The axial vector of the skew part of a 3 x 3 matrix; on skew matrices, the inverse of `hat`.
    Vee(Expr),
    /// A linear part of a square matrix.
    Part(Part, Expr),
    /// A function of a scalar.
    Call(Function, Expr),
    /// A map of quaternions, rigid motions or diagonals.
    Map(Map, Expr),
    /// The value of a functional, differentiated along some of its arguments.
    Given(Applied),
    /// The transposed derivative of a functional with respect to one argument, applied to a seed.
    PullBack(Applied, u8, Expr),
}

/// An expression with its shape; clones share the tree.
#[derive(Clone)]
pub struct Expr(Arc<Inner>);

struct Inner {
    node: Node,
    shape: Shape,
    size: u32,
    hash: u64,
    marks: letter_mask::Marks,
}

impl Expr {
    /// The node at the root.
    pub fn node(&self) -> &Node {
        &self.0.node
    }

    /// The shape.
    pub fn shape(&self) -> Shape {
        self.0.shape
    }

    /// The number of nodes of the tree, saturating, which is the cost of a walk.
    pub fn size(&self) -> u32 {
        self.0.size
    }

    /// Whether this is the zero of its shape.
    pub fn is_zero(&self) -> bool {
        match self.node() {
            Node::Number(q) => q.is_zero(),
            Node::Zero(_) => true,
            _ => false,
        }
    }

    /// Children in order.
    pub fn children(&self) -> Vec<&Expr> {
        self.node().children()
    }
}

impl Node {
    /// Children in order.
    pub fn children(&self) -> Vec<&Expr> {
        let mut out = Vec::new();
        self.each_child(&mut |c| out.push(c));
        out
    }

    /// Visits the children in order.
    pub fn each_child<'a>(&'a self, visit: &mut dyn FnMut(&'a Expr)) {
        match self {
            Node::Number(_)
            | Node::Constant(_)
            | Node::Letter(_)
            | Node::Identity(_)
            | Node::Zero(_)
            | Node::Unit(..)
            | Node::Inclusion(..) => {}
            Node::Sum(list) | Node::Product(list) => list.iter().for_each(visit),
            Node::Neg(a)
            | Node::Power(a, _)
            | Node::Transpose(a)
            | Node::Inverse(a)
            | Node::Trace(a)
            | Node::Det(a)
            | Node::Adjugate(a)
            | Node::Hat(a)
            | Node::Vee(a)
            | Node::Part(_, a)
            | Node::Call(_, a)
            | Node::Map(_, a) => visit(a),
            Node::Quotient(a, b) | Node::Dot(a, b) | Node::Cross(a, b) => {
                visit(a);
                visit(b);
            }
            Node::Given(a) => a.each_child(visit),
            Node::PullBack(a, _, seed) => {
                a.each_child(visit);
                visit(seed);
            }
        }
    }
}

impl PartialEq for Expr {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
            || (self.0.hash == other.0.hash && self.0.node == other.0.node)
    }
}

impl Eq for Expr {}

impl core::hash::Hash for Expr {
    fn hash<H: core::hash::Hasher>(&self, state: &mut H) {
        state.write_u64(self.0.hash);
    }
}

impl core::fmt::Debug for Expr {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        self.node().fmt(f)
    }
}
