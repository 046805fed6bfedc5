//! Axial vectors of a velocity as letters of their own. When both ends of an edge are turned alike,
//! its velocity turns with them, and so does the axis of it: `vee(O)` goes by a cross product, which
//! says in three numbers what the change of the whole matrix says in eighteen.
//! Takes a number and how everything changes; gives the same covector written by cross products.

use super::variation::at;
use crate::algebra::Algebra;
use crate::check::spec::{Configuration, Group};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Shift};

const VECTOR: Shape = Shape::vector(Dim::Fixed(3));

/// The derivative of the number `e` along a turn `xi` of the ends of the edge of `c`, as a covector.
/// None where the velocity does not stand in it by axial vectors alone.
pub(super) fn covector(
    symbols: &Symbols,
    c: &Configuration,
    xi: SymbolId,
    e: &Expr,
    along: &[(Letter, Expr)],
) -> Option<Expr> {
    let mut own = symbols.clone();
    let mut fresh = |base: &str| {
        let name = own.fresh_name(base);
        own.add(&name, VECTOR, Structure::General, Role::Derived)
    };
    let velocity = expr::here(symbols, c.velocity);
    let mut parts = Vec::new();
    match c.group {
        Group::SpecialOrthogonal(Dim::Fixed(3)) => parts.push(expr::vee(velocity)),
        Group::UnitQuaternions => {
            let rotation = expr::rotation(symbols, velocity.clone());
            parts.extend([expr::imaginary(velocity), expr::vee(rotation)]);
        }
        _ => return None,
    }
    let turn = fresh("t");
    let parts: Vec<(Expr, SymbolId)> = parts.into_iter().map(|a| (a, fresh("a"))).collect();
    let written = by_parts(&own, e, &parts);
    let letter = at(c.velocity, Shift::HERE);
    if written == *e || expr::contains(&written, letter) {
        return None;
    }
    // The turn as a vector, wherever the variation is its matrix.
    let turn_letter = expr::here(&own, turn);
    let as_vector = match c.group.coordinates() {
        Some(_) => turn_letter.clone(),
        None => expr::hat(turn_letter.clone()),
    };
    let as_vector = [(at(xi, Shift::HERE), as_vector)];
    let algebra = Algebra::new(&own);
    let mut changes = Vec::new();
    for (l, amount) in along {
        let amount = expr::substitute(&own, amount, &as_vector);
        if *l != letter {
            changes.push((*l, amount));
            continue;
        }
        for (part, axis) in &parts {
            let whole = expr::directional(&own, part, &[(letter, amount.clone())]);
            let turned = expr::cross(turn_letter.clone(), part.clone());
            let by = |s| expr::here(s, *axis);
            if algebra.is_zero(&expr::sub(whole.clone(), turned.clone())) {
                changes.push((
                    at(*axis, Shift::HERE),
                    expr::cross(turn_letter.clone(), by(&own)),
                ));
            } else if algebra.is_zero(&expr::add(whole, turned)) {
                changes.push((
                    at(*axis, Shift::HERE),
                    expr::cross(by(&own), turn_letter.clone()),
                ));
            } else {
                return None;
            }
        }
    }
    let change = expr::directional(&own, &written, &changes);
    let covector = expr::gradient(&own, &change, at(turn, Shift::HERE));
    let back: Vec<(Letter, Expr)> = parts
        .into_iter()
        .map(|(part, axis)| (at(axis, Shift::HERE), part))
        .collect();
    Some(expr::substitute(&own, &covector, &back))
}

/// The expression with letters for the axial vectors.
fn by_parts(s: &Symbols, e: &Expr, parts: &[(Expr, SymbolId)]) -> Expr {
    match parts.iter().find(|(part, _)| part == e) {
        Some((_, axis)) => expr::here(s, *axis),
        None => expr::rebuild(s, e, &mut |x| by_parts(s, x, parts)),
    }
}
