//! Warnings about chain models that derive but are probably not intended, in the words of the declared model.

use super::ExpandedModel;
use crate::derive::warnings::{Topic, Warning, unused_let};
use crate::diagnostic::Diagnostic;
use crate::lattice::{ChainConfig, any_name};
use crate::syntax::ast::{Expression, Extent, Model, Name, Statement};
use std::cell::RefCell;
use std::collections::BTreeSet;

/// Warns about a term of one neighbour only. Its sum starts or ends one site later than the sum of the same term at
/// the site itself.
pub(super) fn one_neighbour(stated: &Expression) -> Warning {
    let message =
        "this term contains a neighbour but not the site itself: its sum omits the site at one end";
    let d = Diagnostic::new(stated.place, message).help(
        "write the term at the site itself, or together with the value there, as in `a*(next(q, i) - q)`",
    );
    Warning::new(Topic::OneNeighbour, d)
}

/// Unused `let` definitions.
pub(super) fn without_use(model: &Model) -> Vec<Warning> {
    let unused = crate::check::unused_definitions(model).into_iter();
    unused
        .map(|(name, place)| unused_let(&name, place))
        .collect()
}

/// Warns about an offset on an open chain; an offset only acts across the seam of a ring.
pub(super) fn without_a_ring(offset: &Name) -> Warning {
    let message = format!(
        "`{}` is the offset of a field around a ring, but the chain is not periodic",
        offset.text
    );
    let d = Diagnostic::new(offset.place, message);
    Warning::new(
        Topic::UnusedParameter,
        d.help("add `periodic;`, or remove the offset"),
    )
}

impl ExpandedModel {
    /// The warnings in the words of the declared model: about terms first, then from the derivation. On a short
    /// chain, or with prescribed ends, a quantity may be unused or constant although it is neither on other chains.
    pub fn declared_warnings(&self, choice: &ChainConfig, found: &[Warning]) -> Vec<Warning> {
        let shortest = 2 * self.width() + 2;
        // Without neighbours, one site represents all sites.
        let short = self.width() > 0 && choice.counts.iter().all(|n| *n < shortest);
        let partial = short || !self.given.is_empty();
        let mut out: Vec<Warning> = Vec::new();
        for w in self.warnings.iter().chain(found) {
            let of_this_choice = matches!(w.topic, Topic::UnusedParameter | Topic::ConstantTerm);
            let place = |w: &Warning| format!("{:?}", w.diagnostic.place);
            let known = |o: &Warning| o.topic == w.topic && place(o) == place(w);
            let stated = self.warnings.iter().any(known);
            // A parameter that no statement names is unused on every chain.
            let of_every_line =
                w.topic == Topic::UnusedParameter && self.stands_in(&self.named.not_at_all, w);
            let of_this_choice = of_this_choice && !of_every_line;
            // An end condition that was not chosen uses it.
            if w.topic == Topic::UnusedParameter && self.stands_in(&self.named.by_ends, w) {
                continue;
            }
            if partial && of_this_choice && !stated || out.iter().any(known) {
                continue;
            }
            if of_this_choice && !self.of_all_copies(w, found) {
                continue;
            }
            let mut d = w.diagnostic.clone();
            d.message = self.without_sites(&d.message);
            d.help = d.help.iter().map(|h| self.without_sites(h)).collect();
            if w.topic == Topic::UnusedParameter
                && let Some(s) = self.spacing(&d.message)
            {
                d.help = vec![format!(
                    "use `{s}` in the Lagrangian, or remove `step {s}` from the label; until then, every case must give `{s}`"
                )];
            }
            out.push(Warning::new(w.topic, d));
        }
        out
    }

    /// The spacing of a label that a warning names.
    fn spacing<'a>(&self, message: &'a str) -> Option<&'a str> {
        let name = message.split('`').nth(1)?;
        self.named.spacings.contains(name).then_some(name)
    }

    /// Whether the parameter of a warning is one of these names.
    fn stands_in(&self, names: &BTreeSet<String>, w: &Warning) -> bool {
        let name = w.diagnostic.message.split('`').nth(1);
        name.is_some_and(|name| {
            let of = self.copy(name).map_or(name, |c| c.of.as_str());
            names.contains(of)
        })
    }

    /// Whether a warning about one copy of a quantity applies to all its copies: the terms of a chain may leave out its
    /// last site.
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

    /// A text with the names of copies replaced by the names of their quantities.
    pub(super) fn without_sites(&self, text: &str) -> String {
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

/// The names in all statements, including the end conditions that were not chosen.
#[derive(Clone, Debug)]
pub(super) struct StatementNames {
    /// Parameters whose names do not occur anywhere.
    not_at_all: BTreeSet<String>,
    /// Names that the terms of end conditions use, chosen or not.
    by_ends: BTreeSet<String>,
    /// The spacings of labels.
    spacings: BTreeSet<String>,
}

impl StatementNames {
    /// Collects the names of a model.
    pub(super) fn of(model: &Model) -> Self {
        StatementNames {
            not_at_all: unnamed(model),
            by_ends: of_ends(model),
            spacings: spacings(model).collect(),
        }
    }
}

/// Parameters whose names occur in no statement and no end condition.
fn unnamed(model: &Model) -> BTreeSet<String> {
    let declared = model.statements.iter().flat_map(|s| match s {
        Statement::Param { names, .. } => names.iter().map(|n| n.text.clone()).collect(),
        _ => Vec::new(),
    });
    let declared = declared.chain(spacings(model));
    declared.filter(|name| !is_named(model, name)).collect()
}

/// The names of the spacings of labels.
fn spacings(model: &Model) -> impl Iterator<Item = String> {
    let steps = model.statements.iter().filter_map(|s| match s {
        Statement::Label { step, .. } => step.as_ref(),
        _ => None,
    });
    steps.map(|n| n.text.clone())
}

/// Names in the terms of all end conditions, chosen or not, and in the definitions that these terms use.
fn of_ends(model: &Model) -> BTreeSet<String> {
    let statements = || model.statements.iter();
    let terms = statements().flat_map(|s| match s {
        Statement::End { alternatives, .. } => alternatives.iter().flat_map(|a| &a.terms).collect(),
        _ => Vec::new(),
    });
    let mut pending: Vec<&Expression> = terms.collect();
    let mut found = BTreeSet::new();
    while let Some(e) = pending.pop() {
        let collected = RefCell::new(Vec::new());
        any_name(e, &|name| {
            collected.borrow_mut().push(name.to_owned());
            false
        });
        for own in collected.into_inner() {
            if !found.insert(own.clone()) {
                continue;
            }
            pending.extend(statements().filter_map(|s| match s {
                Statement::Let { name, value } if name.text == own => Some(value),
                _ => None,
            }));
        }
    }
    found
}

/// Whether a name occurs in an expression of the model, or as the offset or domain of a field.
fn is_named(model: &Model, name: &str) -> bool {
    let used = |e: &Expression| any_name(e, &|n| n == name);
    model.statements.iter().any(|s| match s {
        Statement::Mesh { arguments, .. } => arguments.iter().any(|n| n.text == name),
        Statement::Field { offset, domain, .. } => {
            let lengths = match domain {
                Some(Extent::Torus(lengths)) => Some(lengths),
                _ => None,
            };
            offset.iter().chain(lengths).any(|n| n.text == name)
        }
        // The body of a function counts where the function is called.
        Statement::Given { .. } => false,
        _ => s.expressions().into_iter().any(used),
    })
}
