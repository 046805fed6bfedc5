//! The equations of a step stated in space, with every velocity in the body frame: the same action varied from the
//! right. Terms that grow with the distance from the origin then cancel in the formulas instead of numerically. A
//! tensor that is constant in the body is constant in these equations. Takes the model; gives the momenta of the
//! outgoing edges, if this form is simpler.

use super::Letters;
use super::balance::{self, Balance};
use super::variation::{self, at};
use super::{action, holds, reduction};
use crate::algebra::Algebra;
use crate::check::spec::{Configuration, Side, Spec};
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Letter, Shift};

/// Node momenta on the outgoing edge, with the end of the edge expressed by its start and the velocities.
pub fn outgoing(spec: &Spec, letters: &Letters, balances: &[Balance]) -> Vec<Expr> {
    let (s, forward) = (&letters.symbols, spec.end_of_edge());
    let list = balances.iter();
    list.map(|b| expr::substitute(s, &b.outgoing, &forward))
        .collect()
}

/// The outgoing momenta of a model with spatial velocities, as body covectors of `W = Λ⁻¹ V Λ` in the letters of `V`.
/// `stated` is the model before its reduction to advected quantities of the other side. `None` without an advantage:
/// if only rotations are stated in space, and the equations need more quantities at a node than as stated.
pub fn seen_from_body(
    stated: &Spec,
    spec: &Spec,
    letters: &Letters,
    balances: &[Balance],
) -> Option<Vec<Expr>> {
    let spatial = |c: &Configuration| c.side.is_spatial() && !c.group.is_additive();
    if !spec.configurations.iter().any(spatial) {
        return None;
    }
    let turned = reduction::reduce(turned(stated, letters)).ok()?;
    let own = super::letters(&turned);
    let algebra = Algebra::new(&own.symbols);
    let variations = variation::variations(&turned, &own, &algebra).ok()?;
    let action = holds::with_reactions(&turned, &own, &action::action(&turned));
    let found = balance::balances(&turned, &own, &action, &variations, &algebra);
    // A quantity that the reduction found does not belong to the model: its definition replaces it.
    let found_here = turned.advected.iter().filter(|a| a.found);
    let defined: Option<Vec<(Letter, Expr)>> = found_here
        .map(|a| Some((at(a.quantity, Shift::HERE), a.definition.clone()?)))
        .collect();
    let defined = defined?;
    let found = outgoing(&turned, &own, &found);
    let found: Vec<Expr> = found
        .iter()
        .map(|e| expr::substitute(&own.symbols, e, &defined))
        .collect();
    let needed = spec
        .configurations
        .iter()
        .any(|c| spatial(c) && !c.group.is_isometric());
    let asked = |list: &[Expr]| {
        let mut letters: Vec<Letter> = list.iter().flat_map(expr::letters).collect();
        letters.sort();
        letters.dedup();
        let at_node = |l: &&Letter| {
            let role = spec.symbols.get(l.symbol).role;
            matches!(role, Role::Element | Role::Advected)
        };
        letters.iter().filter(at_node).count()
    };
    (needed || asked(&found) < asked(&outgoing(spec, letters, balances))).then_some(found)
}

/// The model with `Λ V Λ⁻¹` in place of every spatial velocity `V`, which then acts from the right.
fn turned(spec: &Spec, letters: &Letters) -> Spec {
    let s = &letters.symbols;
    let mut turned = spec.clone();
    let mut velocities = Vec::new();
    for c in &mut turned.configurations {
        if c.side.is_body() || c.group.is_additive() {
            continue;
        }
        let (g, v) = (expr::here(s, c.element), expr::here(s, c.velocity));
        let letter = at(c.velocity, Shift::HERE);
        let seen = expr::product([g.clone(), v.clone(), expr::inverse(s, g.clone())]);
        velocities.push((letter, seen));
        c.side = Side::Body;
        c.update = expr::mul(g, v);
    }
    turned.lagrangian = expr::substitute(s, &turned.lagrangian, &velocities);
    for a in &mut turned.advected {
        a.update = expr::substitute(s, &a.update, &velocities);
    }
    turned
}
