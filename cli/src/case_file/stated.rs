//! A model with labels, as its file states it, and the keys of a case that belong to end conditions that are not
//! chosen.

use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::Lattice;
use clebsch_core::pipeline;
use clebsch_core::syntax::ast::Model;

/// A model with labels, as its file states it.
pub(crate) struct Stated {
    pub model: Model,
    pub lattice: Lattice,
}

impl Stated {
    /// Reads the text of a model; `None` if the text is not a model or the model has no labels.
    pub(crate) fn read(source: &str) -> Option<Stated> {
        let model = pipeline::parse_source(source).ok()?;
        if !clebsch_core::lattice::has_labels(&model) {
            return None;
        }
        let lattice = Lattice::read(&model).ok()?;
        Some(Stated { model, lattice })
    }

    /// Whether a key belongs to an end condition or a ring that is not chosen: a case may contain it.
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
}
