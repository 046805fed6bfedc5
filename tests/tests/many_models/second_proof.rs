//! Proves the certificate again by equality saturation, which shares no code with the normal form. Covers the steps of every
//! gallery model. Steps that the search cannot finish are listed with a reason, and no step with a flipped sign is ever proved.

use clebsch_core::expr::symbol::Symbols;
use clebsch_core::expr::{self, Expr, Node};
use clebsch_core::{Derivation, derive_source};
use clebsch_prove::{Limits, Statement, Verdict, prove};

fn derivations() -> impl Iterator<Item = (&'static str, Derivation)> {
    let gallery = clebsch_models::gallery().into_iter();
    gallery.map(|e| (e.card.kebab, derive_source(e.card.source).unwrap()))
}

fn verdict(d: &Derivation, name: &str, left: &Expr, right: &Expr) -> Verdict {
    let statement = Statement {
        name: name.to_owned(),
        left: left.clone(),
        right: right.clone(),
    };
    prove(&d.letters.symbols, &statement, &Limits::default())
}

#[test]
fn every_step_of_the_gallery_is_proved_or_reported() {
    let mut report = String::new();
    for (model, d) in derivations() {
        for step in &d.certificate.steps {
            let said = match verdict(&d, &step.name, &step.left, &step.right) {
                Verdict::Proved { explanation, .. } => {
                    assert!(!explanation.is_empty(), "{}", step.name);
                    "proved".to_owned()
                }
                Verdict::Unproved { reason, .. } => format!("unproved: {reason}"),
            };
            report.push_str(&format!("{model}: {}: {said}\n", step.name));
        }
    }
    insta::assert_snapshot!(report);
}

/// Copies of the expression with the sign of one summand flipped, for each summand of each sum. Without a sum, the whole expression
/// is negated.
fn flipped(symbols: &Symbols, e: &Expr) -> Vec<Expr> {
    let inside = inside(symbols, e);
    if inside.is_empty() && !e.is_zero() {
        return vec![expr::neg(e.clone())];
    }
    inside
}

fn inside(symbols: &Symbols, e: &Expr) -> Vec<Expr> {
    let mut all = Vec::new();
    if let Node::Sum(terms) = e.node() {
        for i in 0..terms.len() {
            let mut terms = terms.clone();
            terms[i] = expr::neg(terms[i].clone());
            all.push(expr::sum(terms, e.shape()));
        }
    }
    for (i, child) in e.children().into_iter().enumerate() {
        for wrong in inside(symbols, child) {
            let mut at = 0;
            all.push(expr::rebuild(symbols, e, &mut |c| {
                at += 1;
                match at == i + 1 {
                    true => wrong.clone(),
                    false => c.clone(),
                }
            }));
        }
    }
    all
}

/// Flips one in this many signs, because an attempt to prove a false step uses its full time limit.
const SIGNS: usize = 9;

#[test]
fn a_flipped_sign_is_never_proved() {
    let mut tried = 0;
    for (model, d) in derivations() {
        for step in &d.certificate.steps {
            for wrong in flipped(&d.letters.symbols, &step.left)
                .into_iter()
                .step_by(SIGNS)
            {
                let verdict = verdict(&d, &step.name, &wrong, &step.right);
                assert!(!verdict.is_proved(), "{model}: {}", step.name);
                tried += 1;
            }
        }
    }
    println!("{tried} signs were flipped");
    assert!(tried >= 40, "only {tried} signs were flipped");
}
