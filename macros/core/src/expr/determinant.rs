//! Determinants and adjugates of expressions, and the polynomials that these are in two and three dimensions.

use super::build::{identity, integer, inverse, make, mul, neg, power, scale, sub, sum, trace};
use super::shape::{Dim, Shape};
use super::symbol::Symbols;
use super::{Expr, Node};
use crate::algebra::Rational;

/// The determinant.
pub fn det(a: Expr) -> Expr {
    match a.node() {
        Node::Identity(_) => integer(1),
        Node::Inverse(x) => power(det(x.clone()), Rational::MINUS_ONE),
        Node::Transpose(x) => det(x.clone()),
        _ if a.shape().is_scalar() => a,
        _ => make(Node::Det(a), Shape::SCALAR),
    }
}

/// Largest argument whose adjugate is computed as a polynomial.
const LARGEST_ADJUGATE: u32 = 8;

/// The adjugate, `det(A) A^-1` for an invertible `A`. In two and three dimensions it is a node of
/// its own, which has a value for every `A`, unless `A` is invertible by its structure or large.
pub fn adjugate(symbols: &Symbols, a: &Expr) -> Expr {
    let invertible = match a.node() {
        Node::Letter(at) => symbols.get(at.symbol).structure.is_invertible(),
        _ => false,
    };
    let small = matches!(a.shape().rows, Dim::Fixed(2 | 3));
    // Its polynomial repeats its argument: for large ones the inverse is the lesser evil.
    if small && !invertible && a.size() <= LARGEST_ADJUGATE {
        return make(Node::Adjugate(a.clone()), a.shape());
    }
    mul(det(a.clone()), inverse(symbols, a.clone()))
}

/// The adjugate of a matrix of two or three rows as a polynomial (Cayley-Hamilton): what is
/// computed and differentiated.
pub fn adjugate_polynomial(a: &Expr) -> Expr {
    let n = a.shape().rows;
    let t = trace(a.clone());
    if n == Dim::Fixed(2) {
        return sub(mul(t, identity(n)), a.clone());
    }
    let square = mul(a.clone(), a.clone());
    let half = scale(
        Rational::HALF,
        sub(
            power(t.clone(), Rational::integer(2)),
            trace(square.clone()),
        ),
    );
    let shape = a.shape();
    sum(
        [square, neg(mul(t, a.clone())), mul(half, identity(n))],
        shape,
    )
}

/// The same expression with every adjugate written as its polynomial.
pub fn without_adjugates(symbols: &Symbols, e: &Expr) -> Expr {
    match e.node() {
        Node::Adjugate(a) => adjugate_polynomial(&without_adjugates(symbols, a)),
        _ => super::rebuild(symbols, e, &mut |x| without_adjugates(symbols, x)),
    }
}
