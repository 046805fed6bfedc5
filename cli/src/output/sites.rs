//! Finds the observables that are copies of one quantity, at the sites of a label.
//! Takes a card; gives each such quantity with the columns of its sites.

use crate::case_file::stated::Stated;
use clebsch::card::{Card, Field};
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::{Kind, Quantity, Sites};
use std::ops::Range;

/// A quantity with a value at each of its sites.
#[derive(Clone, Debug)]
pub(crate) struct AtSites<'a> {
    /// Its name in files, such as `momentum_q`.
    pub key: String,
    /// Its name in print, such as `q`.
    pub name: String,
    /// The label of its index.
    pub index: String,
    /// The observable at its first site, which determines the shape.
    pub field: &'a Field,
    /// Whether the quantity is a field: its observable is followed by a momentum of the same shape.
    pub moves: bool,
    /// Whether its sites have neighbours.
    pub on_line: bool,
    /// Its sites: nodes or segments.
    pub at: Sites,
    /// Whether its value grows by an offset for each turn around a ring.
    pub grows: bool,
    /// The parameter that gives this offset, in ASCII.
    pub offset: Option<String>,
    /// The sites with their columns.
    pub members: Vec<(usize, Range<usize>)>,
}

/// The quantities at sites in the order of their first copies; empty for a model without labels.
pub(crate) fn at_sites(card: &Card) -> Vec<AtSites<'_>> {
    let Some(stated) = Stated::read(card.source) else {
        return Vec::new();
    };
    let quantities = &stated.lattice.quantities;
    let mut out: Vec<AtSites<'_>> = Vec::new();
    let only = the_only_one(card, quantities);
    let mut from = 0;
    for (number, field) in card.observables.iter().enumerate() {
        let columns = from..from + field.count();
        from = columns.end;
        let copy = copy_of(field, quantities).or_else(|| of_the_only_one(field, only.as_ref()?));
        let Some((key, site, own)) = copy else {
            continue;
        };
        match out.iter_mut().find(|q| q.key == key) {
            Some(q) => q.members.push((site, columns)),
            None => {
                let label = stated.lattice.labels.get(own.label);
                let behind = card.observables.get(number + 1);
                out.push(AtSites {
                    key,
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
    for q in &mut out {
        q.members.sort_by_key(|(site, _)| *site);
    }
    out
}

/// The key of a field with the number of a site in its name, its site, and its quantity. For a momentum that is
/// the configuration.
fn copy_of<'a>(field: &Field, quantities: &'a [Quantity]) -> Option<(String, usize, &'a Quantity)> {
    let (key, digits) = field.ascii.rsplit_once('_')?;
    let site = digits.parse().ok()?;
    let own = quantities.iter().find(|q| {
        let of = ascii(&q.name.text);
        let before = key.strip_suffix(&of);
        key == of || before.is_some_and(|rest| rest.ends_with('_'))
    })?;
    Some((key.to_owned(), site, own))
}

/// The single configuration that moves, and its site: in a ring of one site, or in a chain whose ends prescribe all
/// sites but one.
fn the_only_one<'a>(card: &Card, quantities: &'a [Quantity]) -> Option<(usize, &'a Quantity)> {
    let mut copies = card.observables.iter().filter_map(|field| {
        let (key, site, own) = copy_of(field, quantities)?;
        let moves = own.kind == Kind::Configuration && key == ascii(&own.name.text);
        moves.then_some((site, own))
    });
    copies.next().filter(|_| copies.next().is_none())
}

/// Like `the_only_one`, for a momentum whose name omits the configuration because the model has only one.
fn of_the_only_one<'a>(
    field: &Field,
    (site, own): &(usize, &'a Quantity),
) -> Option<(String, usize, &'a Quantity)> {
    let is_momentum = ["momentum", "body_momentum", "spatial_momentum"].contains(&field.ascii);
    let key = format!("{}_{}", field.ascii, ascii(&own.name.text));
    is_momentum.then_some((key, *site, *own))
}
