//! Lagrangians of first order, which are linear in all velocities, as for point vortices and guiding centres. Takes a
//! limit without kinetic energy; decides whether its equations of motion still determine the velocities.

use super::action::summands;
use super::kinetic;
use super::limit::Limit;
use super::variation::at;
use super::{Letters, lie};
use crate::algebra::assumed;
use crate::check::spec::Spec;
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Letter, Shift};

/// The size of the largest expression that is differentiated.
const LARGEST: u32 = 20_000;

/// Whether the Lagrangian is linear in the velocities of fields, `θ(q)·v - V(q)`, and the two-form `dθ` is regular
/// for general parameters. No term may be of second order in the increments only, such as a kinetic term without
/// `/h`.
pub(super) fn is_first_order(
    spec: &Spec,
    letters: &Letters,
    limit: &Limit,
    equations: &[Expr],
) -> bool {
    let s = &letters.symbols;
    let linear = &limit.linear;
    let fits = spec.has_only_fields()
        && limit.kinetic.is_zero()
        && !linear.is_zero()
        && linear.size() <= LARGEST
        && !expr::contains_role(s, linear, Role::Advected);
    if !fits {
        return false;
    }
    let two_form = two_form(spec, letters, linear);
    let regular = kinetic::rank_of(spec, letters, &two_form, equations);
    regular.is_some_and(|(rank, n)| rank == n)
        && !summands(s, &spec.typed)
            .iter()
            .any(|term| is_of_second_order(spec, letters, term, equations))
}

/// The gradients of `dθ(ξ, ·)` with respect to each velocity, in the letters of variation.
fn two_form(spec: &Spec, letters: &Letters, linear: &Expr) -> Vec<Expr> {
    let s = &letters.symbols;
    let here = |id| at(id, Shift::HERE);
    let configurations = spec.configurations.iter().zip(&letters.direction);
    let moved: Vec<(Letter, Expr)> = configurations
        .map(|(c, eta)| (here(c.element), lie::element(s, c.group, *eta)))
        .collect();
    let both = expr::directional(s, linear, &moved);
    let pairs = || letters.variation.iter().zip(&letters.direction);
    let renamed: Vec<(Letter, Expr)> = pairs()
        .map(|(xi, eta)| (here(*eta), expr::here(s, *xi)))
        .collect();
    pairs()
        .map(|(xi, eta)| {
            let first = expr::gradient(s, &both, here(*xi));
            let first = expr::substitute(s, &first, &renamed);
            expr::sub(first, expr::gradient(s, &both, here(*eta)))
        })
        .collect()
}

/// Whether a term and its derivative with respect to the increments vanish at zero velocity, although the term does
/// not.
fn is_of_second_order(spec: &Spec, letters: &Letters, term: &Expr, equations: &[Expr]) -> bool {
    let s = &letters.symbols;
    let term = expr::substitute(s, term, &spec.end_of_edge());
    let velocities = || {
        spec.configurations
            .iter()
            .map(|c| at(c.velocity, Shift::HERE))
    };
    if term.size() > LARGEST || !velocities().any(|v| expr::contains(&term, v)) {
        return false;
    }
    let still: Vec<(Letter, Expr)> = spec
        .configurations
        .iter()
        .map(|c| (at(c.velocity, Shift::HERE), c.group.identity()))
        .collect();
    let vanishes = |e: &Expr| assumed::vanishes(s, equations, &expr::substitute(s, e, &still));
    vanishes(&term)
        && velocities().all(|v| vanishes(&expr::gradient(s, &term, v)))
        && !assumed::vanishes(s, equations, &term)
}
