//! Describes the constraints of a chain or ring as declared: constraints at every site, with indices relative to a
//! middle site, and constraints on sums over all sites, with their multipliers.

use super::{beyond, stated_configurations, sums};
use crate::check::spec::Hold;
use crate::document::holds::{
    ALONG, MIDDLE, ON_ARRIVAL, no_change, projected, rate_on_arrival, reported_multiplier,
};
use crate::document::indexed_notation::{IndexOrigin, IndexedNotation, Part};
use crate::expr::{self, Expr, Shift};
use crate::lattice::StatedTotal;
use crate::print::document::{Document, Inline, Section};
use crate::print::formula::Formula;

/// Adds the constraints at every site, each with indices relative to a middle site.
pub(super) fn holds(folded: &mut IndexedNotation, part: &Part, section: &mut Section) {
    for stated in stated_holds(part) {
        let Some(hold) = part.d.spec.holds.get(stated.shown) else {
            continue;
        };
        let from = IndexOrigin::Site(stated.site);
        let multiplier = folded.letter(part, hold.multiplier, Shift::HERE, from);
        let mut line: Vec<Inline> = vec![
            "The multiplier ".into(),
            multiplier.into(),
            " enforces".into(),
        ];
        if let Some(l) = folded.lattice.line_label() {
            let (first, last) = (stated.first, stated.last);
            let (i, n) = (&l.index.text, &l.count.text);
            let count = part.choice.counts.first().copied().unwrap_or(0);
            let by = isize::try_from(last).unwrap_or(0) - isize::try_from(count).unwrap_or(0);
            line.push(match part.choice.periodic {
                true => format!(", {i} = 0, ..., {n}-1, indices modulo {n}:").into(),
                false => format!(", {i} = {first}, ..., {}:", beyond(n, by)).into(),
            });
        }
        section.paragraph(line);
        let left = folded.expression(part, &hold.left, from);
        let right = folded.expression(part, &hold.right, from);
        let math = |e: Expr| Formula::Expr(expr::shown(&folded.symbols, &e));
        section.equation(Formula::equal(math(left), math(right)));
    }
    for stated in &part.unfolded.totals {
        let Some(hold) = number_of(part, stated).map(|j| &part.d.spec.holds[j]) else {
            continue;
        };
        let multiplier = folded.letter(part, hold.multiplier, Shift::HERE, IndexOrigin::First);
        section.paragraph(vec![
            "The multiplier ".into(),
            multiplier.into(),
            ", one for all sites, enforces:".into(),
        ]);
        let mut side = |e: &Expr| match sums::as_sums(folded, part, e) {
            Some(sum) => sum,
            None => folded.derived(part, e, IndexOrigin::First),
        };
        let both = [side(&hold.left), side(&hold.right)];
        let [left, right] = both;
        section.equation(Formula::equal(left, right));
    }
}

/// Describes how a step enforces the constraints, and what the reported multipliers mean.
pub(super) fn held(folded: &mut IndexedNotation, part: &Part, doc: &mut Document) {
    let d = &part.d;
    if d.spec.holds.is_empty() {
        return;
    }
    let section = doc.section("Constraints on configurations");
    section.text("The step solves for the multipliers together with the velocities, so that the constraints are satisfied at its end (SHAKE). It takes the principal root, which continues from rest with zero multipliers.");
    let Ok(limit) = &d.limit else {
        section.text(
            "The step does not project the momentum at its end, because the momentum does not give the velocity in closed form.",
        );
        return;
    };
    section.text(ON_ARRIVAL);
    for stated in stated_configurations(part) {
        let from = IndexOrigin::Site(stated.site);
        if let Some([left, right]) = projected(d, limit, stated.shown) {
            let both = [left, right].map(|e| folded.derived(part, &e, from));
            let [left, right] = both;
            section.equation(Formula::equal(left, right));
        }
    }
    section.text(ALONG);
    let shown = shown(part);
    for (j, from) in &shown {
        let rate = rate_on_arrival(d, &d.spec.holds[*j]);
        let zero = expr::zero(rate.shape());
        let sum = match from {
            IndexOrigin::Site(_) => None,
            _ => sums::as_sums(folded, part, &rate),
        };
        let rate = sum.unwrap_or_else(|| folded.derived(part, &rate, *from));
        section.equation(Formula::equal(rate, Formula::Expr(zero)));
    }
    section.text(&no_change(d));
    for (j, from) in &shown {
        let told = folded.expression(part, &reported_multiplier(d, *j), *from);
        section.equation(Formula::Expr(told));
    }
    section.text(MIDDLE);
}

/// Numbers of the displayed constraints, and the origins of their indices.
fn shown(part: &Part) -> Vec<(usize, IndexOrigin)> {
    let of_sites = stated_holds(part).into_iter();
    let of_sites = of_sites.map(|h| (h.shown, IndexOrigin::Site(h.site)));
    let totals = part.unfolded.totals.iter();
    let of_totals = totals.filter_map(|total| Some((number_of(part, total)?, IndexOrigin::First)));
    of_sites.chain(of_totals).collect()
}

/// The number of a constraint on sums over all sites.
fn number_of(part: &Part, stated: &StatedTotal) -> Option<usize> {
    let symbols = &part.d.letters.symbols;
    let own = |h: &Hold| symbols.get(h.multiplier).name == stated.name;
    part.d.spec.holds.iter().position(own)
}

/// A declared constraint with copies at several sites.
pub(super) struct StatedHold {
    /// The name of its multiplier.
    pub name: String,
    /// Number of the displayed copy, the one nearest to the middle.
    pub shown: usize,
    /// The site of that copy.
    pub site: usize,
    /// The first and the last site.
    first: usize,
    last: usize,
}

/// The declared constraints, except those with a copy at one site only.
pub(super) fn stated_holds(part: &Part) -> Vec<StatedHold> {
    let mut out: Vec<StatedHold> = Vec::new();
    let middle = part.choice.counts.first().copied().unwrap_or(0) / 2;
    for (j, hold) in part.d.spec.holds.iter().enumerate() {
        let name = &part.d.letters.symbols.get(hold.multiplier).name;
        let Some(copy) = part.unfolded.copy(name) else {
            continue;
        };
        let site = copy.site;
        match out.iter_mut().find(|s| s.name == copy.of) {
            None => out.push(StatedHold {
                name: copy.of.clone(),
                shown: j,
                site,
                first: site,
                last: site,
            }),
            Some(s) => {
                s.first = s.first.min(site);
                s.last = s.last.max(site);
                if site.abs_diff(middle) < s.site.abs_diff(middle) {
                    (s.shown, s.site) = (j, site);
                }
            }
        }
    }
    out
}
