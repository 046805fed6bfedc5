//! The Clebsch relations: stationarity of the constrained action `ℓ + ½<P', Λ' - ΛΩ> + <V', a' - f(a, Ω)>` in every
//! variable, including the multipliers' terms, as in the thesis (2.57-2.62, 2.77, 2.144-2.148). The weight ½ is for
//! SO(n), as in (2.75); for GL(n) it is 1, as in (3.25).

use super::Letters;
use super::action::Action;
use super::balance::{pairing, shorter};
use super::variation::at;
use crate::algebra::{Algebra, Rational};
use crate::check::spec::Spec;
use crate::expr::shape::Shape;
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr, Letter, Shift};

/// Stationarity in one variable.
#[derive(Clone, Debug)]
pub struct Relation {
    /// The variable, at node k or on the edge that starts there.
    pub variable: Letter,
    /// The gradient of the Clebsch action with respect to it.
    pub gradient: Expr,
    /// For a velocity of a group of matrices: the relation holds up to `Θ Ω^-T` with `Θ` normal to the Lie algebra
    /// (symmetric for SO(n)), which is the multiplier of the group constraint.
    pub up_to_group_multiplier: bool,
}

/// The multiplier terms of one edge, one for each constraint, in order of configurations and
/// advected quantities.
pub fn constraint_terms(spec: &Spec, letters: &Letters) -> Vec<Expr> {
    let s = &letters.symbols;
    let term = |multiplier, x, update: &Expr, weight: Rational| {
        let next = expr::letter(s, x, Shift::NEXT);
        let p = expr::letter(s, multiplier, Shift::NEXT);
        let gap = expr::sub(next, update.clone());
        expr::scale(weight, pairing(letters, &p, &gap))
    };
    let groups = spec.configurations.iter().zip(&letters.momentum);
    let groups = groups.map(|(c, p)| term(*p, c.element, &c.update, c.group.weight()));
    let advected = spec.advected.iter().zip(&letters.multiplier);
    let advected = advected.map(|(a, p)| term(*p, a.quantity, &a.update, Rational::ONE));
    groups.chain(advected).collect()
}

/// All relations: configurations, advected quantities, velocities.
pub fn relations(
    spec: &Spec,
    letters: &Letters,
    action: &Action,
    algebra: &Algebra,
) -> Vec<Relation> {
    let s = &letters.symbols;
    let terms = constraint_terms(spec, letters);
    let edge = expr::sum(
        [action.total.clone()].into_iter().chain(terms),
        Shape::SCALAR,
    );
    let before = expr::shift_time(s, &edge, Shift::PREVIOUS.time);
    // A gradient has the structure of its variable: the gradient with respect to a symmetric variable is symmetric.
    let own = |e: &Expr, variable: Letter| {
        let g = expr::gradient(s, e, variable);
        expr::projected(s, s.get(variable.symbol).structure, &g)
    };
    let nodes = spec.configurations.iter().map(|c| c.element);
    let nodes = nodes.chain(spec.advected.iter().map(|a| a.quantity));
    let mut out: Vec<Relation> = nodes
        .map(|symbol| {
            let variable = at(symbol, Shift::HERE);
            Relation {
                variable,
                gradient: shortest(
                    s,
                    algebra,
                    expr::add(own(&before, variable), own(&edge, variable)),
                ),
                up_to_group_multiplier: false,
            }
        })
        .collect();
    for c in &spec.configurations {
        let variable = at(c.velocity, Shift::HERE);
        out.push(Relation {
            variable,
            gradient: expr::collect(s, &expr::gradient(s, &edge, variable)),
            up_to_group_multiplier: c.group.has_normal(),
        });
    }
    out
}

/// The shorter of the gradient with like terms collected and its reduced form.
fn shortest(s: &Symbols, algebra: &Algebra, e: Expr) -> Expr {
    shorter(algebra, expr::collect(s, &e))
}
