//! Fields of an unreduced statement: `next(X)` is put in as `X + ΔX`, and differences are written by the
//! increment. Takes the terms of an edge; gives them in increments and values at its start.

use crate::algebra::Algebra;
use crate::check::spec::Spec;
use crate::derive::balance::shorter;
use crate::derive::variation::at;
use crate::expr::{self, Expr, Letter, Node, Shift};

/// Largest sum that is looked at for what cancels in it.
const LARGEST: u32 = 60;

/// The values of fields at the end of an edge.
pub(super) fn ends(spec: &Spec) -> Vec<(Letter, Expr)> {
    let list = spec.configurations.iter().filter(|c| c.group.is_additive());
    list.map(|c| (at(c.element, Shift::NEXT), c.update.clone()))
        .collect()
}

/// The expression with these put in.
pub(super) fn by_increments(
    spec: &Spec,
    algebra: &Algebra,
    ends: &[(Letter, Expr)],
    e: &Expr,
) -> Expr {
    let put = expr::substitute(&spec.symbols, e, ends);
    let fields = spec.configurations.iter().filter(|c| c.group.is_additive());
    let increments: Vec<Letter> = fields.map(|c| at(c.velocity, Shift::HERE)).collect();
    tidied(spec, algebra, &increments, &put)
}

/// Sums in which values cancel, `X + ΔX - X`.
fn tidied(spec: &Spec, algebra: &Algebra, increments: &[Letter], e: &Expr) -> Expr {
    if !increments.iter().any(|l| expr::contains(e, *l)) {
        return e.clone();
    }
    let e = expr::rebuild(&spec.symbols, e, &mut |x| {
        tidied(spec, algebra, increments, x)
    });
    match e.node() {
        Node::Sum(_) if e.size() <= LARGEST => shorter(algebra, e),
        _ => e,
    }
}
