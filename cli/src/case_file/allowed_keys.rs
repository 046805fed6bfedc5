//! The keys that a table of a case may contain. Takes a table; rejects a key without a field, and suggests the
//! intended key.

use super::at_sites::AtSites;
use super::fields::Fields;
use super::table::{Key, Table};
use super::velocity;
use crate::terminal::failure::Failure;
use crate::words::suggestion::{did_you_mean, slip};
use std::collections::HashSet;

impl Fields<'_> {
    /// Rejects keys without a field.
    pub(super) fn reject_unknown_keys(&self, table: &Table<'_, '_>) -> Result<(), Failure> {
        let Some(values) = table.values else {
            return Ok(());
        };
        // Two more kinds of keys are accepted: in [initial], a configuration whose value is given at every site; in
        // [parameters], a parameter of an end condition that is not chosen.
        let is_left = |sites: &AtSites<'_>, key: &str| match table.name {
            "initial" => sites.group(key).is_some(),
            _ => sites.stated.of_other_ends(key),
        };
        let seen = self.seen.get(table.name);
        let is_own = |key: &str| {
            let is_seen = seen.is_some_and(|seen| seen.contains(key));
            is_seen || self.sites.is_some_and(|sites| is_left(sites, key))
        };
        if values.keys().all(|key| is_own(key.get_ref())) {
            return Ok(());
        }
        let names = self.names(table);
        let mut known: Vec<&str> = names.iter().map(String::as_str).collect();
        let left = values.keys().map(|key| key.get_ref().as_ref());
        let left: Vec<&str> = left.filter(|key| is_own(key)).collect();
        let place = format!("in [{}]", table.name);
        if self.sites.is_some() {
            known.sort_unstable();
            let listed = known.clone();
            known.extend(left);
            let otherwise = |asked: &str| Some(did_you_mean(asked, listed.iter().copied()));
            return self.file.known_keys(values, &known, &place, &otherwise);
        }
        let otherwise = |asked: &str| {
            // `"Λ"` is how the model writes it, but files use the ASCII name.
            let written = table.fields.iter().find(|field| field.name == asked);
            let near = written.map(|field| field.ascii);
            if let Some(near) = near.or_else(|| slip(asked, &known)) {
                return Some(format!("; did you mean `{near}`?"));
            }
            velocity::is_meant(asked)
                .then(|| table.how_to_move())
                .flatten()
        };
        self.file.known_keys(values, &known, &place, &otherwise)
    }

    /// The keys of the fields of a table, in order.
    fn names(&self, table: &Table<'_, '_>) -> Vec<String> {
        let fluid = self.sites.and_then(|sites| sites.fluid.as_ref());
        let mut names: Vec<String> = fluid
            .iter()
            .flat_map(|f| f.used())
            .map(str::to_owned)
            .collect();
        let mut known: HashSet<String> = names.iter().cloned().collect();
        let mut put = |key: Key<'_>| {
            if !known.contains(&*key.name) {
                known.insert(key.name.to_string());
                names.push(key.name.into_owned());
            }
        };
        for (index, field) in table.fields.iter().enumerate() {
            let base = self.sites.and_then(|sites| sites.base(field));
            let base = base.as_ref();
            if self
                .of_fluid(field.ascii, base.map(|b| (&*b.key, b.site)))
                .is_some()
            {
                continue;
            }
            let end = base.and_then(|base| self.sites?.at_end(base));
            table.keys(field, base, end).for_each(&mut put);
            let ways = table.ways(index, base).flat_map(|(_, _, keys)| keys);
            ways.flatten().for_each(&mut put);
        }
        names
    }
}
