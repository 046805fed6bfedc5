//! Rigid motions as homogeneous matrices `[R x; 0 1]`, with one row more than the dimension of space: their blocks,
//! the elements of their Lie algebra, and zero-padding inclusions. Blocks of products are expressed by the blocks of
//! the factors, so that shown and emitted expressions use the dimension of the space itself.

use super::build::make;
use super::quaternion::rotation;
use super::shape::{Dim, Shape, Structure};
use super::symbol::Symbols;
use super::{
    Expr, Map, Node, Rational, add, dot, hat, identity, mul, neg, product, quotient, scale, sub,
    sum, transpose, unit, vee, zero,
};

const ONE: Dim = Dim::Fixed(1);
const TWO: Dim = Dim::Fixed(2);
const THREE: Dim = Dim::Fixed(3);

/// The dimension of the space with this many homogeneous coordinates, which is one less.
pub fn within(homogeneous: Dim) -> Dim {
    match homogeneous {
        Dim::Fixed(n) => Dim::Fixed(n.saturating_sub(1)),
        named @ Dim::Named(_) => named,
    }
}

/// The last of `n` axes.
pub fn last_axis(n: Dim) -> u8 {
    match n {
        Dim::Fixed(n) => u8::try_from(n.saturating_sub(1)).unwrap_or(u8::MAX),
        Dim::Named(_) => u8::MAX,
    }
}

/// The dimension `n` of the space whose twists have this many coordinates, `n (n + 1)/2`.
fn moved_by(coordinates: Dim) -> Dim {
    match coordinates {
        THREE => TWO,
        _ => THREE,
    }
}

/// The quarter turn of the plane, `(x, y) -> (-y, x)`, as a matrix.
pub fn quarter_turn(symbols: &Symbols) -> Expr {
    let (x, y) = (unit(TWO, 0), unit(TWO, 1));
    let dyad = |a: &Expr, b: &Expr| mul(a.clone(), transpose(symbols, b.clone()));
    sub(dyad(&y, &x), dyad(&x, &y))
}

/// The matrix that embeds a vector of length `cols` into one of length `rows`, starting at row `at`; the other
/// entries are zero.
pub fn inclusion(rows: Dim, cols: Dim, at: u8) -> Expr {
    let shape = Shape { rows, cols };
    make(Node::Inclusion(shape, at), shape)
}

/// Whether this is a letter of a group of rigid motions.
pub fn is_motion(symbols: &Symbols, e: &Expr) -> bool {
    match e.node() {
        Node::Letter(at) => symbols.get(at.symbol).structure == Structure::RigidMotion,
        _ => false,
    }
}

/// The element `[hat(ω) v; 0 0]` of the Lie algebra with coordinates `(ω, v)`. In the plane, `ω` is a number, and `ω`
/// times the quarter turn replaces `hat(ω)`.
pub fn twist(x: Expr) -> Expr {
    let shape = Shape::square(match moved_by(x.shape().rows) {
        TWO => THREE,
        _ => Dim::Fixed(4),
    });
    match x.node() {
        Node::Zero(_) => zero(shape),
        Node::Neg(y) => neg(twist(y.clone())),
        _ => make(Node::Map(Map::Twist, x), shape),
    }
}

/// An angular part stacked on a linear part.
pub fn stacked(angular: Expr, linear: Expr) -> Expr {
    let rows = |e: &Expr| match e.shape().rows {
        Dim::Fixed(n) => n,
        Dim::Named(_) => 0,
    };
    let (above, below) = (rows(&angular), rows(&linear));
    let whole = Dim::Fixed(above + below);
    let at = u8::try_from(above).unwrap_or(u8::MAX);
    add(put(whole, 0, angular), put(whole, at, linear))
}

/// A vector or scalar embedded in a longer vector, starting at row `at`.
fn put(whole: Dim, at: u8, part: Expr) -> Expr {
    match part.shape().is_scalar() {
        true => mul(part, unit(whole, at)),
        false => mul(inclusion(whole, part.shape().rows, at), part),
    }
}

/// `count` components of a longer vector, starting at row `at`; a single component is a scalar.
pub fn rows_of(symbols: &Symbols, x: &Expr, at: u8, count: Dim) -> Expr {
    let whole = x.shape().rows;
    match count {
        ONE => dot(unit(whole, at), x.clone()),
        _ => mul(transpose(symbols, inclusion(whole, count, at)), x.clone()),
    }
}

/// The first row and the number of rows of the angular and of the linear part, for an expression in such parts or a
/// vector of length six.
pub fn rows_in_parts(e: &Expr) -> Option<[(u8, Dim); 2]> {
    let whole = match e.shape() {
        s if s == Shape::vector(Dim::Fixed(6)) => return Some([(0, THREE), (3, THREE)]),
        Shape {
            rows: Dim::Fixed(n),
            cols: ONE,
        } => n,
        _ => return None,
    };
    match e.node() {
        Node::Sum(terms) => terms.iter().find_map(rows_in_parts),
        Node::Neg(a) | Node::Quotient(a, _) => rows_in_parts(a),
        Node::Product(factors) => match factors.iter().find(|f| !f.shape().is_scalar())?.node() {
            Node::Inclusion(shape, at) if *at > 0 => match shape.cols {
                Dim::Fixed(n) if u32::from(*at) + n == whole => {
                    let angles = Dim::Fixed(u32::from(*at));
                    Some([(0, angles), (*at, shape.cols)])
                }
                _ => None,
            },
            _ => None,
        },
        _ => None,
    }
}

/// Some components of an expression in such parts; terms in other components are omitted.
pub fn taken_rows(symbols: &Symbols, e: &Expr, row: u8, count: Dim) -> Expr {
    let taken = |x: &Expr| taken_rows(symbols, x, row, count);
    match e.node() {
        Node::Sum(terms) => sum(
            terms.iter().map(taken).collect::<Vec<_>>(),
            Shape::vector(count),
        ),
        Node::Neg(a) => neg(taken(a)),
        Node::Quotient(a, b) => quotient(taken(a), b.clone()),
        Node::Product(factors) => {
            let first = factors.iter().position(|f| !f.shape().is_scalar());
            let included = first.and_then(|i| match factors[i].node() {
                Node::Inclusion(_, at) | Node::Unit(_, at) => Some((i, *at)),
                _ => None,
            });
            match included {
                Some((_, at)) if at != row => zero(Shape::vector(count)),
                Some((i, _)) => {
                    let mut rest = factors.clone();
                    rest.remove(i);
                    product(rest)
                }
                None => rows_of(symbols, e, row, count),
            }
        }
        _ => rows_of(symbols, e, row, count),
    }
}

/// Three components of a vector of length six, starting at row `row`.
pub fn part_of_six(symbols: &Symbols, x: &Expr, row: u8) -> Expr {
    rows_of(symbols, x, row, THREE)
}

/// Blocks of a matrix whose last row is a multiple of `(0, 0, 0, 1)`.
struct Blocks {
    /// The upper left block.
    turn: Expr,
    /// The upper right block.
    shift: Expr,
    /// Whether the last entry is 1; otherwise it is 0.
    corner: bool,
}

/// The blocks of a matrix that is known to have such a last row.
fn blocks(symbols: &Symbols, e: &Expr) -> Option<Blocks> {
    let space = within(e.shape().rows);
    let translation = |x: &Expr| make(Node::Map(Map::Translation, x.clone()), Shape::vector(space));
    Some(match e.node() {
        Node::Identity(_) => Blocks {
            turn: identity(space),
            shift: zero(Shape::vector(space)),
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
        Node::Map(Map::Twist, x) if space == TWO => Blocks {
            turn: mul(rows_of(symbols, x, 0, ONE), quarter_turn(symbols)),
            shift: rows_of(symbols, x, 1, TWO),
            corner: false,
        },
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

/// A matrix without its last row and column: the rotation of a rigid motion.
pub fn block(symbols: &Symbols, a: &Expr) -> Expr {
    if let Some(all) = blocks(symbols, a) {
        return all.turn;
    }
    let whole = a.shape().rows;
    let space = within(whole);
    let shape = Shape::square(space);
    match a.node() {
        Node::Zero(_) => zero(shape),
        Node::Neg(x) => neg(block(symbols, x)),
        Node::Sum(terms) => sum(
            terms.iter().map(|t| block(symbols, t)).collect::<Vec<_>>(),
            shape,
        ),
        _ => {
            let first = inclusion(whole, space, 0);
            product([transpose(symbols, first.clone()), a.clone(), first])
        }
    }
}

/// The last column of a matrix without its last entry: the translation of a rigid motion.
pub fn column(symbols: &Symbols, a: &Expr) -> Expr {
    if let Some(all) = blocks(symbols, a) {
        return all.shift;
    }
    let whole = a.shape().rows;
    let space = within(whole);
    let shape = Shape::vector(space);
    match a.node() {
        Node::Zero(_) => zero(shape),
        Node::Neg(x) => neg(column(symbols, x)),
        Node::Sum(terms) => sum(
            terms.iter().map(|t| column(symbols, t)).collect::<Vec<_>>(),
            shape,
        ),
        _ => {
            let first = inclusion(whole, space, 0);
            let last = unit(whole, last_axis(whole));
            product([transpose(symbols, first), a.clone(), last])
        }
    }
}

/// The number of homogeneous coordinates, which is one more than the dimension.
fn homogeneous(space: Dim) -> Dim {
    match space {
        Dim::Fixed(n) => Dim::Fixed(n + 1),
        named @ Dim::Named(_) => named,
    }
}

/// The homogeneous matrix with `a` as its upper left block and zeros elsewhere: the adjoint of [`block`].
pub(super) fn in_block(symbols: &Symbols, a: Expr) -> Expr {
    let space = a.shape().rows;
    let first = inclusion(homogeneous(space), space, 0);
    product([first.clone(), a, transpose(symbols, first)])
}

/// The homogeneous matrix with `v` as its upper right column and zeros elsewhere: the adjoint of [`column`].
pub(super) fn in_column(symbols: &Symbols, v: Expr) -> Expr {
    let space = v.shape().rows;
    let whole = homogeneous(space);
    let last = transpose(symbols, unit(whole, last_axis(whole)));
    product([inclusion(whole, space, 0), v, last])
}

/// The coordinates `(ω, v)` of the pairing of a matrix `S` with the Lie algebra: `<S, twist(x)>` is the scalar
/// product with `x`.
pub fn paired_with_twists(symbols: &Symbols, s: &Expr) -> Expr {
    let turn = block(symbols, s);
    let angular = match turn.shape().rows {
        TWO => {
            let entry = |i: u8, j: u8| dot(unit(TWO, i), mul(turn.clone(), unit(TWO, j)));
            sub(entry(1, 0), entry(0, 1))
        }
        _ => scale(Rational::integer(2), vee(turn)),
    };
    stacked(angular, column(symbols, s))
}
