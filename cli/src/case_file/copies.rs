//! The sites of each quantity of a chain, and the sites at which its value is prescribed. Takes a model with labels
//! and a choice; gives the sites of each quantity, in order.

use super::stated::Stated;
use clebsch::card::Field;
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::{ChainConfig, ExpandedModel, Kind, Lattice, unfold};
use clebsch_core::syntax::ast::Statement;
use std::borrow::Cow;
use std::collections::HashSet;

/// The largest number of copies for which the model is expanded to find them. The expansion takes every
/// statement into account.
const WRITTEN_OUT: usize = 4096;

/// The sites of one quantity.
#[derive(Clone, Debug)]
pub(crate) struct Group {
    /// Its name in ASCII.
    pub of: String,
    /// Its label.
    pub label: Option<usize>,
    /// Its sites.
    pub sites: Vec<usize>,
    /// The sites at which the value is not prescribed.
    pub moving: Vec<usize>,
}

/// The copies of all quantities.
#[derive(Clone, Debug)]
pub(crate) struct Copies {
    /// Quantities in order.
    pub groups: Vec<Group>,
    /// Parameters of end conditions, by their names with sites, in ASCII.
    pub of_ends: Vec<String>,
    /// The line.
    pub line: Option<usize>,
    /// If only one configuration moves: its name in ASCII, its site, its label.
    pub only: Option<(String, usize, usize)>,
}

impl Copies {
    /// The copies for a choice; `None` if the model cannot be expanded.
    pub(crate) fn of(stated: &Stated, choice: &ChainConfig) -> Option<Self> {
        let lattice = &stated.lattice;
        let counts = lattice.quantities.iter();
        let counts = counts.map(|q| choice.sites_of(lattice, q));
        let few = counts.fold(0, usize::saturating_add) <= WRITTEN_OUT;
        // Functionals of all sites are not written out.
        match few && lattice.meshes.is_empty() {
            true => Some(Self::of_unfolded(
                lattice,
                &unfold(&stated.model, lattice, choice).ok()?,
            )),
            false => Some(Self::counted(lattice, choice)),
        }
    }

    fn of_unfolded(lattice: &Lattice, unfolded: &ExpandedModel) -> Self {
        let given: HashSet<&str> = unfolded.given.iter().map(String::as_str).collect();
        let mut groups: Vec<Group> = Vec::new();
        for copy in &unfolded.copies {
            let of = ascii(&copy.of);
            let at = match groups.iter().position(|g| g.of == of) {
                Some(at) => at,
                None => {
                    groups.push(Group {
                        of,
                        label: lattice.find(&copy.of).map(|q| q.label),
                        sites: Vec::new(),
                        moving: Vec::new(),
                    });
                    groups.len() - 1
                }
            };
            if let Some(group) = groups.get_mut(at) {
                group.sites.push(copy.site);
                if !given.contains(copy.name.as_str()) {
                    group.moving.push(copy.site);
                }
            }
        }
        for group in &mut groups {
            for list in [&mut group.sites, &mut group.moving] {
                list.sort_unstable();
                list.dedup();
            }
        }
        let of_ends = unfolded.end_parameters.iter();
        Copies {
            groups,
            of_ends: of_ends.map(|(own, ..)| ascii(own)).collect(),
            line: lattice.line,
            only: the_only_one(lattice, unfolded),
        }
    }

    /// The copies without expanding the model.
    fn counted(lattice: &Lattice, choice: &ChainConfig) -> Self {
        let mut of_ends = Vec::new();
        let mut held: Vec<(&str, bool)> = Vec::new();
        for (last, list) in lattice.ends.iter().enumerate() {
            let Some(end) = list.get(choice.ends[last]).filter(|_| !choice.periodic) else {
                continue;
            };
            held.extend(end.given.iter().map(|n| (n.text.as_str(), last == 1)));
            let site = match last {
                0 => 0,
                _ => lattice.line.map_or(0, |line| choice.count(line)),
            };
            let names = end.params.iter().flat_map(|(names, _)| names);
            of_ends.extend(names.map(|n| format!("{}_{site}", ascii(&n.text))));
        }
        let groups = lattice.quantities.iter().map(|q| {
            let count = choice.sites_of(lattice, q);
            let is_held = |site: usize| {
                held.iter().any(|(name, last)| {
                    *name == q.name.text && site == if *last { count - 1 } else { 0 }
                })
            };
            Group {
                of: ascii(&q.name.text),
                label: Some(q.label),
                sites: (0..count).collect(),
                moving: (0..count).filter(|site| !is_held(*site)).collect(),
            }
        });
        Copies {
            groups: groups.collect(),
            of_ends,
            line: lattice.line,
            only: None,
        }
    }
}

/// The key of a quantity whose copies are fields of a card, and the site of one of them.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Base<'a> {
    pub key: Cow<'a, str>,
    pub site: usize,
    pub label: usize,
    /// Whether it belongs to an end condition.
    pub end: bool,
    /// Whether its value is prescribed at an end.
    pub given: bool,
    /// The ASCII name of the quantity. For a momentum, the name of its configuration.
    pub of: &'a str,
    /// Whether the field is the momentum of this configuration.
    pub is_momentum: bool,
}

/// The quantity and site that a field of a card is a copy of.
pub(crate) fn base<'a>(copies: &'a Copies, field: &Field) -> Option<Base<'a>> {
    if let Some((of, site, label)) = &copies.only
        && ["momentum", "body_momentum", "spatial_momentum"].contains(&field.ascii)
    {
        // If there is only one configuration, the name of the momentum omits it.
        return Some(Base {
            key: format!("{}_{of}", field.ascii).into(),
            site: *site,
            label: *label,
            end: false,
            given: false,
            of,
            is_momentum: true,
        });
    }
    let (key, digits) = field.ascii.rsplit_once('_')?;
    let site: usize = digits.parse().ok()?;
    if copies.of_ends.iter().any(|own| own == field.ascii) {
        return Some(Base {
            key: key.into(),
            site,
            label: copies.line?,
            end: true,
            given: false,
            of: key,
            is_momentum: false,
        });
    }
    let group = copies.groups.iter().find(|g| {
        let own = key == g.of || key.strip_suffix(&g.of).is_some_and(|k| k.ends_with('_'));
        own && g.sites.binary_search(&site).is_ok()
    })?;
    Some(Base {
        key: key.into(),
        site,
        label: group.label?,
        end: false,
        given: group.moving.binary_search(&site).is_err(),
        is_momentum: key != group.of,
        of: &group.of,
    })
}

/// The configuration of a model, if only one moves.
fn the_only_one(lattice: &Lattice, unfolded: &ExpandedModel) -> Option<(String, usize, usize)> {
    let mut moving = unfolded.copies.iter().filter(|c| {
        let own = lattice.find(&c.of);
        own.is_some_and(|q| q.kind == Kind::Configuration) && !unfolded.given.contains(&c.name)
    });
    let statements = unfolded.model.statements.iter();
    let whole =
        statements.filter(|s| matches!(s, Statement::Field { .. } | Statement::Group { .. }));
    match (moving.next(), moving.next(), whole.count()) {
        (Some(only), None, 1) => Some((ascii(&only.of), only.site, lattice.find(&only.of)?.label)),
        _ => None,
    }
}
