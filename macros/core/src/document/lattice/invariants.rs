//! What is conserved on a lattice, for each way to close or hold it, totals written as sums over
//! sites.

use crate::derive::action::summands;
use crate::derive::invariants::{Family, Invariant, Kind as InvariantKind};
use crate::document::folded::{Folded, From, Part};
use crate::document::lattice::stated_holds;
use crate::expr::{self, Expr, Node};
use crate::lattice::Lattice;
use crate::line::{Line, Written};
use crate::print::document::{Document, Inline};
use crate::print::formula::Formula;
use crate::print::{Format, Style, expression};
use crate::syntax::ast::Model;

/// The section on invariants.
pub(super) fn invariants(folded: &mut Folded, model: &Model, parts: &[Part], doc: &mut Document) {
    let section = doc.section("Invariants");
    for part in parts {
        let mut items: Vec<Vec<Inline>> = Vec::new();
        let written = Written {
            choice: part.choice.clone(),
            unfolded: part.unfolded.clone(),
            d: part.d.outline(),
        };
        let by_walls = |v: &&Invariant| {
            let value = v.value.as_ref();
            value.is_some_and(|e| written.is_turned_by_walls(folded.lattice, e))
        };
        // Of constraints with a multiplier at every site one line speaks for all.
        let at_sites = stated_holds(part);
        let is_of_site = |v: &&Invariant| v.family == Family::Held && !at_sites.is_empty();
        let kept = part
            .d
            .invariants
            .iter()
            .filter(|v| !by_walls(v) && !is_of_site(v));
        let kept: Vec<&Invariant> = kept.collect();
        for v in kept {
            items.push(invariant(folded, part, v));
        }
        for stated in &at_sites {
            let Some(hold) = part.d.spec.holds.get(stated.shown) else {
                continue;
            };
            items.push(vec![
                format!("constraint {}: ", stated.name).into(),
                folded
                    .derived(part, &hold.value, From::Site(stated.site))
                    .into(),
                " and its rate of change, at every site (exact: held by the multiplier)".into(),
            ]);
        }
        if !folded.lattice.meshes.is_empty() {
            items.extend(beside_functionals(folded, part, &written, model));
        }
        let words = heading(folded.lattice, part);
        if items.is_empty() {
            section.text(&format!("{words}: none was found among the candidates."));
        } else {
            section.text(&format!("{words}:"));
            section.list(items);
        }
        let energy = part.d.discrete_energy();
        section.text(&format!(
            "The discrete energy of an edge is {}: {}.",
            energy.0, energy.1
        ));
    }
    let lines = folded.lattice.line.is_some();
    if lines {
        section.text("Fluxes between neighbouring sites, whose differences are the changes of densities, are not sought.");
    }
    let reversible = parts.iter().all(|p| p.d.reversible);
    section.text(match reversible {
        true => "The scheme is symmetric under time reversal, of even order, and may be composed.",
        false => "The scheme is not symmetric under time reversal: it is of first order and must not be composed.",
    });
}

/// Totals that functionals of all sites leave as they are.
fn beside_functionals(
    folded: &mut Folded,
    part: &Part,
    written: &Written,
    model: &Model,
) -> Vec<Vec<Inline>> {
    let Ok(line) = Line::of(model) else {
        return Vec::new();
    };
    let mut items = Vec::new();
    for t in &line.totals {
        let mut sums = Vec::new();
        for (label, _, density) in &t.densities {
            let Some(e) = line.representative.in_letters_of(written, density) else {
                continue;
            };
            let of = folded.derived(part, &e, From::Site(0));
            let Some(l) = folded.lattice.labels.get(*label) else {
                continue;
            };
            sums.push(Formula::SumOver {
                index: l.index.text.clone(),
                from: Some("0".to_owned()),
                to: Some(format!("{}-1", l.count.text)),
                of: Box::new(of),
            });
        }
        items.push(vec![
            format!("{}: ", t.name).into(),
            match <[Formula; 1]>::try_from(sums) {
                Ok([only]) => only,
                Err(several) => Formula::Sum(several),
            }
            .into(),
            format!(" (exact: {})", t.reason).into(),
        ]);
    }
    items
}

/// Which line is meant.
fn heading(lattice: &Lattice, part: &Part) -> String {
    if lattice.line.is_none() {
        return "On a set of sites".to_owned();
    }
    if part.choice.periodic {
        return "On a ring".to_owned();
    }
    format!("On a line {}", part.choice.held(lattice))
}

fn invariant(folded: &mut Folded, part: &Part, v: &Invariant) -> Vec<Inline> {
    let mut line: Vec<Inline> = vec![format!("{}: ", part.unfolded.plain(&v.name)).into()];
    match (&v.value, &v.kind) {
        (Some(e), _) => line.push(total(folded, part, e).into()),
        (None, InvariantKind::ConstraintRate(j)) => {
            let held = part.d.spec.holds[*j].value.clone();
            line.push("rate of change of ".into());
            line.push(total(folded, part, &held).into());
        }
        (None, _) => line.push("kinetic plus potential energy of the limit".into()),
    }
    let how = if v.exact { "exact" } else { "bounded" };
    line.push(format!(" ({how}: {})", v.reason).into());
    line
}

/// A total, terms of the same form collected to sums over sites.
pub(super) fn total(folded: &mut Folded, part: &Part, e: &Expr) -> Formula {
    let pair = |a: Formula, b: Formula| (Box::new(a), Box::new(b));
    match e.node() {
        Node::Dot(a, b) => {
            let (a, b) = pair(total(folded, part, a), total(folded, part, b));
            Formula::Dot(a, b)
        }
        Node::Cross(a, b) => {
            let (a, b) = pair(total(folded, part, a), total(folded, part, b));
            Formula::Cross(a, b)
        }
        Node::Neg(a) => Formula::neg(total(folded, part, a)),
        _ => summed(folded, part, e),
    }
}

fn summed(folded: &mut Folded, part: &Part, e: &Expr) -> Formula {
    let style = Style::new(&part.d.spec.time_index);
    let mut forms: Vec<(String, Expr, Vec<usize>)> = Vec::new();
    for term in terms(e) {
        let site = sites(part, &term).into_iter().min();
        let seen = folded.expression(part, &term, From::Site(site.unwrap_or(0)));
        let text = expression(&seen, &folded.symbols, &style, Format::Text);
        match forms
            .iter_mut()
            .find(|(t, ..)| *t == text && site.is_some())
        {
            Some((.., list)) => list.extend(site),
            None => forms.push((text, term, site.into_iter().collect())),
        }
    }
    let line = folded.lattice.line.unwrap_or(0);
    let (index, count) = match folded.lattice.labels.get(line) {
        Some(l) => (l.index.text.clone(), l.count.text.clone()),
        None => return folded.derived(part, e, From::First),
    };
    let many = part.choice.count(line);
    let mut out = Vec::new();
    for (_, term, mut list) in forms {
        list.sort_unstable();
        let whole = list.windows(2).all(|w| w[0] + 1 == w[1]);
        match (list.first(), list.last()) {
            (Some(a), Some(b)) if list.len() > 2 && whole => {
                let by = isize::try_from(*b).unwrap_or(0) - isize::try_from(many).unwrap_or(0);
                let of = folded.derived(part, &term, From::Site(*a));
                out.push(Formula::SumOver {
                    index: index.clone(),
                    from: Some(a.to_string()),
                    to: Some(super::beyond(&count, by)),
                    of: Box::new(of),
                });
            }
            (Some(a), _) if list.len() == 1 => {
                let from = if 2 * a > many {
                    From::Last
                } else {
                    From::First
                };
                out.push(folded.derived(part, &term, from));
            }
            (None, _) => out.push(folded.derived(part, &term, From::First)),
            _ => return folded.derived(part, e, From::First),
        }
    }
    match <[Formula; 1]>::try_from(out) {
        Ok([only]) => only,
        Err(several) => Formula::Sum(several),
    }
}

/// The terms of a sum, of numbers or vectors.
fn terms(e: &Expr) -> Vec<Expr> {
    match e.node() {
        Node::Sum(list) => list.iter().flat_map(terms).collect(),
        _ => summands(e),
    }
}

/// The sites whose letters an expression holds.
fn sites(part: &Part, e: &Expr) -> Vec<usize> {
    let letters = expr::letters(e).into_iter();
    letters
        .filter_map(|l| {
            let name = &part.d.letters.symbols.get(l.symbol).name;
            if let Some(copy) = part.unfolded.copy(name) {
                return Some(copy.site);
            }
            let own = part.d.letters.node_momentum.iter();
            let i = own.clone().position(|m| *m == l.symbol)?;
            let c = part.d.spec.configurations.get(i)?;
            let element = &part.d.letters.symbols.get(c.element).name;
            part.unfolded.copy(element).map(|c| c.site)
        })
        .collect()
}
