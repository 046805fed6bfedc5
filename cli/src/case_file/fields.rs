//! The tables `[parameters]` and `[initial]` of a case. Takes a table and the fields of a card; gives the
//! numbers of each field, in order, and the velocities of configurations without a given momentum.

use super::at_sites::AtSites;
use super::copies::Base;
use super::from_npz::Arrays;
use super::keys::quantity_of;
use super::location::File;
use super::motion::{Motion, Start};
use super::scope::Scope;
use super::table::{CaseValue, Table};
use super::taken_as::TakenAs;
use super::value::expected;
use super::velocity::Way;
use crate::models::fields::is_momentum;
use crate::terminal::failure::Failure;
use clebsch::card::{Card, Field};
use std::collections::{BTreeMap, HashSet};
use toml::de::DeTable;

/// Reads tables of a case.
pub(super) struct Fields<'a> {
    pub file: &'a File<'a>,
    pub scope: &'a Scope,
    pub arrays: Arrays,
    /// The sites, if the model has labels.
    pub sites: Option<&'a AtSites<'a>>,
    /// The lines of keys.
    pub lines: BTreeMap<String, usize>,
    /// The velocities that the case gives, and the configurations that start at rest.
    pub motion: Motion,
    /// Keys of each table from which a value was read.
    pub seen: BTreeMap<&'static str, HashSet<String>>,
    /// Quantities whose lines are stored for all sites.
    pub quantities: HashSet<(&'static str, &'static str)>,
}

impl Fields<'_> {
    /// The numbers of all parameters and initial values of a card.
    pub(super) fn read(
        &mut self,
        top: &DeTable<'_>,
        card: &Card,
    ) -> Result<[Vec<Vec<f64>>; 2], Failure> {
        let at_sites = self.sites.is_some();
        for name in ["parameters", "initial"] {
            self.file.table(top, name)?;
        }
        let parameters = ("parameters", card.parameters);
        let parameters = self.table(&Table::of(top, parameters, (at_sites, true)))?;
        let initial = ("initial", card.initial);
        let initial = self.table(&Table::of(top, initial, (at_sites, false)))?;
        Ok([parameters, initial])
    }

    fn table(&mut self, table: &Table<'_, '_>) -> Result<Vec<Vec<f64>>, Failure> {
        if self.sites.is_none() {
            let needed = table.fields.iter().filter(|field| !is_momentum(field));
            let needed: Vec<&str> = needed.map(|field| field.ascii).collect();
            if table.span.is_none() && !needed.is_empty() {
                let keys = needed.join(", ");
                let message = format!("missing table [{}] with keys {keys}", table.name);
                return Err(self.file.wrong(None, &message));
            }
            self.reject_unknown_keys(table)?;
        }
        let sites = self.sites;
        let mut all = Vec::with_capacity(table.fields.len());
        for (index, field) in table.fields.iter().enumerate() {
            let base = sites.and_then(|sites| sites.base(field));
            all.push(self.field(table, index, field, base.as_ref())?);
        }
        if self.sites.is_some() {
            self.reject_unknown_keys(table)?;
        }
        Ok(all)
    }

    fn field(
        &mut self,
        table: &Table<'_, '_>,
        index: usize,
        field: &'static Field,
        base: Option<&Base<'_>>,
    ) -> Result<Vec<f64>, Failure> {
        if let Some((numbers, line)) = self.of_fluid(field.ascii, base.map(|b| (&*b.key, b.site))) {
            let numbers = self.plain(field, (table.name, field.ascii), numbers, line)?;
            self.keep_line(table.name, field.ascii, line, base.is_some());
            return Ok(numbers);
        }
        let end = base.and_then(|base| self.sites?.at_end(base));
        let held = base.is_some_and(|b| b.given);
        let Some(found) = table.find(table.keys(field, base, end), held) else {
            if is_momentum(field) && table.elements.contains_key(&index) {
                self.velocities(table, index, base)?;
                return Ok(vec![0.0; field.count()]);
            }
            // A misspelt key is reported first.
            if base.is_none() {
                self.reject_unknown_keys(table)?;
            }
            return Err(self.missing(table, field, base));
        };
        if let Some(second) = self.second(table, &found, (index, field), base) {
            return Err(second);
        }
        let taken_as = match found.key.inertia {
            true => TakenAs::Inertia,
            false => TakenAs::Itself,
        };
        let own = match found.key.inertia {
            true => table.inertia(field, field.ascii),
            false => None,
        };
        let written = own.as_deref().unwrap_or(field.ascii);
        let numbers = self.valued(&found, (field, base), taken_as, written)?;
        let line = self.file.line(&found.value.span());
        let of_sites = found.key.of_sites && found.table == table.name;
        self.keep_line(found.table, field.ascii, line, of_sites);
        self.see(&found);
        Ok(numbers)
    }

    /// The failure if a field is given twice: also by its inertia, or a momentum also by a velocity.
    fn second(
        &self,
        table: &Table<'_, '_>,
        found: &CaseValue<'_, '_, '_>,
        (index, field): (usize, &Field),
        base: Option<&Base<'_>>,
    ) -> Option<Failure> {
        let key = &found.key;
        let inertia = table.inertia(field, &key.name).filter(|_| !key.inertia);
        if let Some((_, value)) = inertia.and_then(|inertia| table.get(&inertia, false)) {
            let why = "is given twice, directly and by its inertia";
            let message = format!("{}.{}: {why}", table.name, key.name);
            return Some(self.file.wrong(Some(&value.span()), &message));
        }
        if !(table.moves && is_momentum(field)) {
            return None;
        }
        let velocities = table.ways(index, base).filter_map(|(_, _, keys)| {
            // One site may have a momentum although the other sites have velocities.
            let keys = keys.into_iter().flatten();
            table.find(keys.filter(|own| !own.of_sites || key.of_sites), false)
        });
        let other = velocities.last()?;
        let message = format!(
            "{}.{}: conflicts with {}: give one of them",
            table.name, other.key.name, key.name
        );
        Some(self.file.wrong(Some(&other.value.span()), &message))
    }

    /// The velocities of a configuration without a given momentum. Without velocities, it starts at rest.
    fn velocities(
        &mut self,
        table: &Table<'_, '_>,
        index: usize,
        base: Option<&Base<'_>>,
    ) -> Result<(), Failure> {
        let Some((momentum, element)) = table.moving(index) else {
            return Ok(());
        };
        let is_fluid = self.sites.is_some_and(|sites| sites.fluid.is_some());
        let mut turns: Option<String> = None;
        let before = self.motion.given.len();
        let ways = table.ways(index, base).filter(|_| table.moves || is_fluid);
        for (way, written, keys) in ways {
            let field = way.field(element, momentum);
            let all = base.and_then(|b| Some((way.key(&b.key)?, b.site)));
            let place = all.as_ref().map(|(key, site)| (key.as_str(), *site));
            let (key, numbers, line, of_sites) = match self.of_fluid(&written, place) {
                Some((numbers, line)) => {
                    let named = (table.name, written.as_str());
                    let numbers = self.plain(&field, named, numbers, line)?;
                    (written, numbers, line, true)
                }
                None => {
                    let Some(found) = table.find(keys.into_iter().flatten(), false) else {
                        continue;
                    };
                    let key = match self.sites {
                        Some(_) => written,
                        None => found.key.name.to_string(),
                    };
                    if let Some(other) = turns.as_ref().filter(|_| way != Way::Rate) {
                        let message = format!(
                            "{}.{key}: conflicts with {other}: give one of them",
                            table.name
                        );
                        return Err(self.file.wrong(Some(&found.value.span()), &message));
                    }
                    let numbers = self.valued(&found, (&field, base), TakenAs::Velocity, &key)?;
                    self.see(&found);
                    let line = self.file.line(&found.value.span());
                    (key, numbers, line, found.key.of_sites)
                }
            };
            self.keep_line(table.name, momentum.ascii, line, of_sites);
            if way != Way::Rate {
                turns = Some(key.clone());
            }
            self.motion.given.push(Start {
                momentum: index,
                way,
                key,
                line,
                numbers,
            });
        }
        if self.motion.given.len() == before {
            self.motion.resting.push(index);
        }
        Ok(())
    }

    fn missing(&self, table: &Table<'_, '_>, field: &Field, base: Option<&Base<'_>>) -> Failure {
        let what = expected(field);
        let name = table.name;
        let Some((base, sites)) = base.zip(self.sites) else {
            let message = format!("missing key `{name}.{}`: {what}", field.ascii);
            return self.file.wrong(table.span.as_ref(), &message);
        };
        let (key, site) = (&base.key, base.site);
        let index = sites.index(base);
        let message = match base.end {
            true => {
                format!("missing key `{name}.{key}`: {what}, of the end condition at site {site}")
            }
            false => format!(
                "missing key `{name}.{key}` for site {index} = {site}: {what}; give numbers or expressions in {index} for all sites, or a list with one entry per site"
            ),
        };
        self.file.wrong(None, &message)
    }

    fn see(&mut self, found: &CaseValue<'_, '_, '_>) {
        let seen = self.seen.entry(found.table).or_default();
        if !seen.contains(&*found.key.name) {
            seen.insert(found.key.name.to_string());
        }
    }

    /// Stores the line of a value under the name of its field. Values at all sites share one entry, under the
    /// name of their quantity.
    fn keep_line(&mut self, table: &'static str, field: &'static str, line: usize, of_sites: bool) {
        let quantity = quantity_of(field).filter(|_| of_sites);
        if quantity.is_none_or(|quantity| self.quantities.insert((table, quantity))) {
            let key = format!("{table}.{}", quantity.unwrap_or(field));
            self.lines.insert(key, line);
        }
    }
}
