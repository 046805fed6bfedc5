//! Parts of an expression in which the elements cancel, written without them: `q^T next(q)` becomes the velocity
//! wherever it occurs, and the statement otherwise keeps its form. Takes expressions in elements and velocities;
//! gives equal ones.

use crate::algebra::{Algebra, Factor, Poly};
use crate::expr::{self, Expr, Map, Node};

/// The expression with its vectors and matrices written without elements if possible; `holds` decides whether an
/// element occurs.
pub(super) fn settled(algebra: &Algebra, holds: &dyn Fn(&Expr) -> bool, e: &Expr) -> Expr {
    if !holds(e) {
        return e.clone();
    }
    let e = expr::rebuild(algebra.symbols(), e, &mut |x| settled(algebra, holds, x));
    if !holds(&e) || algebra.exhausted() {
        return e;
    }
    let shorter = match e.node() {
        Node::Letter(_) => return e,
        // re(g A g^-1) = re(A).
        Node::Map(Map::Real, a) => {
            let inside = algebra.lower(a);
            expr::real(algebra.raise(&without_conjugation(algebra, &inside)))
        }
        _ if e.shape().is_scalar() => return e,
        _ => algebra.raise(&algebra.lower(&e)),
    };
    match holds(&shorter) {
        true => e,
        false => shorter,
    }
}

fn without_conjugation(algebra: &Algebra, p: &Poly) -> Poly {
    let mut out = Poly::zero(p.shape);
    for (t, c) in &p.terms {
        let mut t = t.clone();
        while let [first, middle @ .., last] = t.word.as_slice()
            && is_identity(algebra, last, first)
        {
            t.word = middle.to_vec();
        }
        if !out.push(t, *c) {
            return p.clone();
        }
    }
    out
}

fn is_identity(algebra: &Algebra, a: &Factor, b: &Factor) -> bool {
    algebra
        .cancelled_word(vec![a.clone(), b.clone()])
        .is_empty()
}
