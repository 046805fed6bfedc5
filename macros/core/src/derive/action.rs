//! The action of one step: the Lagrangian, with its purely nodal terms (potentials) distributed over the two adjacent
//! edges by the model's node rule.

use crate::algebra::Rational;
use crate::check::spec::Spec;
use crate::expr::shape::Shape;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Node, Shift};
use crate::syntax::ast::NodeRule;

/// The action of the step from node k to node k+1 and its parts.
#[derive(Clone, Debug)]
pub struct Action {
    /// The whole action of the step, with nodal terms distributed.
    pub total: Expr,
    /// Terms that involve a velocity or both ends of the edge.
    pub edge: Expr,
    /// Purely nodal terms at node k, before distribution.
    pub nodal: Expr,
    /// The nodal terms, distributed over the two ends of the edge.
    pub distributed: Expr,
}

/// Splits the Lagrangian and distributes its nodal terms.
pub fn action(spec: &Spec) -> Action {
    let symbols = &spec.symbols;
    let (edge, nodal) = match &spec.reduction {
        // The terms were assigned to edge and node in the form of the statement.
        Some(r) => (r.edge.clone(), r.nodal.clone()),
        None => split(symbols, &spec.lagrangian),
    };
    let next = expr::shift_time(symbols, &nodal, Shift::NEXT.time);
    let distributed = match spec.node_rule {
        NodeRule::Outgoing => nodal.clone(),
        NodeRule::Incoming => next,
        NodeRule::Symmetric => {
            let halves = summands(symbols, &nodal)
                .into_iter()
                .chain(summands(symbols, &next));
            expr::sum(
                halves
                    .map(|t| expr::scale(Rational::HALF, t))
                    .collect::<Vec<_>>(),
                Shape::SCALAR,
            )
        }
    };
    Action {
        total: expr::add(edge.clone(), distributed.clone()),
        edge,
        nodal,
        distributed,
    }
}

/// The terms of the edge, and the terms at one node, moved to node k. Constants are dropped.
pub fn split(symbols: &Symbols, lagrangian: &Expr) -> (Expr, Expr) {
    let (mut edge, mut nodal) = (Vec::new(), Vec::new());
    for term in summands(symbols, lagrangian) {
        match place(symbols, &term) {
            Place::Constant => {}
            Place::Node(level) => nodal.push(expr::shift_time(symbols, &term, -level)),
            Place::Edge => edge.push(term),
        }
    }
    let sum = |terms: Vec<Expr>| expr::sum(terms, Shape::SCALAR);
    (sum(edge), sum(nodal))
}

/// The edge or node of a term.
enum Place {
    /// Constants only: no variation changes it.
    Constant,
    /// At one node, at this time level.
    Node(i8),
    /// On the edge.
    Edge,
}

fn place(symbols: &Symbols, term: &Expr) -> Place {
    let mut level = None;
    for l in expr::letters(term) {
        match symbols.get(l.symbol).role {
            Role::Velocity => return Place::Edge,
            Role::Element | Role::Advected => match level {
                None => level = Some(l.shift.time),
                Some(t) if t != l.shift.time => return Place::Edge,
                Some(_) => {}
            },
            Role::Step | Role::Parameter | Role::Multiplier | Role::Variation | Role::Derived => {}
        }
    }
    level.map_or(Place::Constant, Place::Node)
}

/// The summands of a scalar, with common factors and divisors of a sum multiplied in. A difference in time under a
/// factor or over a divisor stays one term, as in `x*(next(y) - y)`: if it were split, the nodal part would move to
/// another edge, with half of the momentum.
pub fn summands(symbols: &Symbols, e: &Expr) -> Vec<Expr> {
    match e.node() {
        Node::Sum(terms) => terms.iter().flat_map(|t| summands(symbols, t)).collect(),
        Node::Neg(a) => {
            let terms = summands(symbols, a).into_iter();
            terms.map(expr::neg).collect()
        }
        Node::Quotient(a, b) => {
            let terms = joined(symbols, summands(symbols, a)).into_iter();
            terms.map(|t| expr::quotient(t, b.clone())).collect()
        }
        Node::Product(factors) if factors.iter().all(|f| f.shape().is_scalar()) => {
            // A product of several sums stays one term; only a common factor is multiplied in.
            let mut sums = factors
                .iter()
                .enumerate()
                .filter(|(_, f)| matches!(f.node(), Node::Sum(_) | Node::Quotient(..)));
            let (Some((i, only)), None) = (sums.next(), sums.next()) else {
                return vec![e.clone()];
            };
            let mut terms = joined(symbols, summands(symbols, only));
            let others = factors.iter().enumerate().filter(|(k, _)| *k != i);
            if others.clone().any(|(_, f)| moves(symbols, f)) {
                terms = with_constants(symbols, terms);
            }
            if terms.len() < 2 {
                return vec![e.clone()];
            }
            let with = |t: Expr| {
                let mut rest = factors.clone();
                rest[i] = t;
                expr::product(rest)
            };
            terms.into_iter().map(with).collect()
        }
        _ if e.is_zero() => Vec::new(),
        _ => vec![e.clone()],
    }
}

fn moves(symbols: &Symbols, e: &Expr) -> bool {
    !matches!(place(symbols, e), Place::Constant)
}

/// The terms, with constant terms added to the first term of the edge. In `q^2*(3 - tr(Ω))`, both terms belong to one
/// kinetic energy: if they were split, `3*q^2` would be a term at one node, and half of it would move to another
/// edge.
fn with_constants(symbols: &Symbols, terms: Vec<Expr>) -> Vec<Expr> {
    let is_edge = |t: &Expr| matches!(place(symbols, t), Place::Edge);
    if !terms.iter().any(is_edge) {
        return terms;
    }
    let (mut moving, constant): (Vec<Expr>, Vec<Expr>) =
        terms.into_iter().partition(|t| moves(symbols, t));
    if let Some(edge) = moving.iter_mut().find(|t| is_edge(t)) {
        *edge = expr::sum(
            constant
                .into_iter()
                .chain([edge.clone()])
                .collect::<Vec<_>>(),
            Shape::SCALAR,
        );
    }
    moving
}

/// Adds each term and its negative one step later to one term: `F(next(X)) - F(X)`.
fn joined(symbols: &Symbols, terms: Vec<Expr>) -> Vec<Expr> {
    let mut out: Vec<Expr> = Vec::new();
    let mut left: Vec<Option<Expr>> = terms.into_iter().map(Some).collect();
    for i in 0..left.len() {
        let Some(term) = left[i].take() else {
            continue;
        };
        let Place::Node(level) = place(symbols, &term) else {
            out.push(term);
            continue;
        };
        // The two summands of a difference are evaluated at the two ends of the step.
        let (at, by) = match level {
            0 => (Shift::NEXT.time, Shift::NEXT.time),
            _ => (Shift::HERE.time, -Shift::NEXT.time),
        };
        let opposite = expr::neg(expr::shift_time(symbols, &term, by));
        let partner = left[i + 1..].iter_mut().find(|other| {
            other.as_ref().is_some_and(|other| {
                matches!(place(symbols, other), Place::Node(l) if l == at) && *other == opposite
            })
        });
        out.push(match partner.and_then(Option::take) {
            Some(other) => expr::add(term, other),
            None => term,
        });
    }
    out
}
