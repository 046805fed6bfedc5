//! Which motions are taken as one: of few configurations each by itself; of many those that the action couples are
//! moved together. On a lattice the copies of one configuration are, at all sites, or each by itself where something of
//! every single momentum is conserved. Takes the motions; gives lists of them, of which combinations are sought.

use super::Inputs;
use super::mixed::Component;
use super::motions::{Motion, Sort, Way};
use super::passage::Passage;
use crate::check::spec::CopyOf;

/// Most numbers of one set whose shifts are combined one by one.
const SINGLES: usize = 32;

/// A list of motions that are made together.
pub(super) type Column<'s> = Vec<&'s Motion>;

/// What is moved, and how.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Key {
    /// The configuration as stated, for motions that are told of each; else none.
    family: Option<usize>,
    way: Way,
}

/// The motions of a model, with the sets of configurations that are moved together.
pub(super) struct Columns<'a, 's> {
    pub(super) x: &'s Inputs<'a>,
    pub(super) motions: &'s [Motion],
    /// Sets of configurations that the action couples; empty where each is moved by itself.
    pub(super) sets: Vec<Vec<usize>>,
    pub(super) passages: &'s [Passage<'a>],
}

impl<'a, 's> Columns<'a, 's> {
    /// Motions of a sort that may be combined, for each set. A turn about a place or about its own origin is one of the
    /// others of the set too, which have no place.
    pub(super) fn of_sort(&self, sort: Sort) -> Vec<Vec<Column<'s>>> {
        let own = || self.motions.iter().filter(|m| m.sort == sort);
        if self.sets.is_empty() {
            return vec![own().map(|m| vec![m]).collect()];
        }
        let mut out = self.by_key(sort);
        for (columns, set) in out.iter_mut().zip(&self.sets) {
            let whole: Vec<Column> = columns
                .iter()
                .filter(|list| matches!(list[0].way, Way::Spin | Way::About(_)))
                .filter_map(|list| {
                    let missing = |m: &&Motion| {
                        m.way == Way::Space
                            && set.contains(&m.configuration)
                            && list.iter().all(|l| l.configuration != m.configuration)
                    };
                    let rest: Column = own().filter(missing).collect();
                    (!rest.is_empty()).then(|| [list.clone(), rest].concat())
                })
                .collect();
            columns.extend(whole);
        }
        out
    }

    /// Motions of a sort of single copies, where something of every single momentum is conserved, and of single bodies
    /// that constraints hold.
    pub(super) fn of_every_site(&self, sort: Sort) -> Vec<Column<'s>> {
        // What constraints join is added up afterwards, of which each part is wanted.
        let held = !self.x.spec.holds.is_empty();
        let own = self.motions.iter();
        let own = own.filter(|m| m.sort == sort && m.way == Way::Space && !m.spanned);
        match self.is_lattice() {
            false if held => return own.map(|m| vec![m]).collect(),
            false => return Vec::new(),
            true => {}
        }
        let all = self.by_key(sort).into_iter().flatten();
        let single = |c: &Column| c.len() == 1 && self.copy(c[0].configuration).is_some();
        all.filter(single).collect()
    }

    /// Those of which all others are combinations.
    pub(super) fn basis(&self) -> Vec<Column<'s>> {
        let own = self.motions.iter().filter(|m| !m.spanned);
        // Of many bodies that are listed one by one each is counted.
        if !self.is_lattice() {
            return own.map(|m| vec![m]).collect();
        }
        let mut sorts: Vec<Sort> = Vec::new();
        for m in own {
            if !sorts.contains(&m.sort) {
                sorts.push(m.sort);
            }
        }
        let all = sorts.into_iter().flat_map(|sort| self.by_key(sort));
        let all = all.flatten();
        all.filter(|c| c.iter().all(|m| !m.spanned)).collect()
    }

    fn is_lattice(&self) -> bool {
        !self.sets.is_empty() && self.x.spec.configurations.iter().any(|c| c.copy.is_some())
    }

    /// Motions of a sort by what is moved and how, for each set.
    fn by_key(&self, sort: Sort) -> Vec<Vec<Column<'s>>> {
        let mut out: Vec<Vec<(Key, Column)>> = vec![Vec::new(); self.sets.len()];
        for m in self.motions.iter().filter(|m| m.sort == sort) {
            let set = self.sets.iter().position(|s| s.contains(&m.configuration));
            let Some(columns) = set.and_then(|i| out.get_mut(i)) else {
                continue;
            };
            let key = self.key(m);
            match columns.iter_mut().find(|(known, _)| *known == key) {
                Some((_, list)) => list.push(m),
                None => columns.push((key, vec![m])),
            }
        }
        let apart = |(key, list): (Key, Column<'s>)| match self.is_told_of_each(key, &list) {
            true => list.into_iter().map(|m| vec![m]).collect(),
            false => vec![list],
        };
        let columns = out.into_iter();
        columns
            .map(|set| set.into_iter().flat_map(apart).collect())
            .collect()
    }

    fn key(&self, m: &Motion) -> Key {
        let family = self.copy(m.configuration).map(|c| c.family);
        match m.way {
            Way::Spin | Way::About(_) => Key {
                family: None,
                way: m.way,
            },
            Way::Space | Way::Body | Way::Shift => Key { family, way: m.way },
            Way::Mixing { entry, by } => {
                let of = self.copy(by.configuration);
                let configuration = of.map_or(by.configuration, |c| c.family);
                let by = Component {
                    configuration,
                    ..by
                };
                Key {
                    family,
                    way: Way::Mixing { entry, by },
                }
            }
        }
    }

    fn copy(&self, configuration: usize) -> Option<CopyOf> {
        self.x.spec.configurations[configuration].copy
    }

    /// Whether these are told of each: some component of the momentum of every single copy is conserved.
    fn is_told_of_each(&self, key: Key, list: &Column) -> bool {
        // Numbers that are listed one by one may be coordinates along several axes.
        let number = |m: &&Motion| m.direction().0.is_scalar() && m.way == Way::Space;
        if list.iter().all(number) && !self.is_lattice() {
            return list.len() <= SINGLES;
        }
        let told = key.family.is_some() && matches!(key.way, Way::Space | Way::Body);
        told && list.len() > 1 && list.iter().all(|m| self.keeps_something(m))
    }

    fn keeps_something(&self, m: &Motion) -> bool {
        let mut kept: Option<Vec<bool>> = None;
        for p in self.passages {
            let (Some(before), Some(after)) = (p.before.value(&m.value), p.after.value(&m.value))
            else {
                return false;
            };
            // What vanishes always says nothing.
            let same = before.data.iter().zip(&after.data);
            let same = same.map(|(a, b)| a == b && *a != 0);
            kept = Some(match kept {
                None => same.collect(),
                Some(known) => known.iter().zip(same).map(|(k, s)| *k && s).collect(),
            });
        }
        kept.is_some_and(|k| k.contains(&true))
    }
}
