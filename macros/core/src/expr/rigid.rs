//! Rigid motions as 4 x 4 homogeneous matrices `[R x; 0 1]`: their blocks, the elements of their Lie
//! algebra, and vectors inside longer ones. Blocks of products are written by those of the factors,
//! so that what is shown and emitted is of three dimensions.

use super::build::make;
use super::quaternion::rotation;
use super::shape::{Dim, Shape, Structure};
use super::symbol::Symbols;
use super::{Expr, Map, Node, add, hat, identity, mul, neg, product, sum, transpose, unit, zero};

const THREE: Dim = Dim::Fixed(3);
const FOUR: Dim = Dim::Fixed(4);
const SIX: Dim = Dim::Fixed(6);

/// The matrix that puts a vector of length `cols` into one of length `rows`, from row `at` on; the
/// other entries are zero.
pub fn inclusion(rows: Dim, cols: Dim, at: u8) -> Expr {
    let shape = Shape { rows, cols };
    make(Node::Inclusion(shape, at), shape)
}

/// Whether this is a letter of SE(3).
pub fn is_motion(symbols: &Symbols, e: &Expr) -> bool {
    match e.node() {
        Node::Letter(at) => symbols.get(at.symbol).structure == Structure::RigidMotion,
        _ => false,
    }
}

/// The element `[hat(ω) v; 0 0]` of the Lie algebra of SE(3) with coordinates `(ω, v)`.
pub fn twist(x: Expr) -> Expr {
    let shape = Shape::square(FOUR);
    match x.node() {
        Node::Zero(_) => zero(shape),
        Node::Neg(y) => neg(twist(y.clone())),
        _ => make(Node::Map(Map::Twist, x), shape),
    }
}

/// An angular and a linear vector on top of each other.
pub fn stacked(angular: Expr, linear: Expr) -> Expr {
    let at = |row| inclusion(SIX, THREE, row);
    add(mul(at(0), angular), mul(at(3), linear))
}

/// Three components of a vector of six, from this row on.
pub fn part_of_six(symbols: &Symbols, x: &Expr, row: u8) -> Expr {
    mul(transpose(symbols, inclusion(SIX, THREE, row)), x.clone())
}

/// Blocks of a matrix whose last row is a multiple of `(0, 0, 0, 1)`.
struct Blocks {
    /// The upper left one.
    turn: Expr,
    /// The upper right one.
    shift: Expr,
    /// Whether the last entry is 1; otherwise it is 0.
    corner: bool,
}

/// The blocks of a matrix that is known to have such a last row.
fn blocks(symbols: &Symbols, e: &Expr) -> Option<Blocks> {
    let translation = |x: &Expr| make(Node::Map(Map::Translation, x.clone()), Shape::vector(THREE));
    Some(match e.node() {
        Node::Identity(_) => Blocks {
            turn: identity(THREE),
            shift: zero(Shape::vector(THREE)),
            corner: true,
        },
        Node::Letter(_) if is_motion(symbols, e) => Blocks {
            turn: rotation(symbols, e.clone()),
            shift: translation(e),
            corner: true,
        },
        Node::Inverse(x) if is_motion(symbols, x) => {
            let back = transpose(symbols, rotation(symbols, x.clone()));
            Blocks {
                shift: neg(mul(back.clone(), translation(x))),
                turn: back,
                corner: true,
            }
        }
        Node::Map(Map::Twist, x) => Blocks {
            turn: hat(part_of_six(symbols, x, 0)),
            shift: part_of_six(symbols, x, 3),
            corner: false,
        },
        Node::Product(factors) => {
            let mut factors = factors.iter().rev();
            let mut all = blocks(symbols, factors.next()?)?;
            for f in factors {
                let left = blocks(symbols, f)?;
                let moved = mul(left.turn.clone(), all.shift);
                all = Blocks {
                    shift: if all.corner {
                        add(moved, left.shift)
                    } else {
                        moved
                    },
                    turn: mul(left.turn, all.turn),
                    corner: left.corner && all.corner,
                };
            }
            all
        }
        _ => return None,
    })
}

/// The upper left 3 x 3 block of a 4 x 4 matrix: the rotation of a rigid motion.
pub fn block(symbols: &Symbols, a: &Expr) -> Expr {
    if let Some(all) = blocks(symbols, a) {
        return all.turn;
    }
    let shape = Shape::square(THREE);
    match a.node() {
        Node::Zero(_) => zero(shape),
        Node::Neg(x) => neg(block(symbols, x)),
        Node::Sum(terms) => sum(
            terms.iter().map(|t| block(symbols, t)).collect::<Vec<_>>(),
            shape,
        ),
        _ => {
            let first = inclusion(FOUR, THREE, 0);
            product([transpose(symbols, first.clone()), a.clone(), first])
        }
    }
}

/// The first three entries of the last column of a 4 x 4 matrix: the translation of a rigid motion.
pub fn column(symbols: &Symbols, a: &Expr) -> Expr {
    if let Some(all) = blocks(symbols, a) {
        return all.shift;
    }
    let shape = Shape::vector(THREE);
    match a.node() {
        Node::Zero(_) => zero(shape),
        Node::Neg(x) => neg(column(symbols, x)),
        Node::Sum(terms) => sum(
            terms.iter().map(|t| column(symbols, t)).collect::<Vec<_>>(),
            shape,
        ),
        _ => {
            let first = inclusion(FOUR, THREE, 0);
            product([transpose(symbols, first), a.clone(), unit(FOUR, 3)])
        }
    }
}

/// The 4 x 4 matrix with a 3 x 3 block upper left and zeros elsewhere: the adjoint of [`block`].
pub(super) fn in_block(symbols: &Symbols, a: Expr) -> Expr {
    let first = inclusion(FOUR, THREE, 0);
    product([first.clone(), a, transpose(symbols, first)])
}

/// The 4 x 4 matrix with a vector upper right and zeros elsewhere: the adjoint of [`column`].
pub(super) fn in_column(symbols: &Symbols, v: Expr) -> Expr {
    let last = transpose(symbols, unit(FOUR, 3));
    product([inclusion(FOUR, THREE, 0), v, last])
}
