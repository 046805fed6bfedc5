//! Identities of matrices and of scalars built from them: transposes, traces, inverses, quotients.

use super::Desk;
use crate::conditions::{Value, put};
use crate::language::{Leaf, Term};
use crate::{Limits, prove_terms};
use clebsch_core::algebra::Rational;
use clebsch_core::expr::shape::{Shape, Structure};
use clebsch_core::expr::symbol::Role;
use clebsch_core::expr::*;
use egg::{PatternAst, RecExpr, Var};

/// A term with `?name` for letters. An expression cannot represent a transposed product, since its constructors move
/// transposes to the leaves.
fn term(text: &str, letters: &[(&str, &Expr)]) -> RecExpr<Term> {
    let pattern: PatternAst<Term> = text.parse().unwrap();
    let values: Vec<(Var, Value)> = letters
        .iter()
        .map(|(name, e)| {
            let Node::Letter(at) = e.node() else {
                panic!("not a letter")
            };
            (
                name.parse().unwrap(),
                Value::Leaf(Leaf::Letter(*at, e.shape())),
            )
        })
        .collect();
    RecExpr::try_from(put(&pattern, &values)).unwrap()
}

#[test]
fn transpose_of_a_conjugation() {
    let mut d = Desk::default();
    let (o, a) = (d.rotation("O"), d.general("A"));
    let letters = [("?o", &o), ("?a", &a)];
    let left = term("(T (* (T ?o) (* ?a ?o)))", &letters);
    let right = term("(* (T ?o) (* (T ?a) ?o))", &letters);
    let wrong = term("(* (T ?o) (* ?a ?o))", &letters);
    let limits = Limits::default();
    let v = prove_terms(&d.symbols, &left, &right, None, &limits);
    assert!(v.is_proved());
    assert!(!prove_terms(&d.symbols, &left, &wrong, None, &limits).is_proved());
}

#[test]
fn traces_are_cyclic_and_blind_to_transposition() {
    let mut d = Desk::default();
    let [a, b, c, x, y] = ["A", "B", "C", "D", "E"].map(|n| d.general(n));
    let letters = [("?a", &a), ("?b", &b), ("?c", &c), ("?d", &x), ("?e", &y)];
    let left = term("(tr (* ?a (* ?b (* ?c (* ?d ?e)))))", &letters);
    let right = term("(tr (T (* ?c (* ?d (* ?e (* ?a ?b))))))", &letters);
    let v = prove_terms(&d.symbols, &left, &right, None, &Limits::default());
    assert!(v.is_proved());
    let three = trace(product([a.clone(), b.clone(), c.clone()]));
    let turned = d.t(&product([c.clone(), a.clone(), b.clone()]));
    d.proves("three factors", &three, &trace(turned));
    let exchanged = trace(product([b, a, c]));
    d.refuses("exchanged factors", &three, &exchanged);
}

#[test]
fn symmetric_against_skew() {
    let mut d = Desk::default();
    let (j, x, m, g) = (
        d.symmetric("J"),
        d.skew("ξ"),
        d.general("M"),
        d.rotation("Ω"),
    );
    d.proves(
        "tr(J ξ) = 0",
        &trace(mul(j.clone(), x.clone())),
        &integer(0),
    );
    let conjugated = trace(product([d.t(&m), j.clone(), m.clone(), x.clone()]));
    d.proves("tr(M^T J M ξ) = 0", &conjugated, &integer(0));
    d.refuses(
        "tr(M ξ) = 0",
        &trace(mul(m.clone(), x.clone())),
        &integer(0),
    );
    let part = part(Part::Skew, m.clone());
    let left = trace(mul(d.t(&m), x.clone()));
    d.proves(
        "pairing sees the skew part",
        &left,
        &trace(mul(neg(part), x.clone())).clone(),
    );
    d.refuses("tr(J Ω) = 0", &trace(mul(j, g)), &integer(0));
}

#[test]
fn linear_groups_of_any_dimension() {
    let mut d = Desk::default();
    let n = d.symbols.add_dim("n", 3, 4);
    let mut square =
        |name: &str, structure| d.letter(name, Shape::square(n), structure, Role::Parameter);
    let (g, c) = (
        square("G", Structure::Invertible),
        square("C", Structure::Symmetric),
    );
    let gt = d.t(&g);
    let s = &d.symbols;
    let carried = product([gt.clone(), c.clone(), g.clone()]);
    let ig = inverse(s, g.clone());
    d.proves("G G^-1 C", &product([g.clone(), ig.clone(), c.clone()]), &c);
    let both = mul(power(det(g.clone()), Rational::integer(2)), det(c.clone()));
    d.proves("det(G^T C G)", &det(carried.clone()), &both);
    d.proves(
        "det of an inverse",
        &mul(det(ig), det(g.clone())),
        &integer(1),
    );
    d.refuses(
        "det(G^T C G), one factor lost",
        &det(carried),
        &mul(det(g), det(c)),
    );
}

#[test]
fn quotients_of_numbers() {
    let mut d = Desk::default();
    let [a, b, c, e, h] = ["a", "b", "c", "e", "h"].map(|n| d.scalar(n));
    let left = add(
        quotient(a.clone(), b.clone()),
        quotient(c.clone(), e.clone()),
    );
    let top = add(mul(a.clone(), e.clone()), mul(b.clone(), c.clone()));
    let bottom = mul(b.clone(), e.clone());
    d.proves(
        "common denominator",
        &left,
        &quotient(top.clone(), bottom.clone()),
    );
    d.refuses(
        "common denominator, sign",
        &left,
        &quotient(neg(top), bottom),
    );
    let m = d.general("M");
    let scaled = quotient(mul(mul(h.clone(), h.clone()), m.clone()), h.clone());
    d.proves("h^2 M / h", &scaled, &mul(h, m));
    let square = power(add(a.clone(), b.clone()), Rational::integer(2));
    let two = Rational::integer(2);
    let binomial = sum(
        [
            power(a.clone(), two),
            product([integer(2), a, b.clone()]),
            power(b, two),
        ],
        Shape::SCALAR,
    );
    d.proves("binomial", &square, &binomial);
}
