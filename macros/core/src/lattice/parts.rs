//! The parts of an expression as it was typed, and the sums over sites among them.

use crate::syntax::ast::{Expression, Kind, Model, Statement};

/// Functions that are linear in each of their arguments.
pub(super) const LINEAR: [&str; 12] = [
    "dot", "cross", "hat", "vee", "tr", "Tr", "sym", "skew", "diag", "perp", "re", "im",
];

/// The summand of a call of `sum`.
pub(super) fn summand(e: &Expression) -> Option<&Expression> {
    match &e.kind {
        Kind::Call(f, arguments) if f.text == "sum" => arguments.first(),
        _ => None,
    }
}

/// Whether an expression contains a sum over sites.
pub(super) fn has_sum(e: &Expression) -> bool {
    summand(e).is_some() || parts(e).into_iter().any(has_sum)
}

/// Whether a model has a constraint, and a sum over sites in a constraint or in a `let` that a constraint may use.
pub(crate) fn holds_sums(model: &Model) -> bool {
    let holds = |s: &Statement| matches!(s, Statement::Hold { .. });
    let sums = |s: &Statement| {
        matches!(s, Statement::Hold { .. } | Statement::Let { .. })
            && s.expressions().into_iter().any(has_sum)
    };
    model.statements.iter().any(holds) && model.statements.iter().any(sums)
}

/// The direct subexpressions of an expression.
pub(super) fn parts(e: &Expression) -> Vec<&Expression> {
    match &e.kind {
        Kind::Number(_) | Kind::Constant(_) | Kind::Name(_) => Vec::new(),
        Kind::Shaped(a, _)
        | Kind::Neg(a)
        | Kind::Transpose(a)
        | Kind::Power(a, _)
        | Kind::Component(a, _) => vec![a],
        Kind::Quotient(a, b) => vec![a, b],
        Kind::Sum(terms) => terms.iter().map(|(_, t)| t).collect(),
        Kind::Product(list) | Kind::Call(_, list) => list.iter().collect(),
    }
}

/// The expression with other subexpressions, in the order of [`parts`].
pub(super) fn with_parts(e: &Expression, mut new: impl Iterator<Item = Expression>) -> Expression {
    let mut one = |a: &Expression| Box::new(new.next().unwrap_or_else(|| a.clone()));
    let kind = match &e.kind {
        Kind::Number(_) | Kind::Constant(_) | Kind::Name(_) => e.kind.clone(),
        Kind::Shaped(a, shape) => Kind::Shaped(one(a), shape.clone()),
        Kind::Neg(a) => Kind::Neg(one(a)),
        Kind::Transpose(a) => Kind::Transpose(one(a)),
        Kind::Power(a, q) => Kind::Power(one(a), *q),
        Kind::Component(a, indices) => Kind::Component(one(a), indices.clone()),
        Kind::Quotient(a, b) => Kind::Quotient(one(a), one(b)),
        Kind::Sum(terms) => Kind::Sum(terms.iter().map(|(m, t)| (*m, *one(t))).collect()),
        Kind::Product(list) => Kind::Product(list.iter().map(|t| *one(t)).collect()),
        Kind::Call(f, list) => Kind::Call(f.clone(), list.iter().map(|t| *one(t)).collect()),
    };
    let place = e.place;
    Expression { kind, place }
}

/// The names in the expression.
pub(super) fn names(e: &Expression) -> Vec<&str> {
    match &e.kind {
        Kind::Name(n) => vec![n],
        _ => parts(e).into_iter().flat_map(names).collect(),
    }
}
