//! Fields of an unreduced statement: `X + ΔX` replaces `next(X)`, and differences are expressed by the increment.
//! Takes the terms of an edge; gives them in increments and values at its start.

use crate::algebra::Algebra;
use crate::check::spec::Spec;
use crate::derive::action::{split, summands};
use crate::derive::balance::shorter;
use crate::derive::intermediate_positions;
use crate::derive::variation::at;
use crate::expr::shape::Shape;
use crate::expr::symbol::{Role, SymbolId, Symbols};

use crate::expr::{self, Expr, Letter, Node, Shift};

/// The size of the largest sum that is searched for cancellation.
const LARGEST: u32 = 60;

/// The values of fields at the end of an edge.
pub(super) fn ends(spec: &Spec) -> Vec<(Letter, Expr)> {
    let list = spec.configurations.iter().filter(|c| c.group.is_additive());
    list.map(|c| (at(c.element, Shift::NEXT), c.update.clone()))
        .collect()
}

/// The expression with these substitutions.
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

/// The Lagrangian in which terms with negative powers of the step size are combined if values of fields cancel
/// between them, as in `X'·X'/(2 h) - X'·X/h + X·X/(2 h)`. Separately, each would exert a force of order `1/h` on the
/// momentum.
pub(super) fn gathered(spec: &Spec, algebra: &Algebra, ends: &[(Letter, Expr)]) -> Expr {
    let s = &spec.symbols;
    let fields = spec.configurations.iter().filter(|c| c.group.is_additive());
    let fields: Vec<SymbolId> = fields.map(|c| c.element).collect();
    let values = |e: &Expr| {
        let letters = expr::letters(e);
        letters
            .iter()
            .filter(|l| fields.contains(&l.symbol))
            .count()
    };
    let terms = summands(s, &spec.lagrangian).into_iter();
    let (apart, others): (Vec<Expr>, Vec<Expr>) = terms
        .partition(|t| is_singular(s, t) && values(&by_increments(spec, algebra, ends, t)) > 0);
    if apart.len() < 2 || apart.len() > LARGEST as usize {
        return spec.lagrangian.clone();
    }
    let stated = expr::substitute(s, &expr::sum(apart, Shape::SCALAR), ends);
    let short = algebra.shortest(&stated);
    let together = intermediate_positions::reduced(algebra, &stated, &short).unwrap_or(short);
    // A remainder at a node would be taken for a term that was stated there, and divided between its edges.
    let stays = split(s, &together).1.is_zero();
    match !algebra.exhausted() && stays && values(&together) < values(&stated) {
        true => expr::sum(others.into_iter().chain([together]), Shape::SCALAR),
        false => spec.lagrangian.clone(),
    }
}

/// Whether it is divided by the step size.
pub(crate) fn is_singular(s: &Symbols, e: &Expr) -> bool {
    let holds_step = |e: &Expr| expr::contains_role(s, e, Role::Step);
    match e.node() {
        Node::Quotient(a, b) => holds_step(b) || is_singular(s, a),
        Node::Power(a, q) => q.value() < 0.0 && holds_step(a) || is_singular(s, a),
        Node::Neg(a) => is_singular(s, a),
        Node::Product(factors) => factors.iter().any(|f| is_singular(s, f)),
        Node::Sum(terms) => terms.iter().any(|t| is_singular(s, t)),
        _ => false,
    }
}

/// Simplifies sums in which values cancel, `X + ΔX - X`.
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
