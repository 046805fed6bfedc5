//! Prints the certificate as text: every identity of the proof, in order, with its two sides.

use super::style;
use crate::algebra::Decision;
use crate::derive::Derivation;
use crate::print::{Format, expression};

/// The steps of the proof as lines of plain text.
pub fn proof(d: &Derivation) -> String {
    let st = style(d);
    let show = |e: &crate::expr::Expr| expression(e, &d.letters.symbols, &st, Format::Text);
    let mut out = String::from(
        "Proof. Each step is an identity for all variations. Both sides have the same normal form\nor, where stated, agree at random points in exact arithmetic modulo 2^61 - 1.\n",
    );
    for (i, step) in d.certificate.steps.iter().enumerate() {
        let how = match step.known {
            Decision::NormalForm => "",
            Decision::ExactEvaluation => " (exact evaluation)",
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
