//! What is not searched, and how that is answered.

use super::Desk;
use crate::expr::*;
use crate::prove::{Limits, Statement, Verdict, prove};

#[test]
fn reordered_sums_up_to_the_limit() {
    let mut d = Desk::default();
    let list: Vec<Expr> = (1..=9).map(|i| d.general(&format!("A{i}"))).collect();
    let shape = list[0].shape();
    let some = |order: &[usize]| sum(order.iter().map(|i| list[*i].clone()), shape);
    d.proves(
        "eight, reversed",
        &some(&[0, 1, 2, 3, 4, 5, 6, 7]),
        &some(&[7, 6, 5, 4, 3, 2, 1, 0]),
    );
    let reason = d.refuses(
        "eight, one exchanged",
        &some(&[0, 1, 2, 3, 4, 5, 6, 7]),
        &some(&[8, 6, 5, 4, 3, 2, 1, 0]),
    );
    eprintln!("{reason}");
    // Nine that are all shared leave nothing to search.
    let nine = some(&[0, 1, 2, 3, 4, 5, 6, 7, 8]);
    let lines = d.verdict("nine, reversed", &nine, &some(&[8, 7, 6, 5, 4, 3, 2, 1, 0]));
    match lines {
        Verdict::Proved { explanation, .. } => assert!(explanation[0].starts_with("9 summands")),
        Verdict::Unproved { reason, .. } => panic!("{reason}"),
    }
}

#[test]
fn many_different_summands_are_not_searched() {
    let mut d = Desk::default();
    let list: Vec<Expr> = (1..=9).map(|i| d.general(&format!("A{i}"))).collect();
    let o = d.rotation("O");
    let shape = list[0].shape();
    let left = mul(o.clone(), sum(list.clone(), shape));
    let right = sum(list.iter().rev().map(|a| mul(o.clone(), a.clone())), shape);
    match d.verdict("nine products", &left, &right) {
        Verdict::Unproved {
            reason,
            nodes: 0,
            iterations: 0,
        } => {
            assert!(reason.contains("9 summands"), "{reason}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn shapes_must_agree() {
    let mut d = Desk::default();
    let (a, v) = (d.general("A"), d.vector("v"));
    assert_eq!(
        d.refuses("shapes", &a, &v),
        "the two sides have different shapes"
    );
}

#[test]
fn answers_repeat() {
    let mut d = Desk::default();
    let (o, j) = (d.rotation("Ω"), d.symmetric("J"));
    let statement = Statement {
        name: "recursion".into(),
        left: product([
            d.t(&o),
            sub(mul(j.clone(), d.t(&o)), mul(o.clone(), j.clone())),
            o.clone(),
        ]),
        right: sub(mul(d.t(&o), j.clone()), mul(j, o)),
    };
    let first = prove(&d.symbols, &statement, &Limits::default());
    let second = prove(&d.symbols, &statement, &Limits::default());
    assert_eq!(first, second);
    if let Verdict::Proved { explanation, .. } = first {
        eprintln!("{}", explanation.join("\n"));
    }
}
