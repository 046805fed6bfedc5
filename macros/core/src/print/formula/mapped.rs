//! Traversal of formulas: replaces or visits their expressions, with one match arm for each kind.

use super::Formula;
use crate::expr::Expr;

impl Formula {
    /// Replaces every expression in the formula, in order.
    pub fn mapped(&self, go: &mut dyn FnMut(&Expr) -> Expr) -> Formula {
        let mut one = |f: &Formula| Box::new(f.mapped(go));
        match self {
            Formula::Expr(e) => Formula::Expr(go(e)),
            Formula::Name { .. } | Formula::Gradient { .. } | Formula::Text(_) => self.clone(),
            Formula::Relation(list, relation) => Formula::Relation(all(list, go), *relation),
            Formula::Sum(list) => Formula::Sum(all(list, go)),
            Formula::Product(list) => Formula::Product(all(list, go)),
            Formula::List(list) => Formula::List(all(list, go)),
            Formula::Rows(list) => Formula::Rows(all(list, go)),
            Formula::Sequence(list) => Formula::Sequence(all(list, go)),
            Formula::Matrix(rows) => Formula::Matrix(rows.iter().map(|r| all(r, go)).collect()),
            Formula::Diff(a, b) => Formula::Diff(one(a), one(b)),
            Formula::Neg(a) => Formula::Neg(one(a)),
            Formula::Quotient(a, b) => Formula::Quotient(one(a), one(b)),
            Formula::Power(a, q) => Formula::Power(one(a), *q),
            Formula::Transpose(a) => Formula::Transpose(one(a)),
            Formula::Inverse(a) => Formula::Inverse(one(a)),
            Formula::Dot(a, b) => Formula::Dot(one(a), one(b)),
            Formula::Cross(a, b) => Formula::Cross(one(a), one(b)),
            Formula::Diamond(a, b) => Formula::Diamond(one(a), one(b)),
            Formula::Bracket(a, b) => Formula::Bracket(one(a), one(b)),
            Formula::Pairing(a, b) => Formula::Pairing(one(a), one(b)),
            Formula::Ad { group, argument } => Formula::Ad {
                group: one(group),
                argument: one(argument),
            },
            Formula::AdStar { group, momentum } => Formula::AdStar {
                group: one(group),
                momentum: one(momentum),
            },
            Formula::LieAdStar { algebra, momentum } => Formula::LieAdStar {
                algebra: one(algebra),
                momentum: one(momentum),
            },
            Formula::Rate(a) => Formula::Rate(one(a)),
            Formula::Continuous(a) => Formula::Continuous(one(a)),
            Formula::Variation(a) => Formula::Variation(one(a)),
            Formula::Tangent { parameter, of } => Formula::Tangent {
                parameter: parameter.clone(),
                of: one(of),
            },
            Formula::Operator(operator, a) => Formula::Operator(*operator, one(a)),
            Formula::HatOf(a) => Formula::HatOf(one(a)),
            Formula::Norm(a) => Formula::Norm(one(a)),
            Formula::Grouped(a) => Formula::Grouped(one(a)),
            Formula::Apply {
                function,
                arguments,
            } => Formula::Apply {
                function: one(function),
                arguments: all(arguments, go),
            },
            Formula::SumOver {
                index,
                from,
                to,
                of,
            } => Formula::SumOver {
                index: index.clone(),
                from: from.clone(),
                to: to.clone(),
                of: one(of),
            },
        }
    }

    /// Visits the bases of all names in the formula that are not symbols.
    pub fn each_name(&self, visit: &mut dyn FnMut(&str)) {
        let mut below: Vec<&Formula> = vec![self];
        while let Some(f) = below.pop() {
            if let Formula::Name { base, .. } = f {
                visit(base);
            }
            below.extend(f.children());
        }
    }

    fn children(&self) -> Vec<&Formula> {
        match self {
            Formula::Expr(_)
            | Formula::Name { .. }
            | Formula::Gradient { .. }
            | Formula::Text(_) => Vec::new(),
            Formula::Relation(list, _)
            | Formula::Sum(list)
            | Formula::Product(list)
            | Formula::List(list)
            | Formula::Rows(list)
            | Formula::Sequence(list) => list.iter().collect(),
            Formula::Matrix(rows) => rows.iter().flatten().collect(),
            Formula::Diff(a, b)
            | Formula::Quotient(a, b)
            | Formula::Dot(a, b)
            | Formula::Cross(a, b)
            | Formula::Diamond(a, b)
            | Formula::Bracket(a, b)
            | Formula::Pairing(a, b)
            | Formula::Ad {
                group: a,
                argument: b,
            }
            | Formula::AdStar {
                group: a,
                momentum: b,
            }
            | Formula::LieAdStar {
                algebra: a,
                momentum: b,
            } => vec![a, b],
            Formula::Neg(a)
            | Formula::Power(a, _)
            | Formula::Transpose(a)
            | Formula::Inverse(a)
            | Formula::Rate(a)
            | Formula::Continuous(a)
            | Formula::Variation(a)
            | Formula::Operator(_, a)
            | Formula::HatOf(a)
            | Formula::Norm(a)
            | Formula::Grouped(a)
            | Formula::Tangent { of: a, .. }
            | Formula::SumOver { of: a, .. } => vec![a],
            Formula::Apply {
                function,
                arguments,
            } => [&**function].into_iter().chain(arguments).collect(),
        }
    }

    /// Visits every expression in the formula, in order.
    pub fn each_expression(&self, visit: &mut dyn FnMut(&Expr)) {
        self.mapped(&mut |e| {
            visit(e);
            e.clone()
        });
    }
}

fn all(list: &[Formula], go: &mut dyn FnMut(&Expr) -> Expr) -> Vec<Formula> {
    list.iter().map(|f| f.mapped(go)).collect()
}
