//! A table of a case, `[parameters]` or `[initial]`, and the keys that give the fields of a card.

use super::copies::Base;
use super::inertia;
use super::motion::elements;
use super::velocity::{Way, suffix};
use clebsch::card::Field;
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// One table.
pub(super) struct Table<'t, 'i> {
    pub name: &'static str,
    pub fields: &'static [Field],
    pub values: Option<&'t DeTable<'i>>,
    /// The range of the table in the text.
    pub span: Option<Range<usize>>,
    /// The initial values, which may include values prescribed at an end.
    others: Option<&'t DeTable<'i>>,
    /// The field names that could also be the key of another field, such as its inertia or its velocity.
    /// Without labels these are all names.
    names: HashSet<&'static str>,
    /// Whether the model has labels.
    at_sites: bool,
    /// Whether it gives velocities.
    pub moves: bool,
    /// The configuration of each momentum.
    pub elements: HashMap<usize, usize>,
}

/// A key that gives a field.
pub(super) struct Key<'k> {
    pub name: Cow<'k, str>,
    /// Whether the key gives the values at all sites.
    pub of_sites: bool,
    /// Whether the key gives the inertia instead of second moments.
    pub inertia: bool,
}

/// A value that the case gives.
pub(super) struct CaseValue<'k, 't, 'i> {
    pub key: Key<'k>,
    /// The table that has it.
    pub table: &'static str,
    pub value: &'t Spanned<DeValue<'i>>,
}

impl<'t, 'i> Table<'t, 'i> {
    /// The table with this name. If `held` is true, values prescribed at an end may be among the initial values.
    pub(super) fn of(
        top: &'t DeTable<'i>,
        (name, fields): (&'static str, &'static [Field]),
        (at_sites, held): (bool, bool),
    ) -> Self {
        let table = |name: &str| top.get(name).and_then(|t| t.get_ref().as_table());
        let values = table(name);
        let is_like = |name: &str| {
            let words = Way::ALL.map(Way::word);
            name.starts_with('I') || words.iter().any(|word| name.starts_with(word))
        };
        let names = fields.iter().map(|field| field.ascii);
        let mut keys = values.into_iter().flat_map(|t| t.keys());
        Self {
            name,
            fields,
            values,
            span: top.get(name).map(Spanned::span),
            others: table("initial").filter(|_| held),
            names: names.filter(|name| !at_sites || is_like(name)).collect(),
            at_sites,
            moves: keys.any(|key| key.get_ref().contains("velocity")),
            elements: elements(fields),
        }
    }

    /// The value under a key, and the table that has it.
    pub(super) fn get(
        &self,
        key: &str,
        held: bool,
    ) -> Option<(&'static str, &'t Spanned<DeValue<'i>>)> {
        let own = self.values.and_then(|t| t.get(key));
        let other = || self.others.filter(|_| held)?.get(key);
        own.map(|value| (self.name, value))
            .or_else(|| other().map(|value| ("initial", value)))
    }

    /// The first of these keys that the case gives.
    pub(super) fn find<'k>(
        &self,
        mut keys: impl Iterator<Item = Key<'k>>,
        held: bool,
    ) -> Option<CaseValue<'k, 't, 'i>> {
        keys.find_map(|key| {
            let (table, value) = self.get(&key.name, held)?;
            Some(CaseValue { key, table, value })
        })
    }

    /// The keys of a field; at the last end, the name `end` is a key too.
    pub(super) fn keys<'k>(
        &self,
        field: &'static Field,
        base: Option<&'k Base<'_>>,
        end: Option<String>,
    ) -> impl Iterator<Item = Key<'k>> {
        let all = match base {
            Some(base) => Some(Cow::Borrowed(&*base.key)),
            None => self.of_all_copies(field.ascii).map(Cow::Borrowed),
        };
        let names = [
            (Some(Cow::Borrowed(field.ascii)), false),
            (end.map(Cow::Owned), false),
            (all, base.is_some()),
        ];
        names.into_iter().flat_map(|(name, of_sites)| {
            let inertia = name.as_deref().and_then(|name| self.inertia(field, name));
            let key = move |(name, inertia)| Key {
                name,
                of_sites,
                inertia,
            };
            let names = [(name, false), (inertia.map(Cow::Owned), true)].into_iter();
            names
                .filter_map(|(name, inertia)| Some((name?, inertia)))
                .map(key)
        })
    }

    /// The key of the inertia that may replace second moments, unless a field has that name.
    pub(super) fn inertia(&self, field: &Field, name: &str) -> Option<String> {
        inertia::key_of(field, name).filter(|key| !self.names.contains(key.as_str()))
    }

    /// The velocities that may replace a momentum, with the keys of each.
    pub(super) fn ways<'k>(
        &'k self,
        momentum: usize,
        base: Option<&'k Base<'_>>,
    ) -> impl Iterator<Item = (Way, String, [Option<Key<'k>>; 3])> {
        let fields = self.moving(momentum).into_iter();
        let ways = fields.flat_map(|both| Way::ALL.map(|way| (way, both)));
        ways.filter_map(move |(way, (momentum, element))| {
            let written = way
                .key(momentum.ascii)
                .filter(|_| way.is_of(element, momentum))?;
            let is_only = suffix(momentum.ascii).is_some_and(str::is_empty);
            let named = is_only.then(|| format!("{written}_{}", element.ascii));
            let all = match base {
                Some(base) => way.key(&base.key),
                None => self.of_all_copies(&written).map(str::to_owned),
            };
            // A field of the model may have such a name.
            let key = |name: Option<String>, of_sites: bool| {
                let name = name.filter(|name| !self.names.contains(name.as_str()))?;
                Some(Key {
                    name: name.into(),
                    of_sites,
                    inertia: false,
                })
            };
            let keys = [
                key(Some(written.clone()), false),
                key(named, false),
                key(all, base.is_some()),
            ];
            Some((way, written, keys))
        })
    }

    /// A momentum and its configuration.
    pub(super) fn moving(&self, momentum: usize) -> Option<(&'static Field, &'static Field)> {
        let element = self.fields.get(*self.elements.get(&momentum)?)?;
        Some((self.fields.get(momentum)?, element))
    }

    /// The name of all copies of a quantity with numbered names: `x` for `x1`, `x_2`. `None` if a field has this
    /// name.
    fn of_all_copies<'k>(&self, name: &'k str) -> Option<&'k str> {
        let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
        if self.at_sites || stem.len() == name.len() {
            return None;
        }
        let stem = stem.strip_suffix('_').unwrap_or(stem);
        (!stem.is_empty() && !self.names.contains(stem)).then_some(stem)
    }

    /// The keys of velocities, for messages.
    pub(super) fn how_to_move(&self) -> Option<String> {
        let mut keys: Vec<String> = Vec::new();
        for index in 0..self.fields.len() {
            for (way, _, names) in self.ways(index, None) {
                let Some(key) = names.into_iter().flatten().next() else {
                    continue;
                };
                let said = match way {
                    Way::Rate => format!("`{}`", key.name),
                    Way::Body => format!("`{}` (in the axes of the body)", key.name),
                    Way::Space => format!("`{}` (in space axes)", key.name),
                };
                if !keys.contains(&said) {
                    keys.push(said);
                }
            }
        }
        (!keys.is_empty()).then(|| format!("; velocities are given by {}", keys.join(", ")))
    }
}
