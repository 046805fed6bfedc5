//! Quaternions as 4 x 4 matrices: the constructors of the maps between quaternions and scalars, vectors and
//! rotations. The matrix of a quaternion `w + v` is its left multiplication `p -> (w + v) p` on `(1, i, j, k)`.
//! Products of quaternions are then products of matrices, and the conjugate is the transpose.

use super::build::make;
use super::rigid::within;
use super::shape::{Dim, Shape};
use super::symbol::Symbols;
use super::{Expr, Map, Node, Rational, identity, integer, neg, product, scale, transpose, zero};

const THREE: Dim = Dim::Fixed(3);
const FOUR: Dim = Dim::Fixed(4);

/// The real part of a 4 x 4 matrix, `tr(A)/4`.
pub fn real(a: Expr) -> Expr {
    match a.node() {
        Node::Identity(_) => integer(1),
        Node::Zero(_) | Node::Map(Map::Pure, _) => integer(0),
        Node::Neg(x) => neg(real(x.clone())),
        _ => make(Node::Map(Map::Real, a), Shape::SCALAR),
    }
}

/// The imaginary part of a 4 x 4 matrix, a vector of length 3: the coefficients of its projection
/// on the three imaginary units.
pub fn imaginary(a: Expr) -> Expr {
    let shape = Shape::vector(THREE);
    match a.node() {
        Node::Identity(_) | Node::Zero(_) => zero(shape),
        Node::Map(Map::Pure, v) => v.clone(),
        Node::Neg(x) => neg(imaginary(x.clone())),
        _ => make(Node::Map(Map::Imaginary, a), shape),
    }
}

/// The left multiplication by a vector of length 3 without real part, a skew 4 x 4 matrix.
pub fn pure(v: Expr) -> Expr {
    let shape = Shape::square(FOUR);
    match v.node() {
        Node::Zero(_) => zero(shape),
        Node::Neg(x) => neg(pure(x.clone())),
        _ => make(Node::Map(Map::Pure, v), shape),
    }
}

/// The rotation of a product of quaternions or rigid motions, as the product of their rotations.
pub fn rotation(symbols: &Symbols, a: Expr) -> Expr {
    let of = |x: &Expr| rotation(symbols, x.clone());
    // Quaternions and homogeneous matrices both have one row more than the dimension of space.
    let space = within(a.shape().rows);
    match a.node() {
        Node::Identity(_) => identity(space),
        // q and -q cover the same rotation.
        Node::Neg(x) => of(x),
        Node::Product(factors) => product(factors.iter().map(of).collect::<Vec<_>>()),
        Node::Transpose(x) | Node::Inverse(x) => transpose(symbols, of(x)),
        _ => make(Node::Map(Map::Rotation, a), Shape::square(space)),
    }
}

/// `2 im(A)` for a change `δW` of a letter `W`: with `A = W^T δW`, the vector of the change of the rotation, `δR = R
/// hat(2 im(W^T δW))`.
pub(super) fn angular(symbols: &Symbols, letter: &Expr, change: Expr) -> Expr {
    let back = transpose(symbols, letter.clone());
    scale(Rational::integer(2), imaginary(product([back, change])))
}
