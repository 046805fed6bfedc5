//! The certificate rejects wrong derivations. Each test changes one part of a correct derivation, as an error in the
//! engine would, and asserts that no certificate is given.

use super::{Inputs, certify};
use crate::algebra::Algebra;
use crate::derive::Derivation;
use crate::expr::{self, Expr};
use crate::pipeline::derive_source;

const MODELS: [(&str, &str); 5] = [
    (
        "body side",
        "model M { param J: Sym<3>; param g: Vec<3>; group G: SO<3> velocity W; advected a: Vec<3>; \
         constraint next(G) = G*W; constraint next(a) = W^T*a; \
         lagrangian = -tr(J*W)/h - h*dot(g, a); }",
    ),
    (
        "spatial side",
        "model M { param g: Vec<3>; group G: SO<3> velocity w; advected J: Sym<3>; \
         constraint next(G) = w*G; constraint next(J) = w*J*w^T; \
         lagrangian = -tr(w*J)/h - h*dot(g, J*g); }",
    ),
    (
        "linear maps",
        "model M { param J: Sym<3>; group G: GL<3> velocity W; advected S: Sym<3>; \
         constraint next(G) = G*W; constraint next(S) = W^T*S*W; \
         lagrangian = tr((W - Id)*J*(W - Id)^T)/(2*h) - h*tr(J*S); }",
    ),
    (
        "unit quaternions",
        "model M { param I: Sym<3>; param g: Vec<3>; group q: SU<2> velocity W; advected a: Vec<3>; \
         constraint next(q) = q*W; constraint next(a) = rot(W)^T*a; \
         lagrangian = 2*dot(im(W), I*im(W))/h - h*dot(g, a); }",
    ),
    (
        "rigid motions",
        "model M { param J: Sym<3>; param b: Vec<4>; group G: SE<3> velocity V; advected P: Vec<4>; \
         constraint next(G) = G*V; constraint next(P) = V^T*P; \
         let u = (pos(V) - pos(V^-1))/2; \
         lagrangian = -tr(J*rot(V))/h + dot(u, u)/(2*h) - h*dot(b, P); }",
    ),
];

/// The reason for the rejection; None if the derivation is certified.
fn refusal(d: &Derivation) -> Option<String> {
    let algebra = Algebra::new(&d.letters.symbols);
    let certificate = certify(&Inputs {
        spec: &d.spec,
        letters: &d.letters,
        action: &d.action,
        variations: &d.variations,
        balances: &d.balances,
        relations: &d.relations,
        momenta: &d.momenta,
        algebra: &algebra,
    });
    certificate.err().map(|e| e.to_string())
}

fn opposite(e: &mut Expr) {
    *e = expr::neg(e.clone());
}

fn doubled(e: &mut Expr) {
    *e = expr::scale(crate::algebra::Rational::integer(2), e.clone());
}

/// The description of a mistake, and the change that introduces it.
type Mistake = (&'static str, fn(&mut Derivation));

/// One mistake for each part of a derivation.
fn mistakes() -> Vec<Mistake> {
    vec![
        ("the outgoing velocity varies the other way", |d| {
            opposite(&mut d.variations[0].outgoing.1);
        }),
        ("the incoming velocity varies the other way", |d| {
            opposite(&mut d.variations[0].incoming.1);
        }),
        ("the quantity varies the other way", |d| {
            opposite(&mut d.variations[0].advected[0].1);
        }),
        ("the element varies twice as much", |d| {
            doubled(&mut d.variations[0].element.1);
        }),
        ("the variation on the outgoing edge", |d| {
            opposite(&mut d.balances[0].variation_out);
        }),
        ("the variation on the incoming edge", |d| {
            opposite(&mut d.balances[0].variation_in);
        }),
        ("the outgoing balance", |d| {
            doubled(&mut d.balances[0].outgoing)
        }),
        ("the incoming balance", |d| {
            doubled(&mut d.balances[0].incoming)
        }),
        ("the node term of the outgoing balance", |d| {
            opposite(&mut d.balances[0].node_out);
        }),
        ("the node term of the incoming balance", |d| {
            opposite(&mut d.balances[0].node_in);
        }),
        ("the momentum at the start", |d| {
            opposite(&mut d.momenta[0].start)
        }),
        ("the momentum at the end", |d| {
            opposite(&mut d.momenta[0].end)
        }),
        ("the momentum map", |d| doubled(&mut d.momenta[0].cotangent)),
        ("the diamond", |d| opposite(&mut d.momenta[0].diamonds[0])),
        ("the relation of the element", |d| {
            doubled(&mut d.relations[0].gradient)
        }),
        ("the relation of the quantity", |d| {
            doubled(&mut d.relations[1].gradient)
        }),
        ("the relation of the velocity", |d| {
            doubled(&mut d.relations[2].gradient)
        }),
        ("the relation of the velocity is missing", |d| {
            d.relations.truncate(2);
        }),
        ("the action has another sign", |d| {
            opposite(&mut d.action.total)
        }),
    ]
}

#[test]
fn every_mistake_of_a_derivation_is_refused() {
    for (name, model) in MODELS {
        let d = derive_source(model).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(refusal(&d), None, "{name}");
        for (what, falsify) in mistakes() {
            let mut wrong = d.clone();
            falsify(&mut wrong);
            let message = refusal(&wrong).unwrap_or_default();
            assert!(
                message.contains("cannot prove") && message.contains("remains"),
                "{name}, {what}: {message:?}"
            );
        }
    }
}

#[test]
fn what_the_proof_was_of_is_told_where_it_fails() {
    let (_, model) = MODELS[0];
    let mut d = derive_source(model).unwrap_or_else(|e| panic!("{e}"));
    opposite(&mut d.momenta[0].start);
    let message = refusal(&d).unwrap_or_default();
    assert!(
        message.contains("momentum map of the outgoing edge of G"),
        "{message}"
    );
}
