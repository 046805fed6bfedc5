//! Which observables are copies of one quantity, at the sites of a label.
//! Takes a card; gives each such quantity with the columns of its sites.

use crate::case_file::labels::Stated;
use clebsch::card::{Card, Field};
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::Sites;
use std::ops::Range;

/// A quantity with a value at each of its sites.
#[derive(Clone, Debug)]
pub(crate) struct AtSites<'a> {
    /// Its name in files, such as `momentum_q`.
    pub key: String,
    /// Its name in print, such as `q`.
    pub name: String,
    /// The letter of its index.
    pub index: String,
    /// The observable at its first site, which tells its shape.
    pub field: &'a Field,
    /// Whether a momentum of its own shape stands behind it: it is a field.
    pub moves: bool,
    /// Whether its sites have neighbours.
    pub on_line: bool,
    /// Where on a line its sites are.
    pub at: Sites,
    /// Whether it grows once around a ring.
    pub grows: bool,
    /// By which parameter, in ASCII.
    pub offset: Option<String>,
    /// The sites with their columns.
    pub members: Vec<(usize, Range<usize>)>,
}

/// The quantities at sites in the order of their first copies; none for a model without labels.
pub(crate) fn at_sites(card: &Card) -> Vec<AtSites<'_>> {
    let Some(stated) = Stated::read(card.source) else {
        return Vec::new();
    };
    let quantities = &stated.lattice.quantities;
    let mut out: Vec<AtSites<'_>> = Vec::new();
    let mut from = 0;
    for (number, field) in card.observables.iter().enumerate() {
        let columns = from..from + field.count();
        from = columns.end;
        let Some((key, digits)) = field.ascii.rsplit_once('_') else {
            continue;
        };
        let Ok(site) = digits.parse::<usize>() else {
            continue;
        };
        let own = quantities.iter().find(|q| {
            let of = ascii(&q.name.text);
            key == of
                || key
                    .strip_suffix(&of)
                    .is_some_and(|rest| rest.ends_with('_'))
        });
        let Some(own) = own else { continue };
        match out.iter_mut().find(|q| q.key == key) {
            Some(q) => q.members.push((site, columns)),
            None => {
                let label = stated.lattice.labels.get(own.label);
                let behind = card.observables.get(number + 1);
                out.push(AtSites {
                    key: key.to_owned(),
                    name: own.name.text.clone(),
                    index: label.map_or_else(String::new, |l| l.index.text.clone()),
                    field,
                    moves: behind.is_some_and(|f| f.kind == clebsch::card::Kind::FieldMomentum),
                    on_line: label.is_some_and(|l| !l.set && !l.grid),
                    at: own.sites,
                    grows: own.offset.is_some(),
                    offset: own.offset.as_ref().map(|name| ascii(&name.text)),
                    members: vec![(site, columns)],
                });
            }
        }
    }
    out
}
