//! The constructors cancel terms with opposite signs, in any context, and keep all other terms in order.

use super::shape::{Dim, Shape, Structure};
use super::symbol::{Role, Symbols};
use super::{
    Expr, Function, add, call, dot, here, identity, integer, inverse, mul, neg, quotient, scale,
    sub, sum, transpose,
};
use crate::algebra::Rational;

const THREE: Dim = Dim::Fixed(3);

fn letters() -> [Expr; 4] {
    let mut s = Symbols::default();
    let mut add = |name: &str, shape| s.add(name, shape, Structure::General, Role::Parameter);
    let ids = [
        add("A", Shape::square(THREE)),
        add("B", Shape::square(THREE)),
        add("d", Shape::vector(THREE)),
        add("w", Shape::SCALAR),
    ];
    ids.map(|id| here(&s, id))
}

#[test]
fn a_term_and_its_opposite_vanish_with_all_they_multiply() {
    let [a, _, d, w] = letters();
    let nothing = sub(identity(THREE), identity(THREE));
    assert!(nothing.is_zero());
    assert_eq!(nothing.shape(), Shape::square(THREE));
    let vector = mul(nothing, d.clone());
    assert!(vector.is_zero());
    let number = dot(vector.clone(), mul(a.clone(), vector));
    assert!(number.is_zero());
    let term = quotient(mul(w.clone(), number), w.clone());
    assert_eq!(add(w.clone(), term), w);
    assert!(sub(scale(Rational::HALF, a.clone()), scale(Rational::HALF, a)).is_zero());
}

#[test]
fn only_pairs_vanish_and_the_rest_keeps_its_order() {
    let [a, b, ..] = letters();
    let shape = a.shape();
    let terms = [neg(a.clone()), b.clone(), a.clone(), a.clone(), b.clone()];
    let left = sum(terms, shape);
    assert_eq!(left, sum([b.clone(), a.clone(), b.clone()], shape));
    assert_eq!(left.children(), [&b, &a, &b]);
    let twice = sum([neg(a.clone()), neg(a.clone()), a.clone()], shape);
    assert_eq!(twice, neg(a.clone()));
    // Negative controls: equal signs, different factors, products in another order.
    assert!(!add(a.clone(), a.clone()).is_zero());
    assert!(!sub(scale(Rational::integer(2), a.clone()), a.clone()).is_zero());
    assert!(!sub(mul(a.clone(), b.clone()), mul(b, a)).is_zero());
    assert!(!sub(integer(2), integer(1)).is_zero());
}

#[test]
fn the_inverse_of_a_transposed_inverse_is_the_transpose() {
    let mut s = Symbols::default();
    let id = s.add(
        "Q",
        Shape::square(THREE),
        Structure::Invertible,
        Role::Element,
    );
    let q = here(&s, id);
    let seen = transpose(&s, inverse(&s, q.clone()));
    assert_eq!(inverse(&s, seen), transpose(&s, q));
}

#[test]
fn functions_of_numbers_are_numbers_where_these_are_rational() {
    use Function::{Abs, Cos, Cosh, Exp, Log, Sign, Sin, Sinh, Tanh};
    for (function, at, value) in [
        (Sin, 0, 0),
        (Sinh, 0, 0),
        (Tanh, 0, 0),
        (Cos, 0, 1),
        (Cosh, 0, 1),
        (Exp, 0, 1),
        (Log, 1, 0),
        (Abs, -2, 2),
        (Abs, 2, 2),
        (Sign, -2, -1),
        (Sign, 0, 0),
        (Sign, 3, 1),
    ] {
        assert_eq!(
            call(function, integer(at)),
            integer(value),
            "{function:?}({at})"
        );
    }
    for function in [Sin, Cos, Exp, Tanh] {
        let one = call(function, integer(1));
        assert_ne!(one, integer(0));
        assert_ne!(one, integer(1));
    }
}

#[test]
fn the_gradient_of_a_logarithm_of_a_determinant_is_the_transposed_inverse() {
    let mut s = Symbols::default();
    let shape = Shape::square(THREE);
    let a = s.add("A", shape, Structure::Invertible, Role::Parameter);
    let letter = super::Letter {
        symbol: a,
        shift: super::Shift::HERE,
    };
    let a = here(&s, a);
    let gradient = super::gradient(&s, &call(Function::Log, super::det(a.clone())), letter);
    let algebra = crate::algebra::Algebra::new(&s);
    let wanted = transpose(&s, inverse(&s, a.clone()));
    assert!(algebra.equal(&gradient, &wanted));
    assert!(!algebra.equal(&gradient, &inverse(&s, a)));
}

/// The derivative of the determinant of a product is expressed by its factors, and factors that cancel are not
/// inverted.
#[test]
fn derivatives_of_the_determinant_of_a_product_are_those_of_its_factors() {
    let mut s = Symbols::default();
    let shape = Shape::square(THREE);
    let mut add = |name: &str, role| s.add(name, shape, Structure::General, role);
    let (q, c, v) = (
        add("Q", Role::Element),
        add("C", Role::Parameter),
        add("V", Role::Variation),
    );
    let letter = super::Letter {
        symbol: q,
        shift: super::Shift::HERE,
    };
    let [q, c, v] = [q, c, v].map(|id| here(&s, id));
    let form = super::product([transpose(&s, q.clone()), c.clone(), q.clone()]);
    let algebra = crate::algebra::Algebra::new(&s);
    let gradient = |e: &Expr| super::gradient(&s, e, letter);
    let det = super::det;
    // d log det(Q^T C Q) = 2 Q^-T.
    let of_log = gradient(&call(Function::Log, det(form.clone())));
    let across = transpose(&s, inverse(&s, q.clone()));
    assert!(algebra.equal(&of_log, &scale(Rational::integer(2), across.clone())));
    assert!(!super::contains_role(&s, &of_log, Role::Parameter));
    // d det(Q^T C Q) = 2 det(C) det(Q)^2 Q^-T. Its cofactors are defined for every Q.
    let of_det = gradient(&det(form.clone()));
    let twice = super::product([det(c), det(q.clone()), det(q.clone()), across]);
    assert!(algebra.equal(&of_det, &scale(Rational::integer(2), twice)));
    let inverts = |e: &Expr| {
        let mut all = vec![e.clone()];
        while let Some(e) = all.pop() {
            if matches!(e.node(), super::Node::Inverse(_)) {
                return true;
            }
            all.extend(e.children().into_iter().cloned());
        }
        false
    };
    assert!(!inverts(&of_det));
    // The same along a direction, and the same as the derivative of the polynomial.
    let along = [(letter, v.clone())];
    let change = super::directional(&s, &det(form.clone()), &along);
    let paired = |g: Expr| super::trace(mul(transpose(&s, g), v.clone()));
    assert!(algebra.equal(&change, &paired(of_det)));
    let log = call(Function::Log, det(form.clone()));
    let change = super::directional(&s, &log, &along);
    assert!(algebra.equal(&change, &paired(of_log)));
    // The computed form contains no determinant of a product.
    let plain = super::with_plain_determinants(&s, &det(form.clone()));
    assert_ne!(plain, det(form.clone()));
    assert!(algebra.equal(&plain, &det(form)));
}
