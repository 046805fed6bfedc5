//! The invariants of a lattice for the open chain, the ring and each end condition, with totals as sums over sites.

use crate::derive::invariants::{Family, Invariant, Kind as InvariantKind};
use crate::document::indexed_notation::{IndexOrigin, IndexedNotation, Part};
use crate::document::lattice::{holds::stated_holds, sites, sums};
use crate::expr::{self, Expr};
use crate::lattice::Lattice;
use crate::line::{Line, RepresentativeChain};
use crate::print::document::{Document, Inline};
use crate::print::formula::Formula;
use crate::print::{Format, Style, formula};
use crate::syntax::ast::Model;

/// The section on invariants.
pub(super) fn invariants(
    folded: &mut IndexedNotation,
    model: &Model,
    parts: &[Part],
    doc: &mut Document,
) {
    let section = doc.section("Invariants");
    for part in parts {
        let mut items: Vec<Vec<Inline>> = Vec::new();
        let written = RepresentativeChain {
            choice: part.choice.clone(),
            unfolded: part.unfolded.clone(),
            d: part.d.outline(),
        };
        let by_walls = |v: &&Invariant| {
            let value = v.value.as_ref();
            value.is_some_and(|e| written.is_turned_by_walls(folded.lattice, e))
        };
        // If constraints have a multiplier at every site, one item covers all of them.
        let at_sites = stated_holds(part);
        let is_of_site = |v: &&Invariant| v.family == Family::Held && !at_sites.is_empty();
        let kept = part
            .d
            .invariants
            .iter()
            .filter(|v| !by_walls(v) && !is_of_site(v));
        let kept: Vec<&Invariant> = kept.collect();
        let (told, others) = known(folded, part, &kept);
        items.extend(told.into_iter().map(CommonInvariant::words));
        for stated in &at_sites {
            let Some(hold) = part.d.spec.holds.get(stated.shown) else {
                continue;
            };
            items.push(vec![
                format!("constraint {}: ", stated.name).into(),
                folded
                    .derived(part, &hold.value, IndexOrigin::Site(stated.site))
                    .into(),
                " and its rate of change, at every site (exact: enforced by the multiplier)".into(),
            ]);
        }
        if !folded.lattice.meshes.is_empty() {
            items.extend(beside_functionals(folded, part, &written, model));
        }
        let words = heading(folded.lattice, part);
        if items.is_empty() {
            section.text(&format!(
                "{words}: clebsch found none among the candidates."
            ));
        } else {
            section.text(&format!("{words}:"));
            section.list(items);
        }
        if others {
            section.text("Other invariants of the expanded short chain are omitted: they are not sums that clebsch knows for every number of sites.");
        }
        let energy = part.d.discrete_energy();
        section.text(&format!(
            "The discrete energy of an edge is {}: {}.",
            energy.0, energy.1
        ));
    }
    let lines = folded.lattice.line.is_some();
    if lines {
        section.text("clebsch does not look for local conservation laws, that is, for fluxes between neighbouring sites.");
    }
    let reversible = parts.iter().all(|p| p.d.reversible);
    section.text(match reversible {
        true => "The scheme is symmetric under time reversal, of even order, and may be composed.",
        false => "The scheme is not symmetric under time reversal: it is of first order and must not be composed.",
    });
}

/// Totals that functionals of all sites leave conserved.
fn beside_functionals(
    folded: &mut IndexedNotation,
    part: &Part,
    written: &RepresentativeChain,
    model: &Model,
) -> Vec<Vec<Inline>> {
    let Ok(line) = Line::of(model) else {
        return Vec::new();
    };
    let mut items = Vec::new();
    for t in &line.totals {
        let mut sums = Vec::new();
        for density in &t.densities {
            let of_density = line.representative.in_letters_of(written, &density.value);
            let Some(e) = of_density else {
                continue;
            };
            let of = folded.derived(part, &e, IndexOrigin::Site(0));
            let Some(l) = folded.lattice.labels.get(density.label) else {
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

/// Names the topology or end condition that the invariants belong to.
fn heading(lattice: &Lattice, part: &Part) -> String {
    if lattice.line.is_none() {
        return "On a set of sites".to_owned();
    }
    if part.choice.periodic {
        return "On a ring".to_owned();
    }
    format!("On a chain {}", part.choice.held(lattice))
}

/// An invariant that holds for every number of sites.
struct CommonInvariant {
    name: String,
    value: Vec<Inline>,
    /// The value as text, to match it with an invariant of a longer lattice.
    text: String,
    how: &'static str,
    reason: String,
}

impl CommonInvariant {
    fn words(self) -> Vec<Inline> {
        let mut line: Vec<Inline> = vec![format!("{}: ", self.name).into()];
        line.extend(self.value);
        line.push(format!(" ({}: {})", self.how, self.reason).into());
        line
    }
}

/// The invariants of a part that hold for every number of sites, that is, those that read alike on a longer lattice;
/// and whether there are others.
fn known(
    folded: &mut IndexedNotation,
    part: &Part,
    kept: &[&Invariant],
) -> (Vec<CommonInvariant>, bool) {
    let (own, others) = of_part(folded, part, kept);
    // If the search found nothing on the longer lattice, it made too few draws for that many sites. The comparison
    // then proves nothing, and the ranges from end to end are kept.
    let found = |p: &&Part| p.d.invariants.iter().any(|v| v.family == Family::Noether);
    let Some(longer) = part.longer.as_deref().filter(found) else {
        return (numbered(own), others);
    };
    let all: Vec<&Invariant> = longer.d.invariants.iter().collect();
    let (there, _) = of_part(folded, longer, &all);
    let count = own.len();
    let alike: Vec<CommonInvariant> = own
        .into_iter()
        .filter(|v| there.iter().any(|o| o.text == v.text))
        .collect();
    let lost = alike.len() < count;
    (numbered(alike), others || lost)
}

/// Distinguishes invariants of equal name by numbers.
fn numbered(mut list: Vec<CommonInvariant>) -> Vec<CommonInvariant> {
    for i in 1..list.len() {
        let (before, rest) = list.split_at_mut(i);
        let Some(own) = rest.first_mut() else { break };
        let plain = own.name.clone();
        let mut n = 2;
        while before.iter().any(|o| o.name == own.name) {
            own.name = format!("{plain} {n}");
            n += 1;
        }
    }
    list
}

/// The invariants of one lattice that are sums over sites. Invariants that are not, but share a reason, are added;
/// the result includes their total if that is such a sum. Also returns whether an invariant is not a sum by itself.
fn of_part(
    folded: &mut IndexedNotation,
    part: &Part,
    kept: &[&Invariant],
) -> (Vec<CommonInvariant>, bool) {
    let style = Style::new(&part.d.spec.time_index);
    let mut out: Vec<CommonInvariant> = Vec::new();
    let mut untold: Vec<&Invariant> = Vec::new();
    let told = |folded: &IndexedNotation,
                v: &Invariant,
                [before, after]: [&str; 2],
                f: Option<Formula>| {
        let shown = |f: &Formula| formula(f, &folded.symbols, &style, Format::Text);
        let text = f.as_ref().map_or_else(String::new, shown);
        let mut value: Vec<Inline> = vec![before.into()];
        value.extend(f.map(Inline::Math));
        value.push(after.into());
        CommonInvariant {
            name: part.unfolded.plain(&v.name),
            value,
            text: format!("{before}{text}{after}"),
            how: if v.exact { "exact" } else { "bounded" },
            reason: v.reason.clone(),
        }
    };
    let at_sites = sites::of_sites(folded, part, kept);
    for (i, v) in kept.iter().enumerate() {
        match at_sites.iter().find(|o| o.members.contains(&i)) {
            Some(alike) if alike.begins_with(i) => {
                let after = format!(" {}", alike.at);
                out.push(told(folded, v, ["", &after], Some(alike.value.clone())));
                continue;
            }
            Some(_) => continue,
            None => {}
        }
        let (before, e) = match (&v.value, &v.kind) {
            (Some(e), _) => ("", e),
            (None, InvariantKind::ConstraintRate(j)) => {
                ("rate of change of ", &part.d.spec.holds[*j].value)
            }
            (None, _) => {
                let energy = "kinetic plus potential energy of the limit";
                out.push(told(folded, v, [energy, ""], None));
                continue;
            }
        };
        match total(folded, part, e) {
            Some(f) => out.push(told(folded, v, [before, ""], Some(f))),
            None => untold.push(v),
        }
    }
    let sum = |of: &Invariant| {
        let alike = untold.iter().filter(|v| v.reason == of.reason);
        let values: Vec<Expr> = alike.filter_map(|v| v.value.clone()).collect();
        let shape = of.value.as_ref()?.shape();
        let several = values.len() > 1 && values.iter().all(|e| e.shape() == shape);
        several.then(|| expr::sum(values, shape))
    };
    for (i, v) in untold.iter().enumerate() {
        if untold
            .iter()
            .take(i)
            .any(|before| before.reason == v.reason)
        {
            continue;
        }
        let f = sum(v).and_then(|e| total(folded, part, &e));
        if f.is_some() {
            out.push(told(folded, v, [""; 2], f));
        }
    }
    (out, !untold.is_empty())
}

/// A total as sums over sites; `None` if it does not hold for every number of sites.
pub(super) fn total(folded: &mut IndexedNotation, part: &Part, e: &Expr) -> Option<Formula> {
    let lattice = folded.lattice;
    let of_line = lattice.line.is_some() && lattice.labels.len() == 1;
    match sums::as_sums(folded, part, e).filter(|_| lattice.labels.len() == 1) {
        Some(sum) => Some(sum),
        None if of_line => None,
        // With several labels, the expression at one site represents all sites.
        None => Some(folded.derived(part, e, IndexOrigin::First)),
    }
}
