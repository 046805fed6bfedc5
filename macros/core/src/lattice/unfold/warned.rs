//! What derives on a lattice and is hardly meant, in the words of the statement.

use super::Unfolded;
use crate::derive::warnings::{Topic, Warning, unused_let};
use crate::diagnostic::Diagnostic;
use crate::lattice::{Choice, any_name};
use crate::syntax::ast::{Expression, Extent, Model, Name, Statement};
use std::collections::BTreeSet;

/// The sum of such a term starts or ends a site later than that of the same term at the site itself.
pub(super) fn one_neighbour(stated: &Expression) -> Warning {
    let message = "this term holds a neighbour and not the site itself: it is summed over the sites that have this neighbour, all but the one at the end";
    let d = Diagnostic::new(stated.place, message).help(
        "write it at the site itself, or in one bracket with what it is compared with, as in `a*(next(q, i) - q)`",
    );
    Warning::new(Topic::OneNeighbour, d)
}

/// Abbreviations that nothing uses.
pub(super) fn without_use(model: &Model) -> Vec<Warning> {
    let unused = crate::check::unused_definitions(model).into_iter();
    unused
        .map(|(name, place)| unused_let(&name, place))
        .collect()
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
            // What no statement names is unused on every line.
            let of_every_line = w.topic == Topic::UnusedParameter && self.is_unnamed(w);
            let of_this_choice = of_this_choice && !of_every_line;
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

    /// Whether nothing in the statement names the parameter that a warning speaks of.
    fn is_unnamed(&self, w: &Warning) -> bool {
        let name = w.diagnostic.message.split('`').nth(1);
        name.is_some_and(|name| {
            let of = self.copy(name).map_or(name, |c| c.of.as_str());
            self.unnamed.contains(of)
        })
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

/// Parameters of the model that nothing states by name, at whatever ends.
pub(super) fn unnamed(model: &Model) -> BTreeSet<String> {
    let declared = model.statements.iter().flat_map(|s| match s {
        Statement::Label { step, .. } => step.iter().map(|n| n.text.clone()).collect(),
        Statement::Param { names, .. } => names.iter().map(|n| n.text.clone()).collect(),
        _ => Vec::new(),
    });
    declared.filter(|name| !is_named(model, name)).collect()
}

/// Whether a name stands in an expression of the model, or is what a field grows by or lies in.
fn is_named(model: &Model, name: &str) -> bool {
    let used = |e: &Expression| any_name(e, &|n| n == name);
    model.statements.iter().any(|s| match s {
        Statement::Assume { left, right, .. } | Statement::Hold { left, right, .. } => {
            used(left) || used(right)
        }
        Statement::Lagrangian(value)
        | Statement::Scale(value)
        | Statement::Let { value, .. }
        | Statement::Constraint { value, .. } => used(value),
        Statement::Advected { definition, .. } => definition.iter().any(used),
        Statement::Mesh { arguments, .. } => arguments.iter().any(|n| n.text == name),
        Statement::End { alternatives, .. } => alternatives.iter().flat_map(|a| &a.terms).any(used),
        Statement::Field { offset, domain, .. } => {
            let lengths = match domain {
                Some(Extent::Torus(lengths)) => Some(lengths),
                _ => None,
            };
            offset.iter().chain(lengths).any(|n| n.text == name)
        }
        Statement::Label { .. }
        | Statement::Periodic(_)
        | Statement::Dim { .. }
        | Statement::Time { .. }
        | Statement::Param { .. }
        | Statement::Group { .. }
        | Statement::Given { .. }
        | Statement::Grid(_)
        | Statement::Node(..) => false,
    })
}
