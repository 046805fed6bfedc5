//! A model with labels, as its file states it: how many sites it has where no case says it, and which keys belong to ends that are
//! not chosen.

use super::copies::Copies;
use super::space::Space;
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::{Choice, Lattice};
use clebsch_core::syntax::ast::Model;
use clebsch_core::{document, pipeline};

/// Number of sites where no case says one.
pub(super) const SITES: usize = 8;

/// Number of particles of a fluid where no case says one.
pub(super) const PARTICLES: usize = 64;

/// A model with labels, as its file states it.
pub(crate) struct Stated {
    pub model: Model,
    pub lattice: Lattice,
}

impl Stated {
    /// Reads the text of a model; `None` where it has no labels or is no model.
    pub(crate) fn read(source: &str) -> Option<Stated> {
        let model = pipeline::parse_source(source).ok()?;
        if !clebsch_core::lattice::has_labels(&model) {
            return None;
        }
        let lattice = Lattice::read(&model).ok()?;
        Some(Stated { model, lattice })
    }

    /// What holds where no case says otherwise.
    pub(crate) fn default_choice(&self) -> Option<Choice> {
        let shortest = pipeline::representative(&self.model, &self.lattice).ok()?;
        let mut choice = document::default_choice(&self.lattice, shortest);
        for count in &mut choice.counts {
            *count = SITES;
        }
        if let Some(space) = Space::sample(self) {
            for (count, label) in choice.counts.iter_mut().zip(&self.lattice.labels) {
                *count = if label.grid { space.count() } else { PARTICLES };
            }
        }
        Some(choice)
    }

    /// Whether a key belongs to an end condition or a ring that is not chosen: a case keeps it.
    pub(super) fn of_other_ends(&self, key: &str) -> bool {
        let ends = self.lattice.ends.iter().flatten();
        let mut names = ends
            .flat_map(|a| &a.params)
            .flat_map(|(names, _)| names.iter().map(|n| ascii(&n.text)));
        let bare = key.rsplit_once('_').map_or(key, |(base, _)| base);
        let mut offsets = self
            .lattice
            .quantities
            .iter()
            .filter_map(|q| q.offset.as_ref());
        names.any(|n| n == key || n == bare) || offsets.any(|o| ascii(&o.text) == key)
    }

    /// The copies of quantities at the sites of a choice.
    pub(crate) fn copies(&self, choice: &Choice) -> Option<Copies> {
        Copies::of(self, choice)
    }
}
