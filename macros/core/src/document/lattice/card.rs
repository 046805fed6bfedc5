//! The description of a model with labels when it runs: action, momenta and invariants, with sums over sites instead
//! of lists of copies.

use super::invariants::total;
use super::{ranged, sites, stated_configurations};
use crate::derive::Derivation;
use crate::derive::invariants::{Invariant, Kind as InvariantKind};
use crate::document::indexed_notation::{IndexOrigin, IndexedNotation, Part};
use crate::document::riccati_words;
use crate::expr::{self, Expr, Node};
use crate::lattice::{ChainConfig, ExpandedModel, Lattice};
use crate::print::formula::Formula;
use crate::print::{Format, Style, expression, formula};

/// The description of a lattice with a given number of sites.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CardWords {
    /// A summary of the derivation, in a few lines.
    pub summary: String,
    /// How a step finds the velocities.
    pub solver: String,
    /// The descriptions of the invariants, in the order of the derivation.
    pub invariants: Vec<InvariantWords>,
}

/// The description of one invariant, or of the same invariant at several sites.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InvariantWords {
    /// Its name.
    pub name: String,
    /// Its value.
    pub formula: String,
    /// How many consecutive invariants of the derivation it covers.
    pub count: usize,
}

/// The description of a derived lattice; `solver` names the solvers of its copies.
pub fn card_words(
    lattice: &Lattice,
    choice: &ChainConfig,
    unfolded: ExpandedModel,
    d: &Derivation,
    solver: &str,
) -> CardWords {
    let part = Part {
        choice: choice.clone(),
        unfolded,
        d: d.clone(),
        longer: None,
    };
    let mut folded = IndexedNotation::new(lattice, &part);
    let style = Style::new(&d.spec.time_index);
    let mut lines = vec![format!("lattice              {}", choice.words(lattice))];
    let terms = terms(&mut folded, &part);
    let text =
        |folded: &IndexedNotation, f: &Formula| formula(f, &folded.symbols, &style, Format::Text);
    lines.push(format!("Lagrangian           {}", text(&folded, &terms)));
    for s in stated_configurations(&part) {
        let from = IndexOrigin::Site(s.site);
        let Some(m) = d.momenta.get(s.shown) else {
            continue;
        };
        let reduced = folded.derived(&part, &m.reduced, from);
        lines.push(format!(
            "momentum of {:<8} {}",
            s.name,
            text(&folded, &reduced)
        ));
        if let Some(r) = d.solve.riccati.get(s.shown) {
            let mut show = |e: &Expr| {
                let e = folded.expression(&part, e, from);
                let e = expr::shown(&folded.symbols, &e);
                expression(&e, &folded.symbols, &style, Format::Text)
            };
            let words = without_sites(&part, &riccati_words(r, &mut show));
            lines.push(format!("Riccati form         {words}"));
        }
    }
    let list: Vec<&Invariant> = d.invariants.iter().collect();
    let mut at_sites = sites::of_sites(&mut folded, &part, &list);
    at_sites.retain(|o| o.members.windows(2).all(|w| w[0] + 1 == w[1]));
    // Each entry with whether it covers all sites.
    let mut told: Vec<(InvariantWords, bool)> = Vec::new();
    for (i, v) in list.into_iter().enumerate() {
        let alike = at_sites.iter().find(|o| o.members.contains(&i));
        if alike.is_some_and(|o| !o.begins_with(i)) {
            continue;
        }
        let name = part.unfolded.plain(&v.name).replace(' ', "_");
        let (formula, whole, count) = match (alike, &v.value, &v.kind) {
            (Some(alike), ..) => {
                let value = text(&folded, &alike.value);
                let formula = format!("{value} {}", alike.at);
                (formula, true, alike.members.len())
            }
            (None, Some(e), _) => {
                let (f, whole) = explicit(&mut folded, &part, e);
                (text(&folded, &f), whole, 1)
            }
            (None, None, InvariantKind::ConstraintRate(j)) => {
                let (f, _) = explicit(&mut folded, &part, &part.d.spec.holds[*j].value);
                let formula = format!("rate of change of {}", text(&folded, &f));
                (formula, true, 1)
            }
            (None, None, _) => {
                let formula = "kinetic plus potential energy of the limit".to_owned();
                (formula, true, 1)
            }
        };
        let words = InvariantWords {
            name,
            formula,
            count,
        };
        told.push((words, whole));
    }
    let invariants = numbered(told);
    let names: Vec<&str> = invariants.iter().map(|v| v.name.as_str()).collect();
    lines.push(format!("invariants           {}", names.join(", ")));
    lines.push(format!(
        "time reversal        {}",
        match d.reversible {
            true => "symmetric: second order",
            false => "not symmetric: first order",
        }
    ));
    lines.push(format!("certificate          {}", d.certificate.summary()));
    CardWords {
        summary: lines.join("\n"),
        solver: without_sites(&part, solver),
        invariants,
    }
}

/// A total on this lattice, as sums over sites or term by term, and whether it is written as sums.
fn explicit(folded: &mut IndexedNotation, part: &Part, e: &Expr) -> (Formula, bool) {
    match total(folded, part, e) {
        Some(sum) => (sum, true),
        None => (folded.derived(part, e, IndexOrigin::First), false),
    }
}

/// Distinguishes invariants of equal name by numbers. If none of them is the whole total, as for separate totals of
/// the even and the odd sites, the first one is numbered too.
fn numbered(told: Vec<(InvariantWords, bool)>) -> Vec<InvariantWords> {
    let names: Vec<(String, bool)> = told.iter().map(|(w, b)| (w.name.clone(), *b)).collect();
    let number = |i: usize, name: &str| {
        let same = || names.iter().enumerate().filter(|(_, (own, _))| own == name);
        let whole_first = same().next().is_some_and(|(_, (_, whole))| *whole);
        match same().filter(|(j, _)| *j < i).count() {
            0 if whole_first || same().count() == 1 => None,
            before => Some(before + 1),
        }
    };
    let each = told.into_iter().enumerate().map(|(i, (words, _))| {
        let name = match number(i, &words.name) {
            Some(n) => format!("{}_{n}", words.name),
            None => words.name.clone(),
        };
        InvariantWords { name, ..words }
    });
    each.collect()
}

fn terms(folded: &mut IndexedNotation, part: &Part) -> Formula {
    let all = folded.terms(part).into_iter().zip(&part.unfolded.summands);
    let all: Vec<_> = all.filter_map(|(e, s)| Some((e?, s.range))).collect();
    let each = all.into_iter().map(|(e, range)| {
        let e = expr::shown(&folded.symbols, &e);
        match e.node() {
            Node::Neg(inner) => {
                let inner = Formula::Expr(inner.clone());
                Formula::neg(ranged(folded.lattice, range, inner))
            }
            _ => ranged(folded.lattice, range, Formula::Expr(e.clone())),
        }
    });
    match <[Formula; 1]>::try_from(each.collect::<Vec<_>>()) {
        Ok([only]) => only,
        Err(several) => Formula::Sum(several),
    }
}

/// Contracts a list of copies, `Ω_0; Ω_1; Ω_2`, to `Ω_i`.
fn without_sites(part: &Part, text: &str) -> String {
    let mut out: Vec<String> = Vec::new();
    for piece in text.split("; ") {
        let words: Vec<String> = piece.split(' ').map(|w| word(part, w)).collect();
        let piece = words.join(" ");
        // The last entry of a list may end with words that apply to the whole list.
        let stem = piece.split(',').next().unwrap_or("").to_owned();
        match out.last_mut() {
            Some(last) if *last == stem || last.ends_with(&format!(": {stem}")) => {
                let rest = piece.get(stem.len()..).unwrap_or("");
                last.push_str(rest);
            }
            _ => out.push(piece),
        }
    }
    out.join("; ")
}

fn word(part: &Part, word: &str) -> String {
    let bare = word.trim_end_matches([',', ';', ':']);
    let tail = word.get(bare.len()..).unwrap_or("");
    let name = bare.trim_start_matches('Δ');
    match part.unfolded.copy(name) {
        None => word.to_owned(),
        Some(copy) => {
            let mark = if bare.len() > name.len() { "Δ" } else { "" };
            format!("{mark}{}_i{tail}", copy.of)
        }
    }
}
