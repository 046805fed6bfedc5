//! What is stated without effect: parameters that nothing uses, potentials and terms that are
//! constant along every motion. Takes the model and its variations; gives warnings.

use super::{Inputs, Topic, Warning};
use crate::algebra::Rational;
use crate::derive::action::{split, summands};
use crate::derive::variation::at;
use crate::diagnostic::{Diagnostic, Place};
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Function, Letter, Node, Shift};

/// One warning for each parameter that stands in no Lagrangian, constraint or definition.
pub(super) fn parameters(x: &Inputs) -> Vec<Warning> {
    let spec = x.spec;
    let used: Vec<&Expr> = [&spec.typed]
        .into_iter()
        .chain(&spec.scale)
        .chain(spec.configurations.iter().map(|c| &c.update))
        .chain(spec.advected.iter().map(|a| &a.update))
        .chain(spec.advected.iter().filter_map(|a| a.definition.as_ref()))
        .collect();
    let stands = |list: &[&Expr], symbol| {
        let mut letters = list.iter().flat_map(|e| expr::letters(e));
        letters.any(|l| l.symbol == symbol)
    };
    let assumed = spec.assumptions.iter().flat_map(|a| [&a.left, &a.right]);
    let assumed: Vec<&Expr> = assumed.collect();
    let places = spec.parameters.iter().zip(&spec.parameter_places);
    places
        .filter(|(p, _)| !stands(&used, **p))
        .map(|(p, place)| {
            let name = &spec.symbols.get(*p).name;
            let message = match stands(&assumed, *p) {
                true => format!("the parameter `{name}` is used in an assumption only: the motion does not depend on it"),
                false => format!("the parameter `{name}` is never used"),
            };
            let d = Diagnostic::new(*place, message)
                .help(format!("use `{name}` in the Lagrangian, or leave it out"));
            Warning::new(Topic::UnusedParameter, d)
        })
        .collect()
}

/// Warnings of a constant potential and of terms that are constant along every motion.
pub(super) fn terms(x: &Inputs) -> Vec<Warning> {
    let s = &x.letters.symbols;
    let constant = |e: &Expr| {
        let mut list = x.variations.iter();
        list.all(|v| x.vanishes(&expr::directional(s, e, &v.on_outgoing())))
    };
    let warn = |place, message: String, help: &str| {
        Warning::new(
            Topic::ConstantTerm,
            Diagnostic::new(place, message).help(help),
        )
    };
    let group = "the group leaves such terms unchanged, as it does the length of a carried vector: \
                 let the potential depend on the configuration, or leave it out";
    let all = summands(&x.spec.lagrangian);
    let moving = |e: &Expr| {
        let letters = expr::letters(e);
        let mut roles = letters.iter().map(|l| s.get(l.symbol).role);
        roles.any(|r| !matches!(r, Role::Parameter | Role::Step))
    };
    if !x.action.nodal.is_zero() && constant(&x.action.nodal) {
        let text = x.text(&x.action.nodal);
        let message =
            format!("the potential is constant along every motion: {text} exerts no force");
        let nodal = all.iter().find(|t| moving(t) && split(s, t).0.is_zero());
        return vec![warn(place(x, nodal), message, group)];
    }
    let mut out = Vec::new();
    for term in &all {
        if !moving(term) {
            continue;
        }
        // In velocities and quantities at the start of the edge, its dependence on both ends shows.
        let on_edge = expr::substitute(s, term, &x.spec.end_of_edge());
        if constant(&on_edge) && constant_in_velocity(x, &on_edge) {
            let message = format!(
                "the term {} is constant along every motion: it has no effect",
                x.text(term)
            );
            out.push(warn(place(x, Some(term)), message, group));
        }
    }
    // A potential without a configuration: a constant times the step, and no other potential.
    let h = at(x.spec.step, Shift::HERE);
    let twice = [(
        h,
        expr::scale(Rational::integer(2), expr::here(s, x.spec.step)),
    )];
    let proportional = |t: &&Expr| {
        let doubled = expr::scale(Rational::integer(2), (*t).clone());
        expr::contains(t, h) && x.vanishes(&expr::sub(expr::substitute(s, t, &twice), doubled))
    };
    let lone = all.iter().filter(|t| !moving(t)).find(proportional);
    if let (Some(term), true) = (lone, x.action.nodal.is_zero()) {
        let message = format!(
            "the potential is constant: {} holds no configuration and exerts no force",
            x.text(term)
        );
        let help = "multiply it by a quantity that moves, as in `h*dot(gU, Γ)`, or leave it out";
        out.push(warn(place(x, Some(term)), message, help));
    }
    out
}

/// Whether an expression does not change when the end of the edge moves and its start stays.
fn constant_in_velocity(x: &Inputs, e: &Expr) -> bool {
    let s = &x.letters.symbols;
    let mut ends = x.spec.configurations.iter().zip(&x.letters.direction);
    ends.all(|(c, eta)| {
        let eta = crate::derive::lie::element(s, c.group, *eta);
        let change = expr::mul(expr::here(s, c.velocity), eta);
        let moved: [(Letter, Expr); 1] = [(at(c.velocity, Shift::HERE), change)];
        x.vanishes(&expr::directional(s, e, &moved))
    })
}

/// Where a term was typed: that of the same term without signs and divisors, else the Lagrangian.
fn place(x: &Inputs, term: Option<&Expr>) -> Place {
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

/// One warning for each absolute value or sign of what moves.
pub(super) fn kinks(x: &Inputs) -> Vec<Warning> {
    let s = &x.letters.symbols;
    let moving = |e: &Expr| {
        let letters = expr::letters(e);
        let mut roles = letters.iter().map(|l| s.get(l.symbol).role);
        roles.any(|r| !matches!(r, Role::Parameter | Role::Step))
    };
    let mut found: Vec<Expr> = Vec::new();
    let mut list = vec![&x.spec.typed];
    while let Some(e) = list.pop() {
        if let Node::Call(Function::Abs | Function::Sign, inside) = e.node()
            && moving(inside)
            && !found.contains(e)
        {
            found.push(e.clone());
        }
        list.extend(e.children());
    }
    found
        .iter()
        .rev()
        .map(|e| {
            let at = x.spec.terms.iter().find(|(term, _)| holds(term, e));
            let place = at.map_or(x.spec.lagrangian_place, |(_, place)| *place);
            let message = format!(
                "{} is not smooth where its argument vanishes: a step across has no order, and \
                 the energy may jump",
                x.text(e)
            );
            let help = "where the motion gets there, use a smooth function, such as \
                        `sqrt(x^2 + eps^2)` for `abs(x)`";
            Warning::new(Topic::NotSmooth, Diagnostic::new(place, message).help(help))
        })
        .collect()
}

fn holds(e: &Expr, part: &Expr) -> bool {
    e == part || e.children().into_iter().any(|x| holds(x, part))
}
