//! Selects the motions that are combined. With few configurations, each is moved separately; with many, the
//! configurations that the action couples are moved together. On a chain, the copies of one configuration are moved
//! together at all sites, or separately if part of every single momentum is conserved. Takes the motions; gives lists
//! of them, whose combinations are searched.

use super::Inputs;
use super::mixed::Component;
use super::motions::{Motion, Sort, Way};
use super::noether::components;
use super::random_step::RandomStep;
use crate::check::spec::CopyOf;

/// The largest number of configurations whose momenta are combined individually; otherwise, all coupled ones
/// together.
const FEW: usize = 4;

/// The largest number of scalars in one set whose translations are combined individually.
const SINGLES: usize = 32;

/// A list of motions that are performed together.
pub(super) type Column<'s> = Vec<&'s Motion>;

/// Identifies what a motion moves, and how.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Key {
    /// The configuration as stated, for motions that are listed per configuration; otherwise None.
    family: Option<usize>,
    way: Way,
}

/// The motions of a model, grouped by sort.
pub(super) struct Columns<'s>(Vec<OfSort<'s>>);

/// The columns of one sort.
struct OfSort<'s> {
    sort: Sort,
    /// The motions that may be combined, for each set of coupled configurations.
    combined: Vec<Vec<Column<'s>>>,
    /// Single motions that are reported first.
    single: Vec<Column<'s>>,
    /// The columns that span all others.
    basis: Vec<Column<'s>>,
}

impl<'s> Columns<'s> {
    /// The columns of these motions.
    pub(super) fn new(x: &Inputs, motions: &'s [Motion], passages: &[RandomStep]) -> Self {
        let is_lattice = x.spec.configurations.iter().any(|c| c.copy.is_some());
        let coupled = Coupled {
            x,
            passages,
            is_lattice,
            sets: match x.spec.configurations.len() > FEW || is_lattice {
                true => components(x),
                false => Vec::new(),
            },
        };
        let mut sorts: Vec<(Sort, Vec<&Motion>)> = Vec::new();
        for m in motions {
            match sorts.iter_mut().find(|(sort, _)| *sort == m.sort) {
                Some((_, own)) => own.push(m),
                None => sorts.push((m.sort, vec![m])),
            }
        }
        let of_sort = |(sort, own): (Sort, Vec<&'s Motion>)| coupled.of_sort(sort, &own);
        Columns(sorts.into_iter().map(of_sort).collect())
    }

    /// The sorts, in the order of the motions.
    pub(super) fn sorts(&self) -> Vec<Sort> {
        self.0.iter().map(|own| own.sort).collect()
    }

    /// Motions of a sort that may be combined, for each set.
    pub(super) fn of_sort(&self, sort: Sort) -> &[Vec<Column<'s>>] {
        self.own(sort).map_or(&[], |own| &own.combined)
    }

    /// Motions of single copies, if part of every single momentum is conserved, and motions of single constrained
    /// bodies.
    pub(super) fn of_every_site(&self, sort: Sort) -> &[Column<'s>] {
        self.own(sort).map_or(&[], |own| &own.single)
    }

    /// The columns that span all others, for all sorts.
    pub(super) fn basis(&self) -> impl Iterator<Item = &Column<'s>> {
        self.0.iter().flat_map(|own| &own.basis)
    }

    fn own(&self, sort: Sort) -> Option<&OfSort<'s>> {
        self.0.iter().find(|own| own.sort == sort)
    }
}

/// Decides which motions are combined.
struct Coupled<'x, 'a> {
    x: &'x Inputs<'a>,
    passages: &'x [RandomStep<'a>],
    /// Whether the model is an expanded chain.
    is_lattice: bool,
    /// Sets of configurations that the action couples; none if each is moved separately.
    sets: Vec<Vec<usize>>,
}

impl Coupled<'_, '_> {
    fn of_sort<'s>(&self, sort: Sort, own: &[&'s Motion]) -> OfSort<'s> {
        let alone = |m: &&'s Motion| vec![*m];
        let by_key = self.by_key(own);
        let unspanned = own.iter().filter(|m| !m.spanned);
        let (single, basis) = match self.is_lattice {
            true => {
                let all = || by_key.iter().flatten();
                let is_single =
                    |c: &&Column| c.len() == 1 && self.copy(c[0].configuration).is_some();
                let is_basis = |c: &&Column| c.iter().all(|m| !m.spanned);
                (
                    all().filter(is_single).cloned().collect(),
                    all().filter(is_basis).cloned().collect(),
                )
            }
            // If bodies are listed one by one, each counts separately. Bodies that constraints connect are summed
            // afterwards, so the momentum of each is needed.
            false => {
                let held = !self.x.spec.holds.is_empty();
                let of_space = unspanned.clone().filter(|m| held && m.way == Way::Space);
                (
                    of_space.map(alone).collect(),
                    unspanned.map(alone).collect(),
                )
            }
        };
        OfSort {
            sort,
            combined: match self.sets.is_empty() {
                true => vec![own.iter().map(alone).collect()],
                false => self.with_wholes(own, by_key),
            },
            single,
            basis,
        }
    }

    /// Rotations about a position, or about the body's own origin, are combined with the rotations of the members of
    /// the set that have no position.
    fn with_wholes<'s>(
        &self,
        own: &[&'s Motion],
        mut columns: Vec<Vec<Column<'s>>>,
    ) -> Vec<Vec<Column<'s>>> {
        for (columns, set) in columns.iter_mut().zip(&self.sets) {
            let whole: Vec<Column> = columns
                .iter()
                .filter(|list| matches!(list[0].way, Way::Spin | Way::About(_)))
                .filter_map(|list| {
                    let missing = |m: &&&Motion| {
                        m.way == Way::Space
                            && set.contains(&m.configuration)
                            && list.iter().all(|l| l.configuration != m.configuration)
                    };
                    let rest: Column = own.iter().filter(missing).copied().collect();
                    (!rest.is_empty()).then(|| [list.clone(), rest].concat())
                })
                .collect();
            columns.extend(whole);
        }
        columns
    }

    /// Motions grouped by what they move and how, for each set.
    fn by_key<'s>(&self, own: &[&'s Motion]) -> Vec<Vec<Column<'s>>> {
        let mut out: Vec<Vec<(Key, Column)>> = vec![Vec::new(); self.sets.len()];
        for m in own.iter().copied() {
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

    /// Whether these motions are reported for each copy: a component of the momentum of every single copy is
    /// conserved.
    fn is_told_of_each(&self, key: Key, list: &Column) -> bool {
        // Scalars listed individually may be coordinates along several axes.
        let number = |m: &&Motion| m.direction().0.is_scalar() && m.way == Way::Space;
        if list.iter().all(number) && !self.is_lattice {
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
            // A zero entry does not count as conserved.
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
