//! Identities that hold at random points of a prime field; values at zero; inverses and quaternions of given
//! matrices.

use super::*;
use crate::expr::symbol::Role;

#[test]
fn adjugates_have_values_where_determinants_vanish() {
    let mut s = Symbols::default();
    let v = s.add(
        "V",
        Shape::vector(Dim::Fixed(3)),
        Structure::General,
        Role::Parameter,
    );
    let v = expr::here(&s, v);
    let skew = expr::hat(v.clone());
    let outer = expr::mul(v.clone(), expr::transpose(&s, v));
    let adjugate = expr::adjugate(&s, &skew);
    assert!(vanishes(&s, &expr::det(skew)));
    assert!(vanishes(&s, &expr::sub(adjugate.clone(), outer.clone())));
    assert!(!vanishes(&s, &expr::add(adjugate, outer)));
}

#[test]
fn identities_of_three_dimensions_vanish() {
    let mut s = Symbols::default();
    let three = Dim::Fixed(3);
    let m = Shape::square(three);
    let v = Shape::vector(three);
    let o = s.add("O", m, Structure::Orthogonal, Role::Velocity);
    let y = s.add("Y", v, Structure::General, Role::Parameter);
    let f = s.add("F", v, Structure::General, Role::Parameter);
    let x = s.add("X", m, Structure::Skew, Role::Parameter);
    let l = |i| expr::here(&s, i);
    let t = |e| expr::transpose(&s, e);
    let (o, y, f, x) = (l(o), l(y), l(f), l(x));
    let ot = t(o.clone());
    let oty = expr::mul(ot.clone(), y.clone());
    let terms = vec![
        expr::mul(
            expr::trace(expr::mul(o.clone(), expr::hat(y.clone()))),
            expr::dot(f.clone(), expr::vee(x.clone())),
        ),
        expr::neg(expr::mul(
            expr::trace(expr::mul(o.clone(), x.clone())),
            expr::dot(f.clone(), oty.clone()),
        )),
        expr::dot(f.clone(), expr::product([o.clone(), x.clone(), oty])),
        expr::dot(
            f,
            expr::product([ot.clone(), ot, expr::cross(y, expr::mul(o, expr::vee(x)))]),
        ),
    ];
    assert!(terms.iter().all(|e| !vanishes(&s, e)));
    assert!(vanishes(&s, &expr::sum(terms, Shape::SCALAR)));
}

#[test]
fn inverses_are_found_where_the_diagonal_is_zero() {
    // Permutations of rows: two exchanges, one below the first row, one with it.
    let turned = |rows: [usize; 3]| Matrix::from_fn(3, 3, |i, j| u64::from(rows[i] == j));
    for (rows, det) in [
        ([1, 2, 0], 1),
        ([0, 2, 1], negate(1)),
        ([2, 1, 0], negate(1)),
    ] {
        let a = turned(rows);
        let found = a.inverted().map(|(b, d)| (b.data, d));
        assert_eq!(found, Some((a.transposed().data, det)), "{rows:?}");
    }
}

#[test]
fn functions_have_their_values_at_zero() {
    let mut s = Symbols::default();
    let shape = Shape::vector(Dim::Fixed(3));
    let mut add = |name| s.add(name, shape, Structure::General, Role::Parameter);
    let (u, v) = (add("u"), add("v"));
    let (u, v) = (expr::here(&s, u), expr::here(&s, v));
    // An expression that is zero but not written as zero.
    let zero = expr::dot(u.clone(), expr::cross(u, v));
    let call = |f| expr::call(f, zero.clone());
    for f in [Function::Sin, Function::Sinh, Function::Tanh] {
        assert!(vanishes(&s, &call(f)), "{f:?}");
    }
    for f in [Function::Cos, Function::Cosh, Function::Exp] {
        assert!(vanishes(&s, &expr::sub(call(f), expr::integer(1))), "{f:?}");
    }
}

#[test]
fn matrices_of_quaternions_give_their_parts() {
    let (w, v) = (7, [2, 3, 5]);
    let turned = pure(&v);
    let a = Matrix::from_fn(4, 4, |i, j| {
        add(turned.at(i, j), if i == j { w } else { 0 })
    });
    assert_eq!(quaternion(&a), [28, 8, 12, 20]);
    // The real part is the mean of the diagonal.
    let a = Matrix::from_fn(4, 4, |i, j| if i == j { 1 << i } else { 0 });
    assert_eq!(quaternion(&a), [15, 0, 0, 0]);
}

#[test]
fn adjugates_are_inverses_up_to_the_determinant() {
    let mut s = Symbols::default();
    for n in [2, 3] {
        let shape = Shape::square(Dim::Fixed(n));
        let a = s.add(&format!("A{n}"), shape, Structure::General, Role::Parameter);
        let a = expr::here(&s, a);
        let polynomial = expr::adjugate_polynomial(&a);
        let product = expr::mul(a.clone(), polynomial.clone());
        let multiple = expr::mul(expr::det(a.clone()), expr::identity(Dim::Fixed(n)));
        assert!(vanishes(&s, &expr::sub(product, multiple)), "{n}");
        assert!(
            vanishes(&s, &expr::sub(expr::adjugate(&s, &a), polynomial)),
            "{n}"
        );
    }
}
