//! Identities of discrete mechanics: constraint-preserving variations, momenta, advection.

use super::{Desk, N};
use clebsch_core::expr::shape::{Shape, Structure};
use clebsch_core::expr::symbol::Role;
use clebsch_core::expr::*;

/// The letter, for an expression that is a letter.
fn at(e: &Expr) -> Letter {
    match e.node() {
        Node::Letter(at) => *at,
        _ => panic!("not a letter"),
    }
}

#[test]
fn variations_keep_the_reconstruction() {
    let mut d = Desk::default();
    let (l, o, p, x) = (
        d.rotation("Λ"),
        d.rotation("Ω"),
        d.general("P"),
        d.skew("ξ"),
    );
    let pt = d.t(&p);
    // next(Λ) = Λ Ω with δΛ = Λ ξ, δΩ = -ξ Ω, δnext(Λ) = 0.
    let change = directional(
        &d.symbols,
        &mul(l.clone(), o.clone()),
        &[
            (at(&l), mul(l.clone(), x.clone())),
            (at(&o), neg(mul(x.clone(), o.clone()))),
        ],
    );
    d.proves("outgoing", &trace(mul(pt.clone(), change)), &integer(0));
    let wrong = directional(
        &d.symbols,
        &mul(l.clone(), o.clone()),
        &[
            (at(&l), mul(l.clone(), x.clone())),
            (at(&o), mul(x.clone(), o.clone())),
        ],
    );
    d.refuses(
        "outgoing, sign",
        &trace(mul(pt.clone(), wrong)),
        &integer(0),
    );
    // Λ = Λ[-1] Ω[-1] with δΩ[-1] = Ω[-1] ξ, δΛ[-1] = 0.
    let before = |e: &Expr| letter(&d.symbols, at(e).symbol, Shift::PREVIOUS);
    let (l0, o0) = (before(&l), before(&o));
    let on_shell = |e: &Expr| substitute(&d.symbols, e, &[(at(&l), mul(l0.clone(), o0.clone()))]);
    let (moved, varied) = (
        product([l0.clone(), o0.clone(), x.clone()]),
        mul(l.clone(), x.clone()),
    );
    // In this form no proof is needed: a sum drops a term and its negative.
    assert!(on_shell(&sub(moved.clone(), varied.clone())).is_zero());
    assert!(!on_shell(&sub(moved, neg(varied))).is_zero());
    let left = trace(product([pt.clone(), l0.clone(), o0.clone(), x.clone()]));
    let lt = d.t(&mul(l0, o0));
    let right = neg(trace(product([x.clone(), lt, p])));
    d.proves("incoming pairing", &left, &right);
    d.refuses("incoming pairing, sign", &left, &neg(right));
}

#[test]
fn variations_carry_advected_quantities() {
    let mut d = Desk::default();
    let (o, x, g, v) = (d.rotation("Ω"), d.skew("ξ"), d.vector("Γ"), d.vector("V"));
    let ot = d.t(&o);
    let written = product([ot.clone(), x.clone(), o.clone(), ot.clone(), g.clone()]);
    let short = product([ot.clone(), x.clone(), g.clone()]);
    d.proves(
        "V . Ω^T ξ Ω Ω^T Γ",
        &dot(v.clone(), written.clone()),
        &dot(v.clone(), short.clone()),
    );
    d.refuses(
        "V . Ω^T ξ Ω Ω^T Γ, sign",
        &dot(v.clone(), written),
        &neg(dot(v.clone(), short)),
    );
    // next(Γ) = Ω^T Γ with δΩ = -ξ Ω, δΓ = -ξ Γ: the next value is not varied.
    let change = directional(
        &d.symbols,
        &mul(ot, g.clone()),
        &[
            (at(&o), neg(mul(x.clone(), o.clone()))),
            (at(&g), neg(mul(x.clone(), g.clone()))),
        ],
    );
    d.proves("δ(Ω^T Γ) = 0", &dot(v.clone(), change), &integer(0));
    let pairing = trace(product([o.clone(), g.clone(), d.t(&v)]));
    d.proves("dot is a trace", &dot(v.clone(), mul(o, g)), &pairing);
}

#[test]
fn derivative_of_the_kinetic_term_is_the_momentum() {
    let mut d = Desk::default();
    let (o, x, j) = (d.rotation("Ω"), d.skew("ξ"), d.symmetric("J"));
    let kinetic = trace(mul(j.clone(), o.clone()));
    let change = directional(
        &d.symbols,
        &kinetic,
        &[(at(&o), neg(mul(x.clone(), o.clone())))],
    );
    let momentum = sub(mul(j.clone(), d.t(&o)), mul(o.clone(), j.clone()));
    let pairing = quotient(trace(mul(d.t(&momentum), x.clone())), integer(2));
    d.proves("<grad l, δΩ>", &change, &neg(pairing.clone()));
    d.refuses("<grad l, δΩ>, sign", &change, &pairing);
    let turned = trace(mul(d.t(&mul(x.clone(), o.clone())), d.t(&j)));
    d.proves("tr(J (-ξ Ω))", &change, &neg(turned));
}

#[test]
fn transport_of_the_momentum() {
    let mut d = Desk::default();
    let (l, o, j, m) = (
        d.rotation("Λ"),
        d.rotation("Ω"),
        d.symmetric("J"),
        d.skew("M"),
    );
    let ot = d.t(&o);
    let tail = sub(mul(j.clone(), ot.clone()), mul(o.clone(), j.clone()));
    let head = sub(mul(ot.clone(), j.clone()), mul(j.clone(), o.clone()));
    let carried = product([ot.clone(), tail.clone(), o.clone()]);
    d.proves("free body recursion", &carried, &head);
    d.refuses("free body recursion, sign", &carried, &neg(head.clone()));
    let next = product([ot.clone(), m.clone(), o.clone()]);
    let lo = mul(l.clone(), o.clone());
    let spatial = product([lo.clone(), next.clone(), d.t(&lo)]);
    d.proves(
        "spatial momentum",
        &spatial,
        &product([l.clone(), m.clone(), d.t(&l)]),
    );
    let casimir = trace(mul(next.clone(), next));
    d.proves("Casimir", &casimir, &trace(mul(m.clone(), m.clone())));
    d.refuses("Casimir, sign", &casimir, &neg(trace(mul(m.clone(), m))));
}

#[test]
fn torque_of_the_heavy_top() {
    let mut d = Desk::default();
    let (g, u, x, h) = (d.vector("Γ"), d.vector("gU"), d.vector("x"), d.scalar("h"));
    let (o, o0, j) = (d.rotation("Ω"), d.rotation("Ω0"), d.symmetric("J"));
    let torque = cross(g.clone(), u.clone());
    let dyads = sub(mul(u.clone(), d.t(&g)), mul(g.clone(), d.t(&u)));
    d.proves("hat(Γ x gU)", &hat(torque.clone()), &dyads);
    d.refuses("hat(Γ x gU), sign", &hat(torque.clone()), &neg(dyads));
    // δΓ = -x x Γ.
    let work = dot(u.clone(), neg(cross(x.clone(), g.clone())));
    d.proves(
        "work of the weight",
        &work,
        &neg(dot(x.clone(), torque.clone())),
    );
    d.refuses(
        "work of the weight, sign",
        &work,
        &dot(x.clone(), torque.clone()),
    );
    // The full equation at one node, paired with a variation x.
    let xi = hat(x.clone());
    let incoming = neg(quotient(
        trace(product([j.clone(), o0.clone(), xi.clone()])),
        h.clone(),
    ));
    let outgoing = quotient(
        trace(product([j.clone(), xi.clone(), o.clone()])),
        h.clone(),
    );
    let weight = neg(product([h.clone(), dot(u, neg(cross(x.clone(), g)))]));
    let varied = sum([incoming, outgoing, weight], Shape::SCALAR);
    let head = quotient(vee(mul(j.clone(), o0)), h.clone());
    let tail = quotient(vee(mul(o, j)), h.clone());
    let node = sum(
        [
            mul(integer(2), head.clone()),
            neg(mul(integer(2), tail.clone())),
            mul(h.clone(), torque.clone()),
        ],
        x.shape(),
    );
    d.proves("heavy top, one node", &varied, &dot(x.clone(), node));
    let wrong = sum(
        [
            mul(integer(2), head),
            neg(mul(integer(2), tail)),
            neg(mul(h, torque)),
        ],
        x.shape(),
    );
    d.refuses("heavy top, one node, sign", &varied, &dot(x, wrong));
}

#[test]
fn two_coupled_bodies() {
    let mut d = Desk::default();
    let [l1, o1, l2, o2] = ["Λ1", "Ω1", "Λ2", "Ω2"].map(|n| d.rotation(n));
    let (a, x) = (d.general("A"), d.skew("ξ"));
    let next = mul(
        d.t(&mul(l1.clone(), o1.clone())),
        mul(l2.clone(), o2.clone()),
    );
    let r = mul(d.t(&l1), l2.clone());
    d.proves(
        "relative attitude",
        &next,
        &product([d.t(&o1), r.clone(), o2.clone()]),
    );
    // The coupling tr((Id - Ω1)^T R (Id - Ω2) A), with δΩ1 = -ξ Ω1 and δR = -ξ R.
    let one = identity(N);
    let rr = d.rotation("R");
    let coupling = trace(product([
        d.t(&sub(one.clone(), o1.clone())),
        rr.clone(),
        sub(one.clone(), o2.clone()),
        a.clone(),
    ]));
    let change = directional(
        &d.symbols,
        &coupling,
        &[
            (at(&o1), neg(mul(x.clone(), o1.clone()))),
            (at(&rr), neg(mul(x.clone(), rr.clone()))),
        ],
    );
    let rest = product([x.clone(), rr.clone(), sub(one, o2), a]);
    d.proves("coupling", &change, &neg(trace(rest.clone())));
    d.refuses("coupling, sign", &change, &trace(rest));
}

#[test]
fn inertia_seen_from_space() {
    let mut d = Desk::default();
    let (g, j, o) = (d.rotation("Λ"), d.symmetric("J"), d.rotation("Ω"));
    let turned = |a: &Expr| product([g.clone(), a.clone(), d.t(&g)]);
    // With ω = Λ Ω Λ^T and I = Λ J Λ^T: I ω^T - ω I is Λ (J Ω^T - Ω J) Λ^T.
    let (i, w) = (turned(&j), turned(&o));
    let spatial = sub(mul(i.clone(), d.t(&w)), mul(w.clone(), i.clone()));
    let body = sub(mul(j.clone(), d.t(&o)), mul(o.clone(), j.clone()));
    d.proves("spatial momentum of the body", &spatial, &turned(&body));
    d.refuses(
        "spatial momentum of the body, sign",
        &spatial,
        &turned(&neg(body)),
    );
    let next = product([w.clone(), i.clone(), d.t(&w)]);
    let lo = mul(g.clone(), o);
    d.proves("I' = ω I ω^T", &next, &product([lo.clone(), j, d.t(&lo)]));
}

#[test]
fn casimirs_of_the_heavy_top() {
    let mut d = Desk::default();
    let (g, u, m, h, o) = (
        d.vector("Γ"),
        d.vector("gU"),
        d.vector("μ"),
        d.scalar("h"),
        d.rotation("Ω"),
    );
    // next(Γ) = Ω^T Γ and next(μ) = Ω^T μ + h next(Γ) x gU.
    let next = mul(d.t(&o), g.clone());
    let torque = mul(h, cross(next.clone(), u));
    let momentum = add(mul(d.t(&o), m.clone()), torque.clone());
    let carried = dot(momentum, next.clone());
    d.proves("vertical momentum", &carried, &dot(m.clone(), g.clone()));
    d.refuses(
        "vertical momentum, sign",
        &carried,
        &neg(dot(m.clone(), g.clone())),
    );
    let wrong = add(mul(o.clone(), m.clone()), torque);
    d.refuses(
        "vertical momentum, side",
        &dot(wrong, next.clone()),
        &dot(m, g.clone()),
    );
    d.proves("length", &dot(next.clone(), next), &dot(g.clone(), g));
}

#[test]
fn momentum_as_a_vector() {
    let mut d = Desk::default();
    let (o, j) = (d.rotation("Ω"), d.symmetric("J"));
    let ot = d.t(&o);
    let tail = vee(sub(mul(j.clone(), ot.clone()), mul(o.clone(), j.clone())));
    let head = vee(sub(mul(ot.clone(), j.clone()), mul(j, o)));
    d.proves("head = Ω^T tail", &mul(ot.clone(), tail.clone()), &head);
    d.refuses("head = Ω^T tail, sign", &mul(ot, tail), &neg(head));
}

#[test]
fn ellipsoid_of_any_dimension() {
    let mut d = Desk::default();
    let n = d.symbols.add_dim("n", 3, 4);
    let mut square =
        |name: &str, s: Structure| d.letter(name, Shape::square(n), s, Role::Parameter);
    let g = square("G", Structure::Invertible);
    let c = square("C", Structure::Symmetric);
    let (x, p) = (
        square("ξ", Structure::General),
        square("P", Structure::Symmetric),
    );
    // next(C) = G^T C G with δG = -ξ G and δC = ξ^T C + C ξ: the next value is not varied.
    let next = product([d.t(&g), c.clone(), g.clone()]);
    let moved = add(mul(d.t(&x), c.clone()), mul(c.clone(), x.clone()));
    let change =
        |dg: Expr| directional(&d.symbols, &next, &[(at(&g), dg), (at(&c), moved.clone())]);
    let kept = change(neg(mul(x.clone(), g.clone())));
    d.proves("δ(G^T C G) = 0", &trace(mul(p.clone(), kept)), &integer(0));
    let wrong = change(mul(x.clone(), g.clone()));
    d.refuses("δ(G^T C G), sign", &trace(mul(p, wrong)), &integer(0));
    let log_det = call(Function::Log, det(g.clone()));
    let rate = directional(&d.symbols, &log_det, &[(at(&g), mul(x.clone(), g))]);
    d.proves("δ log det G", &rate, &trace(x.clone()));
    d.refuses("δ log det G, sign", &rate, &neg(trace(x)));
}
