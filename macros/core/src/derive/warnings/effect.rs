//! Unused parameters and abbreviations, and functions that are not smooth. Takes the model; gives warnings.

use super::{Inputs, Topic, Warning};
use crate::diagnostic::{Diagnostic, Place};
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Function, Node};
use crate::syntax::unknown;

/// One warning for each parameter that occurs in no Lagrangian, constraint or definition.
pub(super) fn parameters(x: &Inputs) -> Vec<Warning> {
    let spec = x.spec;
    let used: Vec<&Expr> = [&spec.typed]
        .into_iter()
        .chain(&spec.scale)
        .chain(spec.holds.iter().map(|hold| &hold.value))
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
    // The warning about an unused definition covers the parameters in it.
    let unused = |name: &str| spec.unused_lets.iter().any(|(own, _)| own == name);
    let hidden = spec.lets.iter().filter(|(name, _)| unused(name));
    let hidden: Vec<&Expr> = hidden.map(|(_, value)| value).collect();
    let places = spec.parameters.iter().zip(&spec.parameter_places);
    places
        .filter(|(p, _)| !stands(&used, **p) && !stands(&hidden, **p))
        .map(|(p, place)| {
            let name = &spec.symbols.get(*p).name;
            let message = match stands(&assumed, *p) {
                true => format!("the parameter `{name}` occurs only in assumptions: the motion does not depend on it"),
                false => format!("the parameter `{name}` is never used"),
            };
            let d = Diagnostic::new(*place, message)
                .help(format!("use `{name}` in the Lagrangian, or remove it"));
            Warning::new(Topic::UnusedParameter, d)
        })
        .collect()
}

/// The warning about an unused abbreviation.
pub(crate) fn unused_let(name: &str, place: Place) -> Warning {
    let message = format!("`{name}` is defined by `let` but never used: it has no effect");
    let help = match unknown::is_force(name) {
        true => "forces without a potential are not supported yet, and defining a force does not apply it; add a potential as \
            a term of the Lagrangian".to_owned(),
        false => format!("use `{name}` in the Lagrangian, or remove it"),
    };
    Warning::new(Topic::UnusedLet, Diagnostic::new(place, message).help(help))
}

/// One warning for each absolute value or sign of a moving quantity.
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
                "{} is not smooth where its argument vanishes: a step across this point has a lower order, and the energy may \
                 jump",
                x.text(e)
            );
            let help = "if the motion gets there, use a smooth function, such as `sqrt(x^2 + eps^2)` for `abs(x)`";
            Warning::new(Topic::NotSmooth, Diagnostic::new(place, message).help(help))
        })
        .collect()
}

fn holds(e: &Expr, part: &Expr) -> bool {
    e == part || e.children().into_iter().any(|x| holds(x, part))
}
