//! How vectors and matrices of rigid motions are written in what was derived: the inclusions that put parts into longer
//! vectors and take them out, unit vectors, blocks.

use super::names::Kind;
use crate::expr::shape::Dim;
use crate::expr::{self, Expr, Letter, Node};

const ONE: Dim = Dim::Fixed(1);
const TWO: Dim = Dim::Fixed(2);
const THREE: Dim = Dim::Fixed(3);

/// The rows of the parts of a vector of the Lie algebra of so many components.
pub fn twist_rows(rows: Dim) -> Option<[(u8, Dim); 2]> {
    match rows {
        Dim::Fixed(6) => Some([(0, THREE), (3, THREE)]),
        THREE => Some([(0, ONE), (1, TWO)]),
        _ => None,
    }
}

/// What a factor includes a vector into, or takes it out of.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Inclusion {
    /// The angular or the linear part of a vector of the Lie algebra.
    Twist(usize),
    /// A vector into homogeneous coordinates.
    Point,
}

/// What a factor includes a vector into.
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

/// The inclusion that a factor undoes.
pub fn taken(e: &Expr) -> Option<Inclusion> {
    match e.node() {
        Node::Transpose(inner) => inclusion(inner),
        _ => None,
    }
}

/// What a factor takes apart.
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

/// The letter that an expression is.
pub fn letter(e: &Expr) -> Option<Letter> {
    match e.node() {
        Node::Letter(at) => Some(*at),
        _ => None,
    }
}

/// Scalar factors, and the others in order.
pub fn factors(list: &[Expr]) -> (Vec<Expr>, Vec<Expr>) {
    let scalar = |f: &Expr| f.shape().is_scalar();
    list.iter().cloned().partition(scalar)
}

/// How many homogeneous coordinates a factor puts a vector into.
pub fn homogeneous(e: &Expr) -> Option<Dim> {
    (inclusion(e)? == Inclusion::Point).then(|| e.shape().rows)
}

/// The letter of which a scalar product with the last unit vector takes the last entry.
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

/// Whether a vector is written by what puts others into homogeneous coordinates.
pub fn written_in_points(e: &Expr) -> bool {
    written(e, &|f| inclusion(f) == Some(Inclusion::Point) || is_last(f))
}

/// Whether a vector is written by its angular and its linear part.
pub fn written_in_twists(e: &Expr) -> bool {
    written(e, &|f| matches!(inclusion(f), Some(Inclusion::Twist(_))))
}

/// Whether the first factor of a term that is no number puts what follows into a longer vector.
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

/// A matrix as its block and column, without the terms that are no such matrices.
pub struct Blocks {
    /// Upper left.
    pub block: Vec<Expr>,
    /// Upper right.
    pub column: Vec<Expr>,
    /// The other terms.
    pub rest: Vec<Expr>,
}

impl Blocks {
    /// The terms of a matrix, sorted.
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

/// What a term puts into a homogeneous matrix; `true` into its column.
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
