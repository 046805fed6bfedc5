//! Finds circular and unused `let` definitions.

use crate::diagnostic::{Diagnostic, Errors};
use crate::syntax::ast::{Expression, Kind, Model, Name, Statement};

/// One definition, and the positions in the list of the definitions that it uses.
struct Let<'a> {
    name: &'a Name,
    uses: Vec<usize>,
}

/// The names of circular definitions; each cycle is reported once.
pub fn circular<'a>(model: &'a Model, errors: &mut Errors) -> Vec<&'a Name> {
    let lets = lets(model);
    let mut told: Vec<usize> = Vec::new();
    for start in 0..lets.len() {
        if told.contains(&start) {
            continue;
        }
        let Some(circle) = circle(&lets, start) else {
            continue;
        };
        errors.push(message(&lets, &circle));
        told.extend(circle);
    }
    told.iter()
        .filter_map(|i| lets.get(*i).map(|l| l.name))
        .collect()
}

/// The names of definitions that no other statement uses, directly or through definitions.
pub fn unused(model: &Model) -> Vec<&Name> {
    let lets = lets(model);
    let others = model
        .statements
        .iter()
        .filter(|s| !matches!(s, Statement::Let { .. }));
    let stated = others.flat_map(Statement::expressions);
    let mut used: Vec<&str> = stated.flat_map(names).collect();
    let mut left: Vec<&Let> = lets.iter().collect();
    let mut at = 0;
    while let Some(name) = used.get(at).copied() {
        let found = left.iter().position(|l| l.name.text == name);
        if let Some(found) = found {
            let own = left.remove(found);
            let needed = own.uses.iter().filter_map(|i| lets.get(*i));
            used.extend(needed.map(|l| l.name.text.as_str()));
        }
        at += 1;
    }
    left.into_iter().map(|l| l.name).collect()
}

fn lets(model: &Model) -> Vec<Let<'_>> {
    let stated = model.statements.iter().filter_map(|s| match s {
        Statement::Let { name, value } => Some((name, value)),
        _ => None,
    });
    let stated: Vec<(&Name, &Expression)> = stated.collect();
    let defined = |n: &str| stated.iter().position(|(name, _)| name.text == n);
    let uses = |value| {
        let mut found: Vec<usize> = names(value).into_iter().filter_map(defined).collect();
        found.sort_unstable();
        found.dedup();
        found
    };
    let list = stated.iter().map(|(name, value)| Let {
        name,
        uses: uses(value),
    });
    list.collect()
}

/// The names in an expression, except names of functions.
fn names(e: &Expression) -> Vec<&str> {
    match &e.kind {
        Kind::Name(n) => vec![n],
        Kind::Number(_) | Kind::Constant(_) => Vec::new(),
        Kind::Sum(terms) => terms.iter().flat_map(|(_, t)| names(t)).collect(),
        Kind::Product(list) | Kind::Call(_, list) => list.iter().flat_map(names).collect(),
        Kind::Quotient(a, b) => [names(a), names(b)].concat(),
        Kind::Neg(a)
        | Kind::Transpose(a)
        | Kind::Power(a, _)
        | Kind::Component(a, _)
        | Kind::Shaped(a, _) => names(a),
    }
}

/// The shortest cycle from a definition back to itself, if there is one (breadth-first search).
fn circle(lets: &[Let], start: usize) -> Option<Vec<usize>> {
    let mut ways: Vec<(usize, Option<usize>)> = vec![(start, None)];
    let mut at = 0;
    while let Some((here, _)) = ways.get(at).copied() {
        for next in lets.get(here).map_or(&[][..], |l| &l.uses) {
            if *next == start {
                let mut back = vec![here];
                let mut before = ways.get(at).and_then(|w| w.1);
                while let Some((i, earlier)) = before.and_then(|b| ways.get(b)) {
                    back.push(*i);
                    before = *earlier;
                }
                back.reverse();
                return Some(back);
            }
            if !ways.iter().any(|(i, _)| i == next) {
                ways.push((*next, Some(at)));
            }
        }
        at += 1;
    }
    None
}

fn message(lets: &[Let], circle: &[usize]) -> Diagnostic {
    let name = |i: usize| lets.get(i).map_or("", |l| l.name.text.as_str());
    let following = circle.iter().cycle().skip(1);
    let links = circle.iter().zip(following);
    let links: Vec<String> = links
        .map(|(a, b)| format!("`{}` uses `{}`", name(*a), name(*b)))
        .collect();
    let first = circle.first().and_then(|i| lets.get(*i));
    let place = first.map_or_else(
        || crate::diagnostic::Place::token(proc_macro2::Span::call_site()),
        |l| l.name.place,
    );
    let text = match circle {
        [one] => format!("`{}` is defined in terms of itself", name(*one)),
        _ => format!("these definitions are circular: {}", links.join(", ")),
    };
    Diagnostic::new(place, text)
        .help("write one of them in terms of declared quantities, or make it a `param`")
}
