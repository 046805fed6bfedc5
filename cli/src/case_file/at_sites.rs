//! The sites of a case, if the model has labels: the names that expressions can use there, and the element of a list
//! or an array for each site.

use super::chain_choice;
use super::copies::{Base, Copies, Group, base};
use super::fluid::Fluid;
use super::location::File;
use super::names::Names;
use super::scope::Scope;
use super::sites::Site;
use super::stated::Stated;
use crate::terminal::failure::Failure;
use clebsch::card::Field;
use clebsch_core::lattice::ChainConfig;
use clebsch_core::lattice::value::SiteData;
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;
use toml::de::DeTable;

/// The sites of a case.
pub(super) struct AtSites<'a> {
    pub stated: &'a Stated,
    pub choice: ChainConfig,
    pub fluid: Option<Fluid>,
    copies: Copies,
    /// Expressions by their texts, each parsed once for all sites.
    expressions: RefCell<HashMap<String, Rc<SiteData>>>,
}

impl<'a> AtSites<'a> {
    /// Reads the sites of a case.
    pub(super) fn read(
        file: &File<'_>,
        top: &DeTable<'_>,
        stated: &'a Stated,
    ) -> Result<Self, Failure> {
        let choice = chain_choice::of_case(file, top, stated)?;
        let copies = choice
            .as_ref()
            .and_then(|choice| Copies::of(stated, choice));
        let wrong = || file.wrong(None, "the model cannot be expanded");
        let (choice, copies) = (choice.ok_or_else(wrong)?, copies.ok_or_else(wrong)?);
        Ok(Self {
            stated,
            fluid: Fluid::read(file, top, stated, &choice)?,
            choice,
            copies,
            expressions: RefCell::default(),
        })
    }

    /// The quantity and site that a field of the card is a copy of.
    pub(super) fn base(&self, field: &Field) -> Option<Base<'_>> {
        base(&self.copies, field)
    }

    /// The copies of a quantity.
    pub(super) fn group(&self, of: &str) -> Option<&Group> {
        self.copies.groups.iter().find(|group| group.of == of)
    }

    /// The label of the sites of a copy.
    pub(super) fn index(&self, base: &Base<'_>) -> &str {
        let label = self.stated.lattice.labels.get(base.label);
        label.map_or("i", |l| l.index.text.as_str())
    }

    /// The name of a copy at the last end, such as `m_N`.
    pub(super) fn at_end(&self, base: &Base<'_>) -> Option<String> {
        let label = self.stated.lattice.labels.get(base.label)?;
        let is_last = base.site == self.choice.count(base.label);
        is_last.then(|| format!("{}_{}", base.key, label.count.text))
    }

    /// At which of its sites a field is.
    pub(super) fn at<'f>(&self, field: &'f Field, base: &Base<'_>) -> Site<'f> {
        // A momentum is undefined at sites whose configuration an end condition prescribes; a list may omit these
        // sites.
        let group = self.group(base.of);
        let (every, left) = group.map_or((&[][..], &[][..]), |g| (&g.sites[..], &g.moving[..]));
        let place = |list: &[usize]| list.binary_search(&base.site).unwrap_or(0);
        Site {
            field,
            place: place(every),
            count: if base.end { 1 } else { every.len() },
            moving: base.is_momentum.then(|| (place(left), left.len())),
        }
    }
}

/// The names that an expression can use: the numbers of the case, and at a site its number.
pub(super) struct Here<'a> {
    pub scope: &'a Scope,
    pub sites: Option<&'a AtSites<'a>>,
    pub base: Option<&'a Base<'a>>,
}

impl Names for Here<'_> {
    #[allow(clippy::cast_precision_loss)]
    fn number(&self, name: &str) -> Option<f64> {
        let of_sites = self.sites.and_then(|sites| {
            let labels = &sites.stated.lattice.labels;
            let count = labels.iter().position(|l| l.count.text == name);
            let count = count.map(|i| sites.choice.count(i) as f64);
            let here = self.base.filter(|base| sites.index(base) == name);
            count.or(here.map(|base| base.site as f64))
        });
        of_sites.or_else(|| self.scope.number(name))
    }

    fn expression(&self, text: &str) -> Result<Rc<SiteData>, String> {
        let Some(sites) = self.sites else {
            return self.scope.expression(text);
        };
        let mut all = sites.expressions.borrow_mut();
        if let Some(known) = all.get(text) {
            return Ok(known.clone());
        }
        let read = Rc::new(SiteData::read(text)?);
        all.insert(text.to_owned(), read.clone());
        Ok(read)
    }
}
