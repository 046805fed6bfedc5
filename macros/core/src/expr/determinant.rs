//! Determinants and adjugates of expressions, and their polynomials in two and three dimensions.

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

/// The factors of a product of square matrices, whose determinants multiply to the determinant of the product. The
/// determinant of `Q^T C Q` and its derivatives are expressed by the determinants of `Q` and `C`, without inverses
/// that cancel.
pub(super) fn factors_of_det(a: &Expr) -> Option<&[Expr]> {
    match a.node() {
        Node::Product(factors)
            if factors
                .iter()
                .all(|f| f.shape().is_square() && !f.shape().is_scalar()) =>
        {
            Some(factors)
        }
        _ => None,
    }
}

/// The determinant of a product of square matrices as a product of determinants.
pub(super) fn det_by_factors(a: &Expr) -> Option<Expr> {
    let factors = factors_of_det(a)?;
    Some(super::build::product(factors.iter().cloned().map(det)))
}

/// Largest argument whose adjugate is computed as a polynomial.
const LARGEST_ADJUGATE: u32 = 8;

/// The adjugate, `det(A) A^-1` for an invertible `A`. In two and three dimensions it is a node of its own, defined
/// for every `A`, unless `A` is large or invertible by its structure.
pub fn adjugate(symbols: &Symbols, a: &Expr) -> Expr {
    let invertible = match a.node() {
        Node::Letter(at) => symbols.get(at.symbol).structure.is_invertible(),
        _ => false,
    };
    let small = matches!(a.shape().rows, Dim::Fixed(2 | 3));
    // The polynomial repeats its argument, so for large arguments the inverse is preferable.
    if small && !invertible && a.size() <= LARGEST_ADJUGATE {
        return make(Node::Adjugate(a.clone()), a.shape());
    }
    mul(det(a.clone()), inverse(symbols, a.clone()))
}

/// The adjugate of a 2x2 or 3x3 matrix as a polynomial (Cayley-Hamilton), from which its derivatives are computed.
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

/// The expression with determinants of products as products of determinants.
pub fn with_plain_determinants(symbols: &Symbols, e: &Expr) -> Expr {
    let e = super::rebuild(symbols, e, &mut |x| with_plain_determinants(symbols, x));
    match e.node() {
        Node::Det(a) => det_by_factors(a).unwrap_or(e),
        _ => e,
    }
}
