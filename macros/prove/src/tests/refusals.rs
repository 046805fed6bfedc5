//! Statements that are not searched, and the reasons that are reported.

use super::Desk;
use crate::{Limits, Statement, Verdict, prove};
use clebsch_core::expr::*;

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
    d.refuses(
        "eight, one exchanged",
        &some(&[0, 1, 2, 3, 4, 5, 6, 7]),
        &some(&[8, 6, 5, 4, 3, 2, 1, 0]),
    );
    // Nine shared summands leave nothing to search.
    let nine = some(&[0, 1, 2, 3, 4, 5, 6, 7, 8]);
    let reversed = some(&[8, 7, 6, 5, 4, 3, 2, 1, 0]);
    match d.verdict("nine, reversed", &nine, &reversed) {
        Verdict::Proved { explanation, .. } => {
            assert_eq!(
                explanation[0],
                "9 summands stand on both sides and are taken from both \
                 (A1, A2, A3, A4, A5, A6, A7, A8, A9); what is left:"
            );
            assert_eq!(explanation[1], "0");
        }
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
    let Verdict::Proved { explanation, .. } = first else {
        panic!("{first:?}");
    };
    assert_eq!(explanation[0], "Ω^T (J Ω^T - Ω J) Ω");
    assert_eq!(
        explanation[1],
        "= Ω^T ((J Ω^T) Ω + (-Ω J) Ω)    [product of a sum]"
    );
}

#[test]
fn limits_end_a_search() {
    let mut d = Desk::default();
    let [a, b, c] = ["a", "b", "c"].map(|n| d.vector(n));
    let statement = Statement {
        name: "double cross".into(),
        left: cross(a.clone(), cross(b.clone(), c.clone())),
        right: sub(mul(dot(a.clone(), c.clone()), b.clone()), mul(dot(a, b), c)),
    };
    let usual = Limits::default();
    let tight = [
        (Limits { nodes: 20, ..usual }, "node limit"),
        (
            Limits {
                iterations: 2,
                ..usual
            },
            "iteration limit",
        ),
        (
            Limits {
                summands: 1,
                ..usual
            },
            "2 summands",
        ),
    ];
    for (limits, why) in tight {
        match prove(&d.symbols, &statement, &limits) {
            Verdict::Unproved { reason, .. } => assert!(reason.contains(why), "{reason}"),
            Verdict::Proved { .. } => panic!("proved within the {why}"),
        }
    }
    assert!(prove(&d.symbols, &statement, &usual).is_proved());
}
