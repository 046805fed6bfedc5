//! Maps between vectors and diagonals of matrices: the matrix with a given diagonal, and the diagonal of a matrix as
//! a vector. Each is the adjoint of the other.

use super::build::make;
use super::shape::Shape;
use super::{Expr, Map, Node, Part, neg, part, zero};

/// The matrix with this vector on its diagonal and zeros elsewhere.
pub fn diagonal(v: Expr) -> Expr {
    let shape = Shape::square(v.shape().rows);
    match v.node() {
        Node::Zero(_) => zero(shape),
        Node::Neg(x) => neg(diagonal(x.clone())),
        Node::Map(Map::DiagonalOf, a) => part(Part::Diagonal, a.clone()),
        _ => make(Node::Map(Map::Diagonal, v), shape),
    }
}

/// The diagonal of a square matrix as a vector.
pub fn diagonal_of(a: Expr) -> Expr {
    let shape = Shape::vector(a.shape().rows);
    match a.node() {
        Node::Zero(_) | Node::Hat(_) => zero(shape),
        Node::Neg(x) => neg(diagonal_of(x.clone())),
        Node::Map(Map::Diagonal, v) => v.clone(),
        Node::Part(Part::Diagonal | Part::Symmetric, x) | Node::Transpose(x) => {
            diagonal_of(x.clone())
        }
        _ => make(Node::Map(Map::DiagonalOf, a), shape),
    }
}
