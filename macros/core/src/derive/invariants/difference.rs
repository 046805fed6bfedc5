//! Total differences: a symmetry may change the action of a step by `F(end) - F(start)`, for example through terms
//! that are linear in the velocity. Then the momentum minus `F` is conserved. `F` is the change of the action of a
//! step that starts at the identity. Takes a combination of motions; gives `F`.

use super::motions::Motion;
use super::noether::{Term, combined};
use super::random_step::RandomStep;
use super::{Inputs, here};
use crate::check::spec::Configuration;
use crate::derive::action::summands;
use crate::derive::balance::shorter;
use crate::expr::shape::Shape;
use crate::expr::shape::Structure;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Letter, Shift};

/// The shape and the structure of the direction of a motion.
type Kind = (Shape, Structure);

/// The size of the largest derivative that is computed.
const LARGEST: u32 = 5_000;

/// The expression to subtract from the momentum of a combination of motions, up to constants.
pub(super) fn difference(x: &Inputs, passages: &[RandomStep], terms: &[Term]) -> Option<Expr> {
    // One table with a direction of each kind: on a chain, most of the work would be copies of the table for every
    // term.
    let mut symbols = x.letters.symbols.clone();
    let mut kinds: Vec<(Kind, Letter)> = Vec::new();
    for kind in terms.iter().map(|t| t.motion.direction()) {
        if !kinds.iter().any(|(known, _)| *known == kind) {
            let name = symbols.fresh_name("v");
            let direction = here(symbols.add(&name, kind.0, kind.1, Role::Variation));
            kinds.push((kind, direction));
        }
    }
    let s = &symbols;
    let of = |m: &Motion, term: &Expr| {
        let kind = m.direction();
        let known = kinds.iter().find(|(k, _)| *k == kind);
        known.map(|(_, direction)| of_term(x, s, *direction, m, term))
    };
    let mut parts = Vec::new();
    let mut shape = Shape::SCALAR;
    for term in summands(&x.letters.symbols, &x.action.total) {
        let nothing = || expr::zero(Shape::SCALAR);
        let change = combined(x, terms, |m| of(m, &term).unwrap_or_else(nothing));
        shape = change.shape();
        if change.size() > LARGEST {
            return None;
        }
        // Invariant terms, such as the kinetic energy, add nothing.
        let nothing = |p: &RandomStep| p.before.value(&change).is_some_and(|v| v.vanishes());
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

/// The change of a term of the action along a motion, over a step from the identity to the node, as a covector paired
/// with the direction of the motion.
fn of_term(x: &Inputs, s: &Symbols, direction: Letter, m: &Motion, term: &Expr) -> Expr {
    let v = expr::here(s, direction.symbol);
    let c = &x.spec.configurations[m.configuration];
    let next = |l: Letter| Letter {
        shift: Shift {
            time: l.shift.time + 1,
            ..l.shift
        },
        ..l
    };
    let held = expr::letters(term);
    let variation = &x.variations[m.configuration];
    let (starts, ends) = (variation.on_outgoing(), variation.on_incoming());
    let is_moved = starts.iter().any(|(l, _)| held.contains(l))
        || ends.iter().any(|(l, _)| held.contains(&next(*l)));
    if !is_moved {
        // Most terms of a chain contain other bodies only.
        let nothing = expr::zero(Shape::SCALAR);
        return m.covector(s, expr::gradient(s, &nothing, direction));
    }
    let xi = here(x.letters.variation[m.configuration]);
    let g = expr::here(s, c.element);
    let at_end = expr::shift_time(s, &g, Shift::NEXT.time);
    let along = |g: &Expr, e: &Expr| {
        let moved = m.variation(x, s, g, &v);
        expr::substitute(s, e, &[(xi, moved)])
    };
    let start: Vec<(Letter, Expr)> = starts
        .iter()
        .filter(|(l, _)| held.contains(l))
        .map(|(l, e)| (*l, along(&g, e)))
        .collect();
    let end: Vec<(Letter, Expr)> = ends
        .iter()
        .filter(|(l, _)| held.contains(&next(*l)))
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
    let held = expr::letters(&change);
    let holds = |id| held.iter().any(|l| l.symbol == id);
    let is_held = |c: &&Configuration| holds(c.element) || holds(c.velocity);
    let mut from_identity: Vec<(Letter, Expr)> = Vec::new();
    for c in x.spec.configurations.iter().filter(is_held) {
        let g = expr::here(s, c.element);
        let one = c.group.identity();
        from_identity.push((here(c.element), one));
        from_identity.push((next(here(c.element)), g.clone()));
        from_identity.push((here(c.velocity), g));
    }
    let identities = x.spec.configurations.iter();
    let elements: Vec<(Letter, Expr)> = identities
        .map(|c| (here(c.element), c.group.identity()))
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
    for a in x.spec.advected.iter().filter(|a| holds(a.quantity)) {
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
