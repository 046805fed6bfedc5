//! Recognises how a derivation writes vectors and matrices of rigid motions: inclusions into longer vectors, their
//! transposes, unit vectors and blocks.

use super::names::Kind;
use crate::expr::shape::Dim;
use crate::expr::{self, Expr, Letter, Node};

const ONE: Dim = Dim::Fixed(1);
const TWO: Dim = Dim::Fixed(2);
const THREE: Dim = Dim::Fixed(3);

/// First row and dimension of the two parts of a Lie algebra vector with this many components.
pub fn twist_rows(rows: Dim) -> Option<[(u8, Dim); 2]> {
    match rows {
        Dim::Fixed(6) => Some([(0, THREE), (3, THREE)]),
        THREE => Some([(0, ONE), (1, TWO)]),
        _ => None,
    }
}

/// The kind of longer vector into which an inclusion maps.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Inclusion {
    /// A vector of the Lie algebra, as its angular or linear part.
    Twist(usize),
    /// Homogeneous coordinates.
    Point,
}

/// The kind of inclusion of a factor.
pub fn inclusion(e: &Expr) -> Option<Inclusion> {
    let Node::Inclusion(shape, at) = e.node() else {
        return None;
    };
    if *at == 0 && expr::within(shape.rows) == shape.cols {
        return Some(Inclusion::Point);
    }
    let parts = twist_rows(shape.rows)?;
    let part = parts.iter().position(|p| *p == (*at, shape.cols))?;
    Some(Inclusion::Twist(part))
}

/// The inclusion that a factor is the transpose of.
pub fn taken(e: &Expr) -> Option<Inclusion> {
    match e.node() {
        Node::Transpose(inner) => inclusion(inner),
        _ => None,
    }
}

/// The kind of splitting of a factor.
pub fn taken_kind(e: &Expr) -> Option<Kind> {
    Some(match taken(e)? {
        Inclusion::Twist(_) => Kind::Twist,
        Inclusion::Point => Kind::Point,
    })
}

/// Whether this is the last unit vector of homogeneous coordinates.
pub fn is_last(e: &Expr) -> bool {
    matches!(e.node(), Node::Unit(n, axis) if *axis == expr::last_axis(*n))
}

/// The letter, if the expression is one.
pub fn letter(e: &Expr) -> Option<Letter> {
    match e.node() {
        Node::Letter(at) => Some(*at),
        _ => None,
    }
}

/// Scalar factors, and the other factors in order.
pub fn factors(list: &[Expr]) -> (Vec<Expr>, Vec<Expr>) {
    let scalar = |f: &Expr| f.shape().is_scalar();
    list.iter().cloned().partition(scalar)
}

/// The dimension of the homogeneous coordinates that a factor includes a vector into.
pub fn homogeneous(e: &Expr) -> Option<Dim> {
    (inclusion(e)? == Inclusion::Point).then(|| e.shape().rows)
}

/// The letter whose last entry is taken by a dot product with the last unit vector.
pub fn last_taken(e: &Expr) -> Option<Letter> {
    let Node::Dot(a, b) = e.node() else {
        return None;
    };
    match (is_last(a), is_last(b)) {
        (true, _) => letter(b),
        (_, true) => letter(a),
        _ => None,
    }
}

/// Whether a vector is written with inclusions into homogeneous coordinates.
pub fn written_in_points(e: &Expr) -> bool {
    written(e, &|f| inclusion(f) == Some(Inclusion::Point) || is_last(f))
}

/// Whether a vector is written by its angular and linear part.
pub fn written_in_twists(e: &Expr) -> bool {
    written(e, &|f| matches!(inclusion(f), Some(Inclusion::Twist(_))))
}

/// Whether the first non-scalar factor of a term satisfies `puts`.
fn written(e: &Expr, puts: &dyn Fn(&Expr) -> bool) -> bool {
    match e.node() {
        Node::Sum(terms) => terms.iter().any(|t| written(t, puts)),
        Node::Neg(a) | Node::Quotient(a, _) => written(a, puts),
        Node::Product(list) => {
            let head = list.iter().find(|f| !f.shape().is_scalar());
            e.shape().is_vector() && head.is_some_and(puts)
        }
        _ => false,
    }
}

/// A matrix split into its block and column terms, and terms that are neither.
pub struct Blocks {
    /// Upper left.
    pub block: Vec<Expr>,
    /// Upper right.
    pub column: Vec<Expr>,
    /// The other terms.
    pub rest: Vec<Expr>,
}

impl Blocks {
    /// Sorts the terms of a matrix.
    pub fn of(e: &Expr) -> Blocks {
        let mut out = Blocks {
            block: Vec::new(),
            column: Vec::new(),
            rest: Vec::new(),
        };
        let terms = match e.node() {
            Node::Sum(terms) => terms.clone(),
            _ => vec![e.clone()],
        };
        for term in terms {
            match placed(&term) {
                Some((true, part)) => out.column.push(part),
                Some((false, part)) => out.block.push(part),
                None => out.rest.push(term),
            }
        }
        out
    }
}

/// The part that a term includes into a homogeneous matrix; `true` for its column.
fn placed(term: &Expr) -> Option<(bool, Expr)> {
    match term.node() {
        Node::Neg(a) => placed(a).map(|(column, part)| (column, expr::neg(part))),
        Node::Quotient(a, b) => {
            placed(a).map(|(column, part)| (column, expr::quotient(part, b.clone())))
        }
        Node::Product(list) => {
            let (scalars, others) = factors(list);
            let (head, rest) = others.split_first()?;
            let (end, inner) = rest.split_last()?;
            if inclusion(head) != Some(Inclusion::Point) {
                return None;
            }
            let Node::Transpose(end) = end.node() else {
                return None;
            };
            let column = is_last(end);
            if !column && inclusion(end) != Some(Inclusion::Point) {
                return None;
            }
            let inner = match inner.is_empty() {
                true => vec![expr::identity(head.shape().cols)],
                false => inner.to_vec(),
            };
            let all = scalars.into_iter().chain(inner);
            Some((column, expr::product(all.collect::<Vec<_>>())))
        }
        _ => None,
    }
}

/// Whether this is a unit vector.
pub fn is_unit(e: &Expr) -> bool {
    matches!(e.node(), Node::Unit(..))
}
