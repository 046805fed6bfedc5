//! Identities of vectors in space: hat, vee, cross and dot.

use super::{Desk, N};
use clebsch_core::expr::*;

#[test]
fn products_of_three_vectors() {
    let mut d = Desk::default();
    let [a, b, c] = ["a", "b", "c"].map(|n| d.vector(n));
    let x = |u: &Expr, v: &Expr| cross(u.clone(), v.clone());
    let o = |u: &Expr, v: &Expr| dot(u.clone(), v.clone());
    let jacobi = sum(
        [x(&a, &x(&b, &c)), x(&b, &x(&c, &a)), x(&c, &x(&a, &b))],
        a.shape(),
    );
    d.proves("Jacobi", &jacobi, &zero(a.shape()));
    let expanded = sub(mul(o(&a, &c), b.clone()), mul(o(&a, &b), c.clone()));
    d.proves("double cross", &x(&a, &x(&b, &c)), &expanded);
    d.proves("cyclic", &o(&a, &x(&b, &c)), &o(&b, &x(&c, &a)));
    d.proves("repeated", &o(&a, &x(&b, &a)), &integer(0));
    d.refuses("anticyclic", &o(&a, &x(&b, &c)), &o(&b, &x(&a, &c)));
    d.refuses("double cross, sign", &x(&a, &x(&b, &c)), &neg(expanded));
}

#[test]
fn product_of_two_cross_products() {
    let mut d = Desk::default();
    let [a, b, c, e] = ["a", "b", "c", "e"].map(|n| d.vector(n));
    let o = |u: &Expr, v: &Expr| dot(u.clone(), v.clone());
    let left = dot(cross(a.clone(), b.clone()), cross(c.clone(), e.clone()));
    let (p, q) = (mul(o(&a, &c), o(&b, &e)), mul(o(&a, &e), o(&b, &c)));
    d.proves("Lagrange", &left, &sub(p.clone(), q.clone()));
    d.refuses("Lagrange, sign", &left, &sub(q, p));
}

#[test]
fn hat_is_equivariant_and_turns_commutators_into_cross_products() {
    let mut d = Desk::default();
    let [a, b] = ["a", "b"].map(|n| d.vector(n));
    let g = d.rotation("Λ");
    let h = |v: &Expr| hat(v.clone());
    let gt = d.t(&g);
    let turned = product([g.clone(), h(&a), gt.clone()]);
    d.proves("hat(Λ a)", &hat(mul(g.clone(), a.clone())), &turned);
    let back = product([gt, h(&a), g.clone()]);
    d.refuses(
        "hat(Λ a), wrong side",
        &hat(mul(g.clone(), a.clone())),
        &back,
    );
    let apart = cross(mul(g.clone(), a.clone()), mul(g.clone(), b.clone()));
    let together = mul(g.clone(), cross(a.clone(), b.clone()));
    d.proves("Λ a x Λ b", &apart, &together);
    let commutator = sub(mul(h(&a), h(&b)), mul(h(&b), h(&a)));
    d.proves("commutator", &commutator, &hat(cross(a.clone(), b.clone())));
    let pairing = trace(mul(h(&a), h(&b)));
    let twice = mul(integer(-2), dot(a.clone(), b.clone()));
    d.proves("tr(hat a hat b)", &pairing, &twice);
}

#[test]
fn axial_vectors() {
    let mut d = Desk::default();
    let [a, b, w] = ["a", "b", "w"].map(|n| d.vector(n));
    let (j, m, g) = (d.symmetric("J"), d.general("M"), d.rotation("Λ"));
    let dyad = vee(mul(b.clone(), d.t(&a)));
    let half = quotient(cross(a.clone(), b.clone()), integer(2));
    d.proves("vee of a dyad", &dyad, &half);
    // Inertia from the second moments: vee(J hat w + hat w J) = (tr J Id - J) w.
    let moments = add(
        mul(j.clone(), hat(w.clone())),
        mul(hat(w.clone()), j.clone()),
    );
    let inertia = sub(mul(trace(j.clone()), identity(N)), j.clone());
    let momentum = mul(inertia.clone(), w.clone());
    d.proves("inertia", &vee(moments.clone()), &momentum);
    d.proves("inertia, as a matrix", &hat(momentum.clone()), &moments);
    d.refuses("inertia, sign", &vee(moments), &neg(momentum));
    let spun = vee(product([g.clone(), m.clone(), d.t(&g)]));
    d.proves("vee(Λ M Λ^T)", &spun, &mul(g, vee(m.clone())));
    d.proves("vee of a symmetric matrix", &vee(j), &zero(w.shape()));
    let skew = quotient(sub(m.clone(), d.t(&m)), integer(2));
    d.proves("hat of vee", &hat(vee(m)), &skew);
}

#[test]
fn unit_vectors() {
    let mut d = Desk::default();
    let v = d.vector("v");
    let e = |axis: u8| unit(N, axis);
    d.proves("e1 x e2", &cross(e(0), e(1)), &e(2));
    d.proves("e2 x e1", &cross(e(1), e(0)), &neg(e(2)));
    d.proves("e1 . e1", &dot(e(0), e(0)), &integer(1));
    let along = dot(e(2), mul(dot(e(2), v.clone()), e(2)));
    d.proves("component", &along, &dot(v.clone(), e(2)));
    d.refuses("e1 x e2, sign", &cross(e(0), e(1)), &neg(e(2)));
}
