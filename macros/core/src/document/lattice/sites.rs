//! Groups invariants of single sites that read alike. From the invariants of an expanded lattice it returns one item
//! for each form, with the sites where it is conserved.

use super::beyond;
use crate::derive::invariants::{Family, Invariant};
use crate::document::indexed_notation::{IndexOrigin, IndexedNotation, Part};
use crate::expr::{self, Expr};
use crate::print::formula::Formula;
use crate::print::{Format, Style, expression};

/// Fewest sites that form a group: two may be the two ends.
const FEWEST: usize = 3;

/// An invariant that reads alike at several sites.
pub(super) struct OfSites {
    /// Its name without sites.
    pub name: String,
    /// The quantity at one site.
    pub value: Formula,
    /// The sites in words: `at every site`.
    pub at: String,
    /// The positions of its copies in the list of invariants, ascending.
    pub members: Vec<usize>,
    reason: String,
    text: String,
    label: usize,
    sites: Vec<usize>,
}

impl OfSites {
    /// Whether invariant `i` of the list is the first copy, where the group is printed.
    pub(super) fn begins_with(&self, i: usize) -> bool {
        self.members.first() == Some(&i)
    }
}

/// Groups the invariants of the list that are the same quantity at several sites.
pub(super) fn of_sites(
    folded: &mut IndexedNotation,
    part: &Part,
    list: &[&Invariant],
) -> Vec<OfSites> {
    let style = Style::new(&part.d.spec.time_index);
    let mut out: Vec<OfSites> = Vec::new();
    for (i, v) in list.iter().enumerate() {
        // Constraints are described elsewhere.
        let Some(e) = v.value.as_ref().filter(|_| v.family != Family::Held) else {
            continue;
        };
        let Some((label, site)) = only_site(folded, part, e) else {
            continue;
        };
        let seen = folded.expression(part, e, IndexOrigin::End(site));
        let text = expression(&seen, &folded.symbols, &style, Format::Text);
        let name = part.unfolded.plain(&v.name);
        let alike = |o: &&mut OfSites| {
            (&o.name, &o.text, &o.reason, o.label) == (&name, &text, &v.reason, label)
        };
        match out.iter_mut().find(alike) {
            Some(known) => {
                known.members.push(i);
                known.sites.push(site);
            }
            None => out.push(OfSites {
                name,
                value: folded.derived(part, e, IndexOrigin::End(site)),
                at: String::new(),
                members: vec![i],
                reason: v.reason.clone(),
                text,
                label,
                sites: vec![site],
            }),
        }
    }
    out.retain_mut(|o| match words(folded, part, o) {
        Some(at) => {
            o.at = at;
            true
        }
        None => false,
    });
    out
}

/// Describes the sites, if they are consecutive.
fn words(folded: &IndexedNotation, part: &Part, o: &mut OfSites) -> Option<String> {
    o.sites.sort_unstable();
    let neighbours = o.sites.windows(2).all(|w| w[0] + 1 == w[1]);
    let label = folded.lattice.labels.get(o.label)?;
    let count = part.choice.count(o.label);
    if label.set {
        return (o.sites.len() == count && count > 1).then(|| "at every site".to_owned());
    }
    if !neighbours || o.sites.len() < FEWEST {
        return None;
    }
    if part.choice.periodic {
        return (o.sites.len() == count).then(|| "at every site".to_owned());
    }
    let (first, last) = (*o.sites.first()?, *o.sites.last()?);
    let by = isize::try_from(last).ok()? - isize::try_from(count).ok()?;
    Some(format!(
        "for {} from {first} to {}",
        label.index.text,
        beyond(&label.count.text, by)
    ))
}

/// The label and the site of all letters of an expression that have a site, if they agree.
fn only_site(folded: &IndexedNotation, part: &Part, e: &Expr) -> Option<(usize, usize)> {
    let letters = expr::letters(e).into_iter();
    let mut sites = letters.filter_map(|l| folded.site(part, l.symbol));
    let first = sites.next()?;
    sites.all(|s| s == first).then_some(first)
}
