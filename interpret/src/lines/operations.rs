//! The recorded loops over sites of a chain as text.

use super::LineModel;
use crate::listing;
use std::collections::BTreeSet;

impl LineModel {
    /// The loops of a step, of the energies and of the totals, if they are recorded.
    pub(super) fn operations(&self) -> Option<String> {
        let totals = self.totals.iter().map(|(_, total)| total);
        let routines = [&self.step].into_iter().chain(&self.energies).chain(totals);
        let (mut met, mut sections) = (BTreeSet::new(), Vec::new());
        for routine in routines {
            routine.body.sections(&self.names, &mut met, &mut sections);
        }
        listing::text(&sections)
    }
}
