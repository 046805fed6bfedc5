//! What derives on a lattice and is hardly meant, in the words of the statement.

use super::Unfolded;
use crate::derive::warnings::{Topic, Warning};
use crate::diagnostic::Diagnostic;
use crate::lattice::Choice;
use crate::syntax::ast::{Expression, Name};

/// The sum of such a term starts or ends a site later than that of the same term at the site itself.
pub(super) fn one_neighbour(stated: &Expression) -> Warning {
    let message = "this term holds a neighbour and not the site itself: it is summed over the sites that have this neighbour, all but the one at the end";
    let d = Diagnostic::new(stated.place, message).help(
        "write it at the site itself, or in one bracket with what it is compared with, as in `a*(next(q, i) - q)`",
    );
    Warning::new(Topic::OneNeighbour, d)
}

/// An offset acts across the seam of a ring only.
pub(super) fn without_a_ring(offset: &Name) -> Warning {
    let message = format!(
        "`{}` is what a field grows by around a ring, and the line is not said to be periodic",
        offset.text
    );
    let d = Diagnostic::new(offset.place, message);
    Warning::new(
        Topic::UnusedParameter,
        d.help("add `periodic;`, or leave the offset out"),
    )
}

impl Unfolded {
    /// What is hardly meant, in the words of the statement: of terms first, then what the derivation
    /// finds. Of a line that is held or short, what is unused or constant there may be neither on others.
    pub fn told(&self, choice: &Choice, found: &[Warning]) -> Vec<Warning> {
        let shortest = 2 * self.width() + 2;
        // Without neighbours one site tells of all.
        let short = self.width() > 0 && choice.counts.iter().all(|n| *n < shortest);
        let partial = short || !self.given.is_empty();
        let mut out: Vec<Warning> = Vec::new();
        for w in self.warnings.iter().chain(found) {
            let of_this_choice = matches!(w.topic, Topic::UnusedParameter | Topic::ConstantTerm);
            let place = |w: &Warning| format!("{:?}", w.diagnostic.place);
            let known = |o: &Warning| o.topic == w.topic && place(o) == place(w);
            let stated = self.warnings.iter().any(known);
            if partial && of_this_choice && !stated || out.iter().any(known) {
                continue;
            }
            if of_this_choice && !self.of_all_copies(w, found) {
                continue;
            }
            let mut d = w.diagnostic.clone();
            d.message = self.without_sites(&d.message);
            d.help = d.help.iter().map(|h| self.without_sites(h)).collect();
            out.push(Warning::new(w.topic, d));
        }
        out
    }

    /// Whether what is said of a copy of a quantity is said of all of them: the terms of a line may leave out its last site.
    fn of_all_copies(&self, w: &Warning, found: &[Warning]) -> bool {
        let of = |w: &Warning| {
            let name = w.diagnostic.message.split('`').nth(1)?;
            self.copy(name).map(|c| c.of.as_str())
        };
        let Some(own) = of(w) else { return true };
        let told = found
            .iter()
            .filter(|o| o.topic == w.topic && of(o) == Some(own));
        let copies = self.copies.iter().filter(|c| c.of == own);
        told.count() >= copies.count()
    }

    /// A text with the names of quantities in the place of those of copies.
    fn without_sites(&self, text: &str) -> String {
        let is_part = |c: char| c.is_alphanumeric() || c == '_';
        let mut out = String::new();
        let mut rest = text;
        while let Some(c) = rest.chars().next() {
            let end = rest.find(|c| !is_part(c)).unwrap_or(rest.len());
            let end = if end == 0 { c.len_utf8() } else { end };
            let (word, left) = rest.split_at(end);
            out.push_str(self.copy(word).map_or(word, |c| c.of.as_str()));
            rest = left;
        }
        out
    }
}
