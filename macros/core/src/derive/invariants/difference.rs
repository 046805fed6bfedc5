//! Total differences: the action of a step may change under a symmetry by `F(end) - F(start)`, as terms
//! linear in the velocity do; then the momentum less `F` is conserved. `F` is the change of the action
//! of a step that starts at the identity. Takes a combination of motions; gives `F`.

use super::motions::Motion;
use super::noether::{Term, combined};
use super::passage::Passage;
use super::{Inputs, here};
use crate::derive::action::summands;
use crate::derive::balance::shorter;
use crate::expr::shape::Shape;
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Letter, Shift};

/// Largest derivative that is taken.
const LARGEST: u32 = 5_000;

/// What the momentum of a combination of motions must be lessened by, constants left out.
pub(super) fn difference(x: &Inputs, passages: &[Passage], terms: &[Term]) -> Option<Expr> {
    let s = &x.letters.symbols;
    let mut parts = Vec::new();
    let mut shape = Shape::SCALAR;
    for term in summands(&x.action.total) {
        let change = combined(x, terms, |m| of_term(x, m, &term));
        shape = change.shape();
        if change.size() > LARGEST {
            return None;
        }
        // Invariant terms, the kinetic energy among them, add nothing.
        let nothing = |p: &Passage| p.before.value(&change).is_some_and(|v| v.vanishes());
        if !passages.iter().all(nothing) {
            parts.push(change);
        }
    }
    let total = shorter(x.algebra, expr::collect(s, &expr::sum(parts, shape)));
    let list = match total.node() {
        expr::Node::Sum(list) => list.clone(),
        _ => vec![total.clone()],
    };
    let moves = |e: &Expr| {
        let letters = expr::letters(e);
        let constant = |l: &Letter| matches!(s.get(l.symbol).role, Role::Parameter | Role::Step);
        !letters.iter().all(constant)
    };
    Some(expr::sum(list.into_iter().filter(moves), shape))
}

/// The change of a term of the action along a motion, over a step from the identity to the node: a
/// covector, paired with the direction of the motion.
fn of_term(x: &Inputs, m: &Motion, term: &Expr) -> Expr {
    let mut s = x.letters.symbols.clone();
    let (shape, structure) = m.direction();
    let name = s.fresh_name("v");
    let direction = here(s.add(&name, shape, structure, Role::Variation));
    let s = &s;
    let v = expr::here(s, direction.symbol);
    let c = &x.spec.configurations[m.configuration];
    let next = |l: Letter| Letter {
        shift: Shift {
            time: l.shift.time + 1,
            ..l.shift
        },
        ..l
    };
    let xi = here(x.letters.variation[m.configuration]);
    let g = expr::here(s, c.element);
    let at_end = expr::shift_time(s, &g, Shift::NEXT.time);
    let along = |g: &Expr, e: &Expr| {
        let moved = m.variation(x, s, g, &v);
        expr::substitute(s, e, &[(xi, moved)])
    };
    let variation = &x.variations[m.configuration];
    let start: Vec<(Letter, Expr)> = variation
        .on_outgoing()
        .iter()
        .map(|(l, e)| (*l, along(&g, e)))
        .collect();
    let end: Vec<(Letter, Expr)> = variation
        .on_incoming()
        .iter()
        .map(|(l, e)| {
            (
                next(*l),
                along(&at_end, &expr::shift_time(s, e, Shift::NEXT.time)),
            )
        })
        .collect();
    let change = expr::add(
        expr::directional(s, term, &start),
        expr::directional(s, term, &end),
    );
    let mut from_identity: Vec<(Letter, Expr)> = Vec::new();
    for c in &x.spec.configurations {
        let g = expr::here(s, c.element);
        let one = c.group.identity();
        from_identity.push((here(c.element), one));
        from_identity.push((next(here(c.element)), g.clone()));
        from_identity.push((here(c.velocity), g));
    }
    let elements: Vec<(Letter, Expr)> = from_identity
        .iter()
        .filter(|(l, _)| x.spec.configurations.iter().any(|c| *l == here(c.element)))
        .cloned()
        .collect();
    let backwards: Vec<(Letter, Expr)> = x
        .spec
        .configurations
        .iter()
        .map(|c| {
            (
                here(c.velocity),
                c.group.inverse(s, expr::here(s, c.element)),
            )
        })
        .collect();
    for a in &x.spec.advected {
        let q = here(a.quantity);
        let reference = match &a.definition {
            Some(d) => expr::substitute(s, d, &elements),
            None => expr::substitute(s, &a.update, &backwards),
        };
        from_identity.push((q, reference));
        from_identity.push((next(q), expr::here(s, a.quantity)));
    }
    let change = expr::substitute(s, &change, &from_identity);
    m.covector(s, expr::gradient(s, &change, direction))
}
