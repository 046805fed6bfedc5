//! Vectors in the frame to which a rotation transforms them: `R (a x R^T b)` becomes `R a x b`, without rotating back
//! and forth. Used for emitted code. Takes a rotation and an expression; gives their product, or None if this saves
//! no work.

use super::*;
use crate::expr::symbol::Symbols;

/// `turn x`, if every term of the vector `x` contains an inverse rotation that cancels in part.
pub fn turned(symbols: &Symbols, turn: &Expr, x: &Expr) -> Option<Expr> {
    let of = |e: &Expr| turned(symbols, turn, e);
    match x.node() {
        Node::Neg(a) => of(a).map(neg),
        Node::Quotient(a, b) => of(a).map(|a| quotient(a, b.clone())),
        Node::Sum(terms) => {
            let terms: Option<Vec<Expr>> = terms.iter().map(of).collect();
            Some(sum(terms?, x.shape()))
        }
        Node::Cross(a, b) => {
            let through = |z: &Expr| mul(turn.clone(), z.clone());
            match (of(a), of(b)) {
                (None, None) => None,
                (Some(a), Some(b)) => Some(cross(a, b)),
                (Some(a), None) => Some(cross(a, through(b))),
                (None, Some(b)) => Some(cross(through(a), b)),
            }
        }
        Node::Product(factors) => {
            let (mut word, others): (Vec<Expr>, Vec<Expr>) =
                factors.iter().cloned().partition(|f| f.shape().is_scalar());
            word.push(match others.as_slice() {
                [only] => of(only)?,
                [back, rest @ ..] if *back == transpose(symbols, turn.clone()) => {
                    product(rest.to_vec())
                }
                _ => return None,
            });
            Some(product(word))
        }
        _ => None,
    }
}
