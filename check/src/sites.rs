//! The sites that are judged in a step, and the indices at which a term involves them. On a short chain all sites are
//! judged. On a long chain, the ends and two other windows are judged.

use crate::scene::Varied;
use crate::setup::Setup;
use crate::stated::{Role, Sites, Stated};
use crate::terms::{Letter, Term};
use std::collections::BTreeSet;

/// If a label has at most this many sites, all of them are judged.
const ALL: usize = 96;

/// Sites of a window.
const WINDOW: usize = 24;

/// A configuration that is judged.
#[derive(Clone, Debug)]
pub struct Moving<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its site.
    pub site: Option<usize>,
    /// Its first variable.
    pub first: u32,
    /// How many components its variation has.
    pub components: usize,
}

/// Mixes the bits of a number: a generator of random numbers with no state.
#[must_use]
pub fn mixed(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The sites of a label that are judged in this step.
fn judged(count: usize, step: u64) -> Vec<usize> {
    if count <= ALL {
        return (0..count).collect();
    }
    let most = count - WINDOW;
    let anywhere = |salt: u64| {
        let place = mixed(step ^ (salt << 32)) % (most as u64 + 1);
        usize::try_from(place).unwrap_or(0)
    };
    let starts = [0, most, anywhere(1), anywhere(2)];
    let all: BTreeSet<usize> = starts.iter().flat_map(|s| *s..s + WINDOW).collect();
    all.into_iter().collect()
}

/// The configurations that are judged in this step.
#[must_use]
pub fn moving<'a>(stated: &'a Stated, setup: &Setup, step: u64) -> Vec<Moving<'a>> {
    moving_at(stated, setup, |count| judged(count, step))
}

/// All configurations.
#[must_use]
pub fn all_moving<'a>(stated: &'a Stated, setup: &Setup) -> Vec<Moving<'a>> {
    moving_at(stated, setup, |count| (0..count).collect())
}

/// The configurations at the sites that `chosen` returns for each number of sites.
fn moving_at<'a>(
    stated: &'a Stated,
    setup: &Setup,
    chosen: impl Fn(usize) -> Vec<usize>,
) -> Vec<Moving<'a>> {
    let mut out: Vec<Moving> = Vec::new();
    let mut first = 0;
    for q in stated.quantities.values() {
        let sites: Vec<Option<usize>> = match (&q.role, q.at) {
            (Role::Parameter | Role::Advected, _) => continue,
            (_, None) => vec![None],
            (_, Some((label, sites))) => {
                let count = setup.sites(stated, label, sites);
                chosen(count).into_iter().map(Some).collect()
            }
        };
        for site in sites {
            let Some(own) = setup.observed(&q.name, site) else {
                continue;
            };
            let components = match &q.role {
                Role::Element(group, _) => group.basis().len(),
                _ => own.rows * own.cols,
            };
            out.push(Moving {
                name: &q.name,
                site,
                first,
                components,
            });
            first += u32::try_from(2 * components).unwrap_or(u32::MAX);
        }
    }
    out
}

/// The first variables of all that is judged.
#[must_use]
pub fn varied<'a>(all: &[Moving<'a>]) -> Varied<'a> {
    Varied {
        first: all.iter().map(|m| ((m.name, m.site), m.first)).collect(),
        at_first_node_only: false,
    }
}

/// The indices over which a term is summed.
#[must_use]
pub fn range(stated: &Stated, setup: &Setup, term: &Term) -> Option<std::ops::RangeInclusive<i64>> {
    let label = term.label?;
    let count = |sites: Sites| i64::try_from(setup.sites(stated, label, sites)).unwrap_or(i64::MAX);
    if let Some(over) = term.over {
        return Some(0..=count(over) - 1);
    }
    if stated.line != Some(label) || setup.periodic {
        return Some(0..=count(Sites::Nodes) - 1);
    }
    let from = term.letters.iter().map(|l| -l.offset).max()?;
    let to = term
        .letters
        .iter()
        .map(|l| count(l.sites) - 1 - l.offset)
        .min()?;
    Some(from..=to)
}

/// The indices at which a term involves varied quantities. A term that is not summed gets the single index 0.
#[must_use]
pub fn indices(stated: &Stated, setup: &Setup, term: &Term, moving: &[Moving<'_>]) -> Vec<i64> {
    let Some(range) = range(stated, setup, term) else {
        return vec![0];
    };
    let (Some(label), false) = (term.label, term.global) else {
        return range.collect();
    };
    let size = i64::try_from(setup.sites(stated, label, Sites::Nodes)).unwrap_or(i64::MAX);
    let ring = setup.periodic && stated.line == Some(label);
    let mut out = BTreeSet::new();
    for m in moving {
        let at = stated.quantities.get(m.name).and_then(|q| q.at);
        let (Some((own, sites)), Some(site)) = (at, m.site) else {
            continue;
        };
        let site = i64::try_from(site).unwrap_or(i64::MAX);
        let meets = |l: &&Letter| own == label && l.sites == sites;
        for letter in term.letters.iter().filter(meets) {
            let index = match ring && size > 0 {
                true => (site - letter.offset).rem_euclid(size),
                false => site - letter.offset,
            };
            if range.contains(&index) {
                out.insert(index);
            }
        }
    }
    out.into_iter().collect()
}
