//! Counts the summands of a statement after expansion, and removes summands that both sides share. Reordering n
//! summands gives about n 2^n terms, which limits the search.

use clebsch_core::algebra::Rational;
use clebsch_core::expr::{Expr, Node, neg, sum};

/// The largest number of summands of any sum in the expression after expansion; saturating.
pub fn count(e: &Expr) -> usize {
    let inside = e.children().into_iter().map(count).max().unwrap_or(1);
    expanded(e).max(inside)
}

fn expanded(e: &Expr) -> usize {
    match e.node() {
        Node::Sum(list) => list.iter().map(expanded).fold(0, usize::saturating_add),
        Node::Product(list) => list.iter().map(expanded).fold(1, usize::saturating_mul),
        Node::Dot(a, b) | Node::Cross(a, b) => expanded(a).saturating_mul(expanded(b)),
        Node::Neg(a) | Node::Transpose(a) | Node::Trace(a) | Node::Hat(a) | Node::Vee(a) => {
            expanded(a)
        }
        Node::Part(_, a) => expanded(a),
        Node::Quotient(a, _) => expanded(a),
        Node::Power(a, q) if *q == Rational::integer(2) => expanded(a).saturating_mul(expanded(a)),
        Node::Power(..)
        | Node::Number(_)
        | Node::Constant(_)
        | Node::Letter(_)
        | Node::Identity(_)
        | Node::Zero(_)
        | Node::Unit(..)
        | Node::Inclusion(..)
        | Node::Map(..)
        | Node::Inverse(_)
        | Node::Det(_)
        | Node::Adjugate(_)
        | Node::Call(..)
        | Node::Given(_)
        | Node::PullBack(..) => 1,
    }
}

fn summands(e: &Expr) -> Vec<Expr> {
    match e.node() {
        Node::Sum(list) => list.clone(),
        Node::Neg(a) => summands(a).into_iter().map(neg).collect(),
        _ => vec![e.clone()],
    }
}

/// Both sides without the summands that are identical on both, and the removed summands. The result is an equivalent
/// statement.
pub fn without_common(left: &Expr, right: &Expr) -> (Expr, Expr, Vec<Expr>) {
    let mut rest = summands(right);
    let mut kept = Vec::new();
    let mut common = Vec::new();
    for term in summands(left) {
        match rest.iter().position(|t| *t == term) {
            Some(i) => common.push(rest.remove(i)),
            None => kept.push(term),
        }
    }
    (sum(kept, left.shape()), sum(rest, right.shape()), common)
}
