//! The numbers of a field from the value that a case gives: at one site of a list, from an array of a file, or computed for a fluid.

use super::at_sites::Here;
use super::copies::Base;
use super::fields::Fields;
use super::from_npz::{self, AcceptedShapes, Fault};
use super::inertia;
use super::sites;
use super::table::CaseValue;
use super::taken_as::TakenAs;
use super::value::{expected, is_element};
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use clebsch::card::Field;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The names that the expression of a site may use, for messages.
const READS: &str = ": an expression at a site may contain its label, the number of sites, and numbers of the case that are \
    the same at all sites";

impl<'a> Fields<'a> {
    /// Numbers that were computed for all particles of a fluid, and the line of their key.
    pub(super) fn of_fluid(
        &self,
        name: &str,
        place: Option<(&str, usize)>,
    ) -> Option<(&'a [f64], usize)> {
        self.sites?.fluid.as_ref()?.numbers(name, place)
    }

    /// Numbers that need no conversion to be the value of a field.
    pub(super) fn plain(
        &self,
        field: &Field,
        (table, written): (&str, &str),
        numbers: &[f64],
        line: usize,
    ) -> Result<Vec<f64>, Failure> {
        let fits = field.cols == 1 && field.rows == numbers.len();
        let why = match numbers.iter().find(|x| !x.is_finite()) {
            None if fits => return Ok(numbers.to_vec()),
            None => format!(
                "expected {}, found {} numbers",
                expected(field),
                numbers.len()
            ),
            Some(x) => format!("{x} is not a finite number"),
        };
        let message = format!("{table}.{written}: {why}");
        Err(self.file.wrong_at(line.max(1), &message))
    }

    /// The numbers of a field from the value that was found; `written` is its key with its site.
    pub(super) fn valued(
        &self,
        found: &CaseValue<'_, '_, '_>,
        (field, base): (&Field, Option<&Base<'_>>),
        taken_as: TakenAs,
        written: &str,
    ) -> Result<Vec<f64>, Failure> {
        let own = &*found.key.name;
        let wrong = |key: &str, why: &str, at: &Range<usize>| {
            let message = format!("{}.{}: {why}", found.table, shown(key));
            self.file.wrong(Some(at), &message)
        };
        let span = found.value.span();
        let base = base.filter(|_| found.key.of_sites);
        let at = self
            .sites
            .zip(base)
            .map(|(sites, base)| sites.at(field, base));
        let (value, is_listed) = match at {
            Some(at) if !from_npz::is_meant(found.value.get_ref()) => {
                sites::at(&at, found.value).map_err(|why| wrong(own, &why, &span))?
            }
            _ => (found.value, false),
        };
        let inside = inertia::inside(field, value.get_ref());
        let inside = inside.filter(|_| taken_as == TakenAs::Itself);
        let (value, taken_as, dot) = match inside {
            Some(inertia) => (inertia, TakenAs::Inertia, ".I"),
            None => (value, taken_as, ""),
        };
        if from_npz::is_meant(value.get_ref()) {
            let read = self.of_array(field, base, taken_as, own, value);
            return read.map_err(|fault| wrong(&format!("{own}{dot}"), &fault.why, &fault.at));
        }
        let here = Here {
            scope: self.scope,
            sites: self.sites,
            base,
        };
        taken_as
            .value(field, value.get_ref(), &here)
            .map_err(|why| {
                let Some(sites) = self.sites else {
                    return wrong(&format!("{own}{dot}"), &self.scope.explained(why), &span);
                };
                // A mistake that is the same at every site is reported for the key as the case contains it.
                let other = |table: &DeTable<'_>| !table.contains_key("I");
                let is_whole = is_element(field) || value.get_ref().as_table().is_some_and(other);
                let unvalued = match is_whole {
                    true => Some(why.clone()),
                    false => sites::unvalued(value.get_ref(), &here),
                };
                match (unvalued, base) {
                    (None, _) => {
                        // The message contains the site, which identifies the expression.
                        let why = why.rsplit_once("\": ").map_or(why.as_str(), |(_, why)| why);
                        wrong(&format!("{written}{dot}"), why, &span)
                    }
                    (Some(why), None) => wrong(own, &self.scope.explained(why), &span),
                    (Some(why), Some(base)) => {
                        let listed = match is_listed {
                            true => format!("at {} = {}, ", sites.index(base), base.site),
                            false => String::new(),
                        };
                        let is_missing = why.ends_with("has no value here");
                        let reads = if is_missing { READS } else { "" };
                        wrong(own, &format!("{listed}{why}{reads}"), &span)
                    }
                }
            })
    }

    /// The value of a copy, or of a quantity without sites, from an array of a file.
    fn of_array(
        &self,
        field: &Field,
        base: Option<&Base<'_>>,
        taken_as: TakenAs,
        named: &str,
        value: &Spanned<DeValue<'_>>,
    ) -> Result<Vec<f64>, Fault> {
        let values = from_npz::shapes(&taken_as.of_array(field));
        let base = base.filter(|b| !b.end);
        let group = base.and_then(|b| self.sites?.group(b.of));
        let may_move = base.is_some_and(|b| b.is_momentum);
        let wanted = AcceptedShapes {
            values: &values,
            sites: group.map(|g| &g.sites[..]),
            moving: group.filter(|_| may_move).map(|g| &g.moving[..]),
        };
        let taken = self.arrays.take(value, named, wanted)?;
        let numbers = taken.at(base.map_or(0, |b| b.site));
        let read = numbers.and_then(|numbers| taken_as.array(field, numbers, taken.shape()));
        read.map_err(|why| Fault {
            why,
            at: value.span(),
        })
    }
}
