//! The equations among a model's assumptions that proofs may use. Takes a checked model; gives expressions that
//! vanish for every admitted choice of parameters.

use crate::algebra::assumed;
use crate::check::spec::Spec;
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr};
use crate::syntax::ast::Comparison;

/// Left sides minus right sides. Equations that exact points cannot satisfy are omitted; a result without an
/// assumption also holds with it.
pub(crate) fn equations(spec: &Spec, symbols: &Symbols) -> Vec<Expr> {
    let mut out: Vec<Expr> = Vec::new();
    for a in &spec.assumptions {
        if a.relation != Comparison::Equal || out.len() == assumed::MOST {
            continue;
        }
        out.push(expr::sub(a.left.clone(), a.right.clone()));
        if !assumed::reachable(symbols, &out) {
            out.pop();
        }
    }
    out
}
