//! Terms of the Lagrangian without effect: constants, total differences, and potentials that vanish in the limit of
//! small steps. Takes the Lagrangian as typed; gives warnings.

use super::difference::{is_constant, is_kept, is_total, on_edge};
use super::{Inputs, Topic, Warning};
use crate::algebra::Rational;
use crate::check::spec::Spec;
use crate::derive::action::{self, Action, split, summands};
use crate::derive::reversal::by_configuration;
use crate::derive::variation::at;
use crate::diagnostic::{Diagnostic, Place};
use crate::expr::shape::Structure;
use crate::expr::symbol::{Role, SymbolId};
use crate::expr::{self, Expr, Letter, Node, Shift};
use crate::syntax::ast::NodeRule;

/// The limit on differentiated nodes of the action, times parameters and pairs of ends.
const EVALUATED: u64 = 50_000;

/// The advice for a term that is constant along every motion.
fn constant(x: &Inputs) -> &'static str {
    match x.spec.has_only_fields() {
        true => "let it depend on the configuration, or remove it",
        false => {
            "the group leaves such terms unchanged, like the length of an advected vector: let the potential depend on the \
             configuration, or remove it"
        }
    }
}

/// The advice for a term without a moving quantity.
fn moved(x: &Inputs) -> String {
    let [_, potential] = x.examples();
    format!("multiply it by a quantity that moves, as in `{potential}`, or remove it")
}

/// Whether an expression contains letters other than parameters and the step size.
fn moves(x: &Inputs, e: &Expr) -> bool {
    let s = &x.letters.symbols;
    let letters = expr::letters(e);
    let mut roles = letters.iter().map(|l| s.get(l.symbol).role);
    roles.any(|r| !matches!(r, Role::Parameter | Role::Step))
}

/// The Lagrangian as typed: the terms of its sum unchanged, if it is a sum, and all terms with common factors
/// multiplied in.
pub(super) fn typed(x: &Inputs) -> (Vec<Expr>, Vec<Expr>) {
    let whole = &x.spec.typed;
    let addends = match whole.node() {
        Node::Sum(list) => list.clone(),
        _ => vec![whole.clone()],
    };
    (addends, summands(&x.letters.symbols, whole))
}

fn warn(place: Place, message: String, help: &str) -> Warning {
    Warning::new(
        Topic::ConstantTerm,
        Diagnostic::new(place, message).help(help),
    )
}

/// Warnings about a constant potential, and about terms and parameters that do not affect the motion.
pub(super) fn without_effect(x: &Inputs) -> Vec<Warning> {
    let s = &x.letters.symbols;
    let (addends, all) = typed(x);
    let nodal = &x.action.nodal;
    if !nodal.is_zero() && is_kept(x, nodal) {
        let term = all.iter().find(|t| moves(x, t) && split(s, t).0.is_zero());
        let message = match x.vanishes(nodal) {
            true => {
                "the terms at nodes add up to a total difference, which has no effect on the motion"
                    .to_owned()
            }
            false => format!(
                "the potential is constant along every motion: {} exerts no force",
                x.text(nodal)
            ),
        };
        return vec![warn(place(x, term), message, constant(x))];
    }
    let mut out = Vec::new();
    let mut told: Vec<Letter> = Vec::new();
    for term in addends.iter().filter(|t| moves(x, t)) {
        let why = if is_constant(x, &on_edge(x, term)) {
            "is constant along every motion: it has no effect"
        } else if is_total(x, term) {
            "is a total difference, F(end of the step) - F(start): it has no effect on the motion"
        } else {
            continue;
        };
        told.extend(expr::letters(term));
        let message = format!("the term {} {why}", x.text(term));
        out.push(warn(place(x, Some(term)), message, constant(x)));
    }
    for (last, first) in pairs(x, &addends) {
        let message = format!(
            "the terms {} and {} add up to a total difference, F(end of the step) - F(start): together they have no effect on \
             the motion",
            x.text(last),
            x.text(first)
        );
        told.extend(expr::letters(last));
        out.push(warn(place(x, Some(last)), message, &moved(x)));
    }
    for term in all.iter().filter(|t| moves(x, t) && !addends.contains(t)) {
        if is_constant(x, &on_edge(x, term)) {
            let message = format!(
                "the term {} is constant along every motion: it has no effect",
                x.text(term)
            );
            out.push(warn(place(x, Some(term)), message, constant(x)));
        }
    }
    // A potential without a configuration, and no other potential.
    let lone = all.iter().find(|t| !moves(x, t) && power(x, t) == Some(1));
    if let (Some(term), true) = (lone, nodal.is_zero()) {
        told.extend(expr::letters(term));
        let message = format!(
            "the potential is constant: {} contains no configuration and exerts no force",
            x.text(term)
        );
        out.push(warn(place(x, Some(term)), message, &moved(x)));
    }
    for p in idle(x) {
        if told.iter().any(|l| l.symbol == p) {
            continue;
        }
        let holding: Vec<&Expr> = addends.iter().filter(|t| holds(x, t, p)).collect();
        let Some(first) = holding.first() else {
            continue;
        };
        told.extend(
            expr::letters(first)
                .into_iter()
                .filter(|_| holding.len() == 1),
        );
        let terms: Vec<String> = holding.iter().map(|t| x.text(t)).collect();
        let message = format!(
            "the motion does not depend on `{}`: its terms, {}, add up to a constant or to a total difference",
            s.get(p).name,
            terms.join(" and ")
        );
        out.push(warn(place(x, Some(first)), message, &moved(x)));
    }
    out
}

/// Terms at the end of a step, each paired with a term at the start that is subtracted from it.
fn pairs<'a>(x: &Inputs, addends: &'a [Expr]) -> Vec<(&'a Expr, &'a Expr)> {
    let s = &x.letters.symbols;
    let at_level = |t: &Expr, level: i8| {
        let letters = expr::letters(t);
        let mut moving = letters
            .iter()
            .filter(|l| !matches!(s.get(l.symbol).role, Role::Parameter | Role::Step));
        moves(x, t)
            && moving.all(|l| l.shift.time == level && s.get(l.symbol).role != Role::Velocity)
    };
    let last = addends.iter().filter(|t| at_level(t, Shift::NEXT.time));
    last.filter_map(|t| {
        let moved = expr::shift_time(s, t, -Shift::NEXT.time);
        let mut first = addends.iter().filter(|f| at_level(f, 0));
        let found = first.find(|f| x.vanishes(&expr::add(moved.clone(), (*f).clone())))?;
        Some((t, found))
    })
    .collect()
}

/// Whether a term contains a parameter, possibly in the definition of an advected quantity.
fn holds(x: &Inputs, term: &Expr, p: SymbolId) -> bool {
    let letters = expr::letters(&by_configuration(x.spec, term));
    letters.iter().any(|l| l.symbol == p)
}

/// Parameters that occur in the action only in a constant or a total difference.
fn idle(x: &Inputs) -> Vec<SymbolId> {
    let s = &x.letters.symbols;
    let total = by_configuration(x.spec, &x.spec.typed);
    let updates = x.spec.configurations.iter().map(|c| &c.update);
    let updates = updates.chain(x.spec.advected.iter().map(|a| &a.update));
    let elsewhere: Vec<Letter> = x
        .spec
        .scale
        .iter()
        .chain(updates)
        .flat_map(expr::letters)
        .collect();
    let free = |p: &SymbolId| {
        let fits = !matches!(
            s.get(*p).structure,
            Structure::Orthogonal | Structure::UnitQuaternion | Structure::RigidMotion
        );
        fits && holds(x, &total, *p) && !elsewhere.iter().any(|l| l.symbol == *p)
    };
    let parameters: Vec<SymbolId> = x.spec.parameters.iter().copied().filter(free).collect();
    let pairs = (x.spec.configurations.len() as u64).pow(2) * parameters.len() as u64;
    if pairs * u64::from(total.size()) > EVALUATED {
        return Vec::new();
    }
    let without = |p: &SymbolId| {
        // In a direction of its own shape and structure: its letter at another node.
        let change = [(at(*p, Shift::HERE), expr::letter(s, *p, Shift::NEXT))];
        is_total(x, &expr::directional(s, &total, &change))
    };
    parameters.into_iter().filter(without).collect()
}

/// The power of the step size to which a term is proportional, as a physical action.
fn power(x: &Inputs, term: &Expr) -> Option<i32> {
    let s = &x.letters.symbols;
    let h = at(x.spec.step, Shift::HERE);
    let physical = match &x.spec.scale {
        Some(scale) => expr::quotient(term.clone(), scale.clone()),
        None => term.clone(),
    };
    let two = Rational::integer(2);
    let twice = [(h, expr::scale(two, expr::here(s, x.spec.step)))];
    let doubled = expr::substitute(s, &physical, &twice);
    (-3..=6).find(|n| {
        two.power(*n).is_some_and(|factor| {
            let expected = expr::scale(factor, physical.clone());
            x.vanishes(&expr::sub(doubled.clone(), expected))
        })
    })
}

/// The warning about potentials that vanish in the limit of small steps. A term is a correction to other terms if
/// these contain all its parameters and advected quantities.
pub(super) fn vanishing(x: &Inputs) -> Option<Warning> {
    let s = &x.letters.symbols;
    let (_, all) = typed(x);
    let (moving, h): (Vec<&Expr>, _) = (
        all.iter().filter(|t| moves(x, t)).collect(),
        at(x.spec.step, Shift::HERE),
    );
    let vanishes = |t: &Expr| expr::contains(t, h) && power(x, t).is_some_and(|n| n >= 2);
    let (gone, left): (Vec<&Expr>, Vec<&Expr>) = moving.iter().partition(|t| vanishes(t));
    let known: Vec<SymbolId> = left
        .iter()
        .flat_map(|t| expr::letters(&by_configuration(x.spec, t)))
        .map(|l| l.symbol)
        .collect();
    let own = |t: &Expr| {
        let letters = expr::letters(&by_configuration(x.spec, t));
        letters.into_iter().find(|l| {
            let role = s.get(l.symbol).role;
            matches!(role, Role::Parameter | Role::Advected) && !known.contains(&l.symbol)
        })
    };
    let no_potential = !x.action.nodal.is_zero() && !left.iter().any(|t| split(s, t).0.is_zero());
    let term = gone.iter().find(|t| no_potential || own(t).is_some())?;
    let n = power(x, term)?;
    let [_, potential] = x.examples();
    let d = Diagnostic::new(
        place(x, Some(term)),
        format!(
            "the term {} vanishes in the limit of small steps: the action of a step is proportional to `h`, and this term to \
             `h^{n}`",
            x.text(term)
        ),
    )
    .help(format!(
        "the Lagrangian is (kinetic - potential energy) times the step: multiply a potential by `h` once, as in `-{potential}`"
    ));
    Some(Warning::new(Topic::NoLimit, d))
}

/// The action of a single term as typed.
pub(super) fn action_of(x: &Inputs, term: &Expr) -> Action {
    let physical = match &x.spec.scale {
        Some(scale) => expr::quotient(term.clone(), scale.clone()),
        None => term.clone(),
    };
    action::action(&Spec {
        lagrangian: physical,
        node_rule: NodeRule::Symmetric,
        reduction: None,
        ..x.spec.clone()
    })
}

/// The position at which a term was typed: the position of the same term without signs and divisors, otherwise the
/// position of the Lagrangian.
pub(super) fn place(x: &Inputs, term: Option<&Expr>) -> Place {
    fn core(e: &Expr) -> &Expr {
        match e.node() {
            Node::Neg(a) | Node::Quotient(a, _) => core(a),
            _ => e,
        }
    }
    let found = term.and_then(|t| {
        let mut typed = x.spec.terms.iter();
        typed
            .find(|(e, _)| core(e) == core(t))
            .map(|(_, place)| *place)
    });
    found.unwrap_or(x.spec.lagrangian_place)
}
