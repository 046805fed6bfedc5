//! The certificate as text: every identity of the proof, in order, with its two sides.

use super::style;
use crate::algebra::Known;
use crate::derive::Derivation;
use crate::print::{Format, expression};

/// The steps of the proof as lines of plain text.
pub fn proof(d: &Derivation) -> String {
    let st = style(d);
    let show = |e: &crate::expr::Expr| expression(e, &d.letters.symbols, &st, Format::Text);
    let mut out = String::from(
        "Proof. Each step is an identity for all variations, of which both sides have the same normal form\nor, where it says so, agree at random points in exact arithmetic modulo 2^61 - 1.\n",
    );
    for (i, step) in d.certificate.steps.iter().enumerate() {
        let how = match step.known {
            Known::NormalForm => "",
            Known::ExactEvaluation => " (exact evaluation)",
        };
        out.push_str(&format!("\n{:>3}. {}{how}\n", i + 1, step.name));
        out.push_str(&format!(
            "     {}\n   = {}\n",
            show(&step.left),
            show(&step.right)
        ));
    }
    out
}

/// What equality saturation makes of every step, one text each: the proof by named rules, or why
/// it found none (which refutes nothing).
#[cfg(feature = "egraph")]
pub fn second_proof(d: &Derivation) -> Vec<String> {
    use crate::prove::{Limits, Statement, Verdict, prove};
    let verdict = |step: &crate::derive::certificate::Step| {
        let statement = Statement {
            name: step.name.clone(),
            left: step.left.clone(),
            right: step.right.clone(),
        };
        match prove(&d.letters.symbols, &statement, &Limits::default()) {
            Verdict::Proved { explanation, .. } => {
                format!(
                    "{}: proved\n       {}",
                    step.name,
                    explanation.join("\n       ")
                )
            }
            Verdict::Unproved { reason, .. } => format!("{}: unproved, {reason}", step.name),
        }
    };
    d.certificate.steps.iter().map(verdict).collect()
}
